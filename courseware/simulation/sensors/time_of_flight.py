"""An SR4000-like time-of-flight camera: phasors from sub-pixel rays, noise, wiggling, scattering, drop-outs, wraps.

The camera sends light modulated at frequency f and finds, for every pixel, amplitude and phase of what comes back.
A surface at range r (along the ray, not along the optical axis) adds the phasor

    s = rho cos(theta) / r^2 * exp(i 4 pi f r / c)

to every pixel that sees it. A pixel sums over 3 x 3 sub-pixel rays, so that it floats between two surfaces it sees.
range = c phase / (4 pi f) lies in [0, c / 2f): what comes from farther away is wrapped, or too weak and dropped.
Not modelled: light that takes several paths in the room, motion blur within one exposure, warming up.
"""

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from scipy.ndimage import gaussian_filter

from course_lib.geometry import BODY_FROM_OPTICAL, pose_matrix
from course_lib.rendering.camera import DepthCamera
from courseware.simulation.sensors.ray_casting import WorldCaster

SPEED_OF_LIGHT = 299_792_458.0  # m/s, exact


@dataclass(frozen=True)
class TimeOfFlightModel:
    """Parameters of the camera. Amplitudes are relative to a white target (reflectivity 1) met squarely at 2 m.

    Sources. Data sheet: MESA Imaging, SR4000 data sheet, 10 m model (15 MHz, 850 nm, calibrated from 0.8 m on,
    repeatability about 6 mm at 2 m on a bright target, absolute accuracy +-15 mm). Kavli: Kavli, Kirkhus, Thielemann,
    Jagielski, "Modelling and compensating measurement errors caused by scattering in time-of-flight cameras", 2008.
    The 10 m model is taken because a corridor is longer than the 5 m model's range (30 MHz) in most pixels.
    """

    frequency: float = 15e6  # Hz, modulation, c / 2f = 9.993 m; data sheet
    sub_rays: int = 3  # rays per pixel along each axis; chosen
    shot_noise: float = 0.0036  # no unit, phasor noise at amplitude 1, one sigma: 5.7 mm at 2 m; after the data sheet
    dark_noise: float = 0.00022  # no unit, phasor noise without signal, one sigma (ambient light, read-out); chosen
    least_amplitude: float = 0.010  # no unit, below it no return (about 0.07 m of noise there); chosen
    greatest_amplitude: float = 6.25  # no unit, above it saturated: white nearer than 0.8 m; after the data sheet
    offset: float = 0.003  # m, constant systematic error; chosen within the data sheet's accuracy
    wiggling: float = 0.006  # m, amplitude of the cyclic error; chosen within the data sheet's accuracy
    wiggling_order: int = 4  # cycles of that error over c / 2f (fourth harmonic of a square wave); chosen
    fixed_pattern: float = 0.003  # m, one sigma from pixel to pixel, the same in all frames; chosen
    scattered_share: float = 0.001  # share of all light that is scattered inside the camera; chosen, form after Kavli
    scatter_width: float = 40.0  # pixels, sigma of the scattered light; chosen, form after Kavli

    @property
    def unambiguous_range(self) -> float:
        """c / (2 f) in metres."""
        return SPEED_OF_LIGHT / (2 * self.frequency)


@dataclass(frozen=True)
class CalibrationErrors:
    """How the true camera differs from the one that its user is told of; all zero where calibration is perfect."""

    focal_length: float = 0.0  # share by which the true focal lengths are longer
    radial: float = 0.0  # a pixel that should look along the tangent r looks along r (1 + radial r^2)
    mount: tuple[float, ...] = (0.0,) * 6  # the true camera's pose in the told body frame, metres and radians


@dataclass(frozen=True)
class CalibrationModel:
    """How wrong calibration and mount are: sizes are fixed and signs are drawn."""

    focal_length: float = 0.01  # share of both focal lengths; chosen: a calibration by hand from a few boards
    radial: float = 0.02  # no unit, radial distortion left over: half a pixel in an SR4000's corners; chosen
    mount_position: float = 0.005  # m per axis, a bracket measured with a tape; chosen
    mount_angle_deg: float = 0.3  # degrees per axis, a bracket set with a spirit level; chosen

    def draw(self, rng: Generator) -> CalibrationErrors:
        """Errors of these sizes, each with a sign of its own."""
        signs = rng.choice((-1.0, 1.0), 8)
        sizes = np.concatenate([np.full(3, self.mount_position), np.full(3, np.deg2rad(self.mount_angle_deg))])
        return CalibrationErrors(
            float(signs[0] * self.focal_length), float(signs[1] * self.radial), tuple((signs[2:] * sizes).tolist())
        )


@dataclass(frozen=True)
class Frame:
    """One simulated frame, `(H, W)` each."""

    depth: np.ndarray  # metres along the optical axis, nan = no measurement
    range: np.ndarray  # metres along the ray
    amplitude: np.ndarray  # relative (see `TimeOfFlightModel`)
    nearest: np.ndarray  # least true range of the sub-rays, metres; inf where none met anything
    farthest: np.ndarray  # greatest; -inf where none met anything


