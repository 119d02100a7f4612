"""Redraw a figure many times a second. The fixed parts are drawn once, and the moving parts are drawn on top."""

import cv2
import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from courseware.lessons.kit.display import require_labels


class LiveFigure:
    """Keeps the drawn frame of a figure and draws its moving artists on top.

    figure: finished, with all labels. moving: the artists whose data, text or position change between redraws. Set
    their data, then call `png()`. The limits of their axes must not change.
    """

    def __init__(self, figure: Figure, moving: list[Artist]) -> None:
        require_labels(figure)
        self.figure, self.moving = figure, moving
        for artist in moving:
            artist.set_animated(True)
        figure.canvas.draw()
        figure.set_layout_engine("none")  # it has placed everything, so another pass would only cost time
        figure.canvas.draw()
        self._frame = figure.canvas.copy_from_bbox(figure.bbox)

    def png(self) -> bytes:
        """Return the present picture as a PNG. It is barely compressed, so that encoding is fast."""
        canvas = self.figure.canvas
        canvas.restore_region(self._frame)
        for artist in self.moving:
            (artist.axes or self.figure).draw_artist(artist)
        rgb = np.asarray(canvas.buffer_rgba())[..., :3]
        ok, encoded = cv2.imencode(".png", rgb[..., ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 1])
        if not ok:
            raise RuntimeError(f"OpenCV could not encode a picture of shape {rgb.shape} as PNG")
        return encoded.tobytes()
