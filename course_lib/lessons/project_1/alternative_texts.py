"""What the pictures of project P1 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "frames": "Four depth images of a corridor: both side walls, the floor, and the far end without measurement.",
}
