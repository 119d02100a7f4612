"""Model solution of project P3: every two matches propose a pose, and all observations judge every pose.

`match` uses the five stages as they stand and no colour, because look-alikes share their colour. It withholds an answer
whose confidence is below `MIN_CONFIDENCE`. You can add the objects that should be visible but are not, the walls, and
the colours where they differ.
"""

import itertools

import numpy as np
from scipy.optimize import least_squares, linear_sum_assignment

TOLERANCE = 0.8  # m by which the lengths of two matches may disagree
REWARD = 5.0  # nats for a match that fits exactly: a false alarm is that much rarer there than the object
NOTHING = 3.0  # nats for every observation that "none of these poses" explains
FEWEST = 3  # matches of an answer
MIN_CONFIDENCE = 0.8  # confidence


def rotation(theta):
    cosine, sine = np.cos(theta), np.sin(theta)
    return np.array([[cosine, -sine], [sine, cosine]])


def wrapped(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def squared_distances(pose, places, covariances, landmarks):
    r = rotation(pose[2])
    off = (places @ r.T + pose[:2])[:, None] - landmarks
    information = np.linalg.inv(r @ covariances @ r.T + 0.02**2 * np.eye(2))
    return np.einsum("nmi,nij,nmj->nm", off, information, off)


def hypotheses(places, labels, landmarks, map_labels, tolerance):
    matches = np.argwhere(np.asarray(labels)[:, None] == np.asarray(map_labels))
    found = []
    for (i, j), (k, m) in itertools.combinations(matches, 2):
        if i == k or j == m:
            continue
        seen, true = places[k] - places[i], landmarks[m] - landmarks[j]
        lengths = np.hypot(*seen), np.hypot(*true)
        if abs(lengths[0] - lengths[1]) > tolerance or min(lengths) < 0.5:
            continue
        theta = wrapped(np.arctan2(true[1], true[0]) - np.arctan2(seen[1], seen[0]))
        middle = (landmarks[j] + landmarks[m]) / 2 - rotation(theta) @ (places[i] + places[k]) / 2
        found.append((*middle, theta))
    return np.array(found).reshape(-1, 3)


def assign(squared, like, reward):
    gain = np.where(like, reward - squared / 2, 0.0)
    rows, columns = linear_sum_assignment(np.maximum(gain, 0), maximize=True)
    good = gain[rows, columns] > 0
    landmark = np.full(len(squared), -1)
    landmark[rows[good]] = columns[good]
    return landmark, float(gain[rows[good], columns[good]].sum())


def refit(start, places, covariances, targets):
    roots = np.linalg.cholesky(np.linalg.inv(covariances))

    def off(pose):
        return np.einsum("nji,nj->ni", roots, places - (targets - pose[:2]) @ rotation(pose[2])).ravel()

    x, y, theta = least_squares(off, start, xtol=1e-12, ftol=1e-12, gtol=1e-12).x
    return x, y, wrapped(theta)


def confidence(poses, scores, nothing):
    if not len(poses):
        return 0.0
    best = int(np.argmax(scores))
    far = np.hypot(*(poses[:, :2] - poses[best, :2]).T) > 0.5
    turned = np.abs(wrapped(poses[:, 2] - poses[best, 2])) > np.deg2rad(10)
    rival = np.exp((scores[far | turned] - scores[best]) / 2).max(initial=0.0)
    with np.errstate(over="ignore"):
        return float(1 / (1 + rival + np.exp((nothing - scores[best]) / 2)))


def match(observations, semantic_map):
    if len(observations) < FEWEST:
        return None
    places = np.array([[one.x, one.y] for one in observations])
    covariances = 1.5 * np.array([one.covariance for one in observations])
    labels, landmarks = np.array([one.label for one in observations]), semantic_map.positions
    like = labels[:, None] == np.array(semantic_map.labels)
    poses = hypotheses(places, labels, landmarks, semantic_map.labels, TOLERANCE)
    scored = [(assign(squared_distances(pose, places, covariances, landmarks), like, REWARD), pose) for pose in poses]
    scored = sorted((one for one in scored if (one[0][0] >= 0).sum() >= FEWEST), key=lambda one: -one[0][1])[:30]
    answers = [judged(pose, landmark, places, covariances, landmarks, like) for (landmark, _), pose in scored]
    if not answers:
        return None
    poses, scores = np.array([one[0] for one in answers]), np.array([one[1] for one in answers])
    if confidence(poses, scores, NOTHING * len(places)) < MIN_CONFIDENCE:
        return None
    landmark = answers[int(scores.argmax())][2]
    return [(i, int(j)) for i, j in enumerate(landmark) if j >= 0]


def judged(pose, landmark, places, covariances, landmarks, like):
    """A pose fitted to its matches, its score, and its matches after the fit."""
    used = landmark >= 0
    pose = refit(pose, places[used], covariances[used], landmarks[landmark[used]])
    landmark, score = assign(squared_distances(pose, places, covariances, landmarks), like, REWARD)
    return pose, score, landmark
