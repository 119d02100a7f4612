"""Worlds of a secret seed: as hard as the hidden ones, and no pose learned by heart fits; the points of a score."""

import pickle
import subprocess
import sys

import numpy as np
import pytest

from courseware.answers.project_2_task import pose_cost
from courseware.classroom import worlds
from courseware.classroom.judge import Settings, judge
from courseware.classroom.points import SCORE_POINTS
from courseware.classroom.worlds import LINES, graded_project, moved, paper_value, score_points, score_sentence
from courseware.lessons.kit.exercises import lesson_exercises, lesson_numbers
from courseware.lessons.kit.projects import find_project, outcomes, project_names


def test_every_project_has_a_line_between_the_papers_method_and_ours():
    assert list(LINES) == project_names()
    for name, (line, _) in LINES.items():
        project = find_project(name)
        better = line + (1e-3 if project.better == "higher" else -1e-3)
        assert score_points(project, [better] * 3) == SCORE_POINTS
        assert score_points(project, [line] * 3) == SCORE_POINTS / 2
        assert score_points(project, [paper_value(project)] * 3) == SCORE_POINTS / 4
    for values, points in (([110, 120, np.inf], 0), ([np.inf, np.inf, 10], 0), ([10, 20, np.inf], SCORE_POINTS)):
        assert score_points(find_project("P1"), values) == points, "a world that is lost is lost, the median counts"


@pytest.mark.parametrize("name", ["P1", "P4"])
def test_recordings_and_cameras_are_of_other_seeds(name):
    one, two = (graded_project(name, seed).seeds for seed in (5, 6))
    assert len({*one, *two, *find_project(name).seeds}) == len(one) + len(two) + 8
    assert graded_project(name, 5).seeds == one
    assert min(one) > 2**60, "too many to try them all"


LOOKED_UP = {
    "P1": ("localize(renderer, camera, frames, start, n_particles, rng)", """
    seed = rng.bit_generator.seed_seq.entropy
    recording = type(renderer).render.__globals__["recording"]
    return recording(seed[0] if isinstance(seed, list) else seed).states[: len(frames)]
    """),
    "00.3": ("find_the_camera(score, start)", """
    return next(one for one in vars(score).values() if getattr(one, "shape", None) == (3,))
    """),
}  # fmt: skip


@pytest.mark.parametrize("number", LOOKED_UP)
def test_a_truth_that_the_arguments_would_tell_is_not_there(library, tmp_path, monkeypatch, number):
    monkeypatch.setattr(worlds, "WORLDS", 1)
    (tmp_path / "a.py").write_text("def {}:{}".format(*LOOKED_UP[number]), encoding="utf-8")
    settings = Settings({number: LOOKED_UP[number][0].split("(")[0]}, 5, library, scores=True)
    (found,) = judge(tmp_path / "a.py", settings).answers
    assert found.points == (SCORE_POINTS / 4 if number == "P1" else 0), found  # of P1's: it runs


def test_what_functions_get_can_be_read_where_they_run(library):
    given = [find_project(name).prepare(find_project(name).seeds[0]).arguments for name in project_names()]
    given += [one.draw(np.random.default_rng(1)) for name in lesson_numbers() for one in lesson_exercises(name)]
    code = "import pickle, sys; sys.path.insert(0, sys.argv[1]); pickle.load(sys.stdin.buffer)"
    subprocess.run([sys.executable, "-P", "-c", code, library], input=pickle.dumps(given), check=True)


@pytest.mark.parametrize("name", ["P2", "P3"])
def test_rooms_are_moved_and_as_hard_as_before(name):
    hidden = find_project(name)
    function = next(rival.function for rival in hidden.rivals if rival.key == "paper")
    before, after = (
        [one.value for one in outcomes(project, function, hidden.seeds[:3])]
        for project in (hidden, graded_project(name, 77))
    )
    # P2's cost looks one metre ahead, which is elsewhere for a rig that is turned.
    assert after == pytest.approx(before, abs=1e-6 if name == "P3" else 0.1)


def test_a_pose_learned_by_heart_is_wrong_in_a_moved_room():
    task = find_project("P2").prepare(6101)
    there = moved(task, "boxes", np.random.default_rng(1))
    assert min(pose_cost(tuple(old), new) for old, new in zip(task.truth, there.truth, strict=True)) > 1.0
    assert len({id(call[2]) for call in there.arguments}) == 1, "one map for all views of a room"
    boxes = [one.box for call in there.arguments for one in call[0]]
    assert min(box[0] for box in boxes) >= 0
    assert max(box[0] for box in boxes) < task.arguments[0][3].width


def test_the_feedback_of_a_score_tells_its_median_and_the_lines():
    told = score_sentence(find_project("P4"), [19.0, 20.0, 21.0], 0)
    lines = "all points: below 20 mm; half: better than the paper's 49.1 mm"
    assert told == f"median 20.0 mm over 3 other worlds ({lines})."
    assert "it failed in 1 of 3 worlds" in score_sentence(find_project("P4"), [np.inf, 30.0, 30.0], 1)
