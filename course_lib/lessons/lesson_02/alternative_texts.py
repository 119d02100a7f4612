"""What the pictures of lesson 02 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "A room from above with a scanner in its lower left; rays end on walls, a table's edge and a pillar; "
        "behind the pillar and the cabinet no points are measured."
    ),
    "registration": (
        "Points of two stations on the floor: by the true poses at one height, by the believed poses about five "
        "centimetres apart."
    ),
    "fusion": (
        "Signed distances of two stations along a row of voxels, both falling through zero near 4 m, and their mean."
    ),
    "measure-days": (
        "Thirteen metres of corridor from above: the map's walls cover the world's, but doors stand at other "
        "angles, and two people are in the world only."
    ),
    "break-one": (
        "Maps from one and from three stations over the room, from above: with one, pieces of wall behind the "
        "pillar and beside the cabinet are missing."
    ),
    "break-view": (
        "Depth images from one place in the room: the room, the map from one station with hatched holes, and the "
        "map from three."
    ),
    "break-scene": (
        "A room without ceiling, dark where the map is right; behind the pillar a bright strip stands in the air."
    ),
}
