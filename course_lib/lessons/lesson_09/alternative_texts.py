"""What the pictures of lesson 09 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "A cloud of points with a small circle at its middle; the number of particles inside falls from 77 with "
        "one unknown to 0.06 with six, while the nearest particle is ever farther away."
    ),
    "levels": "One depth image in three sizes: the coarse one still shows walls, floor and a door frame.",
    "temper-agrees": (
        "The paper's weights fall from one to a millionth at once; the tempered ones fall slowly over forty ranks."
    ),
    "same-budget-picture": (
        "Errors over 15 images on logarithmic axes: the annealed filter stays near one centimetre and a tenth of a"
        " degree, both runs of the paper's filter lie ten to several hundred times higher."
    ),
    "basin": (
        "Left, ends of Gauss-Newton over the start's error: one group below 2 centimetres, one above the start's "
        "own error, little between. Right, the share that comes back falls from one to nearly none at 0.4 m."
    ),
    "ablation": (
        "Share of good frames with one idea switched off: without refinement 5 percent, with a single hypothesis "
        "62, without annealing or the second look 95 and 96, with everything or without one of the others 98 or 99"
        " percent."
    ),
    "covariance": (
        "Errors of x, y, z and of the turns about three axes over 15 images, all inside the blue bands of three sigma."
    ),
    "scene": (
        "A corridor cut open; along it small blue ellipsoids on a dashed line, first upright, then wide, then "
        "small; an orange line that wanders to and fro at the start and stays behind."
    ),
    "coverage": (
        "For five recordings: the annealed filter's normalized error lies near 1, all its errors within three "
        "sigma; with calibration errors near 5 to 10 and 85 to 100 percent; the paper's filter at about 1000 and "
        "80 percent."
    ),
    "look-alike-picture": (
        "Three depth images: measured, the map from the true pose, and the map from the estimate: all show a "
        "corridor that runs away between two walls."
    ),
    "bare": (
        "Error along the corridor's axis over eight images with three-sigma bands: bare, it falls behind by 0.7 m "
        "in a band that widens faster; with a pillar both vanish; with an odometer the error stays small in a "
        "widening band."
    ),
}
