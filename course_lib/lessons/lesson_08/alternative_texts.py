"""What the pictures of lesson 08 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "experiment-picture": (
        "The corridor from above: walls with niches, the wagon's winding path between them, and its start on the left."
    ),
    "two-errors": (
        "A winding path; the camera is far along it; the estimate lies beside its beginning, close to the path."
    ),
    "scene": "A black path along the corridor, blue arrows on it, and flat ellipsoids, longer along the corridor.",
    "figures-paper": (
        "Above, the winding true path with our estimates on it; below, our error of every frame, mostly below 0.05 m."
    ),
    "figure-5": "The true path from above with our estimates along all of it, and the Fallon-style estimates near it.",
    "figure-6": (
        "Nearest-path errors over the frames, on a logarithmic axis: ours lower, Fallon-style higher, 0.30 m dashed."
    ),
    "along": "Position along the corridor over the frames: ours on the true line, the Fallon-style one far from it.",
    "collapse": (
        "The weight of a slightly worse particle falls from near 1 to almost nothing as more pixels are summed."
    ),
    "break-signal": (
        "Left, the raw score stays level for the good run and falls for the lost one; right, the normalized "
        "weights of both runs do not tell which one is lost."
    ),
}
