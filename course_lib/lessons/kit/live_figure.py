"""A figure that is redrawn many times a second: what does not change is drawn once, what changes on top of it."""

from __future__ import annotations

import cv2
import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from course_lib.lessons.kit.display import require_labels


class LiveFigure:
    """Keeps the drawn frame of a figure and adds its moving artists to it.

    figure: finished, with all labels. moving: the artists whose data, text or position change between redraws (their
    axes keep their limits). Set their data, then call `png()`.
    """

    def __init__(self, figure: Figure, moving: list[Artist]) -> None:
        require_labels(figure)
        self.figure, self.moving = figure, moving
        for artist in moving:
            artist.set_animated(True)
        figure.canvas.draw()
        # Constrained layout has found its places: another pass would only cost time.
        figure.set_layout_engine("none")
        figure.canvas.draw()
        self._frame = figure.canvas.copy_from_bbox(figure.bbox)

    def png(self) -> bytes:
        """The picture now, encoded quickly (a panel's stored picture is compressed once, when it is shown)."""
        canvas = self.figure.canvas
        canvas.restore_region(self._frame)
        for artist in self.moving:
            self.figure.draw_artist(artist) if artist.axes is None else artist.axes.draw_artist(artist)
        rgb = np.asarray(canvas.buffer_rgba())[..., :3]
        ok, encoded = cv2.imencode(".png", rgb[..., ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 1])
        if not ok:
            raise RuntimeError(f"OpenCV could not encode a picture of shape {rgb.shape} as PNG")
        return encoded.tobytes()
