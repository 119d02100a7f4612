"""Exercises of lesson 11: somebody else's pixels, the way to turn, a stretch across the seam, a knocked tripod."""

from collections.abc import Callable

import numpy as np

from course_lib.geometry import pose_matrix, state_from_matrix, wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake
from course_lib.spherical_stereo.panorama import (
    azimuth_elevation,
    direction_from_angles,
    direction_to_pixel,
    pixel_to_direction,
)

# 11.1: from a pixel of somebody else's panorama to a direction


def direction_of(column: float, row: float, width: int, height: int) -> np.ndarray:
    """Unit vector (3,), x ahead, y left, z up, of a pixel of a panorama whose left edge is ahead.

    Columns and rows are counted from pixel centres: 0 is the middle of the first pixel.
    """
    return _from_angles(*_angles(column, row, width, height))


def _angles(column: float, row: float, width: int, height: int) -> tuple[float, float]:
    """Azimuth, to the left, and elevation, radians."""
    return -(column + 0.5) / width * 2 * np.pi, (0.5 - (row + 0.5) / height) * np.pi


def _from_angles(azimuth: float, elevation: float) -> np.ndarray:
    ahead, left = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth)
    return np.array([ahead, left, np.sin(elevation)])


def _slip(azimuth: Callable = lambda a: a, elevation: Callable = lambda e: e) -> Callable:
    """A mistake: the right function with another azimuth or elevation."""

    def mistaken(column: float, row: float, width: int, height: int) -> np.ndarray:
        a, e = _angles(column, row, width, height)
        return _from_angles(azimuth(a), elevation(e))

    return mistaken


def _pixel(rng: np.random.Generator) -> tuple:
    height = int(rng.choice([320, 512, 640, 960]))
    return float(rng.uniform(0, 2 * height)), float(rng.uniform(0.05, 0.95) * height), 2 * height, height


def _no_cosine(column: float, row: float, width: int, height: int) -> np.ndarray:
    azimuth, elevation = _angles(column, row, width, height)
    return np.array([np.cos(azimuth), np.sin(azimuth), np.sin(elevation)])


def _clamped(column: float, row: float, width: int, height: int) -> np.ndarray:
    return direction_of(min(max(column, 0), width - 1), row, width, height)


# 11.2: the angle from one column to another


def column_gap_deg(u_from: float, u_to: float, width: int) -> float:
    """Azimuth of one column minus that of another, degrees in [-180, 180)."""
    return float((_plain_gap(u_from, u_to, width) + 180) % 360 - 180)


def _plain_gap(u_from: float, u_to: float, width: int) -> float:
    return (u_from - u_to) / width * 360


def _columns(rng: np.random.Generator) -> tuple:
    """Two columns: on one side of the seam, or one on each side of it, in either order."""
    width = int(rng.choice([640, 1280, 1920]))
    u_from, u_to = rng.uniform(0.05, 0.5, size=2) * width
    if rng.random() < 0.5:
        u_from, u_to = rng.uniform(0, 0.1) * width, rng.uniform(0.9, 1) * width
    if rng.random() < 0.5:
        u_from, u_to = u_to, u_from
    return float(u_from), float(u_to), width


def _one_side_only(u_from: float, u_to: float, width: int) -> float:
    gap = _plain_gap(u_from, u_to, width)
    return gap - 360 if gap >= 180 else gap


def _other_side_only(u_from: float, u_to: float, width: int) -> float:
    gap = _plain_gap(u_from, u_to, width)
    return gap + 360 if gap < -180 else gap


# 11.3: the shortest stretch of columns that holds all points


def shortest_stretch(columns: np.ndarray, width: int) -> tuple[float, float]:
    """(u_min, u_max) of the shortest stretch with all columns (n,): 0 <= u_min < width, u_max may pass the width."""
    around = np.sort(np.asarray(columns) % width)
    gaps = np.diff(np.append(around, around[0] + width))
    start = around[(gaps.argmax() + 1) % len(around)]
    return float(start), float(start + width - gaps.max())


