"""A hotel floor of boxes: rooms 101 and 102 are furnished alike, 103 is not, a corridor joins them.

The filter is given the map. What the camera sees is drawn from the *world*: the map, a suitcase and two chairs that the
map lacks, and noise.
"""

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.geometry import optical_pose
from course_lib.lessons.kit.box_world import box_map
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap

CAMERA = DepthCamera.from_fov(40, 30, 75, 58, near=0.1, far=9.0)
NOISE = 0.005  # of the distance, standard deviation
GRAVITY_SIGMA = np.deg2rad(1.0)
HEIGHT = 2.5  # metres, of every room
ROOM = 4.0  # metres from one room to the next along x
EYE = 1.4  # metres, of the camera above the floor
ALIKE = np.array([ROOM, 0.0, 0.0])  # from a place in 101 to its double in 102

Corners = tuple[tuple[float, float, float], tuple[float, float, float]]

# Corners (x, y, z) in metres. Floor, ceiling and outer walls; the corridor is y = 0 to 1.6, the rooms y = 1.7 to 5.7.
SHELL: tuple[Corners, ...] = (
    ((-0.1, -0.1, -0.1), (12.1, 5.8, 0.0)),
    ((-0.1, -0.1, HEIGHT), (12.1, 5.8, HEIGHT + 0.1)),
    ((-0.1, -0.1, 0.0), (12.1, 0.0, HEIGHT)),
    ((-0.1, 5.7, 0.0), (12.1, 5.8, HEIGHT)),
    ((-0.1, 0.0, 0.0), (0.0, 5.7, HEIGHT)),
    ((12.0, 0.0, 0.0), (12.1, 5.7, HEIGHT)),
    ((3.95, 1.7, 0.0), (4.05, 5.7, HEIGHT)),
    ((7.95, 1.7, 0.0), (8.05, 5.7, HEIGHT)),
)
DOOR = (2.6, 3.5)  # x in metres of a room's door, from the room's left wall
# Of 101, and of 102 once more: bed, table, wardrobe, shelf, cupboard, mirror, and a picture in the corridor opposite.
FURNITURE: tuple[Corners, ...] = (
    ((0.05, 3.2, 0.0), (2.1, 4.8, 0.55)),
    ((3.1, 4.6, 0.0), (3.95, 5.7, 0.75)),
    ((0.05, 1.7, 0.0), (1.3, 2.3, 2.0)),
    ((1.2, 5.4, 1.3), (2.4, 5.7, 1.7)),
    ((0.05, 2.6, 0.0), (0.4, 3.0, 1.5)),
    ((3.85, 2.4, 0.6), (3.95, 3.1, 2.0)),
    ((2.7, 0.0, 1.0), (3.3, 0.15, 1.9)),
)
CORRIDOR: tuple[Corners, ...] = (
    ((0.0, 0.0, 0.0), (0.5, 1.1, 0.9)),
    ((11.2, 0.9, 0.0), (12.0, 1.6, 1.9)),
    ((11.6, 0.0, 0.0), (12.0, 0.5, 0.5)),
)
STORE: tuple[Corners, ...] = (  # room 103
    ((8.05, 4.9, 0.0), (10.4, 5.7, 2.1)),
    ((11.4, 2.5, 0.0), (12.0, 5.2, 1.1)),
    ((9.2, 3.0, 0.0), (10.2, 3.9, 0.9)),
)
LACKING: tuple[Corners, ...] = (  # in the world and not on the map
    ((6.2, 0.1, 0.0), (6.6, 0.5, 0.7)),
    ((2.4, 4.9, 0.0), (2.8, 5.3, 0.9)),
    ((2.4 + ROOM, 4.9, 0.0), (2.8 + ROOM, 5.3, 0.9)),
)


def door_leaf(room: int) -> Corners:
    """A closed door of room 0, 1 or 2."""
    return ((ROOM * room + DOOR[0], 1.62, 0.0), (ROOM * room + DOOR[1], 1.68, 2.1))


def _shifted(corners: Corners, x: float) -> Corners:
    return tuple((x + a, b, c) for a, b, c in corners)


def _boxes() -> list[Corners]:
    wall = []
    for room in range(3):
        left, opens, closes = ROOM * room, ROOM * room + DOOR[0], ROOM * room + DOOR[1]
        wall += [((left, 1.6, 0.0), (opens, 1.7, HEIGHT)), ((closes, 1.6, 0.0), (left + ROOM, 1.7, HEIGHT))]
        wall.append(((opens, 1.6, 2.1), (closes, 1.7, HEIGHT)))
    rooms = [_shifted(box, ROOM * room) for room in range(2) for box in FURNITURE]
    return [*SHELL, *wall, *rooms, *CORRIDOR, *STORE]


def boxes_on_the_plan() -> tuple[list[Corners], list[Corners]]:
    """Walls, and what stands in the rooms; floor and ceiling are in neither."""
    shell, rest = SHELL[2:], _boxes()[len(SHELL) :]
    walls = [box for box in rest if box[0][1] == 1.6 and box[0][2] == 0.0]
    return [*shell, *walls], [box for box in rest if box[0][1] != 1.6]


@functools.cache
def hotel_map(*closed: int) -> SceneMap:
    """The map that the filter is given; closed: rooms (0, 1, 2) whose door was shut on the day of the survey."""
    return box_map(*_boxes(), *(door_leaf(room) for room in closed))


@functools.cache
def _world() -> DepthRenderer:
    return DepthRenderer(box_map(*_boxes(), *LACKING), CAMERA, exact=True)


class Recording(NamedTuple):
    """A camera's walk."""

    states: np.ndarray
    """`(T, 6)`, the truth."""
    depths: np.ndarray
    """`(T, H, W)` metres, NaN = no measurement."""
    gravity: np.ndarray
    """`(T, 3)` down in the camera's optical frame, as its accelerometer says."""

    def __len__(self) -> int:
        return len(self.states)


def record(states: np.ndarray, seed: int) -> Recording:
    """What camera and accelerometer measure from states `(T, 6)`, with noise."""
    rng = np.random.default_rng(seed)
    depths = _world().render(states) * (1 + NOISE * rng.standard_normal((len(states), *CAMERA.shape)))
    depths = np.where(np.isfinite(depths), depths, np.nan).astype(np.float32)
    down = -optical_pose(states)[:, 2, :3] + GRAVITY_SIGMA * rng.standard_normal((len(states), 3))
    return Recording(states, depths, down)


def walk(corners: Sequence[Sequence[float]], frames: int, sway: float = 1.0) -> np.ndarray:
    """States `(frames, 6)` along corners [x, y, yaw in degrees], by hand: it sways and nods; sway 0: on a wagon."""
    columns = np.asarray(corners, dtype=np.float64)
    at = np.linspace(0, len(columns) - 1, frames)
    x, y, yaw_deg = (np.interp(at, np.arange(len(columns)), column) for column in columns.T)
    step = np.arange(frames)
    roll, pitch = np.deg2rad(1.5 * sway) * np.sin(1.3 * step), np.deg2rad(8 + 2 * sway * np.sin(0.9 * step))
    return np.column_stack([x, y, EYE + 0.02 * sway * np.sin(1.7 * step), roll, pitch, np.deg2rad(yaw_deg)])


def behind_a_person(depth: np.ndarray, left: int) -> np.ndarray:
    """A depth image with somebody in front, 0.8 m away and 16 columns wide, from column `left` on."""
    image = depth.copy()
    image[:, max(left, 0) : max(left + 16, 0)] = 0.8
    return image
