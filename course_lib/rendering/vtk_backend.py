"""Render depth images by VTK's z-buffer: every particle's view is a tile of one off-screen window, read back once.

Each tile has its own vtkRenderer, and all share one actor, the map. Threads take turns with the window (`_drawing`).
A forked child has no OpenGL threads, so every call would wait for ever. It raises a named error instead.
"""

import os
import re
import sys
import threading
import weakref
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.chunks import MeshChunks
from course_lib.rendering.errors import OpenGLError, RendererClosedError
from course_lib.rendering.scene_map import SceneMap

if sys.platform.startswith("linux"):
    # This must stand before the first import of VTK. No display is needed then. An empty value would crash VTK.
    os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = os.environ.get("VTK_DEFAULT_OPENGL_WINDOW") or "vtkEGLRenderWindow"
    # Mesa maps a file of compiled shaders into memory. If the disk is full, it ends the process (SIGBUS). Without the
    # file the first image takes as long as before.
    os.environ.setdefault("MESA_SHADER_CACHE_DISABLE", "true")

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - registers the OpenGL classes behind the names below
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkLogger, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

CURE = (
    "On Debian or Ubuntu: apt-get install libegl1 libgl1-mesa-dri libgl1 (`python3 course.py check` says what is "
    'missing). Without OpenGL, DepthRenderer(..., backend="raster") gives the same images: leave out --backend vtk'
)
MAX_WINDOW_SIDE = 8192  # pixels: every OpenGL draws windows of this size
MAX_TILES = 1000  # each costs VTK some 40 kB, however small its image, and is kept for the next frame
_NO_SHIFT_AND_SCALE = 0  # vtkPolyDataMapper's DISABLE_SHIFT_SCALE, a name that VTK does not give to Python

_windows: weakref.WeakSet[vtkRenderWindow] = weakref.WeakSet()
_process_of_the_first_window: int | None = None


def off_screen_window() -> vtkRenderWindow:
    """Return a new window off the screen, without multisampling."""
    global _process_of_the_first_window
    if _process_of_the_first_window is None:
        _process_of_the_first_window = os.getpid()
    _require_own_process(_process_of_the_first_window)
    with quiet():
        window = vtkRenderWindow()
    if window.GetClassName() == "vtkOSOpenGLRenderWindow":
        # VTK falls back to this class when EGL fails. Without the OSMesa library it crashes.
        raise OpenGLError(f"OpenGL cannot start without a display (EGL failed). {CURE}")
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    _windows.add(window)
    return window


@contextmanager
def quiet() -> Iterator[None]:
    """Silence VTK's own messages about OpenGL that cannot start, because our errors also say what to do."""
    verbosity = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(verbosity)


def _require_own_process(process: int) -> None:
    """Raise `OpenGLError` unless this is the process that opened the window."""
    if process != os.getpid():
        raise OpenGLError(
            f"OpenGL was started in process {process}; in process {os.getpid()}, forked from it, drawing would hang. "
            'Start workers with multiprocessing.get_context("spawn"), or use backend="raster"'
        )


def _leave_windows_to_the_parent() -> None:
    """Add a reference to each window, so that this forked child never frees one, which would hang."""
    for window in _windows:
        window.Register(None)


if hasattr(os, "register_at_fork"):  # not on Windows, which cannot fork
    os.register_at_fork(after_in_child=_leave_windows_to_the_parent)


