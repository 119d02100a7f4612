"""Exercises of lesson 20: raw depth to metres, K of a smaller image, a baseline measured, a baseline chosen."""

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 20.1: a raw depth image in metres


def to_metres(raw: np.ndarray, units_per_metre: float, invalid: int) -> np.ndarray:
    """Depth `(H, W)` in metres of raw 16-bit numbers; NaN where a pixel holds `invalid`."""
    return np.where(raw == invalid, np.nan, raw / units_per_metre)


def _raw_images(rng: np.random.Generator) -> tuple:
    invalid = int(rng.choice([0, 65535]))
    raw = rng.integers(400, 60_000, size=(3, int(rng.integers(4, 7)))).astype(np.uint16)
    holes = rng.choice(raw.size, size=3, replace=False)
    raw.flat[holes[:2]] = invalid
    # The other number that marks no measurement elsewhere: here it is a depth like any other.
    raw.flat[holes[2]] = 65535 - invalid
    return raw, float(rng.choice([1000, 5000, 4000])), invalid


def _nothing_measured(rng: np.random.Generator) -> tuple:
    return np.zeros((2, 3), dtype=np.uint16), 1000.0, 0


def _all_measured(rng: np.random.Generator) -> tuple:
    return rng.integers(1, 60_000, size=(2, 4)).astype(np.uint16), 5000.0, 0


def _filled(raw: np.ndarray, metres: np.ndarray, invalid: int, value: float) -> np.ndarray:
    return np.where(raw == invalid, value, metres)


def _in_half_precision(raw: np.ndarray, units_per_metre: float, invalid: int) -> np.ndarray:
    return to_metres(raw, units_per_metre, invalid).astype(np.float16).astype(np.float64)


# 20.2: the intrinsics of a resized image


def resized_intrinsics(k: np.ndarray, scale: float) -> np.ndarray:
    """K `(3, 3)` of the same camera after its image was resized by `scale`; pixel centres at integers."""
    fx, fy, cx, cy = k[0, 0], k[1, 1], k[0, 2], k[1, 2]
    return np.array([[scale * fx, 0, scale * (cx + 0.5) - 0.5], [0, scale * fy, scale * (cy + 0.5) - 0.5], [0, 0, 1]])


def _intrinsics(rng: np.random.Generator) -> tuple:
    fx, cx, cy = rng.uniform(400, 700), rng.uniform(300, 340), rng.uniform(220, 260)
    k = np.array([[fx, 0, cx], [0, fx * rng.uniform(0.9, 1.1), cy], [0, 0, 1.0]])
    return k, float(rng.choice([0.25, 0.5, 0.125, 2.0]))


def _unchanged(rng: np.random.Generator) -> tuple:
    return _intrinsics(rng)[0], 1.0


def _the_papers_camera(rng: np.random.Generator) -> tuple:
    """The SR4000 of paper 1 as the course simulates it, at a quarter of its width."""
    return np.array([[217.0, 0, 87.5], [0, 217.0, 71.5], [0, 0, 1]]), 0.25


def _columns_only(k: np.ndarray, scale: float) -> np.ndarray:
    return np.vstack([resized_intrinsics(k, scale)[:1], k[1:]])


def _half_a_pixel_on_the_focal_length(k: np.ndarray, scale: float) -> np.ndarray:
    resized = resized_intrinsics(k, scale)
    resized[[0, 1], [0, 1]] = scale * (k[[0, 1], [0, 1]] + 0.5) - 0.5
    return resized


def _with(k: np.ndarray, focal: float, centre) -> np.ndarray:
    return np.array([[focal * k[0, 0], 0, centre(k[0, 2])], [0, focal * k[1, 1], centre(k[1, 2])], [0, 0, 1]])


def _centre_only(k: np.ndarray, scale: float) -> np.ndarray:
    return _with(k, 1.0, lambda c: scale * (c + 0.5) - 0.5)


def _one_focal_length(k: np.ndarray, scale: float) -> np.ndarray:
    square = k.copy()
    square[1, 1] = k[0, 0]
    return resized_intrinsics(square, scale)


def _one_centre(k: np.ndarray, scale: float) -> np.ndarray:
    resized = resized_intrinsics(k, scale)
    resized[1, 2] = resized[0, 2]
    return resized


# 20.3: the baseline from marks at known distances


