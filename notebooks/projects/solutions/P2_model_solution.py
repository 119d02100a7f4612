"""Model solution of project P2: the paper's steps by hand, and then a second look at what they say.

The stages follow the paper. `locate` first does as the paper does, matching by the penalty of eq. (1). A look at the
practice rooms shows where that fails: look-alike furniture. So every two matches are asked for a pose, and the pose
with which most of the observed objects land on landmarks of their class wins; where a second pose does as well, None.
"""

import itertools

import numpy as np

GAP = 0.1  # radians
NEAR, FAR = 0.25, 0.1  # m, and m a metre of distance, within which an observed object shows a landmark
MARGIN = 0.2  # by which the best pose must be ahead of the second best


def wrapped(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def angles_of(box, width):
    u, v = (box[0] + box[2]) / 2, (box[1] + box[3]) / 2
    return wrapped((0.5 - u / width) * 2 * np.pi), (0.5 - v / (width / 2)) * np.pi


def pair_boxes(upper_labels, upper_angles, lower_labels, lower_angles, largest_gap):
    gap = np.abs(wrapped(upper_angles[:, None, 0] - lower_angles[None, :, 0]))
    same = np.asarray(upper_labels)[:, None] == np.asarray(lower_labels)[None]
    gap[~same | (lower_angles[None, :, 1] <= upper_angles[:, None, 1]) | (gap > largest_gap)] = np.inf
    partner = np.full(len(upper_labels), -1)
    while gap.size and np.isfinite(gap.min()):
        i, j = np.unravel_index(gap.argmin(), gap.shape)
        partner[i] = j
        gap[i], gap[:, j] = np.inf, np.inf
    return partner


def places_of(upper_angles, lower_angles, baseline):
    slope = np.tan(lower_angles[:, 1]) - np.tan(upper_angles[:, 1])
    rho = np.full(len(slope), np.nan)
    there = lower_angles[:, 1] - upper_angles[:, 1] > 1e-3
    rho[there] = baseline / slope[there]
    return rho[:, None] * np.column_stack([np.cos(upper_angles[:, 0]), np.sin(upper_angles[:, 0])])


def penalties(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations):
    d_hue = np.abs(hues[:, None] - map_hues)
    d_hue = np.nan_to_num(np.minimum(d_hue, 360 - d_hue))
    d_saturation = np.abs(saturations[:, None] - map_saturations)
    far_c = np.linalg.norm(places - places.mean(axis=0), axis=1)
    far_m = np.linalg.norm(map_places - map_places.mean(axis=0), axis=1)
    d_far = np.abs(far_c[:, None] - far_m) / np.maximum(far_m, 0.1)
    unlike = np.asarray(labels)[:, None] != np.asarray(map_labels)
    return 100 * unlike + d_hue / 360 + d_saturation / 100 + d_far


def associate(cost):
    cost, column = np.array(cost, dtype=float), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(cost.argmin(), cost.shape)
        if cost[i, j] < 100:
            column[i] = j
        cost[i], cost[:, j] = np.inf, np.inf
    return column


def fit_pose(places, landmarks):
    if len(places) < 2 or min(np.ptp(places, axis=0).max(), np.ptp(landmarks, axis=0).max()) < 1e-3:
        return np.nan, np.nan, np.nan
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    theta = np.arctan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b))
    x, y = landmarks.mean(axis=0) - turned(theta, places.mean(axis=0))
    return x, y, theta


def turned(theta, points):
    cosine, sine = np.cos(theta), np.sin(theta)
    return points @ np.array([[cosine, sine], [-sine, cosine]])


def observe(upper, lower, rig):
    """Labels, places and colours of the objects that both cameras see."""
    angles = [np.array([angles_of(one.box, rig.width) for one in side]).reshape(-1, 2) for side in (upper, lower)]
    labels = [np.array([one.label for one in side], dtype=str) for side in (upper, lower)]
    partner = pair_boxes(labels[0], angles[0], labels[1], angles[1], GAP)
    seen = np.flatnonzero(partner >= 0)
    places = places_of(angles[0][seen], angles[1][partner[seen]], rig.baseline)
    seen, places = seen[np.isfinite(places).all(axis=1)], places[np.isfinite(places).all(axis=1)]
    hues, saturations = (np.array([getattr(upper[i], name) for i in seen]) for name in ("hue", "saturation"))
    return labels[0][seen], places, hues, saturations


def laid_on(pose, places, same, landmarks):
    """How well a pose explains the places: score, and the pairs (place, landmark) of one class that lie close by."""
    there = turned(pose[2], places) + pose[:2]
    allowed = NEAR + FAR * np.linalg.norm(places, axis=1)
    off = np.linalg.norm(there[:, None] - landmarks[None], axis=2) / allowed[:, None]
    off[~same | (off > 1)] = np.inf
    pairs, score = [], 0.0
    while np.isfinite(off.min()):
        i, j = np.unravel_index(off.argmin(), off.shape)
        pairs.append((i, j))
        score += 1 - off[i, j] ** 2
        off[i], off[:, j] = np.inf, np.inf
    return score, np.array(pairs, dtype=int).reshape(-1, 2)


def locate(upper_boxes, lower_boxes, semantic_map, rig):
    labels, places, _, _ = observe(upper_boxes, lower_boxes, rig)
    landmarks, same = semantic_map.positions, labels[:, None] == np.array(semantic_map.labels)
    found = []
    for (i, j), (k, m) in itertools.combinations(np.argwhere(same), 2):
        apart = [np.linalg.norm(ends[1] - ends[0]) for ends in (places[[i, k]], landmarks[[j, m]])]
        if i == k or j == m or abs(apart[0] - apart[1]) > 0.8:
            continue
        score, pairs = laid_on(fit_pose(places[[i, k]], landmarks[[j, m]]), places, same, landmarks)
        if len(pairs) >= 3:
            found.append((score, pairs))
    refitted = []
    for _, pairs in sorted(found, key=lambda one: -one[0])[:60]:
        pose = np.array(fit_pose(places[pairs[:, 0]], landmarks[pairs[:, 1]]))
        refitted.append((laid_on(pose, places, same, landmarks)[0], pose))
    if not refitted:
        return None
    best, pose = max(refitted, key=lambda one: one[0])
    others = [score for score, other in refitted if np.hypot(*(other - pose)[:2]) > 0.5]
    return pose if best > max(others, default=0.0) + MARGIN else None
