"""Why a changed result is right: an independent second reading of the damaged file says the same as the reader.

Each function takes the file's bytes, what the reader made of it, and what it made of the valid file, and returns the
reason in a few words. It returns None where there is none: then the reader made something else of the file than what
is in it, or took values that are outside of what the format allows. The second readings are as simple as can be, since
the file was accepted: they split lines, look names up in JSON, and let another library (Pillow) unpack images.
"""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Callable

import numpy as np

from course_lib.fuzzing.readings import Reading, same

PAYLOAD = "payload: what the file says"
MISSING = "the file is missing, as it may be"
NO_CHECKSUM = "data of a JPEG, which has no checksum: the same picture to another decoder"
ROUNDING = 2e-3
"""What making a rotation exact may change in one of its numbers: files may be wrong by 1e-3."""


def _rows(data: bytes) -> np.ndarray:
    text = data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    rows = [line.partition("#")[0].split() for line in text.split("\n")]
    return np.array([[float(part) for part in row] for row in rows if row])


def optional(explain: Callable) -> Callable:
    """For a file that may be left out: without it, the rest is read."""

    def or_missing(data: bytes | None, found: Reading, original: Reading) -> str | None:
        return MISSING if data is None else explain(data, found, original)

    return or_missing


def _only(found: Reading, original: Reading, *names: str) -> bool:
    """Whether nothing but these parts of a reading changed."""
    return all(same(value, original[name]) for name, value in found.items() if name not in names)


def of_poses(data: bytes, found: Reading, original: Reading) -> str | None:
    """The poses of the rows, their rotations made exact. path_on_floor and the images are as they were."""
    rows, poses = _rows(data), np.asarray(found["poses"])
    said = rows[:, 1:].reshape(-1, 4, 4)
    if said.shape != poses.shape or not _only(found, original, "poses"):
        return None
    exact = np.array_equal(said[:, :3, 3], poses[:, :3, 3]) and np.abs(said - poses).max() < ROUNDING
    return PAYLOAD if exact else None


def of_intrinsics(data: bytes, found: Reading, original: Reading) -> str | None:
    """The nine numbers of the file, focal lengths positive."""
    matrix = np.asarray(found["intrinsics"])
    legal = np.isfinite(matrix).all() and matrix[0, 0] > 0 and matrix[1, 1] > 0
    return PAYLOAD if legal and np.array_equal(matrix, _rows(data)) and _only(found, original, "intrinsics") else None


def of_trajectory(data: bytes, found: Reading, original: Reading) -> str | None:
    """Each image has the pose whose time is nearest; beside a poses.txt the file's own times, of the same poses."""
    rows = _rows(data)
    times, poses = np.asarray(found["times"]), np.asarray(found["poses"])
    if _only(found, original, "times"):
        return PAYLOAD if np.array_equal(rows[:, 0], times) else None
    if not _only(found, original, "times", "poses", "frames", "files", "depth"):
        return None
    nearest = [int(np.abs(rows[:, 0] - time).argmin()) for time in times]
    first = np.asarray(original["times"])
    kept = [row for row, time in enumerate(first) if np.abs(rows[:, 0] - time).min() <= 0.02]
    placed = np.array_equal(rows[nearest, 1:4], poses[:, :3, 3]) and np.array_equal(first[kept], times)
    placed = placed and all(found[name] == [original[name][row] for row in kept] for name in ("frames", "files"))
    placed = placed and same(found["depth"], np.asarray(original["depth"])[kept])
    return PAYLOAD if placed and _are_rotations(poses, rows[nearest, 4:]) else None


def _are_rotations(poses: np.ndarray, quaternions: np.ndarray) -> bool:
    from scipy.spatial.transform import Rotation

    said = Rotation.from_quat(quaternions).as_matrix()
    return bool(np.abs(said - poses[:, :3, :3]).max() < ROUNDING)