def baseline_from_marks(v_upper: np.ndarray, v_lower: np.ndarray, height: int, distance: np.ndarray) -> float:
    """Median over marks of rho (tan e_lower - tan e_upper), metres; rows `(n,)` on panoramas of `height` rows."""
    e_upper, e_lower = (np.pi * (0.5 - np.asarray(v) / height) for v in (v_upper, v_lower))
    return float(np.median(distance * (np.tan(e_lower) - np.tan(e_upper))))


def _marks(rng: np.random.Generator) -> tuple:
    height, baseline, n = int(rng.choice([512, 640, 1024])), rng.uniform(0.15, 0.5), 7
    distance = rng.uniform(0.8, 3.0, size=n)
    drop = rng.uniform(-0.3, 0.8, size=n)  # metres from the upper camera down to the mark
    v_upper = height * (0.5 + np.arctan(drop / distance) / np.pi)
    v_lower = height * (0.5 + np.arctan((drop - baseline) / distance) / np.pi) + rng.normal(0, 0.4, size=n)
    v_lower[0] += 25.0  # a row that was misread: the mean would follow it, and the middle one does not
    return v_upper, v_lower, height, distance


def _exchanged(rng: np.random.Generator) -> tuple:
    """The two panoramas exchanged: the baseline is negative, and says so."""
    v_upper, v_lower, height, distance = _marks(rng)
    return v_lower, v_upper, height, distance


def _even_number_of_marks(rng: np.random.Generator) -> tuple:
    """Four marks that disagree: the median lies between the middle two."""
    v_upper, v_lower, height, distance = _marks(rng)
    return v_upper[:4], v_lower[:4] - [0.0, 6.0, 14.0, 25.0], height, distance[:4]


def _signs_that_differ(rng: np.random.Generator) -> tuple:
    """Two of five marks were misread so far that they give a negative baseline."""
    v_upper, v_lower, height, distance = _marks(rng)
    return v_upper[2:], v_lower[2:] + np.array([200.0, 200.0, 0.0, 0.0, 0.0]), height, distance[2:]


def _one_mark(rng: np.random.Generator) -> tuple:
    return tuple(v[3:4] if isinstance(v, np.ndarray) else v for v in _marks(rng))


def _middle(values: np.ndarray, position: int) -> float:
    return float(np.sort(values)[position])


def _elevations(v_upper: np.ndarray, v_lower: np.ndarray, height: int, span: float = np.pi) -> tuple:
    return span * (0.5 - v_upper / height), span * (0.5 - v_lower / height)


def _of_angles(v_upper: np.ndarray, v_lower: np.ndarray, height: int, distance: np.ndarray) -> float:
    e_upper, e_lower = _elevations(v_upper, v_lower, height)
    return float(np.median(distance * (e_lower - e_upper)))


def _tangent_of_difference(v_upper: np.ndarray, v_lower: np.ndarray, height: int, distance: np.ndarray) -> float:
    e_upper, e_lower = _elevations(v_upper, v_lower, height)
    return float(np.median(distance * np.tan(e_lower - e_upper)))


def _mean(v_upper: np.ndarray, v_lower: np.ndarray, height: int, distance: np.ndarray) -> float:
    e_upper, e_lower = _elevations(v_upper, v_lower, height)
    return float(np.mean(distance * (np.tan(e_lower) - np.tan(e_upper))))


def _all_marks(v_upper: np.ndarray, v_lower: np.ndarray, height: int, distance: np.ndarray) -> np.ndarray:
    e_upper, e_lower = _elevations(v_upper, v_lower, height)
    return distance * (np.tan(e_lower) - np.tan(e_upper))


def _full_turn(v_upper: np.ndarray, v_lower: np.ndarray, height: int, distance: np.ndarray) -> float:
    e_upper, e_lower = _elevations(v_upper, v_lower, height, 2 * np.pi)
    return float(np.median(distance * (np.tan(e_lower) - np.tan(e_upper))))


def _of_sines(v_upper: np.ndarray, v_lower: np.ndarray, height: int, distance: np.ndarray) -> float:
    e_upper, e_lower = _elevations(v_upper, v_lower, height)
    return float(np.median(distance * (np.sin(e_lower) - np.sin(e_upper))))


def _in_degrees(v_upper: np.ndarray, v_lower: np.ndarray, height: int, distance: np.ndarray) -> float:
    e_upper, e_lower = _elevations(v_upper, v_lower, height, 180.0)
    return float(np.median(distance * (np.tan(e_lower) - np.tan(e_upper))))


