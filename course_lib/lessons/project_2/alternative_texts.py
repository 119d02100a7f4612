"""What the pictures of project P2 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "look": (
        "Left and middle: coloured boxes of furniture on the upper and the lower panorama, the same ones higher in"
        " the lower image. Right: the plan of the room with its landmarks and an arrow, the pose that is wanted."
    ),
}