def of_image_list(data: bytes, found: Reading, original: Reading) -> str | None:
    """Times and files of the rows that have a pose near in time."""
    text = data.decode("utf-8-sig").replace("\r", "\n")
    rows = [line.split() for line in text.split("\n") if line.strip() and line.strip()[0] != "#"]
    said = [(float(time), name.rpartition("/")[2]) for time, name in rows]
    kept = list(zip(found["frames"], np.asarray(found["times"]).tolist(), found["files"], strict=True))
    times = np.asarray(original["times"])
    near = [(row, *one) for row, one in enumerate(said, start=1) if np.abs(times - one[0]).min() <= 0.02]
    nearest = [int(np.abs(times - time).argmin()) for time in np.asarray(found["times"])]
    files = [original["files"].index(name) for name in found["files"]]
    belongs = _only(found, original, "frames", "files", "times", "poses", "depth")
    belongs = belongs and same(found["poses"], np.asarray(original["poses"])[nearest])
    belongs = belongs and same(found["depth"], np.asarray(original["depth"])[files])
    return PAYLOAD if kept == near and belongs else None


def of_up(data: bytes, found: Reading, original: Reading) -> str | None:
    """Another axis."""
    said = data.decode("utf-8-sig").strip()
    legal = said == found["up"] and re.fullmatch("-?[xyz]", said) is not None
    return PAYLOAD if legal and _only(found, original, "up") else None


def of_numbers(name: str) -> Callable:
    """Rows of finite numbers, as the file says; for `gravity`, those that follow the frame numbers."""

    def explain(data: bytes, found: Reading, original: Reading) -> str | None:
        rows, values = _rows(data), np.asarray(found[name])
        if name == "gravity":
            by_frame = {int(row[0]): row[1:] for row in rows}
            rows = np.array([by_frame[frame] for frame in found["frames"]])
        return PAYLOAD if np.array_equal(rows, values) and _only(found, original, name) else None

    return explain


def of_start(data: bytes, found: Reading, original: Reading) -> str | None:
    """A pose in any of the three formats."""
    rows, pose = _rows(data), np.asarray(found["pose"])
    if rows.shape == (4, 4) or rows.shape[1] == 17:
        said = rows if rows.shape == (4, 4) else rows[0, 1:].reshape(4, 4)
        return PAYLOAD if np.abs(said - pose).max() < ROUNDING and np.array_equal(said[:3, 3], pose[:3, 3]) else None
    return None


def of_depth_image(data: bytes, found: Reading, original: Reading) -> str | None:
    """The pixels that Pillow finds, in metres."""
    pixels = _pillow(data)
    depth, before = np.asarray(found["depth"]), np.asarray(original["depth"])
    changed = [index for index in range(len(depth)) if not same(depth[index], before[index])]
    if pixels is None or changed != [1] or not _only(found, original, "depth"):
        return None
    said = np.where(pixels == 0, np.nan, pixels / 1000.0)
    return PAYLOAD if said.shape == depth[1].shape and np.allclose(said, depth[1], equal_nan=True) else None


def of_picture(data: bytes, found: Reading, original: Reading) -> str | None:
    """The pixels that Pillow finds: of a PNG exactly, of a JPEG that is complete whatever its data have become."""
    image, is_jpeg = np.asarray(found["pixels"]), data[:2] == b"\xff\xd8"
    for lenient in (False, True):
        pixels = _pillow(data, lenient)
        if pixels is not None and pixels.ndim == 3 and pixels.shape[:2] == image.shape[:2]:
            apart = np.abs(pixels[..., :3].astype(np.int16) - image[..., ::-1]).max()
            if apart <= (2 if is_jpeg else 0):
                return NO_CHECKSUM if lenient else PAYLOAD
        if not (is_jpeg and data.find(b"\xff\xd9", data.find(b"\xff\xda")) > 0):
            return None  # it was cut off, or has checksums
    return None


def _pillow(data: bytes, lenient: bool = False) -> np.ndarray | None:
    """The pixels that Pillow unpacks, None where it does not; lenient: as far as it comes."""
    from PIL import Image, ImageFile

    before, ImageFile.LOAD_TRUNCATED_IMAGES = ImageFile.LOAD_TRUNCATED_IMAGES, lenient
    try:
        with Image.open(io.BytesIO(data)) as image:
            if image.mode.startswith("I"):
                return np.asarray(image)
            return np.asarray(image.convert("RGB"))
    except Exception:  # whatever Pillow stumbles on: it does not accept the file
        return None
    finally:
        ImageFile.LOAD_TRUNCATED_IMAGES = before


