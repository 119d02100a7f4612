"""Where the repository is: its data and its lessons, whatever folder a command or a notebook runs in.

The methods take paths from their callers and never look here.
"""

from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]

STORE_SCENES = "COURSE_STORE_SCENES"
"""Set in the environment: a lesson writes its scenes to notebooks/scenes. Only `refresh` sets it."""


def data_path(relative: str) -> Path:
    """Path of a file or folder under `data/`, such as `data_path("corridor/map.ply")`.

    Raises `FileNotFoundError` where there is none: the message names the folder that was searched and the cure.
    """
    path = REPOSITORY / "data" / relative
    if not path.exists():
        raise FileNotFoundError(
            f"no {relative!r} in {REPOSITORY / 'data'}: lessons and commands run on the data that comes with the "
            "repository. Get a complete copy of it, or make the data again as data/README.md says"
        )
    return path


def notebook_paths() -> list[Path]:
    """The lessons, `notebooks/NN_title.ipynb`, in order."""
    return sorted((REPOSITORY / "notebooks").glob("[0-9][0-9]_*.ipynb"))


def foundation_paths() -> list[Path]:
    """The foundations, `notebooks/foundations/Fn_title.ipynb`, in order. They have the shape of lessons."""
    return sorted((REPOSITORY / "notebooks" / "foundations").glob("F[0-9]_*.ipynb"))


def project_paths() -> list[Path]:
    """The projects, `notebooks/projects/Pn_title.ipynb`, in order."""
    return sorted((REPOSITORY / "notebooks" / "projects").glob("P[0-9]_*.ipynb"))


def numbered_paths() -> dict[str, Path]:
    """Return number ("06", "F1", "P1") -> path of every lesson, foundation and project, in this order."""
    return {path.name[:2]: path for path in [*notebook_paths(), *foundation_paths(), *project_paths()]}
