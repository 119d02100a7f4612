"""Equirectangular pictures of a room from any place, and which object each pixel shows, both drawn by VTK."""

from contextlib import AbstractContextManager

import cv2
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer, vtkTexture
from vtkmodules.vtkRenderingOpenGL2 import vtkPanoramicProjectionPass, vtkRenderStepsPass

from course_lib.geometry import optical_pose
from course_lib.rendering.vtk_backend import off_screen_window, place_camera
from courseware.simulation.corridor.mesh_building import to_polydata
from courseware.simulation.room.scene import Lamp, Room
from courseware.simulation.textures import TexturedMesh

NEAR, FAR = 0.05, 30.0  # m: nothing stands nearer to the rig than its clearance; no room is 30 m across
FEATURE_ANGLE_DEG = 40.0  # chosen: edges sharper than this stay sharp, cushions look round
BACKGROUND = 255  # the number that stands for walls, floor and everything the map does not list
OVERSAMPLING = 2  # pictures are drawn twice as large and averaged down, against jagged edges


class PanoramaRenderer(AbstractContextManager):
    """Draws one room of fewer than 255 objects. A context manager: the windows live until `close`.

    width: of the panoramas, pixels, even. number_scale: pictures of object numbers are so many times as large.
    alone_scale: the same for those of one object alone, which are most of the work, a divisor of number_scale.
    """

    def __init__(self, room: Room, width: int = 1280, number_scale: int = 2, alone_scale: int | None = None) -> None:
        self.room, self.width, self.height = room, width, width // 2
        self._picture = _Scene(OVERSAMPLING * width, interpolate=True)
        self._numbers = _Scene(number_scale * width, interpolate=False)
        self._repeats = number_scale // (alone_scale or number_scale)
        self._alone = _Scene(alone_scale * width, interpolate=False) if self._repeats > 1 else self._numbers
        for lamp in room.lamps:
            self._picture.add_lamp(lamp)
        objects = [(mesh, number) for number, thing in enumerate(room.objects) for mesh in thing.meshes]
        for mesh, number in [*((mesh, BACKGROUND) for mesh in room.shell), *objects]:
            data = _poly_data(mesh)
            self._picture.add(data, mesh, room.ambient)
            for scene in {self._numbers, self._alone}:
                scene.add_flat(data, number)

    def render(self, state: np.ndarray) -> np.ndarray:
        """The panorama `(height, width, 3)` float32 BGR, 255 = full scale, from a body pose `(6,)`, without noise."""
        image = self._picture.draw(state).astype(np.float32)
        return cv2.resize(image, (self.width, self.height), interpolation=cv2.INTER_AREA)[..., ::-1].copy()

    def render_objects(self, state: np.ndarray) -> np.ndarray:
        """The index into `room.objects`, or `BACKGROUND`, of each pixel; uint8, `number_scale` times as large."""
        return self._numbers.draw(state)[..., 0].copy()

    def render_alone(self, state: np.ndarray, number: int) -> np.ndarray:
        """Which pixels would show one object if nothing stood before it: bool, of the size of `render_objects`."""
        self._alone.show_only(number)
        mask = self._alone.draw(state)[..., 0] == number
        self._alone.show_only(None)
        return mask.repeat(self._repeats, axis=0).repeat(self._repeats, axis=1)

    def close(self) -> None:
        """Free the windows."""
        for scene in {self._picture, self._numbers, self._alone}:
            scene.close()

    def __exit__(self, *exception) -> None:
        self.close()


