"""`localize` on recordings: its JSON, what it writes, and what it refuses."""

import json

import numpy as np
import pytest

from course_lib.cli import main
from course_lib.experiments.results import read_tum

KEYS = {
    "frames", "median_position_m", "p90_position_m", "median_rotation_deg", "p90_rotation_deg",
    "within_5cm_5deg_percent", "renders_per_frame", "ms_per_frame", "seed",
}  # fmt: skip


def arguments(folder, sequence="wagon", **options):
    words = ["localize", "--map", str(folder / "map.ply"), "--sequence", str(folder / sequence)]
    for name, value in options.items():
        words += [f"--{name.replace('_', '-')}"] + ([] if value is True else [str(value)])
    return words


def test_the_wagon_is_followed_in_x_y_and_yaw(corridor_folder, tmp_path, capsys):
    words = arguments(corridor_folder, dof="xyyaw", frames=6, particles=60, seed=1, json=True, out=tmp_path)
    assert main(words) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary.keys() >= KEYS
    assert (summary["frames"], summary["renders_per_frame"], summary["seed"]) == (6, 60, 1)
    assert summary["median_position_m"] < 0.15
    stored = json.loads((tmp_path / "localize.json").read_text())
    assert stored["median_position_m"] == summary["median_position_m"]
    assert {"numpy", "vtk", "course_lib"} <= stored["versions"].keys()
    assert len((tmp_path / "localize.csv").read_text().splitlines()) == 7
    assert read_tum(tmp_path / "trajectory.txt")[1].shape == (6, 4, 4)
    assert (tmp_path / "errors.png").read_bytes().startswith(b"\x89PNG")


def test_a_hand_carried_run_is_followed_in_six_degrees(corridor_folder, capsys):
    assert main(arguments(corridor_folder, "hand", dof="6", frames=4, particles=80, json=True)) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["median_position_m"] < 0.3
    assert summary["median_rotation_deg"] < 8


def test_the_same_seed_gives_the_same_table(corridor_folder, capsys):
    tables = []
    for _ in range(2):
        assert main(arguments(corridor_folder, dof="xyyaw", frames=3, particles=30, seed=5)) == 0
        tables.append(capsys.readouterr().out.rsplit("renders", 1)[0])
    assert tables[0] == tables[1]
    assert "within 5 cm and 5 degrees" in tables[0]


def test_the_kitchen_is_localized_in_six_degrees_through_gimbal_lock(kitchen_folder, capsys):
    assert main(arguments(kitchen_folder, ".", dof="6", frames=5, particles=100, json=True)) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["up"] == "unknown"
    assert summary["median_position_m"] < 0.2
    assert summary["median_rotation_deg"] < 8


@pytest.mark.slow
def test_the_kitchen_is_run_to_its_end(kitchen_folder, capsys):
    """With few particles, for time: whether it holds to the camera is the README's table, whether it ends is this."""
    assert main(arguments(kitchen_folder, ".", dof="6", particles=20, json=True)) == 0
    summary = json.loads(capsys.readouterr().out)
    assert (summary["frames"], summary["renders_per_frame"]) == (167, 20)
    assert summary["p90_position_m"] < 1.5


def test_x_y_yaw_in_a_world_whose_up_is_unknown_is_refused(kitchen_folder, capsys):
    assert main(arguments(kitchen_folder, ".", dof="xyyaw", frames=2)) == 2
    error = capsys.readouterr().err
    assert "--up" in error
    assert "Traceback" not in error


@pytest.mark.parametrize("up", ["-y", "x"])
def test_a_turned_world_gives_the_same_errors(corridor_folder, tmp_path, capsys, up):
    """The corridor's map and poses turned so that another axis points up, and told so with --up."""
    import trimesh

    from course_lib.depth_mcl.sequence import rotation_to_z_up
    from course_lib.experiments.results import read_sequence, write_sequence

    turn = np.linalg.inv(rotation_to_z_up(up))
    mesh = trimesh.load(corridor_folder / "map.ply", process=False)
    mesh.apply_transform(turn)
    mesh.export(tmp_path / "map.ply")
    run = read_sequence(corridor_folder / "wagon")
    depths = [run.depth(i) for i in range(3)]
    write_sequence(tmp_path / "run", run.intrinsics, run.frames[:3], depths, turn @ run.camera_to_world[:3])
    words = arguments(tmp_path, "run", dof="xyyaw", particles=80, json=True)
    assert main([*words, "--up", up]) == 0
    turned = json.loads(capsys.readouterr().out)
    assert main(arguments(corridor_folder, dof="xyyaw", particles=80, frames=3, json=True)) == 0
    upright = json.loads(capsys.readouterr().out)
    assert turned["median_position_m"] == pytest.approx(upright["median_position_m"], abs=0.02)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"map": "nowhere.ply"}, "no map at"),
        ({"sequence": "nowhere"}, "no sequence at"),
        ({"particles": "0"}, "particles"),
        ({"frames": "0"}, "frames"),
        ({"sigma-position": "-1"}, "sigma"),
        ({"seed": "-1"}, "--seed"),
    ],
)
def test_bad_input_is_one_sentence_and_writes_nothing(corridor_folder, tmp_path, capsys, options, said):
    words = arguments(corridor_folder, dof="xyyaw", frames=2, out=tmp_path / "out")
    for name, value in options.items():
        words += [f"--{name}={value}"]
    assert main(words) == 2
    error = capsys.readouterr().err
    assert said in error
    assert "Traceback" not in error
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("command", ["localize", "demo corridor"])
@pytest.mark.parametrize("bad", ["a_file", "a_file/below", "/proc/nowhere"])
def test_an_output_folder_that_cannot_be_is_told_before_any_work(corridor_folder, tmp_path, capsys, command, bad):
    (tmp_path / "a_file").write_text("mine")
    out = bad if bad.startswith("/") else str(tmp_path / bad)
    words = arguments(corridor_folder, dof="xyyaw") if command == "localize" else command.split()
    assert main([*words, "--out", out]) == 2
    captured = capsys.readouterr()
    assert "--out" in captured.err
    assert "frame/s" not in captured.err  # no progress bar: nothing ran
    assert (tmp_path / "a_file").read_text() == "mine"
