"""Folders of panoramas with boxes, decoded once, and samples of them: turned, mirrored, scaled, recoloured.

A window wider than the panorama has its left part appended on the right, as in the detector (paper 2, section 2.2).
"""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from courseware.experiments.room_evaluation import counts_as_object
from courseware.simulation.room.stereo_recording import true_object
from tools.training_images import read_image_list

# Width of a whole panorama in memory: a 1280 x 512 network input is one and a quarter panorama, 1.25 * 1024 columns.
STORED_WIDTH = 1024
# An object of which less than this share of the width is inside the window is neither taught nor held to be background.
MIN_SHARE_INSIDE = 0.4


class TrainingDataError(ValueError):
    """A folder of training images that cannot be used."""


@dataclass(frozen=True)
class LabelledPanorama:
    """One panorama and its objects."""

    image: np.ndarray  # (h, 2 h, 3) uint8, BGR
    labels: np.ndarray  # (n,) class numbers
    boxes: np.ndarray  # (n, 4) float32 u_min, v_min, u_max, v_max, edge coordinates; u_max may pass the width
    ignored: np.ndarray  # (n,) boolean: too much hidden or too small to count


def read_panoramas(
    folders: list[Path], names: list[str], width: int = STORED_WIDTH, part: tuple[int, int] = (0, 1)
) -> list[LabelledPanorama]:
    """Panoramas of folders, scaled to `width` columns; part: (k, n) reads every n-th alone. Or `TrainingDataError`."""
    found = []
    for folder in folders:
        for entry in read_image_list(folder)[part[0] :: part[1]]:
            image = cv2.imread(str(Path(folder) / entry["file"]), cv2.IMREAD_COLOR)
            if image is not None:  # the others are still being made
                found.append(labelled_panorama(entry, image, names, width))
    if not found:
        listed = ", ".join(map(str, folders))
        raise TrainingDataError(f"{listed}: boxes.json names no image that is there; make the images first")
    return found


