"""Exercises of lesson 11: somebody else's pixels, the way to turn, a stretch across the seam, a knocked tripod."""

import numpy as np

from course_lib.geometry import pose_matrix, wrap_angle
from course_lib.lessons.kit.cases import case
from course_lib.lessons.kit.exercises import Exercise
from course_lib.spherical_stereo.panorama import (
    azimuth_elevation,
    direction_from_angles,
    direction_to_pixel,
    pixel_to_direction,
)

WIDTHS = (640, 1280, 1920)

# 11.1: from a pixel of somebody else's panorama to a direction


def direction_of(column, row, width, height):
    """Unit vector (3,) of a pixel of a panorama whose left edge is ahead; 0 is a pixel's middle."""
    # Half a pixel first, then the two angles; azimuth falls from 0 at the left edge.
    azimuth = -(column + 0.5) / width * 2 * np.pi
    elevation = (0.5 - (row + 0.5) / height) * np.pi
    flat = np.cos(elevation)
    return np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])


def a_pixel(rng: np.random.Generator) -> tuple:
    height = int(rng.choice([320, 512, 640, 960]))
    return float(rng.uniform(0, 2 * height)), float(rng.uniform(0.05, 0.95) * height), 2 * height, height


# 11.2: the angle from one column to another


def column_gap_deg(u_from, u_to, width):
    """Degrees in [-180, 180) from one column to the other, positive to the left."""
    # The difference in degrees, wrapped.
    gap = (u_from - u_to) / width * 360
    return (gap + 180) % 360 - 180


def two_columns(rng: np.random.Generator) -> tuple:
    """Two columns on one side of the seam, or one on each side of it, in either order."""
    width = int(rng.choice(WIDTHS))
    ends = ((0.05, 0.5), (0.05, 0.5)) if rng.random() < 0.5 else ((0, 0.1), (0.9, 1))
    u_from, u_to = rng.permutation([float(rng.uniform(*end)) * width for end in ends])
    return float(u_from), float(u_to), width


# 11.3: the shortest stretch of columns that holds all points


def shortest_stretch(columns, width):
    """(u_min, u_max) of the shortest stretch with all columns (n,); u_max may pass the width."""
    # The largest gap is left out; the gap across the seam is one of them.
    around = np.sort(columns)
    gaps = np.diff(np.append(around, around[0] + width))
    largest = gaps.argmax()
    start = around[(largest + 1) % len(around)]
    return start, start + width - gaps[largest]


def points_of_an_object(rng: np.random.Generator) -> tuple:
    """Columns within 0.1 to 0.6 of a turn, unsorted, across the seam in more than half of the inputs."""
    width, spread = int(rng.choice(WIDTHS)), rng.uniform(0.05, 0.3)
    middle = rng.uniform(-0.8, 0.8) * spread if rng.random() < 0.6 else rng.uniform(0.35, 0.65)
    return (middle + rng.uniform(-spread, spread, int(rng.integers(4, 9)))) * width % width, width


def left_half_moved(columns, width, when):
    """Least and greatest column, after those of the left half are moved by a turn if `when` is true."""
    moved = columns + width * (when & (columns < width / 2))
    return moved.min(), moved.max()


def unrolled(columns, width):
    """Least and greatest column, after each is moved to the turn in which it is nearest to the first one."""
    near = (columns - columns[0] + width / 2) % width - width / 2 + columns[0]
    return near.min() % width, near.min() % width + np.ptp(near)


# 11.4: a knock against the tripod


def knock(before, after, width, height):
    """Roll, pitch, yaw [degrees] of the second pose in the first, from pixels (n, 2) of far points."""
    # d - d' = w x d', three equations for each point, solved by least squares.
    first, then = (pixel_to_direction(uv, width, height) for uv in (before, after))
    moves = [np.cross(axis, then) for axis in np.eye(3)]  # for a turn about x, y, z by 1
    equations = np.stack(moves, axis=-1).reshape(-1, 3)
    w, *_ = np.linalg.lstsq(equations, (first - then).ravel(), rcond=None)
    return tuple(np.degrees(w))


