"""Depth images by VTK's z-buffer: every particle's view is a tile of one off-screen window, read back once.

One window lives as long as the renderer. Tile k has a vtkRenderer of its own (a viewport and a camera); all share one
actor, the map. The colour of a pixel is never looked at.
"""

from __future__ import annotations

import os
import sys

import numpy as np

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.rendering.chunks import MeshChunks
from course_lib.depth_mcl.rendering.renderer import OpenGLError
from course_lib.depth_mcl.scene_map import SceneMap

if sys.platform.startswith("linux"):
    # Before VTK makes a window: no display is needed. An empty value would crash VTK.
    os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = os.environ.get("VTK_DEFAULT_OPENGL_WINDOW") or "vtkEGLRenderWindow"

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - registers the OpenGL classes behind the names below
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkLogger, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

# The least that OpenGL 4.1 promises for a side of a framebuffer is 16,384 pixels; half of it is promised everywhere.
MAX_WINDOW_SIDE = 8192

# Each tile costs VTK some 40 kB, however small its image, and is kept for the next frame.
MAX_TILES = 1000

CURE = (
    "On Debian or Ubuntu: apt-get install libegl1 libgl1-mesa-dri libgl1 (`python3 course.py check` tells what is "
    'missing). Without OpenGL, ray casting gives the same images: DepthRenderer(..., backend="ray"), or --backend ray'
)