def _points_of_an_object(rng: np.random.Generator) -> tuple:
    """Columns within 0.1 to 0.6 of a turn, unsorted, across the seam in more than half of the inputs."""
    width = int(rng.choice([640, 1280, 1920]))
    spread = rng.uniform(0.05, 0.3)
    middle = rng.uniform(-0.8, 0.8) * spread if rng.random() < 0.6 else rng.uniform(0.35, 0.65)
    columns = (middle + rng.uniform(-spread, spread, size=int(rng.integers(4, 9)))) * width
    return columns % width, width


def _signed_start(columns: np.ndarray, width: int) -> tuple[float, float]:
    low, high = shortest_stretch(columns, width)
    return (low - width, high - width) if high >= width else (low, high)


def _split_in_the_middle(columns: np.ndarray, width: int) -> tuple[float, float]:
    """Columns of the left half are moved by a turn wherever both halves hold some."""
    left = columns < width / 2
    moved = columns + width * (left & (not left.all()))
    return float(moved.min()), float(moved.max())


def _around_the_first(columns: np.ndarray, width: int) -> tuple[float, float]:
    """Each column in the turn nearest to the first one: right for a stretch below half a turn only."""
    near = (columns - columns[0] + width / 2) % width - width / 2 + columns[0]
    start = near.min() % width
    return float(start), float(start + np.ptp(near))


def _around_the_mean(columns: np.ndarray, width: int) -> tuple[float, float]:
    middle = np.angle(np.exp(2j * np.pi * columns / width).sum()) / (2 * np.pi) * width
    near = (columns - middle + width / 2) % width - width / 2 + middle
    start = near.min() % width
    return float(start), float(start + np.ptp(near))


def _largest_gap_itself(columns: np.ndarray, width: int) -> tuple[float, float]:
    low, high = shortest_stretch(columns, width)
    return (high % width, low + width * (low < high % width))


def _gaps_without_the_last(columns: np.ndarray, width: int) -> tuple[float, float]:
    """The gap across the seam is never looked at."""
    around = np.sort(columns)
    k = int(np.diff(around, append=around[-1]).argmax()) + 1 if len(around) > 1 else 0
    return float(around[k]), float(around[k - 1] + width)


def _gaps_without_the_last_of_several(columns: np.ndarray, width: int) -> tuple[float, float]:
    return _gaps_without_the_last(columns, width) if len(columns) > 1 else shortest_stretch(columns, width)


def _moved_if_wide(columns: np.ndarray, width: int) -> tuple[float, float]:
    """Where the columns span more than half the picture, those of its left half are moved by a turn."""
    wide = np.ptp(columns) > width / 2
    moved = columns + width * (wide & (columns < width / 2))
    return float(moved.min()), float(moved.max())


def _gaps_of_half_a_turn(columns: np.ndarray, width: int) -> tuple[float, float]:
    """The seam is looked for only where two neighbours are half the picture apart."""
    around = np.sort(columns)
    k = int(np.diff(around, append=around[-1]).argmax())
    if np.ptp(around[k : k + 2]) < width / 2:
        return float(around[0]), float(around[-1])
    return float(around[k + 1]), float(around[k] + width)


def _from_where_the_gap_begins(columns: np.ndarray, width: int) -> tuple[float, float]:
    low, high = shortest_stretch(columns, width)
    return high % width, high % width + high - low


# 11.4: a knock against the tripod


def knock(before: np.ndarray, after: np.ndarray, width: int, height: int) -> tuple[float, float, float]:
    """Roll, pitch, yaw (degrees) of a camera that saw the same far points first at `before`, then at `after`.

    The rotation R with d_before = R d_after, by the singular values of the sum of outer products (Kabsch).
    """
    first, then = pixel_to_direction(before, width, height), pixel_to_direction(after, width, height)
    u, _, vt = np.linalg.svd(first.T @ then)
    rotation = u @ np.diag([1, 1, np.sign(np.linalg.det(u @ vt))]) @ vt
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    return tuple(np.degrees(state_from_matrix(matrix)[3:]).tolist())


