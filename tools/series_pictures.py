"""Make the picture at a lesson's beginning, which notebooks/README.md shows too, from the lesson's stored outputs.

    python -m tools.series_pictures

writes notebooks/pictures/NN.png (or .webp, .svg) for every lesson, foundation and project. `tools.refresh` writes those
of the lessons that it ran.
"""

import base64
import io
import json
import re
from pathlib import Path

import numpy as np
from PIL import Image

from course_lib.files import atomic_write
from courseware.lessons.kit.compression import compress_photograph, small_png
from courseware.paths import REPOSITORY, numbered_paths

# Lesson -> the cell whose picture we use. Of a lesson that is not listed, we use the first one made of pixels. A
# picture that answers one of the lesson's predictions would spoil it.
CHOSEN = {
    "00": "00-second-picture", "01": "01-order-picture", "03": "03-tiles-picture", "07": "07-panel",
    "08": "08-experiment-picture", "09": "09-panel", "10": "10-narrowing-scores-picture",
    "14": "14-ellipse", "15": "15-panel",
    "F1": "F1-beliefs", "F3": "F3-idea-picture",
}  # fmt: skip
PICTURES = REPOSITORY / "notebooks" / "pictures"
MAX_SIZE = (1000, 520)  # (width, height) in pixels; shown half as wide, so that it is sharp on fine screens
MAX_BYTES = 80_000


def stored_picture(path: Path, cell_id: str | None) -> tuple[str, bytes]:
    """Return kind ("png") and bytes of a cell's picture, or of a notebook's first one, of pixels if it has one.

    Raises `ValueError` if nothing is stored there.
    """
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    outputs = [o for cell in cells if cell_id in (None, cell["id"]) for o in cell.get("outputs", [])]
    shown = "".join("".join(output.get("data", {}).get("text/html", "")) for output in outputs)
    found = re.findall(r'src="data:image/([a-z]+)(?:\+xml)?;base64,([^"]+)"', shown)
    if not found:
        raise ValueError(f"{path.name}: no picture in {cell_id or 'any cell'}; refresh it, or choose another cell")
    kind, data = min(found, key=lambda one: one[0] == "svg")
    return kind, base64.b64decode(data)


def write_picture(path: Path, folder: Path = PICTURES) -> Path:
    """Write the picture of the lesson at `path` into `folder` as NN.png, .webp or .svg, and return its path."""
    number = path.name[:2]
    kind, data = stored_picture(path, CHOSEN.get(number))
    if kind != "svg":
        picture = Image.open(io.BytesIO(data)).convert("RGB")
        width = min(MAX_SIZE[0], MAX_SIZE[1] * picture.width // picture.height, picture.width)
        if kind == "webp":  # a photograph
            data = compress_photograph(np.asarray(picture.resize((width, width * picture.height // picture.width))))
        else:
            data = small_png(picture, width, MAX_BYTES)
    atomic_write(folder / f"{number}.{kind}", data)
    return folder / f"{number}.{kind}"


if __name__ == "__main__":
    for lesson in numbered_paths().values():
        made = write_picture(lesson)
        print(f"{made.relative_to(REPOSITORY)}: {made.stat().st_size / 1000:.0f} kB")
