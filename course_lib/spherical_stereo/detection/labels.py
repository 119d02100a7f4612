"""One name for one kind of object: COCO, VOC and everyday names become the labels of the semantic map.

A detector trained on COCO says "couch" or "sofa" depending on whose list of names it came with. The map must not care.
"""

import re

CANONICAL_LABELS = ("sofa", "chair", "table", "television", "potted plant", "refrigerator", "cabinet")
"""Labels of the maps, rooms and network of this project."""

ALIASES = {
    "couch": "sofa",
    "settee": "sofa",
    "diningtable": "table",
    "dining table": "table",
    "desk": "table",
    "tv": "television",
    "tvmonitor": "television",
    "tv monitor": "television",
    "pottedplant": "potted plant",
    "houseplant": "potted plant",
    "fridge": "refrigerator",
    "cupboard": "cabinet",
}
"""Other names of the same things, in lower case with single spaces -> canonical label."""


def canonical_label(label: str) -> str:
    """The label of the semantic map for a detector's class name.

    Names are recognised in any case, with underscores or hyphens for spaces. A name that is no alias is its own label,
    written in lower case with single spaces, so that "Traffic_Light" and "traffic light" are one class.
    Raises ValueError for an empty label.
    Source: paper 2, section 2.2 (the class c of an object).
    """
    plain = " ".join(re.split(r"[\s_-]+", label.lower())).strip() if isinstance(label, str) else ""
    if not plain:
        raise ValueError(f"a label is a text that is not empty; got {label!r}")
    return ALIASES.get(plain, plain)
