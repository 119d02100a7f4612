"""What the pictures of lesson 18 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "Two plans of the room. Left: matched by colour, each sofa is taken for another one and the pose is beside"
        " the true one. Right: from the pose of two right matches every other object lies near its own landmark."
    ),
    "poses-picture": (
        "The room from above with more than two hundred small arrows scattered in and around it; a dense bundle of"
        " them lies at the true pose."
    ),
    "two-poses-picture": (
        "Left, the best pose: every object lies within its ellipse near its landmark, ellipses point at the robot."
        " Right, the runner-up, a metre and more away: half of the objects have no landmark near them."
    ),
    "risk-picture": (
        "Left, two curves of wrong answers over answered poses, nearly the same: 0 until almost half are answered,"
        " then rising to 50 percent. Right, over the threshold: with the gap alone the risk is 20 percent and more"
        " at most thresholds, with everything it is 0 above 0.5."
    ),
    "ambiguity": (
        "Two plans of the room in squares. For the greedy matcher most squares are dark, and the sofas are joined "
        "by thick dashed lines; for the consistent matcher nearly all squares are light."
    ),
    "break-tracker-picture": (
        "Three plans of the symmetric room with a plant. After the first two views two poses, half a turn apart, "
        "share the belief; after the third, which shows the plant, only the true one is left."
    ),
    "break-ambiguity": (
        "Two plans in squares: without the plant all squares are half dark and equal objects are joined by dashed "
        "lines; with it they are light, and the lines are faint."
    ),
    "break-few": (
        "Four objects with lines to the right landmarks; the pose lies a quarter of a metre from the true one, "
        "which is inside the three-sigma ellipse of the pose."
    ),
}
