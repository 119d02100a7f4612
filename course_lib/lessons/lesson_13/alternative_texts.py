"""What the pictures of lesson 13 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "Strips of the upper and the lower panorama. A blue line at the left edge of each chair runs through both:"
        " it meets the same chair in both, which stands a little higher in the lower picture."
    ),
    "spheres": (
        "Two grey spheres, one above the other, and a black point beside them. A yellow upright plane through all "
        "three cuts each sphere in a circle: bold on the point's side, dashed behind; a ray leads to the point."
    ),
    "counts-picture": (
        "Table of matches of every two objects of one class: large numbers on the diagonal, where both boxes show "
        "one object, and nearly nothing elsewhere."
    ),
    "pairs-agree": (
        "Both strips with the paired objects: the same number on the same object above and below, yellow dots "
        "where some of the features matched."
    ),
}
