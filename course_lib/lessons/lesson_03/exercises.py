"""Exercises of lesson 03: the depth buffer's scale, depth along an edge, what a pixel keeps, a triangle cut."""

from collections.abc import Callable

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 03.1: from the value in the depth buffer to metres


def linearize(b: np.ndarray, near: float, far: float) -> np.ndarray:
    """Depth in metres of depth-buffer values in [0, 1]; inf where the buffer was never written (b = 1)."""
    depth = near * far / (far - b * (far - near))
    return np.where(b < 1, depth, np.inf)


def _buffers(rng: np.random.Generator) -> tuple:
    # Binary fractions: where b is 1 the formula then gives far itself, so that one may ask for Z >= far as well.
    near, far = rng.integers(4, 64) / 64, rng.integers(20, 160) / 4
    b = rng.uniform(0.0, 0.99, size=(rng.integers(3, 6), rng.integers(3, 6)))
    # The near plane, never drawn, and two far surfaces that a careless comparison takes for never drawn.
    b.flat[rng.choice(b.size, size=4, replace=False)] = 0.0, 1.0, 0.995, 0.999999
    return b, near, far


def _nothing_drawn(rng: np.random.Generator) -> tuple:
    return np.ones((3, 4)), 0.125, 30.0


def _the_papers_planes(rng: np.random.Generator) -> tuple:
    """One row, from the lens to the SR4000's 10 m; every value was drawn."""
    return np.linspace(0.0, 0.9999, 9)[None], 0.125, 10.0


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


def _buffer_of_depth(b: np.ndarray, near: float, far: float) -> np.ndarray:
    with np.errstate(divide="ignore", invalid="ignore"):
        return far * (b - near) / (b * (far - near))


def _close_to_one(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(np.isclose(b, 1), np.inf, linearize(b, near, far))


def _nan_for_nothing_drawn(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(b < 1, linearize(b, near, far), np.nan)


def _zero_for_nothing_drawn(b: np.ndarray, near: float, far: float) -> np.ndarray:
    return np.where(b < 1, linearize(b, near, far), 0.0)


# 03.2: depth between two corners, as the screen sees it


def depth_on_edge(z_start: float, z_end: float, s: np.ndarray) -> np.ndarray:
    """Depth in metres at the share s (0 to 1) of an edge's length on the screen: 1/Z is linear there."""
    return 1 / ((1 - s) / z_start + s / z_end)


def _edges(rng: np.random.Generator) -> tuple:
    z_start, z_end = rng.permutation([rng.uniform(0.5, 3.0), rng.uniform(4.0, 20.0)])
    return z_start, z_end, np.concatenate([[0.0, 1.0], rng.uniform(0.05, 0.95, size=rng.integers(3, 9))])


def _level_edge(rng: np.random.Generator) -> tuple:
    """Both ends equally far away."""
    return 3.0, 3.0, np.linspace(0, 1, 5)


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


def _on_the_planes(rng: np.random.Generator) -> tuple:
    """Depths of exactly near and far, which are seen, and a pixel that nothing covers."""
    return np.array([[[0.5, 8.0, np.inf]], [[2.0, 9.0, np.inf]], [[0.4, np.inf, 0.1]]]), 0.5, 8.0


def _one_surface(rng: np.random.Generator) -> tuple:
    return (_layers(rng)[0][:1], 0.75, 10.0)


def _nan_for_nothing(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    image = nearest_surface(layers, near, far)
    return np.where(np.isfinite(image), image, np.nan)


def _planes_left_out(layers: np.ndarray, near: float, far: float) -> np.ndarray:
    seen = (layers > near) & (layers < far)
    return np.where(seen, layers, np.inf).min(axis=0)


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


# 03.4, the challenge: a triangle that reaches behind the near plane


def cut_at_near(corners: np.ndarray, near: float) -> np.ndarray:
    """Corners (n, 3) [m], n = 0, 3 or 4, in order round the edge, of the part of a triangle (3, 3) with Z >= near."""
    kept = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if a[2] >= near:
            kept.append(a)
        if (a[2] >= near) != (b[2] >= near):
            kept.append(a + (near - a[2]) / (b[2] - a[2]) * (b - a))
    return np.array(kept).reshape(-1, 3)


def _triangle(depths: np.ndarray, rng: np.random.Generator) -> tuple:
    corners = np.column_stack([rng.uniform(-2, 2, 3), rng.uniform(-2, 2, 3), depths])
    while np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])) < 0.5:
        corners[:, :2] = rng.uniform(-2, 2, (3, 2))
    return corners, 0.1