def _from_the_top(v_upper: np.ndarray, v_lower: np.ndarray, height: int, distance: np.ndarray) -> float:
    return float(np.median(distance * (np.tan(np.pi * v_lower / height) - np.tan(np.pi * v_upper / height))))


def _positive_only(u: np.ndarray, v: np.ndarray, height: int, distance: np.ndarray) -> float:
    found = _all_marks(u, v, height, distance)
    return float(np.median(found[found > 0])) if (found > 0).any() else float("nan")


# 20.4: how far apart must the cameras stand?


def baseline_needed(distance: float, row_error: float, height: int, limit: float) -> float:
    """Least baseline [m] at which a distance's error (one sigma) is at most `limit` [m]; NaN where there is none.

    With the mark at half the rig's height, tan e = +-B / (2 rho), and rows that are wrong by `row_error` (one sigma,
    each on its own) of `height`: sigma_rho = sqrt(2) sigma_e (rho^2 / B + B / 4), sigma_e = pi row_error / height.
    """
    reach = _reach(row_error, height, limit)
    return float(2 * (reach - np.sqrt(reach**2 - distance**2))) if reach >= distance else float("nan")


def _reach(row_error: float, height: int, limit: float, span: float = np.pi, factor: float = np.sqrt(2)) -> float:
    """limit / (factor sigma_e) [m]: the farthest distance that any baseline measures well enough."""
    return limit / (factor * span * row_error / height)


def _solved(distance: float, reach: float, larger: bool = False) -> float:
    if reach < distance:
        return float("nan")
    return float(2 * (reach + (1 if larger else -1) * np.sqrt(reach**2 - distance**2)))


def _small_angles(distance: float, row_error: float, height: int, limit: float) -> float:
    return distance**2 / _reach(row_error, height, limit)


def _one_cosine(distance: float, row_error: float, height: int, limit: float) -> float:
    rest = _reach(row_error, height, limit) ** 2 - distance**2 / 4
    return float(distance**2 / np.sqrt(rest)) if rest > 0 else float("nan")


def _rig_and_limit(rng: np.random.Generator) -> tuple:
    """From a far mark and a small angle to a near one and a large angle; sometimes no baseline is good enough."""
    distance, height, row_error = rng.uniform(1, 6), int(rng.choice([512, 640, 960, 1024])), rng.uniform(0.2, 1.5)
    reach = distance * rng.uniform(0.9, 8)
    return float(distance), float(row_error), height, float(reach * np.sqrt(2) * np.pi * row_error / height)


def _of_the_task(rng: np.random.Generator) -> tuple:
    return 4.0, 0.5, 960, 0.10


def _none_is_enough(rng: np.random.Generator) -> tuple:
    return 8.0, 2.0, 512, 0.05


def _where_none(value: float):
    """A mistake: `value` where no baseline is good enough."""

    def mistaken(distance, row_error, height, limit):
        found = baseline_needed(distance, row_error, height, limit)
        return found if np.isfinite(found) else value

    return mistaken


def _root_of_absolute(distance: float, reach: float) -> float:
    return float(2 * (reach - np.sqrt(abs(reach**2 - distance**2))))