class TimeOfFlightCamera:
    """A camera with a fixed pattern drawn by `rng`; its user is told `camera`, from which it differs by `errors`."""

    def __init__(
        self, camera: DepthCamera, model: TimeOfFlightModel, rng: Generator, errors: CalibrationErrors | None = None
    ) -> None:
        errors = errors or CalibrationErrors()
        self.camera = camera
        self.model = model
        self.pattern = model.fixed_pattern * rng.normal(size=camera.shape)
        self._rays = _sub_pixel_rays(camera, model.sub_rays, errors)
        self._mount = pose_matrix(np.array(errors.mount))

    def capture(self, world: WorldCaster, state: np.ndarray, rng: Generator) -> Frame:
        """Frame from a body pose; ranges become depths by the rays that the user is told of."""
        pose = pose_matrix(state) @ self._mount
        hits = world.cast(pose[:3, 3], self._rays @ (pose[:3, :3] @ BODY_FROM_OPTICAL).T)
        ranges = hits.distance.astype(np.float64)  # the rays have length one
        reflectivity = np.where(hits.face >= 0, world.reflectivity[hits.face], 0.0)
        phasors = self._phasors(ranges, reflectivity * hits.cosine)
        measured, amplitude = self._measure(phasors, rng)
        unit_forward = 1.0 / np.linalg.norm(self.camera.rays(), axis=-1)
        return Frame(
            depth=(measured * unit_forward).astype(np.float32),
            range=measured,
            amplitude=amplitude,
            nearest=ranges.min(axis=-1),
            farthest=np.where(np.isfinite(ranges), ranges, -np.inf).max(axis=-1),
        )

    def _phasors(self, ranges: np.ndarray, albedo: np.ndarray) -> np.ndarray:
        """Sum over the sub-rays `(H, W, k)`, each with a k-th of the pixel; amplitude 1 is white, square, at 2 m."""
        finite = np.isfinite(ranges)
        r = np.where(finite, ranges, 1.0)
        # A lamp next to the lens lights a very near surface less than 1 / r^2 would say; also no division by zero.
        amplitude = np.where(finite, albedo * 4.0 / np.maximum(r, 0.05) ** 2, 0.0)
        phase = 4 * np.pi * self.model.frequency / SPEED_OF_LIGHT * r
        phasors = (amplitude * np.exp(1j * phase)).mean(axis=-1)
        width, share = self.model.scatter_width, self.model.scattered_share
        scattered = gaussian_filter(phasors.real, width) + 1j * gaussian_filter(phasors.imag, width)
        return (1 - share) * phasors + share * scattered

    def _measure(self, phasors: np.ndarray, rng: Generator) -> tuple[np.ndarray, np.ndarray]:
        """Ranges `(H, W)` in metres, nan = no return, and amplitudes, from phasors without noise."""
        m = self.model
        sigma = np.sqrt(m.shot_noise**2 * np.abs(phasors) + m.dark_noise**2)
        noisy = phasors + sigma * (rng.normal(size=phasors.shape) + 1j * rng.normal(size=phasors.shape))
        amplitude = np.abs(noisy)
        share = (np.angle(noisy) / (2 * np.pi)) % 1.0
        error = m.offset + m.wiggling * np.sin(2 * np.pi * m.wiggling_order * share) + self.pattern
        ranges = (share * m.unambiguous_range + error) % m.unambiguous_range
        lost = (amplitude < m.least_amplitude) | (amplitude > m.greatest_amplitude)
        return np.where(lost, np.nan, ranges), amplitude


def _sub_pixel_rays(camera: DepthCamera, n: int, errors: CalibrationErrors) -> np.ndarray:
    """Unit directions `(H, W, n * n, 3)` through the middles of n x n parts of every pixel, optical frame."""
    fine = camera.resized(camera.width * n, camera.height * n).rays()
    fine[..., :2] *= (1 + errors.radial * (fine[..., :2] ** 2).sum(axis=-1, keepdims=True)) / (1 + errors.focal_length)
    fine = fine / np.linalg.norm(fine, axis=-1, keepdims=True)
    blocks = fine.reshape(camera.height, n, camera.width, n, 3).swapaxes(1, 2)
    return np.ascontiguousarray(blocks.reshape(camera.height, camera.width, n * n, 3), dtype=np.float32)


def frame_counts(frame: Frame, model: TimeOfFlightModel) -> dict[str, int]:
    """Counts of pixels of one frame. Flying: between two surfaces, 5 cm and three times the noise off both."""
    measured = np.isfinite(frame.depth)
    limit = model.unambiguous_range
    beyond = (frame.nearest > limit) & np.isfinite(frame.nearest)
    amplitude = np.maximum(frame.amplitude, 1e-9)
    noise_phase = np.sqrt(model.shot_noise**2 * amplitude + model.dark_noise**2) / amplitude
    margin = np.maximum(0.05, 3 * noise_phase * limit / (2 * np.pi))
    edge = measured & (frame.farthest - frame.nearest > 0.1) & (frame.farthest < limit)
    between = (frame.range > frame.nearest + margin) & (frame.range < frame.farthest - margin)
    return {
        "pixels": frame.depth.size,
        "no_return": int((~measured).sum()),
        "nothing_there": int(np.isinf(frame.nearest).sum()),
        "saturated": int((frame.amplitude > model.greatest_amplitude).sum()),
        "beyond_range": int(beyond.sum()),
        "wrapped": int((beyond & measured).sum()),
        "flying": int((edge & between).sum()),
    }
