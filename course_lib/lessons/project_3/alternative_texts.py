"""What the pictures of project P3 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "look": (
        "Left: observed places around the rig, each with an ellipse that is long along its ray and grows outward. "
        "Right: the plan of the room with all its landmarks, several of one class."
    ),
}