def knock_linear(before: np.ndarray, after: np.ndarray, width: int, height: int) -> tuple[float, float, float]:
    """The same for small angles: d_before = d_after + w x d_after, by linear least squares."""
    first, then = pixel_to_direction(before, width, height), pixel_to_direction(after, width, height)
    cross = np.concatenate([_cross_matrix(d) for d in then])
    w = np.linalg.lstsq(-cross, (first - then).ravel(), rcond=None)[0]
    return tuple(np.degrees(w).tolist())


def _cross_matrix(d: np.ndarray) -> np.ndarray:
    """The matrix [d]x with [d]x w = d x w."""
    x, y, z = d
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def _knocked(angles_deg: np.ndarray, around: np.ndarray, width: int) -> tuple:
    """The arguments for a camera turned by so much, and points at azimuths and elevations (n, 2), radians."""
    height = width // 2
    first = direction_from_angles(around[:, 0], around[:, 1])
    turn = pose_matrix(np.concatenate([np.zeros(3), np.radians(angles_deg)]))[:3, :3]
    before, after = (direction_to_pixel(d, width, height) for d in (first, first @ turn))
    return before, after, width, height


def _a_knock(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(8, 15))
    around = np.column_stack([rng.uniform(-np.pi, np.pi, n), rng.uniform(-0.9, 0.6, n)])
    return _knocked(rng.uniform(-1, 1, 3), around, int(rng.choice([640, 1280, 1920])))


def _no_knock(rng: np.random.Generator) -> tuple:
    around = np.column_stack([rng.uniform(-np.pi, np.pi, 9), rng.uniform(-0.9, 0.6, 9)])
    return _knocked(np.zeros(3), around, 1280)


def _points_behind(rng: np.random.Generator) -> tuple:
    """All points near the seam: every second one of them crosses it."""
    around = np.column_stack([np.pi + rng.uniform(-0.02, 0.02, 12), rng.uniform(-0.9, 0.6, 12)])
    return _knocked(np.array([0.5, -0.7, 0.9]), around, 1280)


def _first_point_twice(rng: np.random.Generator) -> tuple:
    """The first two points are one: together they leave the turn about their own direction open."""
    before, after, width, height = _a_knock(rng)
    before[1], after[1] = before[0], after[0]
    return before, after, width, height


def _from_so_many(n: int) -> Callable:
    """A mistake: the first n points alone."""
    return lambda before, after, width, height: knock_linear(before[:n], after[:n], width, height)


def _yaw_alone(before: np.ndarray, after: np.ndarray, width: int, height: int) -> tuple[float, float, float]:
    return 0.0, 0.0, _mean_turn(before, after, width)


def _mean_turn(before: np.ndarray, after: np.ndarray, width: int) -> float:
    """The mean of the columns that the points moved to the right, as degrees."""
    gap = (after[:, 0] - before[:, 0] + width / 2) % width - width / 2
    return float(gap.mean() / width * 360)


def _rows_and_columns(before: np.ndarray, after: np.ndarray, width: int, height: int) -> tuple[float, float, float]:
    """Pitch from the mean of the rows, yaw from that of the columns: as for a picture of a flat wall."""
    return 0.0, float((before[:, 1] - after[:, 1]).mean() / height * 180), _mean_turn(before, after, width)


def _not_across_the_seam(before: np.ndarray, after: np.ndarray, width: int, height: int) -> tuple[float, float, float]:
    """Azimuth differences without a wrap, in the linear formula for azimuth and elevation."""
    return _from_angle_differences(before, after, width, height, wrap=False)


