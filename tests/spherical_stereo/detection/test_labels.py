"""Labels: one name for one kind of thing, whoever trained the detector."""

import pytest

from course_lib.spherical_stereo.detection.detected_object import ALIASES, CANONICAL_LABELS, canonical_label


@pytest.mark.parametrize(
    ("name", "label"),
    [
        ("couch", "sofa"),
        ("sofa", "sofa"),
        ("tv", "television"),
        ("tvmonitor", "television"),
        ("diningtable", "table"),
        ("dining table", "table"),
        ("pottedplant", "potted plant"),
        ("potted_plant", "potted plant"),
        ("potted plant", "potted plant"),
        ("Refrigerator", "refrigerator"),
        (" Chair ", "chair"),
    ],
)
def test_coco_and_voc_names_become_the_labels_of_the_map(name, label):
    assert canonical_label(name) == label


@pytest.mark.parametrize("name", ["person", "traffic light", "stop sign", "tv stand", "hair drier"])
def test_other_names_stay_as_they_are(name):
    assert canonical_label(name) == name


@pytest.mark.parametrize(
    ("one", "other"), [("Bed", "bed"), ("traffic_light", "traffic light"), ("TV  Stand", "tv-stand"), (" bed_", "bed")]
)
def test_one_name_in_two_spellings_is_one_class(one, other):
    assert canonical_label(one) == canonical_label(other)


def test_every_alias_leads_to_a_canonical_label_that_stays_as_it_is():
    assert set(ALIASES.values()) <= set(CANONICAL_LABELS)
    assert all(canonical_label(label) == label for label in CANONICAL_LABELS)


@pytest.mark.parametrize("name", ["", "  ", "_-", None, 3])
def test_no_name_is_refused(name):
    with pytest.raises(ValueError, match="label"):
        canonical_label(name)