EXERCISES = [
    Exercise(
        number="20.1",
        solution=to_metres,
        inputs=_raw_images,
        level="warm-up",
        cases=(_nothing_measured, _all_measured),
        mistakes=(
            Mistake(
                lambda raw, units_per_metre, invalid: np.where(raw <= invalid, np.nan, raw / units_per_metre),
                "Only a pixel that is equal to `invalid` is a hole, not every one that is smaller.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: np.where(
                    (raw == 0) | (raw == invalid), np.nan, raw / units_per_metre
                ),
                "You leave out 0 as well. Where `invalid` is another number, 0 is a depth like any other.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: _in_half_precision(raw, units_per_metre, invalid),
                "float16 holds three digits only: at 10 m that is 8 mm. Use float32 or float64.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: np.where(raw == 65535, np.nan, raw / units_per_metre),
                "You take 65535 for no measurement in every file. This file may use another number: use `invalid`.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: np.round(to_metres(raw, units_per_metre, invalid), 3),
                "You round to millimetres. With 5000 units a metre the file knows a fifth of one: do not round.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: raw / units_per_metre,
                "Pixels without a measurement have become depths. They must be NaN: compare the raw numbers with "
                "`invalid`.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: np.where(raw == 0, np.nan, raw / units_per_metre),
                "You take 0 for no measurement in every file. This file may use another number: use `invalid`.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: np.where(
                    (raw == 0) | (raw == 65535), np.nan, raw / units_per_metre
                ),
                "You leave out 0 and 65535 both. Only `invalid` marks a hole; the other is a depth like any other.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: _filled(raw, raw / 1000, invalid, np.nan),
                "You always divide by 1000. The file says how many units make a metre: use `units_per_metre`.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: _filled(raw, raw * float(units_per_metre), invalid, np.nan),
                "You multiply. A wall at 2 m holds 2 times `units_per_metre`: divide to come back to 2.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: _filled(raw, raw // units_per_metre, invalid, np.nan),
                "Yours are whole metres: `//` throws the rest away. Use `/`.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: _filled(raw, raw / units_per_metre, invalid, 0.0),
                "A hole is 0 m in yours: a surface at the lens, which every particle would disagree with. Make it NaN.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: _filled(raw, raw / units_per_metre, invalid, np.inf),
                "A hole is infinite in yours. In this course inf is a simulated ray that hit nothing; no measurement "
                "is NaN.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: _filled(raw, 1000 * raw / units_per_metre, invalid, np.nan),
                "Yours is in millimetres. Metres are asked for.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: np.where(
                    raw / units_per_metre == invalid, np.nan, raw / units_per_metre
                ),
                "You compare metres with `invalid`. It is a raw number: compare before you divide.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: np.where(raw != invalid, np.nan, raw / units_per_metre),
                "The two are exchanged: yours is NaN where there is a measurement.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: np.where(raw >= invalid, np.nan, raw / units_per_metre),
                "Only a pixel that is equal to `invalid` is a hole, not every one that is larger.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: _filled(raw, raw / 5000, invalid, np.nan),
                "You always divide by 5000. The file says how many units make a metre: use `units_per_metre`.",
            ),
            Mistake(
                lambda raw, units_per_metre, invalid: _filled(raw, raw / units_per_metre, invalid, -1.0),
                "A hole is -1 m in yours. It must be NaN, which no later step can take for a depth.",
            ),
        ),
    ),
    Exercise(
        number="20.2",
        solution=resized_intrinsics,
        inputs=_intrinsics,
        cases=(_unchanged, _the_papers_camera),
        mistakes=(
            Mistake(
                lambda k, scale: np.floor(resized_intrinsics(k, scale)),
                "You cut off to whole pixels. A principal point may lie anywhere between them.",
            ),
            Mistake(
                lambda k, scale: resized_intrinsics(k, 0.25),
                "Your scale is always a quarter, as in the example: use the argument.",
            ),
            Mistake(
                _one_centre,
                "You take cx for cy as well. The image is not as high as it is wide.",
            ),
            Mistake(
                lambda k, scale: _with(k, scale, lambda c: scale * (c + 1) - 1),
                "The edge lies half a pixel before the first centre, at -0.5: yours is a whole pixel off.",
            ),
            Mistake(
                lambda k, scale: resized_intrinsics(k, scale) * [[1], [1], [0]],
                "The last row is missing: a pinhole's K ends in [0, 0, 1].",
            ),
            Mistake(
                _columns_only,
                "Your rows keep their size. The image shrinks in both directions: fy and cy, too.",
            ),
            Mistake(
                _half_a_pixel_on_the_focal_length,
                "The half pixel belongs to positions, cx and cy. A focal length is a length: it has no origin.",
            ),
            Mistake(
                lambda k, scale: np.round(resized_intrinsics(k, scale)),
                "You round to whole pixels. A principal point may lie anywhere between them.",
            ),
            Mistake(
                lambda k, scale: k * scale,
                "You multiply the whole matrix, and its last 1 with it. A pinhole's K ends in [0, 0, 1].",
            ),
            Mistake(
                lambda k, scale: _with(k, scale, lambda c: scale * c),
                "cx and cy are half a pixel off. The image's edge is at -0.5: measure from there, scale, come back.",
            ),
            Mistake(
                lambda k, scale: _with(k, scale, lambda c: scale * (c - 0.5) + 0.5),
                "Your half pixel has the wrong sign. The edge of the image lies at -0.5, so first add 0.5.",
            ),
            Mistake(
                lambda k, scale: _with(k, scale, lambda c: scale * (c + 0.5)),
                "You count from the image's edge and do not come back: subtract 0.5 at the end.",
            ),
            Mistake(
                _centre_only,
                "fx and fy are unchanged. They are in pixels too: with half the pixels they are half as long.",
            ),
            Mistake(
                lambda k, scale: _with(k, scale, lambda c: c),
                "cx and cy are unchanged: they would lie outside the middle of the new image.",
            ),
            Mistake(
                lambda k, scale: resized_intrinsics(k, 1 / scale),
                "You divide by the scale. An image of half the width (scale 0.5) has half the focal length.",
            ),
            Mistake(
                lambda k, scale: _with(k, scale, lambda c: scale * c - 0.5),
                "You come back from the edge, but never went there: add 0.5 before you scale.",
            ),
            Mistake(
                lambda k, scale: _with(k, scale, lambda c: scale * c + 0.5),
                "Add 0.5 before you scale, and subtract 0.5 after it.",
            ),
            Mistake(
                lambda k, scale: resized_intrinsics(k, scale).T,
                "Your matrix is transposed: cx and cy stand in the last column.",
            ),
            Mistake(
                _one_focal_length,
                "You take fx for fy as well. A camera's two focal lengths may differ.",
            ),
        ),
    ),
    Exercise(
        number="20.3",
        solution=baseline_from_marks,
        inputs=_marks,
        cases=(_exchanged, _even_number_of_marks, _signs_that_differ, _one_mark),
        mistakes=(
            Mistake(
                lambda u, v, height, distance: baseline_from_marks(u, v, height - 1, distance),
                "You divide by height - 1. The symbol table counts `height` rows from straight up to straight down.",
            ),
            Mistake(
                lambda u, v, height, distance: float(np.median(_all_marks(u, v, height, 1 / distance) ** -1)),
                "That is the formula of a *distance*, turned: B = rho (tan - tan), so multiply.",
            ),
            Mistake(
                lambda u, v, height, distance: baseline_from_marks(height - u, v, height, distance),
                "You add the two heights. Both see the same mark: the heights differ by the baseline, so subtract.",
            ),
            Mistake(
                lambda u, v, height, distance: float(np.max(_all_marks(u, v, height, distance))),
                "You take the largest. One mark may be misread: the task asks for the median.",
            ),
            Mistake(
                lambda u, v, height, distance: float(_all_marks(u, v, height, distance)[0]),
                "You use the first mark alone. It may be the misread one: the median of all.",
            ),
            Mistake(
                lambda u, v, height, distance: round(baseline_from_marks(u, v, height, distance), 2),
                "You round to centimetres, as the example is printed. Give the number as it comes out.",
            ),
            Mistake(
                _positive_only,
                "You leave out negative ones: of exchanged images nothing is left. Keep all marks, and the sign.",
            ),
            Mistake(
                lambda u, v, height, distance: abs(baseline_from_marks(u, v, height, distance)),
                "You drop the sign. A negative baseline says that the images are exchanged: leave it as it comes.",
            ),
            Mistake(
                lambda u, v, height, distance: float(np.median(np.abs(_all_marks(u, v, height, distance)))),
                "You drop the signs, mark by mark: images that were exchanged would then pass for good ones.",
            ),
            Mistake(
                lambda u, v, height, distance: _middle(_all_marks(u, v, height, distance), len(u) // 2),
                "For an even number of marks yours is the upper of the middle two; a median lies halfway between.",
            ),
            Mistake(
                lambda u, v, height, distance: _middle(_all_marks(u, v, height, distance), (len(u) - 1) // 2),
                "For an even number of marks yours is the lower of the middle two; a median lies halfway between.",
            ),
            Mistake(
                lambda u, v, height, distance: float(
                    np.median(distance) * np.median(np.tan(np.pi * (np.asarray(u) - v) / height))
                ),
                "The tangent of a difference is not the difference of the tangents; and go mark by mark, one median.",
            ),
            Mistake(
                lambda u, v, height, distance: -baseline_from_marks(u, v, height, distance),
                "Yours is negative. The lower camera sees a mark at the greater elevation: lower minus upper.",
            ),
            Mistake(
                _of_angles,
                "You subtract the angles themselves. Heights go with their tangents: rho tan(e).",
            ),
            Mistake(
                _tangent_of_difference,
                "You take the tangent of the difference. Take the difference of the two tangents.",
            ),
            Mistake(_of_sines, "sin(e) goes with the slanted distance. `distance` is horizontal: use tan(e)."),
            Mistake(_in_degrees, "np.tan wants radians: the rows span pi, not 180."),
            Mistake(
                _from_the_top,
                "Rows count from the top, elevations from the horizon, upwards: e = (1/2 - v / height) pi.",
            ),
            Mistake(_full_turn, "Rows run from straight up to straight down: that is pi radians, not 2 pi."),
            Mistake(_mean, "You take the mean. One misread row pulls it away; the task asks for the median."),
            Mistake(_all_marks, "Yours has one number for each mark. Return their median, one number."),
            Mistake(
                lambda u, v, height, distance: 1000 * baseline_from_marks(u, v, height, distance),
                "Yours is in millimetres; metres are asked for.",
            ),
            Mistake(
                lambda u, v, height, distance: baseline_from_marks(u, v, height, 1 / distance),
                "You divide by the distance. Seen under the same angle, a far mark is higher: multiply.",
            ),
            Mistake(
                lambda u, v, height, distance: float(
                    np.median(distance * np.tan(np.pi * (0.5 - v / height)))
                    - np.median(distance * np.tan(np.pi * (0.5 - u / height)))
                ),
                "You subtract two medians, which may be of different marks. Subtract mark by mark first.",
            ),
            Mistake(
                lambda u, v, height, distance: float(
                    np.median(distance) * np.median(_all_marks(u, v, height, np.ones(len(distance))))
                ),
                "Two medians may be of different marks. Compute the baseline from each mark, then take one median.",
            ),
            Mistake(
                lambda u, v, height, distance: baseline_from_marks(u, v, 512, distance),
                "Your panorama is always 512 rows high: use the argument.",
            ),
        ),
    ),
    Exercise(
        number="20.4",
        solution=baseline_needed,
        inputs=_rig_and_limit,
        level="challenge",
        cases=(_of_the_task, _none_is_enough),
        tolerance=1e-5,
        mistakes=(
            Mistake(
                _where_none(np.inf),
                "Where even the best baseline is not good enough the task asks for NaN, not for infinity.",
            ),
            Mistake(
                _where_none(0.0),
                "Where even the best baseline is not good enough the task asks for NaN, not for 0.",
            ),
            Mistake(
                _where_none(-1.0),
                "Where even the best baseline is not good enough the task asks for NaN, not for -1.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: _root_of_absolute(
                    distance, _reach(row_error, height, limit)
                ),
                "A negative number under the root says that no baseline is good enough: NaN, no absolute value.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: (
                    2 * distance if _reach(row_error, height, limit) >= distance else np.nan
                ),
                "There the error is least. Asked for is the *least baseline* whose error is still within the limit.",
            ),
            Mistake(
                _small_angles,
                "Close: that is for far marks. Near the rig the angles are not small: keep 1 / cos(e)^2.",
            ),
            Mistake(
                _one_cosine,
                "The derivative of tan(e) is 1 / cos(e)^2: yours has one cosine only.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: _solved(
                    distance, _reach(row_error, height, limit, factor=1)
                ),
                "Two rows are read, one on each image, and each is wrong on its own: their variances add.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: _solved(
                    distance, _reach(row_error, height, limit, factor=2)
                ),
                "You add the two rows' errors. They are independent: add their variances, then take the root.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: _solved(
                    distance, _reach(row_error, height, limit, span=2 * np.pi)
                ),
                "Rows run from straight up to straight down: `height` of them span pi radians, not 2 pi.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: _solved(
                    distance, _reach(row_error, height, limit, span=180.0)
                ),
                "The error of an elevation must be in radians: the derivative of tan(e) holds for those only.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: _solved(
                    distance, _reach(row_error, height, limit), larger=True
                ),
                "Two baselines give just that error. The *least* is asked for: the other root.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: (
                    found if np.isfinite(found := baseline_needed(distance, row_error, height, limit)) else 2 * distance
                ),
                "Where even the best baseline is not good enough the task asks for NaN.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: 1000 * baseline_needed(distance, row_error, height, limit),
                "Yours is in millimetres; metres are asked for.",
            ),
            Mistake(
                lambda distance, row_error, height, limit: baseline_needed(distance, row_error, height, limit) / 2,
                "That is half of it: from the rig's middle to one camera. The baseline goes from camera to camera.",
            ),
        ),
    ),
]
