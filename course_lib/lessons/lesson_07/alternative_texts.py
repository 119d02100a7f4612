"""What the pictures of lesson 07 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-circle": (
        "A circle with four headings on its left; the mean of the numbers points right, that on the circle left."
    ),
    "idea-comb": (
        "A strip of six fields; points: systematic evenly spaced, stratified one in each sixth, multinomial anywhere."
    ),
    "scene": "Fifty arrows close together at the corridor's wall; above five of them stand stacks of copies.",
    "measure-rounds": (
        "Different particles over 100 rounds: three schemes stay at 64, multinomial falls below 10 quickly."
    ),
    "break-filterpy": (
        "Mean copies of ten particles: course_lib meets N w everywhere; filterpy gives the two heavy ones 4 to 6 "
        "copies and the eight light ones none."
    ),
    "break-hypotheses": (
        "Two beliefs: the particles are in three heaps at the doors, then in one at 4 m; the bell stays wide."
    ),
}
