"""Exercises of lesson 20: raw depth to metres, K of a smaller image, a baseline measured, a baseline chosen."""

import numpy as np

from course_lib.lessons.kit.exercises import Exercise

# 20.1: a raw depth image in metres


def to_metres(raw, units_per_metre, invalid):
    """Depth in metres (H, W) of raw 16-bit numbers; NaN where a pixel holds `invalid`."""
    # NaN at the holes, units to metres elsewhere.
    return np.where(raw == invalid, np.nan, raw / units_per_metre)


def raw_images(rng: np.random.Generator) -> tuple:
    invalid = int(rng.choice([0, 65535]))
    raw = rng.integers(400, 60_000, size=(3, int(rng.integers(4, 7)))).astype(np.uint16)
    holes = rng.choice(raw.size, size=3, replace=False)
    # The last is the other number that marks no measurement elsewhere: here it is a depth like any other.
    raw.flat[holes] = [invalid, invalid, 65535 - invalid]
    return raw, float(rng.choice([1000, 5000, 4000])), invalid


def nothing_measured(rng: np.random.Generator) -> tuple:
    return np.zeros((2, 3), dtype=np.uint16), 1000.0, 0


def all_measured(rng: np.random.Generator) -> tuple:
    return rng.integers(1, 60_000, size=(2, 4)).astype(np.uint16), 5000.0, 0


# 20.2: the intrinsics of a resized image


def resized_intrinsics(k, scale):
    """K (3, 3) of the same camera after its image was resized by `scale`; pixel centres at whole numbers."""
    # Lengths from the image's edge scale; the edge is at -0.5.
    resized = k.copy()
    resized[[0, 1], [0, 1]] *= scale
    resized[:2, 2] = scale * (k[:2, 2] + 0.5) - 0.5
    return resized


def intrinsics(rng: np.random.Generator) -> tuple:
    fx, cx, cy = rng.uniform(400, 700), rng.uniform(300, 340), rng.uniform(220, 260)
    k = np.array([[fx, 0, cx], [0, fx * rng.uniform(0.9, 1.1), cy], [0, 0, 1.0]])
    return k, float(rng.choice([0.25, 0.5, 0.125, 2.0]))


def size_unchanged(rng: np.random.Generator) -> tuple:
    return intrinsics(rng)[0], 1.0


def the_papers_camera(rng: np.random.Generator) -> tuple:
    return np.array([[217.0, 0, 87.5], [0, 217.0, 71.5], [0, 0, 1]]), 0.25


# 20.3: the baseline from marks at known distances


def baseline_from_marks(v_upper, v_lower, height, distance):
    """Baseline [m], the median over marks at horizontal distances (n,) seen at rows (n,) of two panoramas."""
    # Each mark's height as seen from both cameras; the baseline is the difference.
    e_upper, e_lower = (np.pi * (0.5 - np.asarray(v) / height) for v in (v_upper, v_lower))
    return np.median(distance * (np.tan(e_lower) - np.tan(e_upper)))


def marks(rng: np.random.Generator) -> tuple:
    height, baseline, n = int(rng.choice([512, 640, 1024])), rng.uniform(0.15, 0.5), 7
    distance = rng.uniform(0.8, 3.0, size=n)
    drop = rng.uniform(-0.3, 0.8, size=n)  # metres from the upper camera down to the mark
    v_upper = height * (0.5 + np.arctan(drop / distance) / np.pi)
    v_lower = height * (0.5 + np.arctan((drop - baseline) / distance) / np.pi) + rng.normal(0, 0.4, size=n)
    v_lower[0] += 25.0  # a row that was misread: the mean would follow it, and the middle one does not
    return v_upper, v_lower, height, distance


def images_exchanged(rng: np.random.Generator) -> tuple:
    v_upper, v_lower, height, distance = marks(rng)
    return v_lower, v_upper, height, distance


def an_even_number_of_marks(rng: np.random.Generator) -> tuple:
    v_upper, v_lower, height, distance = marks(rng)
    return v_upper[:4], v_lower[:4] - [0.0, 6.0, 14.0, 25.0], height, distance[:4]


