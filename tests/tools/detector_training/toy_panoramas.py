"""Toy panoramas: a rectangle of its own colour and pattern for every class, on a plain background with clutter."""

import json
from pathlib import Path

import cv2
import numpy as np

ROOM_CFG = Path(__file__).parents[3] / "data" / "detector" / "room_yolo.cfg"
ROOM_NAMES = ROOM_CFG.with_suffix(".names")


def cfg(*sections):
    """A Darknet file of sections, each written as "kind option=value option=value"."""
    return "".join(f"[{words[0]}]\n" + "\n".join(words[1:]) + "\n" for words in map(str.split, sections))


def convolution(filters, stride):
    return f"convolutional batch_normalize=1 filters={filters} size=3 stride={stride} pad=1 activation=leaky"


# A network with every kind of section that the training knows, for panoramas 256 columns wide.
TINY_CFG = cfg(
    "net width=320 height=128 channels=3",
    *(convolution(filters, 2) for filters in (12, 24, 32)),
    "route layers=-1 groups=2 group_id=1",
    convolution(32, 2),
    "maxpool size=5 stride=1",
    "route layers=-1,-2",
    "upsample stride=2",
    "route layers=-1,2",
    convolution(48, 1),
    "convolutional batch_normalize=0 filters=36 size=1 stride=1 pad=1 activation=linear",
    "yolo mask=0,1,2 anchors=12,18,24,16,20,32 classes=7 num=3 scale_x_y=2.0 thresh=0.0001",
)

# Blue, green, red of each class, and the size (width, height) of its boxes at a width of 1280.
CLASSES = {
    "sofa": ((40, 40, 160), (220, 90)),
    "chair": ((40, 160, 40), (60, 100)),
    "table": ((40, 100, 140), (150, 80)),
    "television": ((30, 30, 30), (90, 55)),
    "potted plant": ((60, 200, 60), (55, 120)),
    "refrigerator": ((230, 230, 230), (80, 200)),
    "cabinet": ((90, 120, 200), (110, 110)),
}


def write_toy_folder(folder, n_images, width):
    """A folder with boxes.json and `n_images` JPEG panoramas; objects may cross the seam."""
    folder.mkdir(parents=True)
    rng, entries = np.random.default_rng(0), []
    for number in range(n_images):
        image, boxes = toy_panorama(rng, width)
        name = f"{number:06d}.jpg"
        cv2.imwrite(str(folder / name), image, [cv2.IMWRITE_JPEG_QUALITY, 92])
        entries.append({"file": name, "room_seed": number, "width": width, "height": width // 2, "objects": boxes})
    (folder / "boxes.json").write_text(json.dumps({"version": 1, "images": entries}))
    return folder


def toy_panorama(rng, width, objects=6):
    height, scale = width // 2, width / 1280
    image = np.full((height, width, 3), rng.integers(110, 200, 3), np.uint8)
    image[int(0.6 * height) :] = rng.integers(60, 140, 3)
    # One object to each slot of the circle, so that none hides another.
    starts = (np.arange(objects) + rng.uniform(0, 0.15, objects)) * width / objects + rng.uniform(0, width)
    entries = []
    for start in starts:
        label = list(CLASSES)[rng.integers(len(CLASSES))]
        colour, size = CLASSES[label]
        factor = rng.uniform(0.6, 1.05) * scale
        w, h = int(size[0] * factor), int(size[1] * factor)
        u, v = int(start) % width, int(rng.uniform(0.42, 0.6) * height)
        patch = np.full((h, w, 3), colour, np.int16) + rng.integers(-15, 16, (1, 1, 3))
        patch[:: max(2, h // 6)] += 40
        columns = (u + np.arange(w)) % width
        image[v : v + h, columns] = np.clip(patch, 0, 255).astype(np.uint8)
        box = [float(u), float(v), float(u + w), float(v + h)]
        boxes = {"visible_box": box, "unoccluded_box": box}
        entries.append({"object": len(entries), "label": label, "visible_fraction": 1.0} | boxes)
    return image, entries
