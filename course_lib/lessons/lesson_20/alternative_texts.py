"""What the pictures of lesson 20 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "check-picture": (
        "Three images: the depth that was measured, the map drawn from the same pose, and their small difference."
    ),
    "filter-picture": "Given and estimated x, y and z over eight frames: x falls behind, most z lie too low.",
    "pair-check": "The upper panorama with boxes around its objects and features coloured by their vertical disparity.",
}
