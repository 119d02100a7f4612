"""Whether two pages of `plots.scene_page` show the same scene, up to what processors round otherwise."""

import base64
import io
import json
import re
import zipfile

import numpy as np

ROUNDING = 1e-3  # of numbers and of coordinates in metres: what another processor may round otherwise
_DATA = re.compile(r'base64Str = "([A-Za-z0-9+/=]+)"')
_WORDS = re.compile(r'<title>.*?</title>|<meta name="description".*?/>', re.DOTALL)


def same_scene(page: str, other: str) -> bool:
    """Whether two pages show the same: title, words and objects, up to rounding; their viewers may differ."""
    try:
        scenes = [_scene(text) for text in (page, other)]
    except (ValueError, KeyError, TypeError, zipfile.BadZipFile):  # not one of our pages, or a damaged one
        return False
    return _WORDS.findall(page) == _WORDS.findall(other) and _agree(*scenes)


def _scene(page: str) -> dict:
    """What a page shows: its parts, and its arrays in their order, for their names depend on the last digit."""
    found = _DATA.search(page)
    with zipfile.ZipFile(io.BytesIO(base64.b64decode(found[1] if found else ""))) as archive:
        index = json.loads(archive.read("index.json"))
    text = json.dumps(index["scene"])
    for number, name in enumerate(index["hashes"]):
        text = text.replace(name, f"array {number}")
    arrays = [
        np.frombuffer(base64.b64decode(kept["content"]), np.dtype(kept["type"].removesuffix("Array").lower()))
        for kept in index["hashes"].values()
    ]
    return {"scene": json.loads(text), "arrays": arrays}


def _agree(a, b) -> bool:
    """Whether two pieces of a scene are the same up to rounding."""
    if isinstance(a, dict) and isinstance(b, dict):
        # The window's own class is the operating system's.
        return a.keys() == b.keys() and all(_agree(a[k], b[k]) for k in a if not str(a[k]).endswith("RenderWindow"))
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(_agree, a, b))
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.shape == b.shape and np.allclose(a, b, rtol=ROUNDING, atol=ROUNDING, equal_nan=True)
    if isinstance(a, float) and isinstance(b, float):
        return bool(np.isclose(a, b, rtol=ROUNDING, atol=ROUNDING, equal_nan=True))
    return a == b