def marks_of_both_signs(rng: np.random.Generator) -> tuple:
    v_upper, v_lower, height, distance = marks(rng)
    return v_upper[2:], v_lower[2:] + np.array([200.0, 200.0, 0.0, 0.0, 0.0]), height, distance[2:]


def one_mark(rng: np.random.Generator) -> tuple:
    return tuple(v[3:4] if isinstance(v, np.ndarray) else v for v in marks(rng))


def median_of_positive(values):
    return np.median(values[values > 0]) if (values > 0).any() else np.nan


# 20.4: how far apart must the cameras stand?


def baseline_needed(distance, row_error, height, limit):
    """Least baseline [m] at which a mark's distance is known to `limit` [m] (one sigma); NaN if there is none."""
    # sigma_rho = sqrt(2) sigma_e (rho^2 / B + B / 4), since 1 / cos(e)^2 = 1 + (B / 2 rho)^2.
    reach = limit / (np.sqrt(2) * np.pi * row_error / height)  # the farthest distance that any baseline serves
    if reach < distance:
        return np.nan
    return 2 * (reach - np.sqrt(reach**2 - distance**2))  # B^2 / 4 - reach B + rho^2 = 0


def rig_and_limit(rng: np.random.Generator) -> tuple:
    """From a far mark and a small angle to a near one and a large angle; sometimes no baseline is good enough."""
    distance, height, row_error = rng.uniform(1, 6), int(rng.choice([512, 640, 960, 1024])), rng.uniform(0.2, 1.5)
    reach = distance * rng.uniform(0.9, 8)
    return float(distance), float(row_error), height, float(reach * np.sqrt(2) * np.pi * row_error / height)


def the_example(rng: np.random.Generator) -> tuple:
    return 4.0, 0.5, 960, 0.10


def no_baseline_is_enough(rng: np.random.Generator) -> tuple:
    return 8.0, 2.0, 512, 0.05


