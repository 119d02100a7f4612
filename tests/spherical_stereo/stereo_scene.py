"""One small scene for the tests of matching: eight boards in a textured room, seen by both cameras."""

from functools import cache

import numpy as np

from tests.spherical_stereo.vertical_pair import (
    BASELINE,
    Board,
    blotches,
    detections,
    panorama,
    room_walls,
    tiled,
)


@cache
def scene():
    """(boards, upper image, lower image, upper detections, lower detections); the lower ones in another order.

    Two sofas look exactly alike, one chair's texture repeats itself, one table stands across the seam, and the chair
    behind the first is partly hidden by it.
    """
    rng = np.random.default_rng(7)
    alike = blotches(rng)
    boards = [
        Board("chair", 0.30, 1.6, 0.7, -1.0, -0.1, blotches(rng)),
        Board("chair", 0.52, 2.6, 0.9, -1.0, 0.2, blotches(rng)),
        Board("chair", 1.30, 2.0, 0.9, -1.0, 0.0, tiled(blotches(rng, 12), 3)),
        Board("table", np.pi - 0.05, 2.2, 1.5, -1.0, -0.2, blotches(rng)),
        Board("table", 2.10, 2.4, 1.2, -1.0, -0.2, blotches(rng)),
        Board("sofa", -0.90, 2.5, 1.3, -1.1, -0.2, alike),
        Board("sofa", -1.70, 2.0, 1.2, -1.1, -0.2, alike),
        Board("cabinet", -2.50, 2.3, 0.9, -1.2, 0.4, blotches(rng)),
    ]
    everything = boards + room_walls(blotches(rng, 40))
    upper, lower = panorama(everything), panorama(everything, -BASELINE)
    return boards, upper, lower, detections(boards), detections(boards, -BASELINE)[::-1]
