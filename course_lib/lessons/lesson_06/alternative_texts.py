"""What the pictures of lesson 06 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "The measured image of a corridor with two people; the terms of particle A are bright except on the people"
        " and far away; those of particle B are dark nearly everywhere."
    ),
    "betas": "Weight over normalized likelihood for four beta: the smaller beta, the later and steeper the rise to 1.",
    "scene": (
        "A flat cloud of 200 arrowheads about the axes of the true pose: most are dark; the bright ones look the "
        "way the truth looks, and stand within a decimetre or two of it along the corridor."
    ),
    "costs": "Cost over difference: the Gaussian's parabola leaves the picture; the other two level off near 1.",
    "profiles": (
        "Six plots, one for each axis: the paper's form has the narrowest peak at the truth, half-normal and "
        "disparity wider ones, and the Gaussian is ragged, with its highest place elsewhere on all axes but roll."
    ),
}
