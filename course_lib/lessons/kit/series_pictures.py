"""Make the small pictures of notebooks/README.md from the lessons' stored outputs.

    python -m course_lib.lessons.kit.series_pictures

writes notebooks/pictures/NN.png for every lesson. Run it again when a lesson's picture has changed.
"""

import base64
import io
import json
import re
from pathlib import Path

from PIL import Image

from course_lib.files import atomic_write
from course_lib.paths import REPOSITORY, notebook_paths

CHOSEN = {
    "00": "00-second-picture",
    "01": "01-order-picture",
    "02": "02-idea-picture",
    "03": "03-tiles-picture",
    "04": "04-idea-picture",
    "05": "05-idea-picture",
    "06": "06-idea-picture",
    "07": "07-idea-comb",
    "08": "08-figure-5",
    "09": "09-same-budget-picture",
    "10": "10-narrowing-scores-picture",
    "11": "11-idea-picture",
    "12": "12-idea-picture",
    "13": "13-idea-picture",
    "14": "14-places-picture",
    "15": "15-panel",
    "16": "16-idea-picture",
    "17": "17-places",
    "18": "18-idea-picture",
    "19": "19-stages",
    "20": "20-check-picture",
}
"""Lesson -> the cell whose picture we use. For a lesson that is not listed, we use the first picture."""

MAX_SIZE = (420, 230)  # (width, height) in pixels
MAX_BYTES = 30_000
_COLOURS = (128, 64, 32, 16)  # in the palette; the first that makes the picture small enough is used


class SeriesPictureError(ValueError):
    """A lesson without a stored picture, or with a picture that stays too large."""


def stored_picture(path: Path, cell_id: str | None = None) -> Image.Image:
    """Return the stored picture (RGB) of a cell. If `cell_id` is None, return the notebook's first picture.

    Raises `SeriesPictureError` if there is no picture.
    """
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell_id is not None and cell["id"] != cell_id:
            continue
        for output in cell.get("outputs", []):
            text = "".join(output.get("data", {}).get("text/html", ""))
            found = re.search(r'src="data:image/[a-z]+;base64,([^"]+)"', text)
            if found:
                return Image.open(io.BytesIO(base64.b64decode(found.group(1)))).convert("RGB")
    where = "no cell" if cell_id is None else f"no cell {cell_id}"
    raise SeriesPictureError(f"{path.name}: {where} has a stored picture; refresh the lesson, or choose another cell")


def small_png(picture: Image.Image) -> bytes:
    """Return a PNG within `MAX_SIZE` and `MAX_BYTES`. Raises `SeriesPictureError` if that is impossible."""
    picture = picture.copy()
    picture.thumbnail(MAX_SIZE, Image.Resampling.LANCZOS)
    for colours in _COLOURS:
        buffer = io.BytesIO()
        reduced = picture.quantize(colours, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
        reduced.save(buffer, format="PNG", optimize=True)
        if buffer.tell() <= MAX_BYTES:
            return buffer.getvalue()
    raise SeriesPictureError(f"{buffer.tell()} bytes with {_COLOURS[-1]} colours are too many; at most {MAX_BYTES} fit")


def write_pictures(folder: Path) -> list[Path]:
    """Write NN.png of every lesson into `folder` and return the paths. Raises `SeriesPictureError`."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for path in notebook_paths():
        number = path.name[:2]
        target = folder / f"{number}.png"
        atomic_write(target, small_png(stored_picture(path, CHOSEN.get(number))))
        written.append(target)
    return written


if __name__ == "__main__":
    for made in write_pictures(REPOSITORY / "notebooks" / "pictures"):
        print(f"{made.relative_to(REPOSITORY)}: {made.stat().st_size / 1000:.0f} kB")
