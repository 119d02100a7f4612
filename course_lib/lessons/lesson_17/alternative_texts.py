"""What the pictures of lesson 17 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "places": (
        "A room of six by six metres from above with fourteen objects and ten numbered places, two arrows at each."
    ),
    "thin-picture": (
        "Left, rates: poses become unable where less than 0.4 of the objects are seen. Right: errors of metres there."
    ),
    "grid": "A grid of runs and poses: dots where the pose was correct, crosses where it was incorrect.",
    "live-picture": (
        "The room from above with the true and the estimated pose, and lines from measured objects to their landmarks."
    ),
}