def _any_triangle(rng: np.random.Generator) -> tuple:
    """One, two or three corners before the near plane or none, some of them behind the camera."""
    before = rng.permutation(3) < rng.integers(0, 4)
    corners, _ = _triangle(np.where(before, rng.uniform(-3, 0.3, 3), rng.uniform(0.6, 6, 3)), rng)
    return corners, rng.uniform(0.35, 0.55)


def _one_before(rng: np.random.Generator) -> tuple:
    return _triangle(np.array([2.0, -1.0, 3.0]), rng)


def _two_before(rng: np.random.Generator) -> tuple:
    return _triangle(np.array([-0.5, 4.0, 0.05]), rng)


def _all_before(rng: np.random.Generator) -> tuple:
    return _triangle(np.array([-0.5, 0.05, -2.0]), rng)


def _none_before(rng: np.random.Generator) -> tuple:
    return _triangle(np.array([1.0, 2.5, 0.2]), rng)


def _a_corner_on_the_plane(rng: np.random.Generator) -> tuple:
    return _triangle(np.array([0.1, -1.0, 3.0]), rng)


def _distinct(corners: np.ndarray) -> np.ndarray:
    """The corners without those that repeat the one before; none where no area is left."""
    after = np.roll(corners, 1, axis=0)
    distinct = corners[np.linalg.norm(corners - after, axis=1) > 1e-6]
    return distinct if len(distinct) >= 3 else np.empty((0, 3))


def off_the_cut(arguments: tuple, answer: object) -> str | None:
    """What is wrong with a cut triangle, or None; the corners may begin anywhere and go round either way."""
    _, near = arguments
    right = _distinct(cut_at_near(*arguments))
    try:
        given = np.asarray(answer, dtype=np.float64)
    except (TypeError, ValueError):
        return "Give the corners as rows of three numbers: an array (n, 3)."
    if given.size == 0:
        given = np.empty((0, 3))
    if given.ndim != 2 or given.shape[1] != 3:
        return f"Give the corners as rows of three numbers, (n, 3); yours has the shape {given.shape}."
    if not np.isfinite(given).all():
        return "One of your corners is nan or inf: did you divide by a difference of depths that is zero?"
    given = _distinct(given)
    if len(given) and given[:, 2].min() < near - 1e-6:
        return "Some of your corners lie before the near plane: nothing of that part may be left."
    if len(given) != len(right):
        return f"One of your polygons has {len(given)} corners and should have {len(right)}: draw that case on paper."
    if len(given) == 0 or any(
        np.allclose(np.roll(turned, k, axis=0), right, atol=1e-6) for turned in (given, given[::-1]) for k in range(4)
    ):
        return None
    if all(np.linalg.norm(right - corner, axis=1).min() < 1e-6 for corner in given):
        return "The corners are right, but not in order round the edge: the polygon crosses itself."
    return "The number of corners is right, but not their places: where exactly does an edge meet the plane Z = near?"


def _dropped(corners: np.ndarray, near: float) -> np.ndarray:
    return corners[corners[:, 2] >= near]


def _whole_or_nothing(corners: np.ndarray, near: float) -> np.ndarray:
    return corners if (corners[:, 2] >= near).all() else np.empty((0, 3))


def _pulled_forward(corners: np.ndarray, near: float) -> np.ndarray:
    return np.column_stack([corners[:, :2], np.maximum(corners[:, 2], near)])


def _the_other_part(corners: np.ndarray, near: float) -> np.ndarray:
    return cut_at_near(corners * [1, 1, -1], -near) * [1, 1, -1]


def _cut_with(share) -> Callable:
    """A cut whose new corners lie at `share(a, b, near)` of the edge from a to b."""

    def cut(corners: np.ndarray, near: float) -> np.ndarray:
        kept = []
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            if a[2] >= near:
                kept.append(a)
            if (a[2] >= near) != (b[2] >= near):
                kept.append(a + share(a[2], b[2], near) * (b - a))
        return np.array(kept).reshape(-1, 3)

    return cut


def _new_corners_last(corners: np.ndarray, near: float) -> np.ndarray:
    new = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if (a[2] >= near) != (b[2] >= near):
            new.append(a + (near - a[2]) / (b[2] - a[2]) * (b - a))
    return np.concatenate([_dropped(corners, near), np.reshape(new, (-1, 3))])