def knock_by_angles(before, after, width, height, wrap=wrap_angle):
    """Another right way: da = yaw - tan e (roll cos a + pitch sin a), de = roll sin a - pitch cos a, off the poles."""
    (a, e), (a_then, e_then) = (azimuth_elevation(pixel_to_direction(uv, width, height)) for uv in (before, after))
    azimuths = np.column_stack([-np.tan(e) * np.cos(a), -np.tan(e) * np.sin(a), np.ones_like(a)])
    elevations = np.column_stack([np.sin(a), -np.cos(a), np.zeros_like(a)])
    steps = np.concatenate([wrap(a - a_then), e - e_then])
    return tuple(np.degrees(np.linalg.lstsq(np.concatenate([azimuths, elevations]), steps, rcond=None)[0]))


def mean_steps(before, after, width):
    """How far the points moved to the right and down in the mean, degrees."""
    right, down = (after - before).T / width * 360
    return ((right + 180) % 360 - 180).mean(), down.mean()


def knocked(rng: np.random.Generator, azimuth=None, largest=1.0) -> tuple:
    """Far points at these azimuths [rad] (default: all around) before and after a turn of up to `largest` degrees."""
    width = int(rng.choice(WIDTHS))
    azimuth = rng.uniform(-np.pi, np.pi, int(rng.integers(8, 15))) if azimuth is None else azimuth
    first = direction_from_angles(azimuth, rng.uniform(-0.9, 0.6, len(azimuth)))
    turn = pose_matrix(np.radians([0, 0, 0, *rng.uniform(-largest, largest, 3)]))[:3, :3]
    before, after = (direction_to_pixel(d, width, width // 2) for d in (first, first @ turn))
    return before, after, width, width // 2


def no_knock(rng: np.random.Generator) -> tuple:
    return knocked(rng, largest=0.0)


def points_behind(rng: np.random.Generator) -> tuple:
    return knocked(rng, np.pi + rng.uniform(-0.02, 0.02, 12))


def the_first_point_twice(rng: np.random.Generator) -> tuple:
    """Together the first two points leave the turn about their own direction open."""
    before, after, width, height = knocked(rng)
    before[1], after[1] = before[0], after[0]
    return before, after, width, height


# fmt: off
EXERCISES = [
    Exercise("11.1", direction_of, a_pixel, "warm-up", cases=[
        case("straight ahead", -0.5, 319.5, 1280, 640), case("straight up", 100.0, -0.5, 1280, 640),
        case("a column beyond the right edge", 1290.0, 400.0, 1280, 640),
        case("a column beyond the left edge", -20.0, 400.0, 1280, 640),
    ], mistakes="""
        -(column + 0.5) / width => (0.5 - (column + 0.5) / width)
        -(column + 0.5) / width => (0.5 - column / width) and also (row + 0.5) => row
        That is our own panorama, whose middle is ahead. Here the left edge is ahead, and 0 is a pixel's middle.
        -(column + 0.5) => (column + 0.5)
        (0.5 - (row + 0.5) / height) => ((row + 0.5) / height - 0.5)
        -(column + 0.5) => (column + 0.5) and also (0.5 - (row + 0.5) / height) => ((row + 0.5) / height - 0.5)
        Mirrored, or upside down: columns run to the right, rows run down, so azimuth and elevation fall with them.
        flat = np.cos(elevation) => flat = 1
        Your vectors are longer than 1 off the horizon: x and y shrink with the cosine of the elevation.
        / width * 2 * np.pi => / width * np.pi
        / height) * np.pi => / height) * 2 * np.pi
        The whole width is a whole turn, 2 pi. The whole height is half a turn, pi.
        (0.5 - (row + 0.5) / height) => (row + 0.5) / height
        You measure from straight up, so at the horizon yours is 90 degrees. Elevation is 0 there.
        2 * np.pi => 360 and also * np.pi => * 180
        np.cos and np.sin take radians; you give them degrees.
        (column + 0.5) => column and also (row + 0.5) => row
        You take its numbers for edge coordinates: its column 0 is the middle of a pixel, half a pixel on.
        + 0.5 => - 0.5
        Half a pixel the wrong way: the middle of its first pixel is at 0.5 in edge coordinates.
        (column + 0.5) => column
        (row + 0.5) => row
        Columns and rows are both counted from pixel centres. In yours only one of them is.
        np.sin(elevation)]) => np.sin(elevation)])[[1, 0, 2]]
        np.sin(elevation)]) => np.sin(elevation)])[[1, 2, 0]] * [-1, -1, 1]
        The axes are exchanged: x is ahead (cosine of the azimuth), y is left (its sine), z is up.
        / width => / (width - 1) and also / height => / (height - 1)
        You divide by the width less one. The image is `width` pixels wide, edge to edge.
    """),
    Exercise("11.2", column_gap_deg, two_columns, cases=[
        case("half a turn", 960.0, 320.0, 1280), case("half a turn to the left", 320.0, 960.0, 1280),
        case("equal columns", 77.0, 77.0, 1280), case("the two edges", 0.0, 1280.0, 1280),
        case("u_max of a box across the seam", 1410.0, 130.0, 1280), case("more than a turn", 10.0, 1900.0, 1280),
        case("nearly two turns", 2500.0, 40.0, 1280),
    ], mistakes="""
        (gap + 180) % 360 - 180 => gap - 360 if gap >= 180 else gap + 360 if gap < -180 else gap
        An `if` takes away one turn at most. Columns beyond the edges may be more than one turn apart.
        (gap + 180) % 360 - 180 => gap - 360 if gap >= 180 else gap
        (gap + 180) % 360 - 180 => gap + 360 if gap < -180 else gap
        You mend gaps of 180 and more, or those below -180, but not both.
        (gap + 180) % 360 - 180 => gap
        Across the seam yours is nearly a whole turn. Bring the difference back to [-180, 180).
        (u_from - u_to) => (u_to - u_from)
        Your sign is turned around: azimuth grows to the left, where columns get smaller.
        (gap + 180) % 360 - 180 => abs((gap + 180) % 360 - 180)
        (gap + 180) % 360 - 180 => min(abs(gap), 360 - abs(gap))
        The sign is lost: left is positive, right is negative. Wrap the gap with its sign.
        (gap + 180) % 360 - 180 => gap % 360
        Yours lies in [0, 360): something 10 degrees to the right comes out as 350.
        (gap + 180) % 360 - 180 => 180 - (180 - gap) % 360
        (gap + 180) % 360 - 180 => np.degrees(np.angle(np.exp(1j * np.radians(gap))))
        Half a turn is -180 here, never +180: the range is [-180, 180), its right end is out.
        (gap + 180) => abs(gap + 180)
        An absolute value before the remainder spoils gaps below -180. `%` alone copes with negative numbers.
        (gap + 180) % 360 - 180 => gap if abs(gap) < 180 else 360 - gap
        360 minus the gap turns its sign around. A whole turn is *taken away* from the gap, or added.
        (gap + 180) % 360 - 180 => np.sign(gap) * min(abs(gap), 360 - abs(gap))
        The size is right. But across the seam the shorter way goes to the other side: wrap sign and all.
        (gap + 180) % 360 - 180 => (gap + 90) % 180 - 90
        (gap + 180) % 360 - 180 => gap % 180
        (gap + 180) % 360 - 180 => np.sign(gap) * (abs(gap) % 180)
        The remainder by 180 makes opposite directions alike. Only whole turns may be taken away.
        / width * 360 => / width * 180
        / width * 360 => / width * 180 and also (gap + 180) % 360 - 180 => (gap + 90) % 180 - 90
        The whole width is 360 degrees; in yours it is 180.
    """),
    Exercise("11.3", shortest_stretch, points_of_an_object, cases=[
        case("one point", np.array([300.0]), 1280), case("equal points", np.array([5.0, 5.0, 5.0]), 640),
        case("across the seam", np.array([1270.0, 2.0, 1278.0, 18.0]), 1280),
        case("a point on the seam", np.array([0.0, 1200.0]), 1280),
        case("across the middle", np.array([630.0, 645.0, 650.0]), 1280),
        case("more than half a turn", np.array([300.0, 700.0, 1000.0, 1250.0]), 1280),
        case("most of them at one end", np.array([300.0, 310.0, 320.0, 330.0, 700.0, 1100.0]), 1280),
    ], mistakes="""
        around[0] + width)) => around[-1]))
        around[0] + width)) => around[-1] + (len(around) == 1) * width))
        One gap is missing: the one from the last point across the seam to the first.
        ... => return columns.min(), columns.max()
        Least and greatest column: across the seam that is the long way round, through the whole picture.
        return start, start + => start -= width * (start + width - gaps[largest] >= width); return start, start +
        Your u_min is negative across the seam. Move both by a turn: 0 <= u_min < width.
        start + width - gaps[largest] => (start + width - gaps[largest]) % width
        The remainder of u_max turns the stretch inside out: across the seam it must pass the width.
        ... => return left_half_moved(columns, width, columns.max() >= width / 2)
        You cut at mid width: a stretch across the middle of the picture is torn. Look for the largest gap.
        ... => return left_half_moved(columns, width, np.ptp(columns) > width / 2)
        Points that span half the picture need not lie across the seam. Look for the largest gap, all around.
        ... => return unrolled(columns, width)
        You unroll around the first point: a stretch of more than half a turn is torn on the other side.
        largest = gaps.argmax() => largest = gaps.argmax() if gaps.max() >= width / 2 else -1
        The largest gap may be less than half a turn, and still be the one to leave out.
        (largest + 1) % len(around) => largest
        Your stretch begins where the largest gap begins. It begins where that gap ends.
        (largest + 1) % len(around) => largest and also gaps[largest] => (width - gaps[largest])
        That is the empty part, the largest gap. The points are in all the rest.
        return start, start + width => return start, width
        The second number is the length of the stretch. Asked is u_max, where it ends.
    """),
    Exercise("11.4", knock, knocked, "challenge", cases=[no_knock, points_behind, the_first_point_twice],
             others=[knock_by_angles], tolerance=0.05, mistakes="""
        (before, after) => (before[:1], after[:1])
        (before, after) => (before[:2], after[:2])
        You use the first points only. Which turn do they leave open? Stack them all.
        np.degrees(w) => np.degrees(w) * [-1, 1, 1]
        np.degrees(w) => np.degrees(w) * [1, -1, 1]
        np.degrees(w) => np.degrees(w) * [1, 1, -1]
        One sign is wrong: a positive roll lowers the right side, a positive pitch the nose, a positive yaw turns left.
        (before, after) => (after, before)
        Your signs are turned around. A camera that turns left sees everything move to the right.
        ... => return 0.0, 0.0, mean_steps(before, after, width)[0]
        That is yaw alone, as if the axis stood upright. Look how a tilt moves points ahead, and at the left.
        ... => right, down = mean_steps(before, after, width); return 0.0, down, right
        ... => right, down = mean_steps(before, after, width); return 0.0, -down, right
        Rows are not pitch: a pitch lowers what is ahead and lifts what is behind, and the mean hides both.
        ... => return knock_by_angles(before, after, width, height, wrap=np.array)
        Points that crossed the seam seem to have moved by a whole turn. Compute with unit vectors, or wrap.
        np.degrees(w) => np.degrees(np.cross(then, first).mean(axis=0))
        A mean of cross products is too small: no point shows a turn about its own direction. Solve the equations.
    """),
]
