"""What the pictures of project P4 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "room": (
        "Four range images of a room with boxes and poles, some pixels missing, blurred seams at the edges of things."
    ),
}