EXERCISES = [
    Exercise(
        number="03.1",
        level="warm-up",
        solution=linearize,
        inputs=_buffers,
        cases=(_nothing_drawn, _the_papers_planes),
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
            Mistake(
                _nan_for_nothing_drawn,
                "Right, except where b = 1: yours is nan there. Nothing was drawn, so the depth is inf.",
            ),
            Mistake(
                _zero_for_nothing_drawn,
                "Right, except where b = 1: yours is 0 there, a surface at the lens. It must be inf.",
            ),
            Mistake(_in_millimetres, "Yours is 1000 times too large: millimetres? The task asks for metres."),
            Mistake(
                _close_to_one,
                "A b just below 1 is a far surface, and yours makes it inf. Only b = 1 itself was never drawn.",
            ),
            Mistake(
                _buffer_of_depth,
                "That is the equation for b itself, with b put in for Z. Solve it for Z: what is Z for a given b?",
            ),
            Mistake(
                lambda b, near, far: np.where(b < 1, near / np.where(b < 1, 1 - b, 1), np.inf),
                "near / (1 - b) holds for an infinite far plane. Here b = 1 would lie at far: keep far in.",
            ),
            Mistake(
                lambda b, near, far: linearize(b, 0.1, 30.0),
                "Right for near = 0.1 and far = 30 m alone: take the two that are given.",
            ),
        ),
    ),
    Exercise(
        number="03.2",
        solution=depth_on_edge,
        inputs=_edges,
        cases=(_level_edge,),
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
            Mistake(
                lambda z_start, z_end, s: 1 / ((1 - s) * z_start + s * z_end),
                "You mix first and turn over then. Turn each depth over first: it is 1/Z that is mixed.",
            ),
            Mistake(
                lambda z_start, z_end, s: 0 * s + 2 / (1 / z_start + 1 / z_end),
                "That is the depth half way, at s = 0.5, everywhere. Where is s?",
            ),
        ),
    ),
    Exercise(
        number="03.3",
        solution=nearest_surface,
        inputs=_layers,
        cases=(_on_the_planes, _one_surface),
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
            Mistake(
                _nan_for_nothing,
                "Right where something is seen. Where nothing is, yours reads nan: it must be inf.",
            ),
            Mistake(
                _planes_left_out,
                "Close: a surface exactly on the near or the far plane is still seen.",
            ),
            Mistake(_zero_for_nothing, "Where nothing is seen yours reads 0 m, right at the lens: it must be inf."),
            Mistake(
                lambda layers, near, far: np.where((layers > near) & (layers <= far), layers, np.inf).min(axis=0),
                "Close: a surface exactly on the near plane is still seen.",
            ),
            Mistake(
                lambda layers, near, far: np.where((layers >= near) & (layers < far), layers, np.inf).min(axis=0),
                "Close: a surface exactly on the far plane is still seen.",
            ),
        ),
    ),
    Exercise(
        number="03.4",
        level="challenge",
        solution=cut_at_near,
        inputs=_any_triangle,
        cases=(_one_before, _two_before, _all_before, _none_before, _a_corner_on_the_plane),
        verify=off_the_cut,
        mistakes=(
            Mistake(
                _dropped,
                "You drop the corners before the plane and cut no edge: where one crosses the plane a corner is new.",
            ),
            Mistake(
                _whole_or_nothing,
                "You throw the whole triangle away that reaches before the plane: then the floor at your feet is gone.",
            ),
            Mistake(
                _pulled_forward,
                "You push corners onto the plane. That bends the triangle: it must keep lying in its own plane.",
            ),
            Mistake(
                lambda corners, near: corners,
                "You cut nothing. Which part of the triangle lies before the near plane?",
            ),
            Mistake(
                _the_other_part,
                "You keep the part that is cut away: what is seen has Z of at least near.",
            ),
            Mistake(
                _cut_with(lambda a, b, near: 0.5),
                "You halve every edge that is cut. It meets the plane where its Z is near, rarely at the middle.",
            ),
            Mistake(
                _cut_with(lambda a, b, near: 1 - (near - a) / (b - a)),
                "You measure the share of an edge from the wrong end.",
            ),
            Mistake(
                _cut_with(lambda a, b, near: -a / (b - a)),
                "You cut where Z is 0, at the lens itself. The near plane lies a little before it.",
            ),
            Mistake(
                _new_corners_last,
                "The corners are right. Put each new one where its edge is, or the polygon crosses itself.",
            ),
            Mistake(
                _cut_with(lambda a, b, near: (1 / near - 1 / a) / (1 / b - 1 / a)),
                "1/Z changes evenly on the *screen*. Along an edge in space Z itself does: take the share from Z.",
            ),
        ),
    ),
]