def labelled_panorama(entry: dict, image: np.ndarray, names: list[str], width: int) -> LabelledPanorama:
    """One entry of boxes.json with its image, scaled to `width` columns; labels not in `names` are background."""
    recorded = image.shape[1]
    objects = [thing for thing in map(true_object, entry["objects"]) if thing.label in names]
    labels = np.array([names.index(thing.label) for thing in objects], dtype=np.int64)
    boxes = np.array([thing.visible_box for thing in objects], dtype=np.float32).reshape(-1, 4)
    ignored = np.array([not counts_as_object(thing, recorded) for thing in objects], dtype=bool)
    if recorded != width:
        image = cv2.resize(image, (width, width // 2), interpolation=cv2.INTER_AREA)
    return LabelledPanorama(image, labels, boxes * np.float32(width / recorded), ignored)


@dataclass(frozen=True)
class AugmentationRanges:
    """How much a sample may differ from its panorama (chosen: light and cameras differ, furniture stands upright)."""

    scale: tuple[float, float] = (0.85, 1.15)  # size of the picture in the window, 1 = as the detector sees it
    vertical_shift: float = 0.03  # share of the panorama's height; a mount tilted by 1 degree moves 0.006
    exposure: float = 0.35  # largest change of brightness, as a natural logarithm: a factor from 0.70 to 1.42
    gamma: float = 0.2  # the same for the exponent of the tone curve
    white_balance: float = 0.12  # the same for the gain of each colour channel
    saturation: tuple[float, float] = (0.6, 1.3)
    noise: float = 8.0  # largest standard deviation, grey levels of 255
    blur: float = 1.0  # largest standard deviation, pixels; half of the samples have none


@dataclass(frozen=True)
class Sample:
    """What the network sees, and what it should find."""

    image: np.ndarray  # (h, w, 3) uint8, BGR
    labels: np.ndarray  # (n,) class numbers
    boxes: np.ndarray  # (n, 4) u_min, v_min, u_max, v_max, pixels of `image`
    ignored: np.ndarray  # (n,) boolean


def augmented_sample(
    panorama: LabelledPanorama, window: tuple[int, int], rng, ranges: AugmentationRanges | None = None
) -> Sample:
    """A random sample of a panorama in a window (width, height) of pixels; a lower one is cut at a random height."""
    ranges = ranges or AugmentationRanges()
    height, width = panorama.image.shape[:2]
    scale = float(np.exp(rng.uniform(*np.log(ranges.scale))))
    shift = rng.uniform(-1.0, 1.0) * ranges.vertical_shift * height
    # Rows that the window leaves out: rather of the ceiling than of the floor, on which the furniture stands.
    spare = max(0.0, height - window[1])
    top = scale * height / 2 - height / 2 + spare / 2 + shift + rng.uniform(-0.3, 0.5) * spare
    sample = panorama_window(panorama, window, int(rng.integers(width)), bool(rng.integers(2)), scale, top)
    return Sample(recoloured(sample.image, rng, ranges), sample.labels, sample.boxes, sample.ignored)


def panorama_window(
    panorama: LabelledPanorama, window: tuple[int, int], roll: int = 0, mirror: bool = False, scale=1.0, top=0.0
) -> Sample:
    """The window (width, height) of a panorama rolled by `roll` columns, mirrored, and scaled.

    Column u of the panorama comes to (u + roll) scale, modulo the turn, row v to v scale - top. By default it is what
    the detector sees. Boxes are cut at the window's border; of which too little is left, they become ignored.
    """
    width = panorama.image.shape[1]
    image, boxes = panorama.image, panorama.boxes.astype(np.float64)
    if mirror:
        image = image[:, ::-1]
        boxes = np.stack([width - boxes[:, 2], boxes[:, 1], width - boxes[:, 0], boxes[:, 3]], axis=1)
    columns = int(np.ceil(window[0] / scale)) + 2
    image = np.take(image, (np.arange(columns) - roll) % width, axis=1)
    if scale != 1.0 or top != 0.0 or image.shape[:2] != (window[1], window[0]):
        # OpenCV's warp counts from pixel centres, boxes from pixel edges: half a pixel, scaled, lies between.
        half = 0.5 * scale - 0.5
        matrix = np.array([[scale, 0.0, half], [0.0, scale, half - top]])
        image = cv2.warpAffine(image, matrix, window, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    boxes[:, [0, 2]] += roll
    start = np.floor(boxes[:, 0] / width) * width
    boxes[:, [0, 2]] -= start[:, None]
    turns = np.arange(-1, int(np.ceil(columns / width)) + 1)
    copies = boxes[None] + width * turns[:, None, None] * np.array([1.0, 0.0, 1.0, 0.0])
    copies = copies.reshape(-1, 4) * scale - np.array([0.0, top, 0.0, top])
    labels, ignored = np.tile(panorama.labels, len(turns)), np.tile(panorama.ignored, len(turns))
    limits = np.array([window[0], window[1], window[0], window[1]], dtype=np.float64)
    cut = np.clip(copies, 0.0, limits)
    share = (cut[:, 2:] - cut[:, :2]) / (copies[:, 2:] - copies[:, :2])
    inside = (share > 0.0).all(axis=1)
    ignored = ignored | (share < MIN_SHARE_INSIDE).any(axis=1)
    return Sample(np.ascontiguousarray(image), labels[inside], cut[inside].astype(np.float32), ignored[inside])


def recoloured(image: np.ndarray, rng: np.random.Generator, ranges: AugmentationRanges) -> np.ndarray:
    """The image (h, w, 3) under other light and with another camera: gains, tone curve, saturation, blur, noise."""
    gains = np.exp(rng.uniform(-ranges.exposure, ranges.exposure) + rng.uniform(-1, 1, 3) * ranges.white_balance)
    gamma = np.exp(rng.uniform(-ranges.gamma, ranges.gamma))
    saturation = rng.uniform(*ranges.saturation)
    blur = rng.uniform(-1.0, 1.0) * ranges.blur
    amplitude = rng.uniform(0.0, ranges.noise)
    levels = np.linspace(0.0, 1.0, 256)[:, None]
    table = np.clip(255.0 * (gains * levels**gamma), 0, 255).astype(np.uint8).reshape(1, 256, 3)
    result = cv2.LUT(image, table)
    grey = np.array([0.114, 0.587, 0.299])  # luma of B, G, R (ITU-R BT.601)
    result = cv2.transform(result, saturation * np.eye(3) + (1.0 - saturation) * np.tile(grey, (3, 1)))
    if blur > 0.3:
        result = cv2.GaussianBlur(result, (0, 0), blur)
    if amplitude > 1.0:
        result = cv2.add(result, _noise(result.shape, amplitude, rng), dtype=cv2.CV_8U)
    return result


def _noise(shape: tuple[int, int, int], amplitude: float, rng: np.random.Generator) -> np.ndarray:
    """Noise of `shape`, int16: a random tile laid side by side, since drawing every pixel would cost 20 ms."""
    tile = (amplitude * rng.standard_normal((97, 131, 3), dtype=np.float32)).astype(np.int16)
    repeats = (-(-shape[0] // 97), -(-shape[1] // 131), 1)
    return np.tile(tile, repeats)[: shape[0], : shape[1]]
