"""What the pictures of lesson 04 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "Left, the points of one frame from above: two walls of a corridor; right, the depth image made of them."
    ),
    "tof-picture": (
        "Left, hands of a clock for ranges of 2, 6 and 12 m: 2 and 12 m nearly coincide; right, the range read "
        "over the true range, a saw that falls back to zero every 10 m."
    ),
    "measure-noise-picture": (
        "The scatter of a wall's depth grows from 7 mm at 2 m to about 29 mm at 8 m, in proportion to the distance."
    ),
    "measure-recorded-picture": (
        "A recorded depth image, the true one, and the histogram of their difference: a narrow hill at zero and a "
        "bar of errors of many metres at its left end."
    ),
    "scene": (
        "The points of one frame in the corridor: blue ones lie on the grey true surfaces, red ones hang before "
        "the camera where nothing is, black ones float behind the edges of people and pillars."
    ),
    "break-mixing": (
        "Range read over the pole's share of the pixel: for a wall at 4 or 6 m it falls to 2 m from above; for a "
        "wall at 8 m it rises beyond 8 m, jumps to zero, and comes to 2 m from below."
    ),
}