class _Scene:
    """One window, one renderer, one panoramic pass."""

    def __init__(self, width: int, interpolate: bool) -> None:
        self._width = width
        self._actors: list[tuple[vtkActor, int]] = []
        self._renderer = vtkRenderer()
        self._renderer.SetBackground(1.0, 1.0, 1.0)
        self._renderer.SetAutomaticLightCreation(False)
        self._renderer.SetLightFollowCamera(False)
        self._renderer.SetTwoSidedLighting(True)
        # The culler knows the front camera's view only and would throw away what is behind and beside it.
        self._renderer.GetCullers().RemoveAllItems()
        self._pass = vtkPanoramicProjectionPass()
        self._pass.SetProjectionTypeToEquirectangular()
        self._pass.SetAngle(360.0)
        # A cube face covers a quarter of the panorama's width; its middle is the coarsest part, 4 / pi times as fine.
        self._pass.SetCubeResolution(int(np.ceil(width / np.pi)))
        self._pass.SetInterpolate(interpolate)
        self._pass.SetDelegatePass(vtkRenderStepsPass())
        self._renderer.SetPass(self._pass)
        self._window = off_screen_window()
        self._window.SetSize(width, width // 2)
        self._window.AddRenderer(self._renderer)
        self._pixels = vtkUnsignedCharArray()

    def add_lamp(self, lamp: Lamp) -> None:
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPositional(True)
        light.SetPosition(*lamp.position)
        light.SetConeAngle(180.0)
        light.SetColor(*lamp.colour)
        light.SetIntensity(lamp.strength)
        # Falls off with the square of the distance, but stays finite beside the lamp; 1 at one metre.
        light.SetAttenuationValues(0.4, 0.0, 0.6)
        self._renderer.AddLight(light)

    def add(self, data: vtkPolyData, mesh: TexturedMesh, ambient: tuple[float, float, float]) -> None:
        """A mesh in its texture, lit by the lamps and by light from everywhere (ambient, RGB)."""
        actor = self._actor(data)
        actor.SetTexture(_texture(mesh.texture))
        surface = actor.GetProperty()
        surface.SetAmbient(1.0)
        surface.SetAmbientColor(*np.clip(mesh.emission + (1.0 - mesh.emission) * np.asarray(ambient), 0.0, 1.0))
        surface.SetDiffuse(1.0 - mesh.emission)
        surface.SetSpecular(0.0)

    def add_flat(self, data: vtkPolyData, number: int) -> None:
        """A mesh painted with the number of its object."""
        actor = self._actor(data)
        actor.GetProperty().LightingOff()
        actor.GetProperty().SetColor(number / 255.0, number / 255.0, number / 255.0)
        self._actors.append((actor, number))

    def _actor(self, data: vtkPolyData) -> vtkActor:
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(data)
        actor = vtkActor()
        actor.SetMapper(mapper)
        self._renderer.AddActor(actor)
        return actor

    def show_only(self, number: int | None) -> None:
        for actor, its_number in self._actors:
            actor.SetVisibility(number is None or its_number == number)

    def draw(self, state: np.ndarray) -> np.ndarray:
        pose, camera = optical_pose(state), self._renderer.GetActiveCamera()
        place_camera(camera, pose[:3, :3], pose[:3, 3])
        camera.SetClippingRange(NEAR, FAR)
        self._window.Render()
        self._window.GetPixelData(0, 0, self._width - 1, self._width // 2 - 1, 1, self._pixels, 0)
        return vtk_to_numpy(self._pixels).reshape(self._width // 2, self._width, 3)[::-1]

    def close(self) -> None:
        self._pass.ReleaseGraphicsResources(self._window)
        self._renderer.RemoveAllViewProps()
        self._window.RemoveRenderer(self._renderer)
        self._window.Finalize()


def _poly_data(mesh: TexturedMesh) -> vtkPolyData:
    data = to_polydata(np.asarray(mesh.vertices, np.float32), mesh.faces)
    data.active_texture_coordinates = np.asarray(mesh.texture_coordinates, np.float32)
    return data.compute_normals(
        cell_normals=False, split_vertices=True, feature_angle=FEATURE_ANGLE_DEG, consistent_normals=False
    )


def _texture(picture: np.ndarray) -> vtkTexture:
    height, width = picture.shape[:2]
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    # VTK counts texture rows from the bottom.
    image.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(picture[::-1]).reshape(-1, 3), deep=True))
    texture = vtkTexture()
    texture.SetInputData(image)
    texture.InterpolateOn()
    texture.MipmapOn()
    texture.RepeatOn()
    # Anisotropic filtering, VTK's default of 4, sends Mesa's software renderer into an endless loop where the texture's
    # derivatives degenerate (one view of 240 did), and costs more than drawing twice as large.
    texture.SetMaximumAnisotropicFiltering(1.0)
    return texture
