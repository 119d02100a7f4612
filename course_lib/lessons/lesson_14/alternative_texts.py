"""What the pictures of lesson 14 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "A triangle of the upper camera, the lower camera and a point. The baseline B is its left side; the ray d "
        "from the upper camera drops by the angle e_u, that from the lower camera by the smaller e_l."
    ),
    "places-picture": (
        "The room from above: the rig, pale markers where the map has the objects, and crosses where two boxes put"
        " them, most of them close to their markers."
    ),
    "ellipse": (
        "From above: a ray from the rig to the sofa, and around the sofa a needle along the ray. Drawn large: 400 "
        "dots, the ellipses of one and two sigma, and their two axes, along the ray and across it."
    ),
    "scene": (
        "Two cameras on one axis, rays to twelve objects, thin green ellipsoids that point at the rig, and black "
        "balls at the true places: near ones beside small ellipsoids, far ones inside long ones."
    ),
    "measure-growth": (
        "Sigma of the range over the range on logarithmic axes: three parallel straight lines, lower for longer "
        "baselines."
    ),
    "measure-both": (
        "Errors over the true range with boxes off by three pixels: box centres scatter by up to two metres beyond"
        " 4 m, features stay within about half a metre everywhere."
    ),
}
