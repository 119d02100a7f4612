"""`localize` on recordings: its JSON, what it writes, what it believes of its track, and what it refuses."""

import csv
import json

import numpy as np
import pytest

from course_lib.cli import main
from course_lib.commands.localize_report import believed
from course_lib.depth_mcl.sequence import read_sequence, write_sequence
from course_lib.depth_mcl.sequence_files import read_tum
from course_lib.geometry import rotation_to_z_up, state_from_optical_pose


def arguments(folder, sequence="wagon", **options):
    words = ["localize", "--map", str(folder / "map.ply"), "--sequence", str(folder / sequence)]
    for name, value in options.items():
        words += [f"--{name.replace('_', '-')}"] + ([] if value is True else [str(value)])
    return words


def test_the_wagon_is_followed_in_x_y_and_yaw(corridor_folder, tmp_path, capsys):
    words = arguments(corridor_folder, dof="xyyaw", frames=6, particles=60, seed=1, json=True, out=tmp_path)
    assert main(words) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["believes"] == "tracked in all 6 frames"
    assert (summary["frames"], summary["renders_per_frame"], summary["seed"]) == (6, 60, 1)
    assert summary["median_position_m"] < 0.15
    stored = json.loads((tmp_path / "localize.json").read_text())
    assert stored["median_position_m"] == summary["median_position_m"]
    assert {"numpy", "vtk", "course_lib"} <= stored["versions"].keys()
    rows = list(csv.DictReader((tmp_path / "localize.csv").open()))
    assert [row["status"] for row in rows] == ["tracked"] * 6
    assert all(0.4 < float(row["score"]) < 1 and float(row["position_error_m"]) < 0.3 for row in rows)
    assert read_tum(tmp_path / "trajectory.txt")[1].shape == (6, 4, 4)
    assert (tmp_path / "track.png").read_bytes().startswith(b"\x89PNG")
    page = (tmp_path / "track.html").read_text()
    assert "<title>Path of wagon in map.ply</title>" in page