def of_stereo(data: bytes, found: Reading, original: Reading) -> str | None:
    """The poses, names, boxes and the rig of the JSON, of images that are as they were."""
    content = json.loads(data.decode("utf-8-sig"))
    pairs = content["pairs"]
    poses = np.array([[one["rig"]["x"], one["rig"]["y"], one["rig"]["heading"]] for one in pairs], float)
    objects = [
        (one["object"], one["label"], *one["visible_box"], *one["unoccluded_box"], one["visible_fraction"])
        for pair in pairs
        for side in ("upper", "lower")
        for one in pair[side]["objects"]
    ]
    numbers = [value for one in found["objects"] for value in one if not isinstance(value, str)]
    legal = np.isfinite(poses).all() and np.isfinite(numbers).all() and np.isfinite(np.asarray(found["rig"])).all()
    said = (
        same(np.asarray(found["poses"]), poses)
        and found["objects"] == objects
        and found["names"] == [one["name"] for one in pairs]
        and found["files"] == [one[side]["file"] for one in pairs for side in ("upper", "lower")]
        and found["size"] == (content["width"], content["height"])
        and np.array_equal(np.asarray(found["rig"]), [content["baseline"], pairs[0]["rig"]["upper_height"]])
        and found["size"] == np.asarray(found["pixels"]).shape[2:0:-1]
        and found["seed"] == content.get("seed")
        and same(
            found["pixels"], np.asarray(original["pixels"])[[original["files"].index(one) for one in found["files"]]]
        )
    )
    return PAYLOAD if legal and said else None


def of_objects_json(data: bytes, found: Reading, original: Reading) -> str | None:
    """The landmarks of the JSON in their order."""
    content = json.loads(data.decode("utf-8-sig"))
    rows = content["landmarks"]
    walls = content.get("walls")
    kept = found["name"] == content.get("name", "") and same(
        found["walls"], None if walls is None else np.array(walls, float)
    )
    return PAYLOAD if kept and _are_landmarks(rows, found) else None


def of_objects_csv(data: bytes, found: Reading, original: Reading) -> str | None:
    """The rows below the header, in their order."""
    text = data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n").partition("\n")[2]
    rows = [
        {name: value if name == "label" else float(value) if value.strip() else None for name, value in row.items()
         if name in ("label", "x", "y", "hue", "saturation")}
        for row in csv.DictReader(io.StringIO(text))
    ]  # fmt: skip
    return PAYLOAD if _are_landmarks(rows, found) and found["name"] == "" and found["walls"] is None else None


def _are_landmarks(rows: list[dict], found: Reading) -> bool:
    """Whether the landmarks found are those of the rows, and have values that a map may have."""
    hues = np.array([np.nan if row["hue"] is None else row["hue"] for row in rows], float)
    saturations = np.array([row["saturation"] for row in rows], float)
    positions = np.array([[row["x"], row["y"]] for row in rows], float)
    legal = np.isfinite(positions).all() and ((saturations >= 0) & (saturations <= 100)).all()
    legal = legal and (np.isnan(hues) | ((hues >= 0) & (hues < 360))).all()
    said = (
        same(np.asarray(found["positions"]), positions)
        and same(np.asarray(found["hues"]), hues)
        and same(np.asarray(found["saturations"]), saturations)
        and [_plain(label) for label in found["labels"]] == [_plain(row["label"]) for row in rows]
    )
    return bool(legal and said)


def _plain(label: str) -> str:
    """A label in lower case with single spaces, and the one other name that the samples use."""
    plain = " ".join(re.split(r"[\s_-]+", label.lower())).strip()
    return {"couch": "sofa"}.get(plain, plain)


