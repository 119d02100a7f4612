"""What the simulated corridor grants and a real one does not, with what each is worth where that was measured."""

from __future__ import annotations

from typing import NamedTuple

from course_lib.simulation.corridor.seeded_recording import Hardship, SeedModels
from course_lib.simulation.data_folder import parameter_table, parameter_tables


class Idealization(NamedTuple):
    """One thing that flatters the results. hardship: what takes it away in a seed's recording by hand; None: nothing
    does, so its effect is not measured."""

    granted: str
    real: str
    hardship: Hardship | None = None


IDEALIZATIONS = (
    Idealization("focal lengths are exactly those told", "wrong by 1 %", "focal length"),
    Idealization("no lens distortion is left over", "half a pixel in the corners", "lens distortion"),
    Idealization("the camera sits exactly where it is told to, z included", "5 mm off on each axis", "mount position"),
    Idealization("roll, pitch and heading of the mount are exact", "0.3 degrees off on each axis", "mount angle"),
    Idealization(
        "the wagon keeps its speed within 1.5 % and its heading within a degree or two",
        "pushed by hand: speed varies by tens of percent, stops, sways with each step",
        "pushed by hand",
    ),
    Idealization("the principal point is exactly that told", "a pixel or two off; acts much like 0.3 degrees"),
    Idealization("the first pose is exact", "measured with a tape"),
    Idealization("true poses are exact, and of the very instant of each image", "surveyed and synchronized"),
    Idealization("the floor is level and flat; wheels lift by at most 2 mm, 0.2 degrees", "thresholds, cables, slopes"),
    Idealization("people stand still", "they walk, and follow whom they watch"),
    Idealization("light takes one path", "corners and glossy floors send it over two"),
    Idealization("an image is taken in an instant", "four exposures, blurred and torn by motion"),
    Idealization("the camera is warm and its error patterns do not drift", "centimetres in the first half hour"),
    Idealization("surfaces are Lambertian; glass is not there at all", "gloss, mirrors, glass doors, sunlight"),
    Idealization("one building and one map, whatever the seed", "every building is another"),
)

# Median errors of the paper's method on recordings with one hardship each, metres: nearest point of the path, and same
# frame; the median over tuning seeds 10001 to 10003. Made by `demo corridor --idealizations --backend ray --frames 120`
# and stored in data/corridor/results/kindnesses.json.
MEASURED: dict[str, tuple[float, float]] = {
    "none": (0.0150, 0.0253),
    "focal length": (0.0210, 0.0280),
    "lens distortion": (0.0153, 0.0256),
    "mount position": (0.0159, 0.0286),
    "mount angle": (0.0179, 0.0299),
    "pushed by hand": (0.0158, 0.0280),
    "all": (0.0259, 0.0320),
}


def corridor_parameters(models: object) -> str:
    """PARAMETERS.md for `models`, a `CorridorModels`; what only the recordings of `demo corridor` have follows."""
    seeds = SeedModels()
    own = [parameter_table(model) for model in (seeds.day, seeds.push, seeds.calibration)]
    return "\n".join([parameter_tables(models, "corridor"), *own, idealization_table()])


def idealization_table() -> str:
    """The idealizations as a Markdown section."""
    effects = {name: " / ".join(f"{1000 * error:.0f}" for error in errors) + " mm" for name, errors in MEASURED.items()}
    rows = [f"| {one.granted} | {one.real} | {effects.get(one.hardship, 'not measured')} |" for one in IDEALIZATIONS]
    none, everything = effects["none"], effects["all"]
    head = f"""## What the simulation grants

Median errors of the paper's method (nearest point of the path / same frame) on recordings with one
hardship alone, the median over three tuning seeds at 44 x 36 pixels, 120 frames. With none of them: {none}; with all
that are measured, as in the second part of table 1: {everything}.

| granted | real | median error with it |
|---|---|---|"""
    return "\n".join([head, *rows, ""])