# fmt: off
EXERCISES = [
    Exercise("20.1", to_metres, raw_images, "warm-up", cases=[nothing_measured, all_measured], mistakes="""
        raw == invalid => raw <= invalid
        raw == invalid => raw >= invalid
        Only a pixel that is equal to `invalid` is a hole, not every one that is smaller or larger.
        raw == invalid => raw == 0
        raw == invalid => raw == 65535
        raw == invalid => (raw == 0) | (raw == 65535)
        raw == invalid => (raw == 0) | (raw == invalid)
        Which number marks a hole is another in each file: `invalid`. Both 0 and 65535 may be depths like any other.
        raw == invalid => raw != invalid
        The two are exchanged: yours is NaN where there is a measurement.
        raw == invalid => raw / units_per_metre == invalid
        You compare metres with `invalid`. It is a raw number: compare before you divide.
        ... => return raw / units_per_metre
        Pixels without a measurement have become depths. They must be NaN: compare the raw numbers with `invalid`.
        raw / units_per_metre => raw / 1000
        You always divide by 1000. The file says how many units make a metre: use `units_per_metre`.
        raw / units_per_metre => raw * float(units_per_metre)
        You multiply. A wall at 2 m holds 2 times `units_per_metre`: divide to come back to 2.
        raw / units_per_metre => 1000 * raw / units_per_metre
        Yours is in millimetres. Metres are asked for.
        raw / units_per_metre => raw // units_per_metre
        Yours are whole metres: `//` throws the rest away. Use `/`.
        np.nan => 0.0
        np.nan => np.inf
        A hole is NaN: 0 would be a surface at the lens, and inf is a simulated ray that hit nothing.
        raw / units_per_metre => np.round(raw / units_per_metre, 3)
        raw / units_per_metre => (raw / units_per_metre).astype(np.float16).astype(float)
        You round. With 5000 units a metre the file knows a fifth of a millimetre: use float32 or float64 as it is.
    """),
    Exercise("20.2", resized_intrinsics, intrinsics, cases=[size_unchanged, the_papers_camera], mistakes="""
        scale * (k[:2, 2] + 0.5) - 0.5 => scale * k[:2, 2]
        cx and cy are half a pixel off. The image's edge is at -0.5: measure from there, scale, come back.
        scale * (k[:2, 2] + 0.5) - 0.5 => scale * (k[:2, 2] - 0.5) + 0.5
        Your half pixel has the wrong sign. The edge of the image lies at -0.5, so first add 0.5.
        scale * (k[:2, 2] + 0.5) - 0.5 => scale * (k[:2, 2] + 1) - 1
        The edge lies half a pixel before the first centre, at -0.5: yours is a whole pixel off.
        scale * (k[:2, 2] + 0.5) - 0.5 => scale * (k[:2, 2] + 0.5)
        You count from the image's edge and do not come back: subtract 0.5 at the end.
        scale * (k[:2, 2] + 0.5) - 0.5 => scale * k[:2, 2] - 0.5
        scale * (k[:2, 2] + 0.5) - 0.5 => scale * k[:2, 2] + 0.5
        Go to the edge before you scale (add 0.5), and come back after it (subtract 0.5).
        resized[[0, 1], [0, 1]] *= scale => resized[[0, 1], [0, 1]] = scale * (k[[0, 1], [0, 1]] + 0.5) - 0.5
        The half pixel belongs to positions, cx and cy. A focal length is a length: it has no origin.
        resized[[0, 1], [0, 1]] *= scale => pass
        fx and fy are unchanged. They are in pixels too: with half the pixels they are half as long.
        resized[:2, 2] = scale * (k[:2, 2] + 0.5) - 0.5 => pass
        cx and cy are unchanged: they would lie outside the middle of the new image.
        return resized => return np.vstack([resized[:1], k[1:]])
        Your rows keep their size. The image shrinks in both directions: fy and cy, too.
        ... => return k * scale
        ... => return resized_intrinsics(k, scale) * [[1], [1], [0]]
        Only focal lengths and positions scale: a pinhole's K ends in [0, 0, 1].
        ... => return resized_intrinsics(k, 1 / scale)
        You divide by the scale. An image of half the width (scale 0.5) has half the focal length.
        return resized => return np.round(resized)
        You round to whole pixels. A principal point may lie anywhere between them.
        return resized => resized[1, 1] = resized[0, 0]; return resized
        return resized => resized[1, 2] = resized[0, 2]; return resized
        You take the column's number for the row as well: fx and fy may differ, and so do cx and cy.
    """),
    Exercise("20.3", baseline_from_marks, marks, cases=[
        images_exchanged, an_even_number_of_marks, marks_of_both_signs, one_mark,
    ], mistakes="""
        np.tan(e_lower) - np.tan(e_upper) => e_lower - e_upper
        You subtract the angles themselves. Heights go with their tangents: rho tan(e).
        np.tan(e_lower) - np.tan(e_upper) => np.tan(e_lower - e_upper)
        ... => return np.median(distance) * np.median(np.tan(np.pi * (np.asarray(v_upper) - v_lower) / height))
        The tangent of a difference is not the difference of the tangents. Subtract mark by mark, then one median.
        np.tan(e_lower) - np.tan(e_upper) => np.sin(e_lower) - np.sin(e_upper)
        sin(e) goes with the slanted distance. `distance` is horizontal: use tan(e).
        - np.tan(e_upper) => + np.tan(e_upper)
        You add the two heights. Both see the same mark: the heights differ by the baseline, so subtract.
        np.pi * => 180 *
        np.tan wants radians: the rows span pi, not 180.
        np.pi * => 2 * np.pi *
        Rows run from straight up to straight down: that is pi radians, not 2 pi.
        0.5 - np.asarray(v) / height => np.asarray(v) / height
        Rows count from the top, elevations from the horizon, upwards: e = (1/2 - v / height) pi.
        np.asarray(v) / height => np.asarray(v) / (height - 1)
        You divide by height - 1. The symbol table counts `height` rows from straight up to straight down.
        ... => return abs(baseline_from_marks(v_upper, v_lower, height, distance))
        (np.tan(e_lower) - np.tan(e_upper)) => abs(np.tan(e_lower) - np.tan(e_upper))
        You drop the sign. A negative baseline says that the images are exchanged: leave it as it comes.
        np.median( => median_of_positive(
        You leave out negative ones: of exchanged images nothing is left. Keep all marks, and the sign.
        ... => return -baseline_from_marks(v_upper, v_lower, height, distance)
        Yours is negative. The lower camera sees a mark at the greater elevation: lower minus upper.
        np.median => np.mean
        You take the mean. One misread row pulls it away; the task asks for the median.
        return np.median => return np.max
        return np.median( => return (lambda values: values[0])(
        You use one mark alone. It may be the misread one: the median of all.
        return np.median( => return (
        Yours has one number for each mark. Return their median, one number.
        np.median( => (lambda values: np.sort(values)[len(values) // 2])(
        np.median( => (lambda values: np.sort(values)[(len(values) - 1) // 2])(
        For an even number of marks a median lies halfway between the middle two; yours is one of them.
        (np.tan(e_lower) - np.tan(e_upper)) => np.tan(e_lower)) - np.median(distance * np.tan(e_upper)
        np.median(distance * (np.tan(e_lower) - => np.median(distance) * np.median((np.tan(e_lower) -
        Two medians may be of different marks. Compute the baseline from each mark, then take one median.
        distance * ( => 1 / distance * (
        You divide by the distance. Seen under the same angle, a far mark is higher: multiply.
        ... => return round(baseline_from_marks(v_upper, v_lower, height, distance), 2)
        You round to centimetres, as the example is printed. Give the number as it comes out.
        ... => return baseline_from_marks(v_upper, v_lower, 512, distance)
        Your panorama is always 512 rows high: use the argument.
    """),
    Exercise("20.4", baseline_needed, rig_and_limit, "challenge", cases=[the_example, no_baseline_is_enough],
             tolerance=1e-5, mistakes="""
        return np.nan => return np.inf
        return np.nan => return 0.0
        return np.nan => return -1.0
        return np.nan => return 2 * distance
        Where even the best baseline is not good enough the task asks for NaN.
        ... => r = limit / (np.sqrt(2) * np.pi * row_error / height); return 2 * (r - np.sqrt(abs(r**2 - distance**2)))
        A negative number under the root says that no baseline is good enough: NaN, no absolute value.
        return 2 * (reach - np.sqrt(reach**2 - distance**2)) => return 2 * distance
        There the error is least. Asked for is the *least baseline* whose error is still within the limit.
        ... => return distance**2 / (limit / (np.sqrt(2) * np.pi * row_error / height))
        Close: that is for far marks. Near the rig the angles are not small: keep 1 / cos(e)^2.
        2 * (reach - np.sqrt(reach**2 - distance**2)) => distance**2 / np.sqrt(reach**2 - distance**2 / 4)
        The derivative of tan(e) is 1 / cos(e)^2: yours has one cosine only.
        np.sqrt(2) * np.pi => np.pi
        Two rows are read, one on each image, and each is wrong on its own: their variances add.
        np.sqrt(2) * np.pi => 2 * np.pi
        You add the two rows' errors. They are independent: add their variances, then take the root.
        np.sqrt(2) * np.pi => np.sqrt(2) * 2 * np.pi
        Rows run from straight up to straight down: `height` of them span pi radians, not 2 pi.
        np.sqrt(2) * np.pi => np.sqrt(2) * 180
        The error of an elevation must be in radians: the derivative of tan(e) holds for those only.
        reach - np.sqrt => reach + np.sqrt
        Two baselines give just that error. The *least* is asked for: the other root.
        return 2 * (reach => return reach - np.sqrt(reach**2 - distance**2) + 0 * (reach
        That is half of it: from the rig's middle to one camera. The baseline goes from camera to camera.
        return 2 * (reach => return 2000 * (reach
        Yours is in millimetres; metres are asked for.
    """),
]
