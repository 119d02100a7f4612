"""Make the small pictures of notebooks/README.md from the lessons' stored outputs.

    python -m course_lib.lessons.kit.series_pictures

writes notebooks/pictures/NN.png for every lesson and foundation. Run it again when a lesson's picture has changed.
"""

import base64
import io
import json
import re
from pathlib import Path

from PIL import Image

from course_lib.files import atomic_write
from course_lib.lessons.kit.compression import small_png
from course_lib.paths import REPOSITORY, foundation_paths, notebook_paths

# Lesson -> the cell whose picture we use. Of a lesson that is not listed, we use the first one made of pixels.
CHOSEN = {
    "00": "00-second-picture", "01": "01-order-picture", "03": "03-tiles-picture", "07": "07-panel",
    "08": "08-figure-5", "09": "09-same-budget-picture", "10": "10-narrowing-scores-picture",
    "14": "14-ellipse", "15": "15-panel",
    "F1": "F1-beliefs", "F3": "F3-joins",
}  # fmt: skip
MAX_SIZE = (420, 230)  # (width, height) in pixels
MAX_BYTES = 30_000


def stored_picture(path: Path, cell_id: str | None) -> Image.Image:
    """Return the stored picture (RGB) of a cell, or a notebook's first picture. Raises `ValueError`."""
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        for output in cell.get("outputs", []) if cell_id in (None, cell["id"]) else ():
            text = "".join(output.get("data", {}).get("text/html", ""))
            if found := re.search(r'src="data:image/[a-z]+;base64,([^"]+)"', text):
                return Image.open(io.BytesIO(base64.b64decode(found[1]))).convert("RGB")
    raise ValueError(f"{path.name}: no stored picture in {cell_id or 'any cell'}; refresh it, or choose another cell")


def write_pictures(folder: Path) -> list[Path]:
    """Write NN.png of every lesson into `folder` and return the paths. Raises `ValueError`."""
    folder.mkdir(parents=True, exist_ok=True)
    lessons = {path.name[:2]: path for path in [*notebook_paths(), *foundation_paths()]}
    for number, path in lessons.items():
        picture = stored_picture(path, CHOSEN.get(number))
        width = min(MAX_SIZE[0], MAX_SIZE[1] * picture.width // picture.height)
        atomic_write(folder / f"{number}.png", small_png(picture, width, MAX_BYTES))
    return [folder / f"{number}.png" for number in lessons]


if __name__ == "__main__":
    for made in write_pictures(REPOSITORY / "notebooks" / "pictures"):
        print(f"{made.relative_to(REPOSITORY)}: {made.stat().st_size / 1000:.0f} kB")
