"""Everything under data/room from one seed: the paper's stereo panoramas, exact boxes and poses, the semantic map."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from course_lib.files import staging_dir
from courseware.simulation.data_folder import checksums, parameter_tables
from courseware.simulation.room.experiment_room import make_experiment_room
from courseware.simulation.room.measurement_places import MEASUREMENT_PLACES
from courseware.simulation.room.stereo_photographs import photograph_pair, write_poses
from courseware.simulation.room.survey import RoomSurveyModel, survey_room
from courseware.simulation.sensors import panorama_rig
from courseware.simulation.sensors.panorama_renderer import PanoramaRenderer
from courseware.simulation.sensors.panorama_rig import NEARLY_PERFECT_RIG, PanoramaCameraModel, RigModel

PRODUCTS = ("experiment_1", "experiment_2", "semantic_map.json", "PARAMETERS.md", "SHA256SUMS")


@dataclass(frozen=True)
class RigHeights:
    """The paper's rigs (section 3): two THETA Z1, 0.30 m apart on one vertical axis."""

    upper_1: float = 1.32  # m above the floor, upper camera of experiment 1; paper 2, section 3
    upper_2: float = 1.44  # m above the floor, upper camera of experiment 2; paper 2, section 3
    baseline: float = 0.30  # m between the cameras; paper 2, section 3


@dataclass(frozen=True)
class RoomModels:
    """All parameters of the room's data. The defaults are the shipped data's; tests take smaller ones."""

    heights: RigHeights = field(default_factory=RigHeights)
    rig: RigModel = NEARLY_PERFECT_RIG
    camera: PanoramaCameraModel = field(default_factory=PanoramaCameraModel)
    survey: RoomSurveyModel = field(default_factory=RoomSurveyModel)
    width: int = 1280  # pixels
    places: tuple[int, ...] = tuple(place.place for place in MEASUREMENT_PLACES)  # of the paper's table 1


def make_room_data(
    out: str | Path, seed: int, models: RoomModels = RoomModels(), progress: Callable[[Iterable], Iterable] = iter
) -> dict:
    """Make the data in folder `out`; return a summary. One seed gives one set of bytes."""
    survey_rng, rng = np.random.default_rng(seed).spawn(2)
    room = make_experiment_room()
    mount = None if models.rig.assembled_anew else panorama_rig.assemble(models.rig, rng.spawn(1)[0])
    baseline, heights = models.heights.baseline, {1: models.heights.upper_1, 2: models.heights.upper_2}
    places = [place for place in MEASUREMENT_PLACES if place.place in models.places]
    shots = [(experiment, place, turn) for experiment in heights for place in places for turn in range(2)]
    lists: dict[int, list[dict]] = {experiment: [] for experiment in heights}
    with staging_dir(out, PRODUCTS) as folder:
        survey_room(room, models.survey, survey_rng).save(folder / "semantic_map.json")
        for experiment in heights:
            (folder / f"experiment_{experiment}").mkdir()
        with PanoramaRenderer(room, models.width) as renderer:
            for experiment, place, turn in progress(shots):
                pose = place.x, place.y, np.deg2rad(place.headings_deg[turn])
                rig = panorama_rig.stand_up(pose, heights[experiment], baseline, models.rig, rng, mount)
                name, where = f"{place.place:02d}_{'ab'[turn]}", folder / f"experiment_{experiment}"
                lists[experiment].append(photograph_pair(renderer, rig, where, name, models.camera, rng))
        for experiment, entries in lists.items():
            write_poses(folder / f"experiment_{experiment}", seed, models.width, baseline, entries)
        (folder / "PARAMETERS.md").write_text(parameter_tables(models, "room"))
        (folder / "SHA256SUMS").write_text(checksums(folder, PRODUCTS))
    return {"seed": seed, "pairs": sum(map(len, lists.values())), "objects": len(room.objects)}
