"""`demo lost`: what its trials gave is told, whatever they gave."""

from courseware.experiments.lost import lost_table, summarize


def a_trial(frames_to_recover):
    return {
        "kidnapped": {"frames_to_recover": frames_to_recover},
        "start": {"status": "several", "right": False, "frames": 20, "particles": 5000, "seconds": 1.5},
        "in peace": {"frames": 60, "alarms": 0},
    }


def test_the_median_is_of_the_cameras_that_were_found_again():
    found = summarize([a_trial(3), a_trial(None), a_trial(7)])
    assert (found["kidnapped_recovered"], found["frames_to_recover"]) == (2, 5.0)
    assert "2 of 3 recovered within 30 frames (median 5)" in lost_table(found)