class VtkBackend:
    """Draws batches of at most `batch_size` views, fewer where a window would grow beyond what OpenGL allows."""

    def __init__(self, scene_map: SceneMap, camera: DepthCamera, batch_size: int) -> None:
        if camera.width > MAX_WINDOW_SIDE or camera.height > MAX_WINDOW_SIDE:
            raise ValueError(
                f"an image of {camera.width} x {camera.height} pixels is larger than one OpenGL window "
                f"({MAX_WINDOW_SIDE} on a side): use camera.resized(...)"
            )
        self.camera = camera
        self._columns = max(1, min(MAX_WINDOW_SIDE // camera.width, int(np.ceil(np.sqrt(batch_size)))))
        self._n_tiles = min(batch_size, MAX_TILES, self._columns * (MAX_WINDOW_SIDE // camera.height))
        self._window: vtkRenderWindow | None = None
        self._window_rows = 0
        self._tiles: list[vtkRenderer] = []
        self._buffer = vtkFloatArray()

        vertices = scene_map.vertices - scene_map.origin
        self._chunks = MeshChunks(vertices, scene_map.faces)
        self._faces = np.ascontiguousarray(scene_map.faces[self._chunks.order], dtype=np.int64)
        self._drawn_chunks = np.zeros(len(self._chunks.centers), dtype=bool)
        self._map_data = _poly_data(vertices)
        self._map_actor = _plain_actor(self._map_data)

        self._points_data = vtkPolyData()
        self._points_tile = vtkRenderer()
        self._points_tile.AddActor(_plain_actor(self._points_data))
        self._open_window()

    def render(self, poses: np.ndarray, out: np.ndarray) -> None:
        """Fills `out` `(N, H, W)` with the depth seen from poses `(N, 4, 4)`, relative to the map's origin."""
        for start in range(0, len(poses), self._n_tiles):
            batch = slice(start, start + self._n_tiles)
            self._draw_only(poses[batch])
            self._prepare_tiles(len(poses[batch]))
            for tile, pose in zip(self._tiles, poses[batch], strict=False):
                _place(tile.GetActiveCamera(), pose)
            self._draw_and_read(self._tiles[: len(poses[batch])], out[batch])

    def render_points(self, points: np.ndarray) -> np.ndarray:
        """Depth image `(H, W)` of points `(M, 3)` in the optical frame, through the same z-buffer; NaN where none."""
        count = len(points)
        vtk_points = vtkPoints()
        vtk_points.SetData(numpy_to_vtk(points.astype(np.float32), deep=True))
        self._points_data.SetPoints(vtk_points)
        cells = np.stack([np.ones(count, dtype=np.int64), np.arange(count)], axis=1)
        vertices = vtkCellArray()
        vertices.ImportLegacyFormat(numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
        self._points_data.SetVerts(vertices)
        self._points_data.Modified()
        image = np.empty(self.camera.shape, dtype=np.float32)
        self._draw_and_read([self._points_tile], image[None])
        image[np.isinf(image)] = np.nan
        return image

    def describe(self) -> str:
        """The OpenGL renderer's name, for example llvmpipe (a CPU) or a graphics card."""
        for line in self._window.ReportCapabilities().splitlines():
            if line.startswith("OpenGL renderer string:"):
                return line.split(":", 1)[1].strip()
        return self._window.GetClassName()

    def close(self) -> None:
        """Frees the window with its framebuffers."""
        if self._window is not None:
            for tile in [*self._tiles, self._points_tile]:
                tile.RemoveAllViewProps()
                self._window.RemoveRenderer(tile)
            self._window.Finalize()
        self._window, self._tiles = None, []
        self._map_actor = self._map_data = self._points_data = self._points_tile = self._buffer = None

    def _open_window(self) -> None:
        # VTK reports on the console what the error below says better.
        verbosity = vtkLogger.GetCurrentVerbosityCutoff()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        try:
            window = vtkRenderWindow()
            if window.GetClassName() == "vtkOSOpenGLRenderWindow":
                # VTK's last resort when EGL fails; drawing with it crashes where the OSMesa library is missing.
                raise OpenGLError(f"OpenGL cannot start without a display (EGL failed). {CURE}")
            window.SetOffScreenRendering(True)
            window.SetMultiSamples(0)
            self._window = window
            self._resize_window(1)
            self._points_tile.SetViewport(*self._viewport(0))
            self._set_projection(self._points_tile)
            _place(self._points_tile.GetActiveCamera(), np.eye(4))
            window.AddRenderer(self._points_tile)
            window.Render()
            if not window.SupportsOpenGL() or window.GetDepthBufferSize() < 24:
                raise OpenGLError(f"OpenGL gives no 24-bit depth buffer. {CURE}")
            self._points_tile.DrawOff()
        finally:
            vtkLogger.SetStderrVerbosity(verbosity)

    def _resize_window(self, rows: int) -> None:
        self._window_rows = rows
        self._window.SetSize(self._columns * self.camera.width, rows * self.camera.height)
        for index, tile in enumerate(self._tiles):
            tile.SetViewport(*self._viewport(index))
        self._points_tile.SetViewport(*self._viewport(0))

    def _viewport(self, index: int) -> tuple[float, float, float, float]:
        """Tile `index`, counted from the bottom left, as VTK's fractions (x_min, y_min, x_max, y_max) of the window."""
        row, column = divmod(index, self._columns)
        columns, rows = self._columns, self._window_rows
        return column / columns, row / rows, (column + 1) / columns, (row + 1) / rows

    def _prepare_tiles(self, count: int) -> None:
        """Makes the window and its tiles large and many enough; they only ever grow."""
        rows = -(-count // self._columns)
        if rows > self._window_rows:
            self._resize_window(rows)
        while len(self._tiles) < count:
            tile = vtkRenderer()
            tile.AddActor(self._map_actor)
            tile.SetViewport(*self._viewport(len(self._tiles)))
            self._set_projection(tile)
            self._window.AddRenderer(tile)
            self._tiles.append(tile)

    def _set_projection(self, tile: vtkRenderer) -> None:
        matrix = vtkMatrix4x4()
        matrix.DeepCopy(self.camera.projection_matrix().ravel())
        vtk_camera = tile.GetActiveCamera()
        vtk_camera.SetUseExplicitProjectionTransformMatrix(True)
        vtk_camera.SetExplicitProjectionTransformMatrix(matrix)
        vtk_camera.SetClippingRange(self.camera.near, self.camera.far)

    def _draw_only(self, poses: np.ndarray) -> None:
        """Puts the triangles that one of the views may see into the map's actor; uploads only what is new."""
        visible = self._chunks.visible(self.camera, poses)
        if (visible & ~self._drawn_chunks).any() or 2 * visible.sum() < self._drawn_chunks.sum():
            cells = vtkCellArray()
            faces = self._faces[self._chunks.faces_of(visible)]
            cells.SetData(3, numpy_to_vtkIdTypeArray(faces.ravel(), deep=True))
            self._map_data.SetPolys(cells)
            self._map_data.Modified()
            self._drawn_chunks = visible

    def _draw_and_read(self, tiles: list[vtkRenderer], out: np.ndarray) -> None:
        """Draws just these tiles and fills `out` `(n, H, W)` from them."""
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
        """Fills `out` `(n, H, W)` from the first n tiles: the window's z-buffer read once, cut up and linearized."""
        height, width = self.camera.shape
        columns, rows = self._columns, -(-len(out) // self._columns)
        self._window.GetZbufferData(0, 0, columns * width - 1, rows * height - 1, self._buffer)
        window = vtk_to_numpy(self._buffer).reshape(rows, height, columns, width)
        for index, image in enumerate(out):
            row, column = divmod(index, columns)
            # OpenGL's bottom row comes first, among the tiles and within each.
            image[:] = depth_from_buffer(window[row, ::-1, column], self.camera)


def depth_from_buffer(buffer: np.ndarray, camera: DepthCamera) -> np.ndarray:
    """Depth in metres, float32, of depth-buffer values in [0, 1]; `inf` where the buffer still holds its clear value 1.

    Z = near far / (far - b (far - near)), the inverse of b = far (Z - near) / (Z (far - near)).
    """
    near, far = camera.near, camera.far
    # float64, since far - b (far - near) loses the digits that the two have in common.
    depth = near * far / (far - np.asarray(buffer, dtype=np.float64) * (far - near))
    return np.where(buffer >= 1.0, np.inf, depth).astype(np.float32)


def _poly_data(vertices: np.ndarray) -> vtkPolyData:
    points = vtkPoints()
    points.SetData(numpy_to_vtk(vertices.astype(np.float32), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    return data


def _plain_actor(data: vtkPolyData) -> vtkActor:
    """Actor without light, colour arrays or normals: only its depth is of interest."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetPointSize(1)
    return actor


def _place(vtk_camera: object, pose: np.ndarray) -> None:
    """Puts a VTK camera at a camera-to-world matrix `(4, 4)` in the optical convention."""
    right, down, forward, position = pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3]
    del right
    vtk_camera.SetPosition(*position)
    vtk_camera.SetFocalPoint(*(position + forward))
    vtk_camera.SetViewUp(*(-down))
