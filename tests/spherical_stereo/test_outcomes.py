"""The words of the method: each has one meaning, and is written as it reads."""

import json

from course_lib.spherical_stereo.outcomes import NoPartner, ObjectOutcome, Reason, Status


def test_no_word_has_two_meanings_and_each_is_compared_printed_and_written_as_it_reads():
    words = [word for level in (NoPartner, ObjectOutcome, Reason, Status) for word in level]
    shared = {str(word) for word in words if [str(one) for one in words].count(str(word)) > 1}
    assert shared == {"ok"}, "of an object and of a localization"
    assert Reason.BLANK == "blank image"
    assert f"{Reason.BLANK}" == str(Reason.BLANK) == "blank image"
    assert json.dumps({Reason.BLANK: Reason.BLANK}) == '{"blank image": "blank image"}'
    assert Reason.BLANK in {"blank image"}
