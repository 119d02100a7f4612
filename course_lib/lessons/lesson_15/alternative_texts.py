"""What the pictures of lesson 15 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "Thirteen objects around the camera in its own frame, and the fourteen of the map; from each object a line"
        " to the centroid of its side. The two stars of lines look alike, but turned."
    ),
    "table-picture": (
        "Four heat maps, two by two: in hue and saturation the three sofas are all alike and dark; in distance "
        "bright columns for landmarks near the centroid; in the total only blocks of like classes are dark, the "
        "right darkest."
    ),
    "break-sofas": (
        "On a line of distances to the centroid: on the map sofa 1 at 2.35, sofa 0 at 2.63, sofa 2 at 3.44 metres;"
        " observed, sofas 0 and 1 lie nearly on one another at 2.3 metres."
    ),
}
