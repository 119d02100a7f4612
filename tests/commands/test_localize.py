"""`localize` on recordings: its JSON, what it writes, and what it believes of its track."""

import json

import numpy as np
import pytest
import trimesh

from course_lib.beyond import GuardedLocalizer, RecoveringLocalizer
from course_lib.beyond.guarded_depth import status_of
from course_lib.depth_mcl.sequence import read_sequence, write_sequence
from course_lib.depth_mcl.sequence_files import read_tum
from course_lib.geometry import optical_pose, rotation_to_z_up, state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.cli import main
from courseware.commands.localize_report import believed
from tests.beyond.six_dof.test_calibration import STATES
from tests.commands.conftest import rows_of
from tests.rendering.shapes import SMALL, furnished_room


def arguments(folder, sequence="wagon", **options):
    words = ["localize", "--map", str(folder / "map.ply"), "--sequence", str(folder / sequence)]
    for name, value in options.items():
        words += [f"--{name.replace('_', '-')}"] + ([] if value is True else [str(value)])
    return words


def test_the_wagon_is_followed_in_x_y_and_yaw(corridor_folder, tmp_path, told):
    summary = told(*arguments(corridor_folder, dof="xyyaw", frames=6, particles=60, seed=1, out=tmp_path))
    assert summary["believes"] == "tracked in all 6 frames"
    assert (summary["frames"], summary["renders_per_frame"], summary["seed"]) == (6, 60, 1)
    assert summary["median_position_m"] < 0.15
    stored = json.loads((tmp_path / "localize.json").read_text())
    assert stored["median_position_m"] == summary["median_position_m"]
    rows = rows_of(tmp_path / "localize.csv")
    assert [row["status"] for row in rows] == ["tracked"] * 6
    assert all(0.4 < float(row["score"]) < 1 and float(row["position_error_m"]) < 0.3 for row in rows)
    assert read_tum(tmp_path / "trajectory.txt")[1].shape == (6, 4, 4)
    assert (tmp_path / "track.png").read_bytes().startswith(b"\x89PNG")
    files = {path.name for path in tmp_path.iterdir()} - {"run.json"}
    assert set(json.loads((tmp_path / "run.json").read_text())["files"]) == files
    assert "<title>Path of wagon in map.ply</title>" in (tmp_path / "track.html").read_text()


@pytest.mark.slow
def test_frames_at_fault_are_named_and_not_used(corridor_folder, tmp_path, recorded, printed):
    """A frame that came twice, one at its stop and a dark one; the frames before them are localized as ever."""

    def spoil(depths):
        depths[4], depths[6], depths[7] = depths[3], np.full_like(depths[6], 9.9), np.full_like(depths[7], np.nan)

    options = {"dof": "xyyaw", "particles": 60, "seed": 1}
    said = printed(
        *arguments(corridor_folder, recorded("wagon", range(9), "seen", spoil), out=tmp_path / "out", **options)
    )
    assert "2 frames were at fault and not used: repeated 1, saturated 1" in said
    assert "1 frames held no measurement" in said
    rows = rows_of(tmp_path / "out" / "localize.csv")
    assert [row["fault"] for row in rows] == ["", "", "", "", "repeated", "", "saturated", "no return", ""]
    assert all(rows[k]["status"] == "no measurement" for k in (4, 6, 7))
    printed(*arguments(corridor_folder, frames=4, out=tmp_path / "good", **options))
    assert [row["x_m"] for row in rows[:4]] == [row["x_m"] for row in rows_of(tmp_path / "good" / "localize.csv")]


