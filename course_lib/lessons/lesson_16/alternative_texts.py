"""What the pictures of lesson 16 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "Thirteen measured points in the body frame; their landmarks on the map; and both about their centroids, "
        "where one pattern is the other turned by a quarter of a circle."
    ),
    "curves": (
        "Residual over heading: two smooth valleys, the deeper one for two pairs, both lowest near minus 90 degrees."
    ),
    "measure-noise-picture": (
        "Spread of the heading over the number of points, both logarithmic: tried values on the closed form's line."
    ),
}
