"""`score-detector --voting`: the table of the voters' constants, the used choice marked."""

import json

import pytest

from tools import detector_evaluation
from tools.detector_evaluation import DetectorScore, VotingScore


@pytest.fixture
def compared(monkeypatch):
    """Nothing is detected: three choices with scores made up."""
    score = DetectorScore(60, 100, 90, 10)
    choices = [(*detector_evaluation.NO_VOTES, 3.2), (0.6, 0.1, 2.5), (0.8, 0.3, 2.6)]
    found = [VotingScore(iou, least, score, 1.0, jitter) for iou, least, jitter in choices]
    monkeypatch.setattr(detector_evaluation, "compare_voting", lambda detector, labelled: found)


def test_json_is_one_object_with_the_constants_in_use(compared, tmp_path, run_tool, capsys):
    assert run_tool("score_detector", "--voting", "--images", tmp_path, "--json") == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["used"] == {"vote_iou": 0.6, "vote_score": 0.1}
    assert [one["jitter_v"] for one in printed["voting"]] == [3.2, 2.5, 2.6]
