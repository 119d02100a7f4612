"""What the pictures of lesson 03 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "Side view: seven rays leave a virtual camera; each keeps its first hit on a surface and drops the later ones."
    ),
    "triangle-picture": (
        "Two depth images of one triangle that leans away from the camera; mixing Z makes its middle too far away."
    ),
    "agree-picture": (
        "Two equal depth images of a corridor's end: a wall at 7.5 m, in front of it a pillar (left) and a crate."
    ),
    "buffer-picture": (
        "Buffer value over depth for near planes at 1, 0.1 and 0.01 m: steep at first, then close to 1 for good."
    ),
    "tiles-picture": (
        "Twenty small depth images of the corridor in five columns and four rows, each from a slightly other pose."
    ),
    "times": (
        "Time per view over the number of views, on this computer: as tiles of one window and one after the other."
    ),
}
