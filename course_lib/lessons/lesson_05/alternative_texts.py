"""What the pictures of lesson 05 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "The corridor from above, three times: a cloud of 200 particles after 1, 5 and 20 frames, wider every time."
    ),
    "bayes-picture": (
        "Probabilities of 20 cells: five equal peaks at the doors; moved on by one cell and blurred, with the "
        "shares of 200 particles scattered about them; one cell with 0.35 after the fourth look."
    ),
    "scene": (
        "Two clouds of arrowheads in a corridor: a small black one, all nearly alike, and a blue one that is "
        "metres long, not quite one wide, flat as a sheet of paper, with headings that fan out."
    ),
    "spread-picture": "Spread over 100 frames: 2000 particles follow the root of t, ten particles stray from it.",
    "measure-trade-picture": (
        "Distance to the nearest particle over sigma: metres below 0.035 m, a minimum near 0.07 m, then a steady rise."
    ),
    "break-corner-picture": (
        "A wagon turns left into a side corridor; noise along world axes falls behind, along its own axes it follows."
    ),
}