def test_the_command_treats_every_frame_as_the_watch_of_the_readme_does(corridor_folder, recorded, tmp_path, printed):
    """A frame that never came, and a frozen image: the same outcomes and the same poses."""

    def freeze(depths):
        depths[5] = depths[4]

    folder = recorded("hand", [0, 1, 2, 4, 5, 6, 7, 8, 9], "troubled", freeze, timed=True)
    recording = read_sequence(folder)
    words = arguments(corridor_folder, folder, seed=1, particles=60, recover=True, out=tmp_path / "out")
    assert "1 frames were at fault and not used: repeated 1" in printed(*words)
    with DepthRenderer(SceneMap.load(corridor_folder / "map.ply"), recording.camera()) as renderer:
        robot = GuardedLocalizer(RecoveringLocalizer(renderer, 60, seed=1), period=recording.period)
        robot.initialize(state_from_optical_pose(recording.camera_to_world[0]))
        seen = [robot.step(recording.depth(k), time) for k, time in enumerate(recording.times)]
    assert [len(frame.missed) for frame in seen] == [0, 0, 0, 1, 0, 0, 0, 0, 0]
    rows = rows_of(tmp_path / "out" / "localize.csv")
    assert [row["fault"] or row["status"] for row in rows] == [frame.outcome for frame in seen]
    assert [row["status"] for row in rows] == [status_of(frame.outcome) for frame in seen]
    poses = [[float(row[f"{axis}_m"]) for axis in "xyz"] for row in rows]
    assert np.allclose(poses, [frame.estimate.state[:3] for frame in seen], atol=1e-5)


@pytest.mark.parametrize(("method", "metres", "degrees"), [("paper", 0.3, 8), ("annealed", 0.04, 0.5)])
def test_a_hand_carried_run_is_followed_in_six_degrees(corridor_folder, told, method, metres, degrees):
    """By the paper's filter roughly, annealed to a few centimetres: no other tests measure so with so little."""
    found = told(*arguments(corridor_folder, "hand", dof="6", frames=4, particles=80, method=method))
    assert found["method"] == method
    assert found["median_position_m"] < metres
    assert found["median_rotation_deg"] < degrees
    if method == "paper":
        assert 0.05 < found["mean_normalized_error"] < 20
    else:
        assert found["renders_per_frame"] < found["most_renders"] <= 600


@pytest.mark.slow
def test_from_an_unknown_start_through_a_kidnapping(corridor_folder, recorded, tmp_path, printed):
    """Without truth, with gravity, in two stretches that lie six metres apart."""
    kept = [*range(40, 46), *range(125, 134)]
    true = read_sequence(corridor_folder / "hand").camera_to_world[kept]
    folder = recorded("hand", kept, "cut")
    (folder / "poses.txt").unlink()
    (folder / "groundtruth.txt").unlink(missing_ok=True)
    np.savetxt(folder / "gravity.txt", np.column_stack([kept, -9.81 * true[:, 2, :3]]))
    options = {"start": "unknown", "recover": True, "seed": 1, "out": tmp_path}
    assert "lost" in printed(*arguments(corridor_folder, folder, **options)).splitlines()[-1]
    first = json.loads((tmp_path / "localize.json").read_text())["found_in_frame"] - 40
    assert 3 <= first < 6
    track = read_tum(tmp_path / "trajectory.txt")[1]
    assert len(track) == 15 - first
    off = np.linalg.norm(track[:, :3, 3] - true[first:, :3, 3], axis=1)
    assert off[: 6 - first].max() < 0.05
    assert off[6 - first] > 1
    assert off[-1] < 0.05


@pytest.mark.slow
def test_a_recording_without_truth_is_localized_from_a_pose_that_is_given(corridor_folder, recorded, printed, capsys):
    """As numbers, from a file, and as with the truth: the same trajectory; without the truth no errors."""
    folder = recorded("wagon", range(4), "blind")
    (folder / "poses.txt").rename(folder / "truth.txt")
    state = state_from_optical_pose(read_sequence(corridor_folder / "wagon").camera_to_world[0])
    numbers = [f"{v:.9f}" for v in (*state[:3], *np.rad2deg(state[3:]))]
    common, tracks = {"dof": "xyyaw", "seed": 3, "particles": 30, "frames": 4}, []
    for index, start in enumerate((numbers, [str(folder / "truth.txt")], None)):
        out, sequence = folder / f"out{index}", folder if start else "wagon"
        words = arguments(corridor_folder, sequence, out=out, **common) + (["--start", *start] if start else [])
        said = printed(*words)
        assert ("errors are not known" in said) == ("position error" not in said) == (start is not None)
        assert said.splitlines()[-1] == "tracked in all 4 frames"
        tracks.append(read_tum(out / "trajectory.txt")[1])
    assert all(np.allclose(track, tracks[0], atol=1e-5) for track in tracks)
    assert main(arguments(corridor_folder, folder, **common)) == 2
    assert "where does the camera start" in capsys.readouterr().err


