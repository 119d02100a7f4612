"""Lesson 17: objects that were not seen, and what would have saved a pose."""

from course_lib.experiments.room_evaluation import UNABLE, wrong_pairs
from course_lib.lessons.kit.room_observations import in_body_frame
from course_lib.lessons.lesson_17 import room_map, room_recording
from course_lib.lessons.lesson_17.room_runs import exact_results, is_matched_rightly, thinned
from course_lib.spherical_stereo import Localization, Observation, SemanticLocalizer


def test_nothing_hidden_gives_the_pose_back_and_one_object_left_is_unable():
    result, localizer = exact_results(1)[2], SemanticLocalizer(room_recording(1).rig, room_map())
    assert thinned(result, range(len(result.true_landmarks)), localizer).outcome == result.outcome
    assert thinned(result, [0], localizer).outcome.kind == UNABLE


def test_each_cure_mends_what_it_should():
    for one in exact_results(2):
        assert is_matched_rightly(one) == (not wrong_pairs(one.localization, one.true_landmarks))
    room, pose = room_map(), exact_results(2)[0].pair.pose

    def cured(landmarks, shown, cure):
        """Whether perfect observations of these landmarks, at the places of those shown, are matched rightly."""
        places = in_body_frame(room.positions[shown], pose)
        its = [room.landmarks[j] for j in landmarks]
        seen = [Observation(m.label, *place, m.hue, m.saturation) for m, place in zip(its, places, strict=True)]
        return is_matched_rightly(
            exact_results(2)[0]._replace(localization=Localization(observations=seen), true_landmarks=landmarks), cure
        )

    everything = list(range(len(room)))
    swapped = [1, 0, *everything[2:]]  # two sofas
    assert cured(everything, everything, None)
    assert [cured(everything, swapped, one) for one in ("true centroid", "true places")] == [False, True]
    east = [j for j in everything if room.positions[j, 0] > 2.0]  # of half of the room the centroid is elsewhere
    assert [cured(east, east, one) for one in (None, "true centroid")] == [False, True]
