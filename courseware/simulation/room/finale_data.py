"""Everything under data/finale: the semantic map and the mesh map that `demo finale` would make of one seed."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from course_lib.files import staging_dir
from courseware.simulation.corridor.mesh_building import write_ply
from courseware.simulation.data_folder import checksums, parameter_table
from courseware.simulation.room.depth_world import MAP, STREAM, DepthSurveyModel, surveyed_mesh
from courseware.simulation.room.look_alike_recording import RecordingModels, surveyed_room
from courseware.simulation.sensors.time_of_flight import TimeOfFlightModel

SEED = 10_001  # of the shipped room: a tuning seed, so no room of the reported table is looked at here
PRODUCTS = ("map.ply", "semantic_map.json", "PARAMETERS.md", "SHA256SUMS")


@dataclass(frozen=True)
class FinaleModels:
    """How the room is drawn, photographed and surveyed, and what its depth camera gets wrong."""

    recording: RecordingModels = field(default_factory=RecordingModels)
    mesh: DepthSurveyModel = field(default_factory=DepthSurveyModel)
    depth_camera: TimeOfFlightModel = field(default_factory=TimeOfFlightModel)


def make_finale_data(out: str | Path, seed: int, models: FinaleModels = FinaleModels()) -> dict:
    """Make the data in folder `out`; return a summary. One seed gives one set of bytes."""
    with staging_dir(out, PRODUCTS) as folder:
        room, semantic_map = surveyed_room(seed, models.recording)
        semantic_map.save(folder / "semantic_map.json")
        vertices, faces = surveyed_mesh(room, models.mesh, np.random.default_rng([STREAM, seed, MAP]))
        write_ply(folder / "map.ply", vertices, faces, "generated room, simulated laser survey; CC BY 4.0")
        (folder / "PARAMETERS.md").write_text(finale_parameters(models))
        (folder / "SHA256SUMS").write_text(checksums(folder, PRODUCTS))
    return {"seed": seed, "objects": len(room.objects), "triangles": len(faces)}


def finale_parameters(models: FinaleModels) -> str:
    """PARAMETERS.md: the tables of all models, from their source text."""
    one, mesh = models.recording, models.mesh
    parts = (one.limits, one.rig, one.camera, one.survey, mesh.scanner, mesh.fusion, models.depth_camera)
    head = "# Parameters of the finale's room\n\nWritten by `make-data finale` from the models' source text.\n"
    return "\n".join([head, *map(parameter_table, parts)])