@pytest.mark.slow
def test_frames_at_fault_are_named_and_not_used(corridor_folder, tmp_path, capsys):
    """A frame that came twice, one at its stop and a dark one; the frames before them are localized as ever."""
    wagon = read_sequence(corridor_folder / "wagon")
    depths = [wagon.depth(k) for k in range(9)]
    depths[4], depths[6] = depths[3], np.full_like(depths[6], 9.9)
    depths[7] = np.full_like(depths[7], np.nan)
    write_sequence(tmp_path / "seen", wagon.intrinsics, list(range(9)), depths, wagon.camera_to_world[:9], up="z")
    words = ["--map", str(corridor_folder / "map.ply"), "--dof", "xyyaw", "--particles", "60", "--seed", "1"]
    assert main(["localize", *words, "--sequence", str(tmp_path / "seen"), "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "2 frames were at fault and not used: repeated 1, saturated 1" in said
    assert "1 frames held no measurement" in said
    rows = list(csv.DictReader((tmp_path / "out" / "localize.csv").open()))
    assert [row["fault"] for row in rows] == ["", "", "", "", "repeated", "", "saturated", "no return", ""]
    assert all(rows[k]["status"] != "tracked" for k in (4, 6, 7))
    assert main(arguments(corridor_folder, dof="xyyaw", frames=4, particles=60, seed=1, out=tmp_path / "good")) == 0
    good = list(csv.DictReader((tmp_path / "good" / "localize.csv").open()))
    assert [row["x_m"] for row in rows[:4]] == [row["x_m"] for row in good]


def test_a_hand_carried_run_is_followed_in_six_degrees(corridor_folder, capsys):
    """By the paper's filter roughly, annealed to a few centimetres: no other tests measure so with so little."""
    found = {}
    for method in ("paper", "annealed"):
        words = arguments(corridor_folder, "hand", dof="6", frames=4, particles=80, method=method, json=True)
        assert main(words) == 0
        found[method] = json.loads(capsys.readouterr().out)
        assert found[method]["method"] == method
    assert found["paper"]["median_position_m"] < 0.3
    assert found["paper"]["median_rotation_deg"] < 8
    assert 0.05 < found["paper"]["mean_normalized_error"] < 20
    assert found["annealed"]["median_position_m"] < 0.04
    assert found["annealed"]["median_rotation_deg"] < 0.5
    assert found["annealed"]["renders_per_frame"] < found["annealed"]["most_renders"] <= 600


@pytest.fixture
def cut(corridor_folder, tmp_path):
    """The shipped recording by hand without its truth, in two stretches that lie six metres apart, with gravity."""
    hand = read_sequence(corridor_folder / "hand")
    kept = [*range(40, 46), *range(125, 134)]
    folder = tmp_path / "cut"
    write_sequence(folder, hand.intrinsics, kept, [hand.depth(i) for i in kept], hand.camera_to_world[kept], up="z")
    (folder / "poses.txt").rename(tmp_path / "poses.txt")
    (folder / "groundtruth.txt").unlink(missing_ok=True)
    down = -hand.camera_to_world[kept][:, 2, :3]
    np.savetxt(folder / "gravity.txt", np.column_stack([kept, 9.81 * down]))
    return folder, hand.camera_to_world[kept]


@pytest.mark.slow
def test_from_an_unknown_start_through_a_kidnapping(corridor_folder, cut, tmp_path, capsys):
    folder, true = cut
    words = ["localize", "--map", str(corridor_folder / "map.ply"), "--sequence", str(folder), "--out", str(tmp_path)]
    assert main([*words, "--start", "unknown", "--recover", "--seed", "1"]) == 0
    assert "lost" in capsys.readouterr().out.splitlines()[-1]
    stored = json.loads((tmp_path / "localize.json").read_text())
    first = stored["found_in_frame"] - 40
    assert 3 <= first < 6
    track = read_tum(tmp_path / "trajectory.txt")[1]
    assert len(track) == 15 - first
    off = np.linalg.norm(track[:, :3, 3] - true[first:, :3, 3], axis=1)
    assert off[: 6 - first].max() < 0.05
    assert off[6 - first] > 1
    assert off[-1] < 0.05


@pytest.fixture
def blind(corridor_folder, tmp_path):
    """Four frames of the wagon without their truth, and what the truth is: the folder, the first pose's numbers."""
    run = read_sequence(corridor_folder / "wagon")
    write_sequence(
        tmp_path / "blind", run.intrinsics, run.frames[:4], [run.depth(i) for i in range(4)], run.camera_to_world[:4],
        up="z",
    )  # fmt: skip
    (tmp_path / "blind" / "poses.txt").rename(tmp_path / "truth.txt")
    state = state_from_optical_pose(run.camera_to_world[0])
    return tmp_path, [f"{v:.9f}" for v in (*state[:3], *np.rad2deg(state[3:]))]


@pytest.mark.slow
def test_a_recording_without_truth_is_localized_from_a_pose_that_is_given(corridor_folder, blind, capsys):
    """As numbers, from a file, and as with the truth: the same trajectory; without the truth no errors."""
    folder, numbers = blind
    common = {"dof": "xyyaw", "seed": 3, "particles": 30, "frames": 4}
    tracks = []
    for index, start in enumerate((numbers, [str(folder / "truth.txt")], None)):
        out, sequence = folder / f"out{index}", folder / "blind" if start else "wagon"
        words = arguments(corridor_folder, sequence, out=out, **common)
        assert main(words + (["--start", *start] if start else [])) == 0
        said = capsys.readouterr().out
        assert ("errors are not known" in said) == ("position error" not in said) == (start is not None)
        assert said.splitlines()[-1] == "tracked in all 4 frames"
        tracks.append(read_tum(out / "trajectory.txt")[1])
    assert all(np.allclose(track, tracks[0], atol=1e-5) for track in tracks)


def test_a_start_is_meant_in_the_map_s_own_axes_and_its_angles_as_upright(corridor_folder, tmp_path, capsys):
    """In a world whose y points up: the position as the mesh has it, yaw about the vertical."""
    import trimesh

    turn = np.linalg.inv(rotation_to_z_up("y"))
    trimesh.load(corridor_folder / "map.ply", process=False).apply_transform(turn).export(tmp_path / "map.ply")
    run = read_sequence(corridor_folder / "wagon")
    poses = turn @ run.camera_to_world[:2]
    write_sequence(tmp_path / "run", run.intrinsics, [0, 1], [run.depth(0), run.depth(1)], poses, up="y")
    state = state_from_optical_pose(run.camera_to_world[0])
    start = [f"{v:.9f}" for v in (*poses[0, :3, 3], *np.rad2deg(state[3:]))]
    assert main([*arguments(tmp_path, "run", dof="xyyaw", particles=40, json=True), "--start", *start]) == 0
    assert json.loads(capsys.readouterr().out)["median_position_m"] < 0.15


def test_a_filter_that_is_wrong_from_the_start_says_so_and_ends_well(corridor_folder, tmp_path, capsys):
    words = arguments(corridor_folder, dof="xyyaw", frames=5, particles=30, out=tmp_path, start="20 0 1.4 0 0 120")
    assert main(words) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("lost from the first frame on (5 of 5 frames")
    assert {row["status"] for row in csv.DictReader((tmp_path / "localize.csv").open())} == {"lost"}


@pytest.mark.parametrize(
    ("statuses", "line"),
    [
        ("TTTT", "tracked in all 4 frames"),
        ("TLLD", "lost from frame 20 on (2 of 4 frames; tracked 1, doubtful 1)"),
        ("TLTLLT", "lost in 2 stretches between frames 20 and 50 (3 of 6 frames; tracked 3, doubtful 0)"),
    ],
)
def test_one_line_says_what_is_believed(statuses, line):
    names = {"T": "tracked", "D": "doubtful", "L": "lost"}
    assert believed([10 * (i + 1) for i in range(len(statuses))], [names[s] for s in statuses]) == line


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"start": "1 2 nan 0 0 0"}, "six finite numbers"),
        ({"start": "500 0 1 0 0 0"}, "outside the map"),
        ({"depth-scale": "nan"}, "--depth-scale"),
        ({"near": "5", "far": "2"}, "--near must be below --far"),
        ({"map": "nowhere.ply"}, "nowhere.ply is missing"),
        ({"sequence": "nowhere"}, "no sequence at"),
        ({"frames": "-3"}, "--frames must be at least 1; got -3"),
        ({"sequence": "{blind}"}, "where does the camera start"),
        ({"up": "unknown"}, "which way is up in this world is unknown"),
        ({"method": "annealed"}, "six degrees of freedom"),
        ({"dof": "6", "method": "paper", "recover": True}, "--recover goes with the annealed filter"),
    ],
)
def test_bad_input_is_one_sentence_and_writes_nothing(corridor_folder, blind, tmp_path, capsys, options, said):
    words = arguments(corridor_folder, dof="xyyaw", frames=2, out=tmp_path / "out")
    for name, value in options.items():
        given = str(value).format(blind=blind[0] / "blind")
        words += [f"--{name}"] if value is True else [f"--{name}={given}"]
    assert main(words) == 2
    error = capsys.readouterr().err
    assert said in error
    assert "Traceback" not in error
    assert not (tmp_path / "out").exists()


def test_an_output_folder_that_cannot_be_is_told_before_any_work(corridor_folder, tmp_path, capsys):
    (tmp_path / "a_file").write_text("mine")
    assert main(arguments(corridor_folder, dof="xyyaw", out=tmp_path / "a_file")) == 2
    captured = capsys.readouterr()
    assert "--out" in captured.err
    assert "frame/s" not in captured.err  # no progress bar: nothing ran
    assert (tmp_path / "a_file").read_text() == "mine"