def _from_angle_differences(before, after, width, height, wrap: bool = True) -> tuple[float, float, float]:
    """Small angles: da = yaw - tan e (roll cos a + pitch sin a), de = roll sin a - pitch cos a, off the poles."""
    (a, e), (a_then, e_then) = (azimuth_elevation(pixel_to_direction(uv, width, height)) for uv in (before, after))
    gap = wrap_angle(a - a_then) if wrap else a - a_then
    rows = np.column_stack([-np.tan(e) * np.cos(a), -np.tan(e) * np.sin(a), np.ones_like(a)])
    others = np.column_stack([np.sin(a), -np.cos(a), np.zeros_like(a)])
    w = np.linalg.lstsq(np.concatenate([rows, others]), np.concatenate([gap, e - e_then]), rcond=None)[0]
    return tuple(np.degrees(w).tolist())


EXERCISES = [
    Exercise(
        number="11.1",
        level="warm-up",
        solution=direction_of,
        inputs=_pixel,
        cases=(
            lambda rng: (-0.5, 319.5, 1280, 640),  # straight ahead, on the edge of the first pixel
            lambda rng: (1290.0, 400.0, 1280, 640),  # a box across the seam goes on beyond the width
            lambda rng: (-20.0, 400.0, 1280, 640),
            lambda rng: (100.0, -0.5, 1280, 640),  # straight up
        ),
        mistakes=(
            Mistake(
                _slip(azimuth=lambda a: a + np.pi),
                "That is our own panorama, whose middle is ahead. In this one the left edge is ahead.",
            ),
            Mistake(
                lambda c, r, w, h: _slip(azimuth=lambda a: a + np.pi)(c - 0.5, r - 0.5, w, h),
                "That is our own panorama, in edge coordinates. Here the left edge is ahead, 0 a pixel's middle.",
            ),
            Mistake(
                _slip(azimuth=lambda a: -a),
                "Mirrored: to the right, which is where columns go, y gets less, not more.",
            ),
            Mistake(
                _slip(elevation=lambda e: -e),
                "Yours is upside down: row 0 is straight up, so elevation falls with the row.",
            ),
            Mistake(
                _slip(azimuth=lambda a: -a, elevation=lambda e: -e),
                "Both signs are turned around: azimuth falls with the column, elevation falls with the row.",
            ),
            Mistake(
                _no_cosine,
                "Your vectors are longer than 1 off the horizon: x and y shrink with the cosine of the elevation.",
            ),
            Mistake(_slip(azimuth=lambda a: a / 2), "Your panorama spans half a turn: the whole width is 2 pi."),
            Mistake(
                _slip(elevation=lambda e: 2 * e),
                "Your elevation runs over a whole turn: from straight up to straight down it is pi.",
            ),
            Mistake(
                _slip(elevation=lambda e: np.pi / 2 - e),
                "You measure from straight up, so at the horizon yours is 90 degrees. Elevation is 0 there.",
            ),
            Mistake(
                _slip(np.degrees, np.degrees),
                "np.cos and np.sin take radians; you give them degrees.",
            ),
            Mistake(
                lambda c, r, w, h: direction_of(c - 0.5, r - 0.5, w, h),
                "You take its numbers for edge coordinates: its column 0 is the middle of a pixel, half a pixel on.",
            ),
            Mistake(
                lambda c, r, w, h: direction_of(c - 1, r - 1, w, h),
                "Half a pixel the wrong way: the middle of its first pixel is at 0.5 in edge coordinates.",
            ),
            Mistake(
                lambda c, r, w, h: direction_of(c, r - 0.5, w, h),
                "The columns are right. Its rows are counted from pixel centres, too.",
            ),
            Mistake(
                lambda c, r, w, h: direction_of(c - 0.5, r, w, h),
                "The rows are right. Its columns are counted from pixel centres, too.",
            ),
            Mistake(
                lambda c, r, w, h: direction_of(c, r, w, h)[[1, 0, 2]],
                "x and y are swapped: x (ahead) takes the cosine of the azimuth, y (left) the sine.",
            ),
            Mistake(
                lambda c, r, w, h: _from_angles(-(c + 0.5) / (w - 1) * 2 * np.pi, (0.5 - (r + 0.5) / (h - 1)) * np.pi),
                "You divide by the width less one. The image is `width` pixels wide, edge to edge.",
            ),
            Mistake(_clamped, "A column beyond the edge is a direction, too: do not cut it off there."),
            Mistake(
                lambda c, r, w, h: direction_of(c, r, 1280, 640),
                "Your image is always 1280 x 640: use the arguments.",
            ),
            Mistake(
                lambda c, r, w, h: _from_angles(_angles(c, r, w, h)[0], (0.5 - (r + 0.5) / w) * np.pi),
                "You divide the row by the width. Rows run over the height.",
            ),
            Mistake(
                lambda c, r, w, h: direction_of(c, r, w, h)[[1, 2, 0]] * [-1, -1, 1],
                "That is x right, y down, z forward, as in a depth camera. Here x is ahead, y left, z up.",
            ),
            Mistake(
                lambda c, r, w, h: np.array([*direction_of(c, r, w, h)[:2], np.cos(_angles(c, r, w, h)[1])]),
                "z is the sine of the elevation: 0 on the horizon, 1 straight up.",
            ),
        ),
    ),
    Exercise(
        number="11.2",
        solution=column_gap_deg,
        inputs=_columns,
        cases=(
            lambda rng: (960.0, 320.0, 1280),  # half a turn: -180, by the range
            lambda rng: (320.0, 960.0, 1280),
            lambda rng: (77.0, 77.0, 1280),
            lambda rng: (0.0, 1280.0, 1280),  # both edges are one line
            lambda rng: (1410.0, 130.0, 1280),  # u_max of a box across the seam
            lambda rng: (10.0, 1900.0, 1280),
            lambda rng: (2500.0, 40.0, 1280),  # nearly two turns: one `if` takes away a single one
        ),
        mistakes=(
            Mistake(
                lambda a, b, w: g - 360 if (g := _plain_gap(a, b, w)) >= 180 else g + 360 if g < -180 else g,
                "An `if` takes away one turn at most. Columns beyond the edges may be more than one turn apart.",
            ),
            Mistake(
                _plain_gap,
                "Across the seam yours is nearly a whole turn. Bring the difference back to [-180, 180).",
            ),
            Mistake(
                lambda a, b, w: column_gap_deg(b, a, w),
                "Your sign is turned around: azimuth grows to the left, where columns get smaller.",
            ),
            Mistake(
                lambda a, b, w: _plain_gap(b, a, w),
                "Two things: azimuth grows where columns get smaller, and the seam needs a wrap to [-180, 180).",
            ),
            Mistake(
                lambda a, b, w: abs(column_gap_deg(a, b, w)),
                "The sign is lost: left is positive, right is negative.",
            ),
            Mistake(
                lambda a, b, w: _plain_gap(a, b, w) % 360,
                "Yours lies in [0, 360): something 10 degrees to the right comes out as 350.",
            ),
            Mistake(
                lambda a, b, w: 180.0 - (180 - _plain_gap(a, b, w)) % 360,
                "Half a turn is -180 here, not +180: the range is [-180, 180), its right end is out.",
            ),
            Mistake(
                lambda a, b, w: abs(_plain_gap(a, b, w) + 180) % 360 - 180,
                "An absolute value before the remainder spoils gaps below -180. `%` alone copes with negative numbers.",
            ),
            Mistake(
                lambda a, b, w: float(np.sign(_plain_gap(a, b, w)) * (abs(_plain_gap(a, b, w)) % 180)),
                "Size and sign apart lose the way round: a gap of 200 degrees one way is 160 the other way.",
            ),
            Mistake(
                lambda a, b, w: float(min(abs(_plain_gap(a, b, w)), 360 - abs(_plain_gap(a, b, w)))),
                "The sign is lost, and beyond a whole turn yours is negative. Wrap the signed gap instead.",
            ),
            Mistake(
                lambda a, b, w: g if abs(g := _plain_gap(a, b, w)) < 180 else 360 - g,
                "360 minus the gap turns its sign around. A whole turn is *taken away* from the gap, or added.",
            ),
            Mistake(
                _one_side_only,
                "You mend differences of 180 and more only. Those below -180 need it as well.",
            ),
            Mistake(
                _other_side_only,
                "You mend differences below -180 only. Those of 180 and more need it as well.",
            ),
            Mistake(
                lambda a, b, w: (_plain_gap(a, b, w) + 90) % 180 - 90,
                "You wrap at 90 degrees. A difference may be as large as half a turn.",
            ),
            Mistake(
                lambda a, b, w: float(np.radians(column_gap_deg(a, b, w))),
                "These are radians; the task asks for degrees.",
            ),
            Mistake(
                lambda a, b, w: column_gap_deg(a, b, w) / 360 * w,
                "That is the difference in columns, wrapped. Turn it into degrees.",
            ),
            Mistake(
                lambda a, b, w: column_gap_deg(a, b, 1280),
                "Your image is always 1280 columns wide: use the argument.",
            ),
            Mistake(
                lambda a, b, w: float(np.sign(a - b) * min(abs(a - b), w - abs(a - b)) / w * 360),
                "The size is right. But across the seam the shorter way goes to the other side: wrap sign and all.",
            ),
            Mistake(
                lambda a, b, w: float(np.degrees(np.angle(np.exp(2j * np.pi * (a - b) / w)))),
                "Half a turn comes out as 180 in one direction, as -180 in the other. The range has -180 alone.",
            ),
            Mistake(
                lambda a, b, w: float(column_gap_deg(a, b, 2 * w)),
                "The whole width is 360 degrees; in yours it is 180.",
            ),
            Mistake(
                lambda a, b, w: float((_plain_gap(a, b, w) / 2 + 90) % 180 - 90),
                "You took 180 degrees for the whole width, and wrapped by 180. It is 360.",
            ),
            Mistake(
                lambda a, b, w: float(_plain_gap(a, b, w) % 180),
                "The remainder by 180 makes opposite directions alike. Only whole turns may be taken away.",
            ),
        ),
    ),
    Exercise(
        number="11.3",
        solution=shortest_stretch,
        inputs=_points_of_an_object,
        cases=(
            lambda rng: (np.array([1270.0, 2.0, 1278.0, 18.0]), 1280),
            lambda rng: (np.array([300.0]), 1280),
            lambda rng: (np.array([5.0, 5.0, 5.0]), 640),  # equal ones
            lambda rng: (np.array([0.0, 1200.0]), 1280),  # a point on the seam itself
            lambda rng: (np.array([630.0, 645.0, 650.0]), 1280),  # across the middle: no matter at all
            lambda rng: (np.array([300.0, 700.0, 1000.0, 1250.0]), 1280),  # more than half a turn
            lambda rng: (np.array([300.0, 310.0, 320.0, 330.0, 700.0, 1100.0]), 1280),  # most of them at one end
        ),
        mistakes=(
            Mistake(
                _gaps_without_the_last_of_several,
                "One gap is missing: the one from the last point across the seam to the first.",
                others=(_gaps_without_the_last,),
            ),
            Mistake(
                lambda columns, width: (float(columns.min()), float(columns.max())),
                "Least and greatest column: across the seam that is the long way round, through the whole picture.",
            ),
            Mistake(_signed_start, "Your u_min is negative across the seam. Move both by a turn: 0 <= u_min < width."),
            Mistake(
                lambda columns, width: tuple(u % width for u in shortest_stretch(columns, width)),
                "The remainder of u_max turns the stretch inside out: across the seam it must pass the width.",
            ),
            Mistake(
                lambda columns, width: shortest_stretch(columns, width)[::-1],
                "The right values, but u_max first. Give u_min, u_max.",
            ),
            Mistake(
                _split_in_the_middle,
                "You cut at mid width: a stretch across the middle of the picture is torn. Look for the largest gap.",
            ),
            Mistake(
                _around_the_first,
                "You unroll around the first point: a stretch of more than half a turn is torn on the other side.",
            ),
            Mistake(
                _around_the_mean,
                "You unroll around a mean direction: for a stretch of more than half a turn it may be in the gap.",
            ),
            Mistake(
                _moved_if_wide,
                "Points that span half the picture need not lie across the seam. Look for the largest gap, all around.",
            ),
            Mistake(
                _gaps_of_half_a_turn,
                "The largest gap may be less than half a turn, and still be the one to leave out.",
            ),
            Mistake(
                _from_where_the_gap_begins,
                "Your stretch begins where the largest gap begins. It begins where that gap ends.",
            ),
            Mistake(_largest_gap_itself, "That is the empty part, the largest gap. The points are in all the rest."),
            Mistake(
                lambda columns, width: (
                    shortest_stretch(columns, width)[0],
                    float(np.ptp(shortest_stretch(columns, width))),
                ),
                "The second number is the length of the stretch. Asked is u_max, where it ends.",
            ),
            Mistake(
                lambda columns, width: shortest_stretch(columns, 1280),
                "Your image is always 1280 columns wide: use the argument.",
            ),
        ),
    ),
    Exercise(
        number="11.4",
        level="challenge",
        solution=knock,
        inputs=_a_knock,
        cases=(_no_knock, _points_behind, _first_point_twice),
        others=(knock_linear, _from_angle_differences),
        tolerance=0.05,
        mistakes=(
            Mistake(
                _from_so_many(1),
                "You use the first points only. Which turn do they leave open? Stack them all.",
                others=(_from_so_many(2),),
            ),
            Mistake(
                lambda b, a, w, h: (*np.multiply(knock(b, a, w, h), [1, 1, -1]).tolist(),),
                "Roll and pitch are right, yaw has the wrong sign: left is positive, and moves what is seen right.",
            ),
            Mistake(
                lambda b, a, w, h: (*np.multiply(knock(b, a, w, h), [-1, 1, 1]).tolist(),),
                "Pitch and yaw are right, roll has the wrong sign: a positive one lowers the right side (y is left).",
            ),
            Mistake(
                lambda b, a, w, h: knock(a, b, w, h),
                "Your signs are turned around. A camera that turns left sees everything move to the right.",
            ),
            Mistake(
                lambda b, a, w, h: tuple(np.radians(knock(b, a, w, h)).tolist()),
                "These are radians; the task asks for degrees.",
            ),
            Mistake(
                lambda b, a, w, h: knock(b, a, w, h)[::-1],
                "The right angles, but yaw first. The order is roll, pitch, yaw.",
            ),
            Mistake(
                _yaw_alone,
                "That is yaw alone, as if the axis stood upright. Look how a tilt moves points ahead, and at the left.",
            ),
            Mistake(
                _rows_and_columns,
                "Rows are not pitch: a pitch lifts what is ahead and sinks what is behind, and the mean hides both.",
            ),
            Mistake(
                lambda b, a, w, h: (0.0, -_rows_and_columns(b, a, w, h)[1], _mean_turn(b, a, w)),
                "You take mean rows for pitch. A pitch moves what is ahead and what is behind in opposite ways.",
            ),
            Mistake(
                _not_across_the_seam,
                "Points that crossed the seam seem to have moved by a whole turn. Compute with unit vectors, or wrap.",
            ),
            Mistake(
                lambda b, a, w, h: (*np.multiply(knock(b, a, w, h), [1, -1, 1]).tolist(),),
                "Roll and yaw are right, pitch has the wrong sign: a positive one lowers the nose (y is left).",
            ),
            Mistake(
                lambda b, a, w, h: (knock(b, a, w, h)[1], knock(b, a, w, h)[0], knock(b, a, w, h)[2]),
                "Roll and pitch are swapped: roll turns about x, the axis that points ahead.",
            ),
        ),
    ),
]
