"""What the pictures of lesson 00 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "The corridor from above with the camera and a guess 1.2 m behind it; the depth image that the camera "
        "measured; the depth image that the map gives for the guess."
    ),
    "measure-hills": "Three curves of l / m over the error in x, y and yaw; each is a hill with its top at zero error.",
    "filter-picture": "Ten estimates beside ten true positions from above, with the clouds of particles around them.",
    "second-picture": (
        "The upper panorama with a numbered box around every object found; and the room from above with the true "
        "and the estimated pose and lines to the objects that were used."
    ),
    "break-floor": (
        "l / m over the error along the corridor: a steep hill for the whole image, nearly a level line for the floor."
    ),
}
