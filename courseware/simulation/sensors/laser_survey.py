"""A terrestrial laser survey: stations, scans with their errors, and how well the stations are registered."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.random import Generator
from scipy.spatial import cKDTree

from course_lib.geometry import pose_matrix
from course_lib.spherical_stereo.panorama import direction_from_angles
from courseware.simulation.sensors.ray_casting import WorldCaster

# Where the scanner stands on the survey day: x, y in metres. Chosen: every 4 to 7 m, one in the side corridor's mouth.
STATIONS = ((2.2, -0.3), (8.3, 0.3), (13.3, -0.4), (17.7, 0.5), (23.3, -0.3), (29.4, 0.4), (36.3, -0.2))

_DENSE_RANGE = 3.5  # m: within it a scan's points lie about a centimetre apart, so spacing does not hide the offset


@dataclass(frozen=True)
class ScannerModel:
    """A phase-based terrestrial scanner.

    Orders of magnitude after the data sheet of the FARO Focus3D (about 2 mm ranging error, sub-millimetre noise at
    10 m on bright surfaces, 3 mm beam at exit, 0.19 mrad divergence, 0.6 m least range); the rest is chosen.
    """

    height: float = 1.6  # m above the floor; chosen
    step_deg: float = 0.15  # degrees in azimuth and elevation; chosen (a quick indoor scan)
    lowest_deg: float = -60.0  # degrees; the tripod hides what is below; after the data sheet
    noise_constant: float = 0.0012  # m, one sigma on a bright surface; chosen
    noise_per_metre: float = 0.0002  # m per m of range, one sigma; chosen
    beam_at_exit: float = 0.003  # m, diameter; data sheet
    divergence: float = 0.00019  # rad, full angle; data sheet
    least_range: float = 0.6  # m; data sheet
    greatest_range: float = 30.0  # m; chosen: the corridor is no longer
    grazing_deg: float = 82.0  # degrees of incidence beyond which nothing comes back; chosen
    least_signal: float = 0.02  # no unit: below this reflectivity * cos(incidence) * (10 m / range)^2 no return; chosen
    registration_position: float = 0.006  # m, one sigma per axis and station; chosen for the paper's 10 mm
    registration_tilt_deg: float = 0.01  # degrees, one sigma about the horizontal axes (levelled instrument); chosen
    registration_heading_deg: float = 0.03  # degrees, one sigma about the vertical; chosen


@dataclass(frozen=True)
class RegisteredScan:
    """One station as the surveyor knows it, and all that a map may be made from."""

    ranges: np.ndarray  # `(E, A)` metres, nan = nothing came back
    elevations: np.ndarray  # `(E,)` radians
    azimuths: np.ndarray  # `(A,)` radians
    registered_pose: np.ndarray  # `(4, 4)` scanner-to-world, where registration believes that the scanner stood

    def points(self, pose: np.ndarray | None = None) -> np.ndarray:
        """Measured points `(n, 3)` in the world, by the registered pose if no other is given."""
        pose, measured = self.registered_pose if pose is None else pose, np.isfinite(self.ranges)
        directions = direction_from_angles(self.azimuths, self.elevations[:, None])
        local = directions[measured] * self.ranges[measured][:, None]
        return local @ pose[:3, :3].T + pose[:3, 3]


@dataclass(frozen=True)
class Scan(RegisteredScan):
    """One station as the simulation knows it. true_pose `(4, 4)` scanner-to-world: where it really stood."""

    true_pose: np.ndarray

    def as_registered(self) -> RegisteredScan:
        """What leaves the simulation: the scan without its true pose."""
        return RegisteredScan(self.ranges, self.elevations, self.azimuths, self.registered_pose)


def survey(caster: WorldCaster, model: ScannerModel, rng: Generator, stations: tuple = STATIONS) -> list[Scan]:
    """Scans the world from every station (x, y in metres); each station gets its own registration error."""
    turns = np.deg2rad([model.registration_tilt_deg] * 2 + [model.registration_heading_deg])
    sigma = np.concatenate([np.full(3, model.registration_position), turns])
    scans = []
    for x, y in stations:
        heading = rng.uniform(-np.pi, np.pi)
        true_pose = pose_matrix(np.array([x, y, model.height, 0.0, 0.0, heading]))
        error = rng.normal(size=6) * sigma
        # The error turns the station about itself and moves it: it multiplies the pose's rotation, adds to its place.
        registered = pose_matrix(np.concatenate([np.zeros(3), error[3:]])) @ true_pose
        registered[:3, 3] = true_pose[:3, 3] + error[:3]
        scans.append(scan(caster, model, true_pose, registered, rng))
    return scans


def scan(
    caster: WorldCaster, model: ScannerModel, true_pose: np.ndarray, registered_pose: np.ndarray, rng: Generator
) -> Scan:
    """One station's scan, with noise, drop-outs and mixed pixels."""
    step = np.deg2rad(model.step_deg)
    elevations = np.arange(np.deg2rad(model.lowest_deg), np.pi / 2 - step, step)
    azimuths = np.arange(round(2 * np.pi / step)) * step - np.pi
    bands = np.array_split(elevations, max(1, len(elevations) // 200))
    directions = (direction_from_angles(azimuths, band[:, None]) for band in bands)
    ranges = np.concatenate([_ranges(caster, model, true_pose, each, rng) for each in directions])
    return Scan(ranges, elevations, azimuths, registered_pose, true_pose)


def _ranges(
    caster: WorldCaster, model: ScannerModel, pose: np.ndarray, directions: np.ndarray, rng: Generator
) -> np.ndarray:
    """Measured ranges `(E, A)` along directions `(E, A, 3)` in the scanner's frame."""
    directions = directions @ pose[:3, :3].T
    hits = caster.cast(pose[:3, 3], directions)
    ranges = hits.distance.astype(np.float64)
    shape = ranges.shape
    signal = np.where(hits.face >= 0, caster.reflectivity[hits.face], 0.0) * hits.cosine * (10.0 / ranges) ** 2
    footprint = 0.5 * (model.beam_at_exit / np.where(np.isfinite(ranges), ranges, 1.0) + model.divergence)
    offset = np.deg2rad(model.step_deg) / 50 + footprint
    angle = rng.uniform(0, 2 * np.pi, shape)
    beside = directions + (offset * np.cos(angle))[..., None] * _tangent(directions)
    beside += (offset * np.sin(angle))[..., None] * np.cross(directions, _tangent(directions))
    # Where a second ray within the beam's footprint meets another surface, the range is a weighted mean of both.
    other = caster.cast(pose[:3, 3], beside).distance
    share = rng.uniform(0.0, 0.5, shape)
    both = np.isfinite(other) & np.isfinite(ranges)
    edge = both & (np.abs(np.where(both, other, 0.0) - np.where(both, ranges, 0.0)) > 0.02)
    ranges = np.where(edge, (1 - share) * ranges + share * np.where(edge, other, 0.0), ranges)
    with np.errstate(invalid="ignore", divide="ignore"):
        sigma = (model.noise_constant + model.noise_per_metre * ranges) / np.sqrt(np.clip(signal, 0.05, 1.0))
        measured = ranges + np.where(np.isfinite(sigma), sigma, 0.0) * rng.normal(size=shape)
    lost = (hits.cosine < np.cos(np.deg2rad(model.grazing_deg))) | (signal < model.least_signal)
    lost |= ~np.isfinite(ranges) | (ranges < model.least_range) | (ranges > model.greatest_range)
    return np.where(lost, np.nan, measured).astype(np.float32)


def registration_error(scans: list[Scan], rng: Generator, n_points: int = 20_000) -> dict[str, float]:
    """Return how far apart neighbouring stations' points lie, m. Paper 1 gives this for its scan and its map."""
    # Spacing and noise are in it, so the same number with the true poses stands beside it.
    result = {}
    for key, name in (("mean_point_distance_m", "registered_pose"), ("mean_point_distance_true_poses_m", "true_pose")):
        means = []
        for first, second in pairwise(scans):
            source, target = (one.points(getattr(one, name)) for one in (first, second))
            near = target[np.linalg.norm(target - second.true_pose[:3, 3], axis=1) < _DENSE_RANGE]
            source = source[np.linalg.norm(source - second.true_pose[:3, 3], axis=1) < _DENSE_RANGE - 0.1]
            source = source[rng.choice(len(source), min(n_points, len(source)), replace=False)]
            distance = cKDTree(near).query(source, distance_upper_bound=0.05)[0]
            means.append(distance[np.isfinite(distance)].mean())
        result[key] = float(np.mean(means))
    offsets = [s.registered_pose[:3, 3] - s.true_pose[:3, 3] for s in scans]
    result["rms_station_position_error_m"] = float(np.sqrt(np.mean(np.sum(np.square(offsets), axis=1))))
    return result


def _tangent(directions: np.ndarray) -> np.ndarray:
    """A unit vector across each direction, horizontal."""
    across = np.stack([-directions[..., 1], directions[..., 0], np.zeros(directions.shape[:-1])], axis=-1)
    return across / np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-9)
