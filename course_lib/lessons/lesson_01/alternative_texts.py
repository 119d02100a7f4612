"""What the pictures of lesson 01 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "turns-picture": (
        "Three turns by 30 degrees: yaw turns forward to the left, pitch turns it down, roll lifts the left side."
    ),
    "order-picture": (
        "Two depth images of the corridor with the same two angles in two orders; in the second, edges of walls lean."
    ),
    "frames-picture": (
        "Left, the body's axes at a place in the world; right, optical X to the right, Y down and Z forward."
    ),
    "measure-mean-picture": (
        "Headings on a circle near 180 degrees; the mean of the numbers points away, the mean direction to them."
    ),
    "break-lock-picture": (
        "Least and greatest turn over pitch: both 1 at pitch 0; the least falls to 0 at plus and minus 90 degrees."
    ),
}
