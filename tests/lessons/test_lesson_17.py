"""Lesson 17: objects that were not seen, and what would have saved a pose."""

from course_lib.spherical_stereo import Localization, Observation, SemanticLocalizer
from courseware.lessons.kit.room_data import in_body_frame, room_map, room_recording
from courseware.lessons.lesson_17.room_runs import exact_results, is_matched_rightly, thinned


def test_nothing_hidden_gives_the_pose_back_and_one_object_left_is_unable():
    result, localizer = exact_results(1)[2], SemanticLocalizer(room_recording(1).rig, room_map())
    assert thinned(result, range(len(result.true_landmarks)), localizer).outcome == result.outcome
    assert thinned(result, [0], localizer).outcome.kind == "unable"


def test_each_cure_mends_what_it_should():
    def cured(landmarks, cure, order=()):
        """Whether perfect observations of these landmarks, the first ones in another place, are matched rightly."""
        places = in_body_frame(room.positions[[*order, *landmarks[len(order) :]]], one.pair.pose)
        looks = [(room.landmarks[j], place) for j, place in zip(landmarks, places, strict=True)]
        seen = Localization(observations=[Observation(m.label, *place, m.hue, m.saturation) for m, place in looks])
        return is_matched_rightly(one._replace(localization=seen, true_landmarks=landmarks), cure)

    room, one, swapped = room_map(), exact_results(2)[0], (1, 0)  # two sofas
    everything, east = range(len(room)), [j for j in range(len(room)) if room.positions[j, 0] > 2.0]
    assert [cured(everything, cure, swapped) for cure in ("true centroid", "true places")] == [False, True]
    assert [cured(some, cure) for some, cure in ((everything, None), (east, None), (east, "true centroid"))] == [
        1,
        0,
        1,
    ]
