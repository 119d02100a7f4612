"""Figures of lesson 14 that explain: the triangle of two cameras and a point, and the ellipse of its error."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc

from course_lib.lessons.kit.display import described
from course_lib.lessons.lesson_14.noise import ellipse
from course_lib.plots.figures import BLUE, ORANGE, VERMILION, new_figure


def triangle_figure(horizontal_range: float, height: float, upper_height: float, baseline: float) -> Figure:
    """Return the vertical plane through both cameras and a point, with the angles and lengths of the text [m]."""
    figure, axes = new_figure(size=(7.4, 3.9))
    lower_height = upper_height - baseline
    cameras = ("upper", upper_height, BLUE, "-", "o"), ("lower", lower_height, ORANGE, "--", "s")
    for name, z, colour, line, marker in cameras:
        axes.plot([0, horizontal_range], [z, height], line, color=colour, linewidth=1.8)
        axes.plot([0, 1.1], [z, z], color="0.7", linewidth=0.8)
        angle = np.degrees(np.arctan2(height - z, horizontal_range))
        axes.add_patch(Arc((0, z), 1.7, 1.7, theta1=min(angle, 0), theta2=max(angle, 0), color=colour, linewidth=1.4))
        axes.text(0.92, z + 0.43 * np.radians(angle), f"$e_{name[0]}$", color=colour, fontsize=11, va="center")
        axes.plot(0, z, marker, color=colour, markersize=8)
        axes.text(-0.1, z, name, ha="right", va="center", fontsize=9)
    axes.plot([0, 0], [upper_height, lower_height], color="black", linewidth=3)
    axes.text(0.07, upper_height - 0.6 * baseline, "$B$", fontsize=11, va="center")
    axes.plot(horizontal_range, height, "*", color=VERMILION, markersize=14)
    axes.text(horizontal_range + 0.1, height, "$\\mathbf{X}$", fontsize=12, va="center")
    middle = upper_height + (height - upper_height) * 0.55 + 0.09
    axes.text(horizontal_range * 0.55, middle, "$d$", color=BLUE, fontsize=12)
    axes.annotate("", (0, -0.12), (horizontal_range, -0.12), arrowprops={"arrowstyle": "<->", "color": "0.3"})
    axes.text(horizontal_range / 2, -0.06, r"$\rho$", fontsize=12, ha="center", va="bottom")
    axes.plot([horizontal_range, horizontal_range], [-0.12, height], color="0.7", linewidth=0.8)
    axes.set(title="Seen from the side: two cameras and a point", xlabel="horizontal range [m]", ylabel="height [m]")
    axes.set(xlim=(-0.75, horizontal_range + 0.4), ylim=(-0.2, upper_height + 0.3), aspect="equal")
    return described(
        figure,
        "A triangle of the upper camera, the lower camera and a point. The baseline B is its left side; the ray d "
        "from the upper camera drops by the angle e_u, that from the lower camera by the smaller e_l.",
    )


def ellipse_figure(
    place: np.ndarray, covariance: np.ndarray, samples: np.ndarray, ways: np.ndarray, sigmas: np.ndarray
) -> Figure:
    """Return the error ellipse from above, in the room and drawn large, with its two axes.

    place: `(3,)`, covariance: `(3, 3)` of it, samples: `(n, 3)` noisy measurements, metres in the upper camera's frame.
    ways: `(2, 2)`, the axes' unit vectors in its columns, sigmas: `(2,)` metres along them, the smaller first.
    """
    figure, (room, large) = new_figure(1, 2, size=(9.4, 4.4))
    room.plot([0, 1.25 * place[0]], [0, 1.25 * place[1]], color="0.6", linewidth=0.9, label="ray")
    room.plot(0, 0, "o", color="black", label="rig")
    room.plot(*ellipse(covariance[:2, :2], place[:2]).T, color=BLUE, linewidth=1.6, label="two sigma")
    room.set(title="From above", xlabel="x, forward [m]", ylabel="y, left [m]", aspect="equal")
    room.legend(fontsize=8)
    ray, left = place[:2], np.array([-place[1], place[0]])
    turn = np.stack([way * np.sign(way @ side) for way, side in zip(ways.T[::-1], (ray, left), strict=True)])
    scattered = 100 * (samples[:, :2] - place[:2]) @ turn.T
    large.plot(*scattered.T, ".", color="0.6", markersize=2.5, label=f"{len(samples)} noisy measurements")
    for n_sigma, line in ((1, "-"), (2, "--")):
        outline = ellipse(1e4 * turn @ covariance[:2, :2] @ turn.T, np.zeros(2), n_sigma)
        large.plot(*outline.T, line, color=BLUE, linewidth=1.6, label=f"{n_sigma} sigma")
    ends = 100 * np.diag(sigmas[::-1])
    for end, colour, name in zip(ends, (VERMILION, ORANGE), ("along", "across"), strict=True):
        large.annotate("", end, (0, 0), arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 2})
        large.plot([], [], color=colour, linewidth=2, label=f"{name}: {end.max():.1f} cm")
    large.set(title="Turned, and stretched across the ray", xlabel="along the ray, away from the rig [cm]")
    large.set(ylabel="across it, left [cm]", xlim=(-330 * sigmas[1], 330 * sigmas[1]))
    large.set(ylim=(-400 * sigmas[0], 550 * sigmas[0]))
    large.legend(loc="upper center", fontsize=8, ncols=2)
    return described(
        figure,
        "From above: a ray from the rig to the sofa, and around the sofa a needle along the ray. Drawn large: 400 "
        "dots, the ellipses of one and two sigma, and their two axes, along the ray and across it.",
    )
