"""What the pictures of lesson 19 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "sensors": "A panorama with twelve framed objects; a depth image of a wall and a plant; the room from above.",
    "stages": "Three plans, each closer: the room; the semantic pose and its ellipse; the filter on the cross.",
    "starts-figure": "Left, three starts in the room and where each ends, one at the robot; right, its bar is highest.",
    "basin-figure": (
        "All filters arrive from half a metre or 30 degrees, few from farther; semantic poses lie far left."
    ),
    "scene": (
        "A furnished room cut open, its landmarks as posts with names; on the far wall a blue patch with the "
        "potted plant, on the same wall a tilted purple patch beside the refrigerator, and an orange one below the"
        " ceiling."
    ),
    "wall": "Left, a depth image in upright stripes; right, the estimate in a tall ellipse: its height is not known.",
}
