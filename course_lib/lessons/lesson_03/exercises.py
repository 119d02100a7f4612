"""Exercises of lesson 03: the depth buffer's scale, depth along an edge, and what a pixel keeps."""

from __future__ import annotations

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 03.1: from the value in the depth buffer to metres


def linearize(b: np.ndarray, near: float, far: float) -> np.ndarray:
    """Depth in metres of depth-buffer values in [0, 1]; inf where the buffer was never written (b = 1)."""
    depth = near * far / (far - b * (far - near))
    return np.where(b < 1, depth, np.inf)


def _buffers(rng: np.random.Generator) -> tuple:
    near, far = rng.uniform(0.05, 1.0), rng.uniform(5.0, 40.0)
    b = rng.uniform(0.0, 0.99, size=(rng.integers(3, 6), rng.integers(3, 6)))
    # The near plane, never drawn, and two far surfaces that a careless comparison takes for never drawn.
    b.flat[rng.choice(b.size, size=4, replace=False)] = 0.0, 1.0, 0.995, 0.999999
    return b, near, far


def _taken_as_linear(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(b < 1, near + b * (far - near), np.inf)


def _planes_swapped(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(b < 1, near * far / (near + b * (far - near)), np.inf)


def _for_minus_one_to_one(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(b < 1, 2 * near * far / (far + near - b * (far - near)), np.inf)


def _without_planes_product(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(b < 1, 1 / (far - b * (far - near)), np.inf)


def _plus_for_minus(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(b < 1, near * far / (far + b * (far - near)), np.inf)


def _without_brackets(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(b < 1, near * far / (far - b * far - near), np.inf)


def _near_forgotten(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(b < 1, far / (far - b * (far - near)), np.inf)


def _in_millimetres(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return 1000 * linearize(b, near, far)


def _close_to_one(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(np.isclose(b, 1), np.inf, linearize(b, near, far))


# 03.2: depth between two corners, as the screen sees it


def depth_on_edge(z_start: float, z_end: float, s: np.ndarray) -> np.ndarray:
    """Depth in metres at the share s (0 to 1) of an edge's length on the screen: 1/Z is linear there."""
    return 1 / ((1 - s) / z_start + s / z_end)


def _edges(rng: np.random.Generator) -> tuple:
    z_start, z_end = rng.permutation([rng.uniform(0.5, 3.0), rng.uniform(4.0, 20.0)])
    return z_start, z_end, np.concatenate([[0.0, 1.0], rng.uniform(0.05, 0.95, size=rng.integers(3, 9))])


def _ends_sorted(z_start: float, z_end: float, s: np.ndarray) -> np.ndarray:
    return depth_on_edge(min(z_start, z_end), max(z_start, z_end), s)


# 03.3: what one pixel keeps of several surfaces


def nearest_surface(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    """Depth image (H, W) of surfaces (K, H, W): the least depth between near and far, inf where there is none."""
    seen = (layers >= near) & (layers <= far)
    return np.where(seen, layers, np.inf).min(axis=0)


def _layers(rng: np.random.Generator) -> tuple:
    near, far = rng.uniform(0.5, 1.0), rng.uniform(8.0, 12.0)
    layers = rng.uniform(0.1, 15.0, size=(rng.integers(2, 6), rng.integers(4, 8), rng.integers(4, 8)))
    layers[rng.random(layers.shape) < 0.35] = np.inf
    return layers, near, far


def _last_drawn(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    image = np.full(layers.shape[1:], np.inf)
    for layer in layers:
        seen = (layer >= near) & (layer <= far)
        image[seen] = layer[seen]
    return image


def _farthest(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    seen = (layers >= near) & (layers <= far)
    image = np.where(seen, layers, -np.inf).max(axis=0)
    return np.where(np.isfinite(image), image, np.inf)


def _minimum_before_planes(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    image = layers.min(axis=0)
    return np.where((image >= near) & (image <= far), image, np.inf)


def _pulled_to_planes(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.clip(layers, near, far).min(axis=0)


def _first_layer(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    return nearest_surface(layers[:1], near, far)


def _near_alone(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    return nearest_surface(layers, near, np.inf)


def _far_alone(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    return nearest_surface(layers, 0.0, far)


def _far_for_nothing(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.minimum(nearest_surface(layers, near, far), far)


def _zero_for_nothing(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    image = nearest_surface(layers, near, far)
    return np.where(np.isfinite(image), image, 0.0)


EXERCISES = [
    Exercise(
        number="03.1",
        reference=linearize,
        inputs=_buffers,
        mistakes=(
            Mistake(
                _taken_as_linear,
                "You spread b evenly between near and far, but b is not linear in Z: solve the equation of b for Z.",
            ),
            Mistake(_planes_swapped, "At b = 0 your depth is far; it must be near. Have near and far changed places?"),
            Mistake(
                lambda b, near, far: near * far / (far - b * (far - near)),
                "Right, except where b = 1: nothing was ever drawn there, so the depth is inf, not far.",
            ),
            Mistake(
                _for_minus_one_to_one,
                "That formula is for buffer values from -1 to 1; here b runs from 0 (near) to 1 (far).",
            ),
            Mistake(
                _without_planes_product,
                "Check the units: your result is 1 / metres. What stands above the fraction line, in square metres?",
            ),
            Mistake(
                _plus_for_minus,
                "Your depth shrinks as b grows; it must grow. Look at the sign below the fraction line.",
            ),
            Mistake(
                _without_brackets,
                "Mind the brackets: b multiplies the whole of far - near.",
            ),
            Mistake(
                _near_forgotten,
                "At b = 0 your depth is always 1; it must be near. What is missing above the fraction line?",
            ),
            Mistake(_in_millimetres, "Yours is 1000 times too large: millimetres? The task asks for metres."),
            Mistake(
                _close_to_one,
                "A b just below 1 is a far surface, and yours makes it inf. Only b = 1 itself was never drawn.",
            ),
        ),
    ),
    Exercise(
        number="03.2",
        reference=depth_on_edge,
        inputs=_edges,
        mistakes=(
            Mistake(
                lambda z_start, z_end, s: (1 - s) * z_start + s * z_end,
                "You mix Z itself. On the screen it is 1/Z that changes evenly: mix 1/Z, then turn it over.",
            ),
            Mistake(
                lambda z_start, z_end, s: (1 - s) / z_start + s / z_end,
                "Almost: this is 1/Z, in 1 / metres. Turn it over at the end.",
            ),
            Mistake(
                lambda z_start, z_end, s: 1 / (s / z_start + (1 - s) / z_end),
                "The ends have changed places: s = 0 is the start and must give z_start.",
            ),
            Mistake(
                lambda z_start, z_end, s: z_start ** (1 - s) * z_end**s,
                "You mix the logarithms of Z. It is 1/Z that changes evenly on the screen.",
            ),
            Mistake(
                _ends_sorted,
                "You walk from the nearer end. s counts from z_start, even where that is the farther one.",
            ),
            Mistake(
                lambda z_start, z_end, s: 1 / (1 / z_start + s / z_end),
                "At s = 1 only z_end may be left: by how much must the share of z_start shrink?",
            ),
        ),
    ),
    Exercise(
        number="03.3",
        reference=nearest_surface,
        inputs=_layers,
        mistakes=(
            Mistake(
                _last_drawn,
                "The layer that is drawn last wins in yours, whatever its depth. Compare with what is there already.",
            ),
            Mistake(_farthest, "Your pixels keep the farthest surface; the camera sees the nearest."),
            Mistake(
                _minimum_before_planes,
                "A surface before the near plane hides what is behind it in yours. Drop it first, then take the least.",
            ),
            Mistake(
                _pulled_to_planes,
                "A surface outside near and far is not moved onto a plane (np.clip does that): it is not seen at all.",
            ),
            Mistake(
                lambda layers, near, far: layers.min(axis=0),
                "You have not used near and far: what lies outside them is not seen.",
            ),
            Mistake(_first_layer, "Yours looks at the first layer alone: compare all K of them, pixel by pixel."),
            Mistake(_near_alone, "You have used near but not far: what lies behind the far plane is not seen either."),
            Mistake(_far_alone, "You have used far but not near: what lies before the near plane is not seen either."),
            Mistake(
                _far_for_nothing, "Where nothing is seen yours reads far, as if a wall stood there: it must be inf."
            ),
            Mistake(_zero_for_nothing, "Where nothing is seen yours reads 0 m, right at the lens: it must be inf."),
        ),
    ),
]