class VtkBackend:
    """Render batches of at most `batch_size` views, fewer where a window would become too large for OpenGL."""

    def __init__(self, scene_map: SceneMap, camera: DepthCamera, batch_size: int) -> None:
        if camera.width > MAX_WINDOW_SIDE or camera.height > MAX_WINDOW_SIDE:
            size = f"{camera.width} x {camera.height}"
            raise ValueError(f"{size} pixels are too many for OpenGL ({MAX_WINDOW_SIDE} on a side): use camera.resized")
        self.camera = camera
        # OpenGL clips so far beyond `farthest` that rounding decides nothing there.
        self._drawn = camera.with_clip_planes(camera.nearest, 1.01 * camera.farthest)
        self._columns = max(1, min(MAX_WINDOW_SIDE // camera.width, int(np.ceil(np.sqrt(batch_size)))))
        self._n_tiles = min(batch_size, MAX_TILES, self._columns * (MAX_WINDOW_SIDE // camera.height))
        self._process = os.getpid()
        self._turn = threading.Lock()
        self._window: vtkRenderWindow | None = None
        self._rows = 0
        self._tiles: list[vtkRenderer] = []
        self._buffer = vtkFloatArray()
        self._scene_map = scene_map
        self._chunks = MeshChunks(scene_map.vertices, scene_map.faces)
        self._faces = np.ascontiguousarray(scene_map.faces[self._chunks.order], dtype=np.int64)
        self._drawn_chunks = np.zeros(len(self._chunks.centers), dtype=bool)
        self._map_data = vtkPolyData()
        self._map_actor = _plain_actor(self._map_data)
        self._upload_vertices(scene_map.origin)
        self._points_data = vtkPolyData()
        self._open_window()

    def render(self, poses: np.ndarray, out: np.ndarray) -> None:
        """Fill `out` `(N, H, W)` with the depth seen from camera poses `(N, 4, 4)`."""
        for start in range(0, len(poses), self._n_tiles):
            batch = slice(start, start + self._n_tiles)
            with self._drawing():
                self._render_batch(poses[batch], out[batch])

    def _render_batch(self, poses: np.ndarray, out: np.ndarray) -> None:
        anchor = self._scene_map.anchor(poses[:, :3, 3])
        if not np.array_equal(anchor, self._anchor):  # rarely: the cameras stay near the anchor
            self._upload_vertices(anchor)
        self._draw_only(poses)
        self._make_room(len(poses))
        for tile, pose in zip(self._tiles, poses, strict=False):
            place_camera(tile.GetActiveCamera(), pose[:3, :3], pose[:3, 3] - anchor)
        self._draw_and_read(self._tiles[: len(poses)], out)

    def render_points(self, points: np.ndarray) -> np.ndarray:
        """Return the depth image `(H, W)` of points `(M, 3)` in the optical frame; NaN where none fell."""
        vtk_points, vertices = vtkPoints(), vtkCellArray()
        vtk_points.SetData(numpy_to_vtk(points.astype(np.float32), deep=True))
        vertices.SetData(1, numpy_to_vtkIdTypeArray(np.arange(len(points)), deep=True))
        image = np.empty(self.camera.shape, dtype=np.float32)
        with self._drawing():
            self._points_data.SetPoints(vtk_points)
            self._points_data.SetVerts(vertices)
            self._points_data.Modified()
            self._draw_and_read([self._points_tile], image[None])
        image[np.isinf(image)] = np.nan
        return image

    def describe(self) -> str:
        """Return OpenGL's name of its device, such as llvmpipe (a CPU) or a graphics card."""
        with self._drawing():
            named = re.search(r"^OpenGL renderer string: *(.+)$", self._window.ReportCapabilities(), re.MULTILINE)
            return named[1].strip() if named else self._window.GetClassName()

    def close(self) -> None:
        """Free the window with its framebuffers. A forked child leaves it to its parent."""
        if self._process != os.getpid():
            return
        with self._turn:
            if self._window is not None:
                for tile in [*self._tiles, self._points_tile]:
                    tile.RemoveAllViewProps()
                    self._window.RemoveRenderer(tile)
                self._window.Finalize()
            self._window, self._tiles = None, []
            self._map_actor = self._map_data = self._points_data = self._points_tile = self._buffer = None

    @contextmanager
    def _drawing(self) -> Iterator[None]:
        """Give this thread the window's context. Without it, the thread would read an earlier image, and no error."""
        _require_own_process(self._process)  # before the lock: a fork copies it as it is, held or not
        with self._turn:
            if self._window is None:
                raise RendererClosedError("this renderer was closed by another thread while it drew")
            self._window.MakeCurrent()
            try:
                yield
            finally:
                self._window.ReleaseCurrent()

    def _open_window(self) -> None:
        with quiet():
            self._window = window = off_screen_window()
            self._points_tile = self._new_tile(_plain_actor(self._points_data))
            place_camera(self._points_tile.GetActiveCamera(), np.eye(3), np.zeros(3))
            self._make_room(0)
            window.Render()
            if not window.SupportsOpenGL() or window.GetDepthBufferSize() < 24:
                raise OpenGLError(f"OpenGL gives no 24-bit depth buffer. {CURE}")
            self._points_tile.DrawOff()
            window.ReleaseCurrent()

    def _make_room(self, count: int) -> None:
        """Enlarge the window and add tiles until `count` views have room; nothing ever shrinks."""
        rows, columns = max(1, self._rows, -(-count // self._columns)), self._columns
        if rows == self._rows and count <= len(self._tiles):
            return
        self._rows = rows
        self._window.SetSize(columns * self.camera.width, rows * self.camera.height)
        self._tiles += [self._new_tile(self._map_actor) for _ in range(len(self._tiles), count)]
        for tiles in (self._tiles, [self._points_tile]):
            for index, tile in enumerate(tiles):  # from the bottom left, in fractions of the window
                row, column = divmod(index, columns)
                tile.SetViewport(column / columns, row / rows, (column + 1) / columns, (row + 1) / rows)

    def _new_tile(self, actor: vtkActor) -> vtkRenderer:
        """Return a new tile of the window that renders an actor with the camera's projection."""
        tile, matrix = vtkRenderer(), vtkMatrix4x4()
        tile.AddActor(actor)
        matrix.DeepCopy(self._drawn.projection_matrix().ravel())
        vtk_camera = tile.GetActiveCamera()
        vtk_camera.SetUseExplicitProjectionTransformMatrix(True)
        vtk_camera.SetExplicitProjectionTransformMatrix(matrix)
        vtk_camera.SetClippingRange(self._drawn.near, self._drawn.far)
        self._window.AddRenderer(tile)
        return tile

    def _upload_vertices(self, anchor: np.ndarray) -> None:
        """Give OpenGL the map's vertices, float32, relative to `anchor` `(3,)`."""
        points = vtkPoints()
        points.SetData(numpy_to_vtk((self._scene_map.vertices - anchor).astype(np.float32), deep=True))
        self._map_data.SetPoints(points)
        self._map_data.Modified()
        self._anchor = anchor

    def _draw_only(self, poses: np.ndarray) -> None:
        """Give OpenGL the triangles that the views may see, if it lacks some of them or has more than twice as many."""
        visible = self._chunks.visible(self._drawn, poses, self._anchor)
        if (visible & ~self._drawn_chunks).any() or 2 * visible.sum() < self._drawn_chunks.sum():
            cells = vtkCellArray()
            faces = self._faces[np.repeat(visible, np.diff(self._chunks.starts))]
            cells.SetData(3, numpy_to_vtkIdTypeArray(faces.ravel(), deep=True))
            self._map_data.SetPolys(cells)
            self._map_data.Modified()
            self._drawn_chunks = visible

    def _draw_and_read(self, tiles: list[vtkRenderer], out: np.ndarray) -> None:
        """Render only these tiles and fill `out` `(n, H, W)` from them."""
        try:
            for tile in tiles:
                tile.DrawOn()
            self._window.Render()
            self._read_tiles(out)
        finally:
            # Also after Ctrl-C: the map's first tile and the points' tile cover the same pixels.
            for tile in tiles:
                tile.DrawOff()

    def _read_tiles(self, out: np.ndarray) -> None:
        """Read the z-buffer once and fill `out` `(n, H, W)` from its first n tiles."""
        height, width = self.camera.shape
        columns, rows = self._columns, -(-len(out) // self._columns)
        self._window.GetZbufferData(0, 0, columns * width - 1, rows * height - 1, self._buffer)
        window = vtk_to_numpy(self._buffer).reshape(rows, height, columns, width)
        for index, image in enumerate(out):
            row, column = divmod(index, columns)
            # OpenGL's bottom row comes first, among the tiles and within each.
            image[:] = depth_from_buffer(window[row, ::-1, column], self._drawn, self.camera.farthest)


def depth_from_buffer(buffer: np.ndarray, camera: DepthCamera, farthest: float) -> np.ndarray:
    """Return depth in metres, float32, of depth-buffer values b in [0, 1]; `inf` beyond `farthest`.

    Z = near far / (far - b (far - near)), the inverse of b = far (Z - near) / (Z (far - near))
    """
    near, far = camera.near, camera.far
    # float64, because far - b (far - near) loses the digits that the two have in common.
    depth = near * far / (far - np.asarray(buffer, dtype=np.float64) * (far - near))
    return np.where(depth <= farthest, depth, np.inf).astype(np.float32)


def _plain_actor(data: vtkPolyData) -> vtkActor:
    """Return an actor without light, colours or normals, because we read its depth alone."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToOff()
    # Without this, VTK scales the vertices by their bounding box, which one stray triangle can stretch.
    mapper.SetVBOShiftScaleMethod(_NO_SHIFT_AND_SCALE)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetPointSize(1)
    return actor


def place_camera(vtk_camera: object, rotation: np.ndarray, position: np.ndarray) -> None:
    """Put a VTK camera at a position `(3,)`; the columns of `rotation` `(3, 3)` are its right, down and forward."""
    vtk_camera.SetPosition(*position)
    vtk_camera.SetFocalPoint(*(position + rotation[:, 2]))
    vtk_camera.SetViewUp(*-rotation[:, 1])
