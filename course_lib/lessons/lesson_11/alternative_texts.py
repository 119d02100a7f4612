"""What the pictures of lesson 11 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "Left, an equirectangular image of a room; right, the same picture inside a sphere. Four points lie on both."
    ),
    "view-picture": (
        "Three flat views out of one panorama: ahead, left, behind. Behind, the sofa that the seam cuts is whole."
    ),
    "bearings": (
        "Azimuth of the box centres over the azimuth by map and true pose: all points lie close to the diagonal."
    ),
    "break-mean": "Panorama with the sofa's box in two pieces at the edges; the mean of its columns lies in mid image.",
}