def test_a_start_is_meant_in_the_map_s_own_axes_and_its_angles_as_upright(corridor_folder, tmp_path, told):
    """In a world whose y points up: the position as the mesh has it, yaw about the vertical."""
    turn = np.linalg.inv(rotation_to_z_up("y"))
    trimesh.load(corridor_folder / "map.ply", process=False).apply_transform(turn).export(tmp_path / "map.ply")
    run = read_sequence(corridor_folder / "wagon")
    poses = turn @ run.camera_to_world[:2]
    write_sequence(tmp_path / "run", run.intrinsics, [0, 1], [run.depth(0), run.depth(1)], poses, up="y")
    state = state_from_optical_pose(run.camera_to_world[0])
    start = [f"{v:.9f}" for v in (*poses[0, :3, 3], *np.rad2deg(state[3:]))]
    found = told(*arguments(tmp_path, "run", dof="xyyaw", particles=40), "--start", *start)
    assert found["median_position_m"] < 0.15


def test_a_filter_that_is_wrong_from_the_start_says_so_and_ends_well(corridor_folder, tmp_path, printed):
    words = arguments(corridor_folder, dof="xyyaw", frames=5, particles=30, out=tmp_path, start="20 0 1.4 0 0 120")
    assert printed(*words).splitlines()[-1].startswith("lost from the first frame on (5 of 5 frames")
    assert {row["status"] for row in rows_of(tmp_path / "localize.csv")} == {"lost"}


@pytest.mark.parametrize("factor", [1.0, 1.05])
def test_a_wrong_focal_length_is_told_in_one_sentence(tmp_path, told, factor):
    scene_map = furnished_room()
    trimesh.Trimesh(scene_map.vertices, scene_map.faces, process=False).export(tmp_path / "map.ply")
    with DepthRenderer(scene_map, SMALL) as renderer:
        images = renderer.render(STATES)
    k = SMALL.matrix @ np.diag([factor, factor, 1.0])
    write_sequence(tmp_path / "run", k, list(range(len(STATES))), list(images), optical_pose(STATES), up="z")
    summary = told(*arguments(tmp_path, "run", no_recover=True))
    assert summary["intrinsics_off_by"]["images"] == len(STATES) // 3
    if factor == 1.0:
        assert summary["intrinsics_doubted"] is None
        return
    assert "the images fit a focal length of 5" in summary["intrinsics_doubted"]
    assert summary["intrinsics_doubted"].endswith("%): check intrinsics.txt")
    assert summary["intrinsics_off_by"]["focal_length_percent"] == pytest.approx(-5, abs=2)


@pytest.mark.parametrize(
    ("statuses", "line"),
    [
        ("TTTT", "tracked in all 4 frames"),
        ("TTND", "tracked in 2 of 4 frames, doubtful in 1, predicted only 1"),
        ("TLND", "lost from frame 20 on (1 of 4 frames; tracked 1, doubtful 1, predicted only 1)"),
        ("TLLD", "lost from frame 20 on (2 of 4 frames; tracked 1, doubtful 1)"),
        ("TLTLLT", "lost in 2 stretches between frames 20 and 50 (3 of 6 frames; tracked 3, doubtful 0)"),
    ],
)
def test_one_line_says_what_is_believed(statuses, line):
    names = {"T": "tracked", "D": "doubtful", "L": "lost", "N": "no measurement"}
    assert believed([10 * (i + 1) for i in range(len(statuses))], [names[s] for s in statuses]) == line