def of_boxes(data: bytes, found: Reading, original: Reading) -> str | None:
    """The boxes of the JSON, inside the image, where u may pass the seam."""
    content = json.loads(data.decode("utf-8-sig"))
    items = [*content["upper"], *content["lower"]]
    boxes, size = np.asarray(found["boxes"]), (content["width"], content["height"])
    said = np.array([item["box"] for item in items], float).reshape(-1, 4)
    turns = (said[:, 0] - boxes[:, 0]) / size[0]
    said[:, [0, 2]] -= size[0] * np.rint(turns)[:, None]
    legal = np.isfinite(boxes).all() and ((boxes[:, 0] >= 0) & (boxes[:, 0] < size[0])).all()
    legal = legal and (boxes[:, 2:] > boxes[:, :2]).all() and (boxes[:, 2] - boxes[:, 0] <= size[0]).all()
    legal = legal and ((boxes[:, 1] >= 0) & (boxes[:, 3] <= size[1])).all()
    same_texts = [_plain(item["label"]) for item in items] == [_plain(label) for label in found["labels"]]
    same_texts = same_texts and [item.get("name") for item in items] == found["names"] and found["size"] == size
    counted = found["counts"] == (len(content["upper"]), len(content["lower"]))
    return PAYLOAD if legal and same_texts and counted and np.allclose(said, boxes, atol=1e-9) else None


def _gives_numbers(found: Reading) -> bool:
    """Whether what the network gives for a picture are numbers; what it finds in one, finite ones."""
    boxes = [box for _, _, *box in found["found"]]
    finite = np.isfinite(np.asarray(found["scores"])).all() and np.isfinite(np.array(boxes)).all()
    return bool(finite and not np.isnan(np.asarray(found["boxes"])).any())


def of_cfg(data: bytes, found: Reading, original: Reading) -> str | None:
    """The sections and options of the file, in their order, and results that are numbers."""
    sections: list[tuple[str, dict]] = []
    for line in data.decode("utf-8-sig").splitlines():
        line = re.split("[#;]", line)[0].strip()
        if line.startswith("["):
            sections.append((line[1:-1].strip().lower(), {}))
        elif line:
            key, _, value = line.partition("=")
            sections[-1][1][key.strip()] = value.strip()
    said = [(kind, tuple(options.items())) for kind, options in sections]
    width, height = int(sections[0][1]["width"]), int(sections[0][1]["height"])
    fits = found["sections"] == said and found["input"] == (width, height)
    fits = fits and _only(found, original, "sections", "input", "boxes", "scores", "found")
    return PAYLOAD if fits and _gives_numbers(found) else None


def of_weights(data: bytes, found: Reading, original: Reading) -> str | None:
    """As many numbers as before, all finite."""
    if not _only(found, original, "boxes", "scores", "found") or not _gives_numbers(found):
        return None
    return PAYLOAD if np.asarray(found["boxes"]).shape == np.asarray(original["boxes"]).shape else None


of_onnx = of_weights


def of_names(data: bytes, found: Reading, original: Reading) -> str | None:
    """One class a line."""
    names = [line.strip() for line in data.decode("utf-8-sig").rstrip().splitlines()]
    said = sorted({_plain(name) for name in names})
    return PAYLOAD if found["labels"] == said and _only(found, original, "labels", "found") else None


def of_training(data: bytes, found: Reading, original: Reading) -> str | None:
    """Another threshold, from 0 to 1."""
    threshold = json.loads(data.decode("utf-8-sig"))["score_threshold"]
    legal = found["threshold"] == threshold and 0 <= threshold <= 1 and not isinstance(threshold, bool | str)
    return PAYLOAD if legal and _only(found, original, "threshold", "found") else None


def of_notebook(data: bytes, found: Reading, original: Reading) -> str | None:
    """The code of the cells, in their order."""
    sources = []
    for cell in json.loads(data.decode("utf-8-sig"))["cells"]:
        if (
            isinstance(cell, dict)
            and cell.get("cell_type") == "code"
            and isinstance(cell.get("source", ""), str | list)
        ):
            source = cell.get("source", "")
            if isinstance(source, str) or all(isinstance(line, str) for line in source):
                sources.append(source if isinstance(source, str) else "".join(source))
    return PAYLOAD if [source for _, source in found["cells"]] == sources else None


def of_python(data: bytes, found: Reading, original: Reading) -> str | None:
    """The text of the file."""
    return PAYLOAD if found["cells"] == [("the file", data.decode("utf-8-sig"))] else None
