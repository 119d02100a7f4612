"""Exercises of lesson 20: raw depth to metres, K of a smaller image, a baseline from marks at a known distance."""

from __future__ import annotations

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


def _filled(raw: np.ndarray, metres: np.ndarray, invalid: int, value: float) -> np.ndarray:
    return np.where(raw == invalid, value, metres)


# 20.2: the intrinsics of a resized image


def resized_intrinsics(k: np.ndarray, scale: float) -> np.ndarray:
    """K `(3, 3)` of the same camera after its image was resized by `scale`; pixel centres at integers."""
    fx, fy, cx, cy = k[0, 0], k[1, 1], k[0, 2], k[1, 2]
    return np.array([[scale * fx, 0, scale * (cx + 0.5) - 0.5], [0, scale * fy, scale * (cy + 0.5) - 0.5], [0, 0, 1]])


def _intrinsics(rng: np.random.Generator) -> tuple:
    fx, cx, cy = rng.uniform(400, 700), rng.uniform(300, 340), rng.uniform(220, 260)
    k = np.array([[fx, 0, cx], [0, fx * rng.uniform(0.9, 1.1), cy], [0, 0, 1.0]])
    return k, float(rng.choice([0.25, 0.5, 0.125, 2.0]))


def _with(k: np.ndarray, focal: float, centre) -> np.ndarray:
    return np.array([[focal * k[0, 0], 0, centre(k[0, 2])], [0, focal * k[1, 1], centre(k[1, 2])], [0, 0, 1]])


def _centre_only(k: np.ndarray, scale: float) -> np.ndarray:
    return _with(k, 1.0, lambda c: scale * (c + 0.5) - 0.5)


def _one_focal_length(k: np.ndarray, scale: float) -> np.ndarray:
    square = k.copy()
    square[1, 1] = k[0, 0]
    return resized_intrinsics(square, scale)


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


EXERCISES = [
    Exercise(
        number="20.1",
        reference=to_metres,
        inputs=_raw_images,
        mistakes=(
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
        reference=resized_intrinsics,
        inputs=_intrinsics,
        mistakes=(
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
        reference=baseline_from_marks,
        inputs=_marks,
        mistakes=(
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
]
