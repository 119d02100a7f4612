"""The semantic map of a room as a surveyor makes it: another day, under warmer light, with a measuring error."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from course_lib.geometry import circular_mean
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from courseware.simulation.room.scene import Lamp, Room, free_places
from courseware.simulation.sensors.panorama_renderer import PanoramaRenderer
from courseware.simulation.sensors.panorama_rig import PanoramaCameraModel, photograph


@dataclass(frozen=True)
class RoomSurveyModel:
    """How the semantic map is surveyed."""

    position_error: float = 0.01  # m, standard deviation of each coordinate of a centroid; chosen: a tape measure
    places: int = 6  # places from which the colours are photographed; chosen
    camera_height: float = 1.5  # m above the floor; chosen
    lamp_colour: tuple[float, float, float] = (1.0, 0.94, 0.84)  # RGB, warmer than the room's own lamps; chosen
    lamp_gain: float = 1.15  # strength of the lamps against the room's own; chosen
    width: int = 1280  # pixels of the survey's panoramas; chosen
    fewest_pixels: int = 150  # an object seen by fewer pixels is not judged from that place; chosen


class UnseenObject(ValueError):
    """An object that is seen from none of the survey's places."""


def survey_room(room: Room, model: RoomSurveyModel, rng: Generator) -> SemanticMap:
    """The semantic map of a room, its colours the means over what several places see. Raises `UnseenObject`."""
    colour = np.asarray(model.lamp_colour)
    lamps = tuple(Lamp(one.position, tuple(colour * one.colour), one.strength * model.lamp_gain) for one in room.lamps)
    colours: list[list] = [[] for _ in room.objects]  # of each object, its (hue, saturation) from each place
    lit = replace(room, lamps=lamps, ambient=tuple(colour * room.ambient))
    with PanoramaRenderer(lit, model.width, number_scale=1) as renderer:
        for x, y in free_places(room, model.places, rng):
            state = np.array([x, y, model.camera_height, 0.0, 0.0, rng.uniform(-np.pi, np.pi)])
            image = photograph(renderer.render(state), PanoramaCameraModel(), rng)
            numbers = renderer.render_objects(state)
            for number, seen in enumerate(colours):
                mask = numbers == number
                if mask.sum() >= model.fewest_pixels:
                    seen.append(mean_hue_saturation(image, mask=mask))
    landmarks = []
    for number, thing in enumerate(room.objects):
        if not colours[number]:
            raise UnseenObject(f"object {number} ({thing.label}) is seen from none of the {model.places} places")
        hue, saturation = _mean_colour(colours[number])
        x, y = np.array([thing.x, thing.y]) + model.position_error * rng.standard_normal(2)
        landmarks.append(Landmark(thing.label, round(float(x), 3), round(float(y), 3), hue, saturation))
    return SemanticMap(tuple(landmarks), walls=np.asarray(room.walls, float))


def _mean_colour(colours: list[tuple[float, float]]) -> tuple[float, float]:
    """The mean; an object that is grey from most places has no hue (nan)."""
    hues, saturations = np.array(colours).T
    saturation, coloured = round(float(saturations.mean()), 1), np.isfinite(hues)
    if coloured.sum() * 2 < len(hues):
        return float("nan"), saturation
    hue = np.rad2deg(circular_mean(np.deg2rad(hues[coloured]), saturations[coloured])) % 360.0
    return round(float(hue), 1) % 360.0, saturation
