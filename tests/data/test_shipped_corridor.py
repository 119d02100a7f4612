"""The shipped corridor: as large as promised, and an honest experiment."""

import dataclasses
import json
import re
from pathlib import Path

import numpy as np
import pytest
import trimesh

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import rotation_angle
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from courseware.simulation.corridor.world import CLUTTER, make_corridor
from courseware.simulation.sensors.ray_casting import WorldCaster
from tools.corridor_data import CorridorModels

FOLDER = Path(__file__).resolve().parents[2] / "data" / "corridor"


@pytest.fixture(scope="module")
def summary():
    return json.loads((FOLDER / "summary.json").read_text())


@pytest.fixture(scope="module")
def map_caster():
    scene_map = SceneMap.load(FOLDER / "map.ply")
    assert 100_000 <= len(scene_map.faces) <= 200_000
    assert scene_map.bounds[1][0] - scene_map.bounds[0][0] > 39
    return WorldCaster(scene_map.vertices, scene_map.faces)


@pytest.fixture(scope="module")
def true_caster():
    mesh = trimesh.load(FOLDER / "true_world.ply", process=False)
    return WorldCaster(np.asarray(mesh.vertices), np.asarray(mesh.faces))


@pytest.mark.parametrize(("run", "least_frames"), [("wagon", 300), ("hand", 150)])
def test_a_run_has_a_timed_pose_for_every_frame_and_short_steps(run, least_frames):
    sequence = read_sequence(FOLDER / run)
    poses = sequence.camera_to_world
    assert len(sequence) == len(sequence.times) == len(poses) >= least_frames
    assert sequence.up == "z"
    assert np.diff(sequence.times) == pytest.approx(0.1, abs=1e-6)
    assert sequence.image_shape == DepthCamera.sr4000().shape
    assert sequence.intrinsics == pytest.approx(DepthCamera.sr4000().matrix, abs=1e-5)
    assert np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1).max() <= 0.1
    turns = rotation_angle(np.swapaxes(poses[:-1, :3, :3], 1, 2) @ poses[1:, :3, :3])
    assert np.rad2deg(turns.max()) <= 5.0


@pytest.mark.parametrize("number", [i for i, row in enumerate(CLUTTER) if row[0] in ("cartons", "person", "bin")])
def test_the_map_lacks_the_clutter(number, map_caster, true_caster):
    kind, x, y, _ = CLUTTER[number]
    # From the middle of the corridor; people are met at the chest, not between the legs.
    height = 1.2 if kind == "person" else 0.5
    eye = np.array([x - 1.5, 0.0, height])
    target = np.array([x, y, height]) - eye
    seen, mapped = (c.cast(eye, target[None]).distance[0] for c in (true_caster, map_caster))
    assert seen < 1.05
    assert mapped > seen + 0.05


@pytest.mark.parametrize("run", ["wagon", "hand"])
def test_at_the_true_poses_the_camera_mostly_agrees_with_the_map(run, map_caster, summary):
    """Most pixels agree to centimetres, and a shift of a decimetre along the corridor is seen in every frame."""
    sequence = read_sequence(FOLDER / run)
    missing = np.mean([np.isnan(sequence.depth(i)).mean() for i in range(len(sequence))])
    assert missing == pytest.approx(summary["measured"][run]["no_return_share"], rel=1e-3)
    rays = DepthCamera.sr4000().rays()[::2, ::2]
    medians = []
    for index in range(0, len(sequence), 12):
        measured, pose = sequence.depth(index)[::2, ::2], sequence.camera_to_world[index]
        scores = []
        for shift in (-0.1, 0.0, 0.1):
            origin = pose[:3, 3] + [shift, 0.0, 0.0]
            with np.errstate(invalid="ignore"):
                error = np.abs(measured - map_caster.cast(origin, rays @ pose[:3, :3].T).distance)
                scores.append(np.nansum(1 - error / (0.1 + error)))
            if shift == 0.0:
                medians.append(np.nanmedian(error))
        assert scores[1] > max(scores[0], scores[2]) * 1.01, f"frame {index}"
    assert np.median(medians) < 0.035


def test_seed_models_and_true_world_are_those_of_the_code(summary):
    assert summary["seed"] == 4
    assert summary["models"] == json.loads(json.dumps(dataclasses.asdict(CorridorModels())))
    world = make_corridor(np.random.default_rng(4).spawn(7)[0])
    mesh = trimesh.load(FOLDER / "true_world.ply", process=False)
    assert np.array_equal(mesh.faces, world.run_day.faces)
    assert mesh.vertices == pytest.approx(world.run_day.vertices, abs=1e-5)
    reflectivity = mesh.metadata["_ply_raw"]["vertex"]["data"]["reflectivity"][mesh.faces[:, 0]]
    assert np.ravel(reflectivity) == pytest.approx(world.run_day.reflectivity, rel=1e-6)


def test_the_readme_tells_the_measured_numbers(summary):
    text, measured = (FOLDER / "README.md").read_text(), summary["measured"]
    surface, registration = measured["map"]["distance_to_surveyed_world"], measured["map"]["registration"]
    names = "mean_point_distance_m", "mean_point_distance_true_poses_m", "rms_station_position_error_m"
    millimetres = [registration[name] for name in names] + [surface["median_m"], surface["p90_m"]]
    millimetres += measured["noise_on_a_wall_m"].values()
    found = [float(number) for number in re.findall(r"\| ([\d.]+) mm \|", text)]
    assert found == pytest.approx([1000 * value for value in millimetres], abs=0.06)
    rows = re.findall(r"\| ([\d.]+) % \| ([\d.]+) % \|", text)
    keys = ("no_return", "nothing_there", "saturated", "beyond_unambiguous_range", "wrapped", "flying")
    for shares, key in zip(rows, keys, strict=True):
        expected = [100 * measured[run][f"{key}_share"] for run in ("wagon", "hand")]
        assert [float(share) for share in shares] == pytest.approx(expected, abs=0.06)
    assert f"{100 * measured['map']['hole_share']:.1f} % |" in text
