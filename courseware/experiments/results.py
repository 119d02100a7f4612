"""Results of commands and experiments: JSON and CSV, with seed and versions inside."""

import csv
import io
import json
import platform
from importlib.metadata import version
from pathlib import Path

import course_lib
from course_lib.files import atomic_write


def versions() -> dict[str, str]:
    """Return the versions that a result depends on: Python, this library, and the packages that compute."""
    packages = ("numpy", "scipy", "numba", "vtk", "trimesh", "opencv-python-headless")
    return {"python": platform.python_version(), "course_lib": course_lib.__version__} | {
        name: version(name) for name in packages
    }


def write_results(path: str | Path, results: dict, rows: list[dict] | None = None) -> None:
    """Write results as JSON, with the versions inside, and rows beside it as a CSV file of the same name.

    Raises `ValueError` for NaN or infinite numbers, which JSON has not, `OSError` where it cannot be written.
    """
    path = Path(path)
    text = json.dumps(results | {"versions": versions()}, indent=2, allow_nan=False) + "\n"
    path.parent.mkdir(parents=True, exist_ok=True)
    if rows:
        table = io.StringIO(newline="")
        writer = csv.DictWriter(table, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
        atomic_write(path.with_suffix(".csv"), table.getvalue())
    atomic_write(path, text)
