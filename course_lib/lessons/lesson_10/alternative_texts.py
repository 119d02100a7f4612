"""What the pictures of lesson 10 show, for those who cannot see them: out of the visible cells, where they would tell
the answer."""

ALT = {
    "idea-picture": (
        "A hotel floor from above: three rooms over a corridor, 101 and 102 furnished alike. A camera walks along "
        "the corridor below 101; a dashed arrow carries it into 103, where it looks around."
    ),
    "carried-picture": (
        "Three panels over 30 frames. The error jumps to 6 m at the kidnapping and stays above 5 m. The score "
        "falls to 0.2 there and climbs back to nearly 0.6. The best weight goes up and down before and after."
    ),
    "free-picture": (
        "The hotel from above with 1500 random places. Free ones fill rooms and corridor; crosses lie near walls."
    ),
    "narrowing-scores-picture": (
        "The hotel from above, full of dots coloured by score. The twenty best have arrows; seven lie near the "
        "camera in 101 or near its double in 102, the others elsewhere in the three rooms."
    ),
    "kld-picture": (
        "Left: particles needed grow nearly as the occupied bins do; a smaller error needs more. Right: over the "
        "frames of a run bins fall from about a hundred to a few, and particles from 3000 to 100."
    ),
    "chance": (
        "Weight in the right room over ten frames for seven runs: they start between 0 and 0.5 and go to 0 or to 1."
    ),
    "search": (
        "Above: searching for three frames, then several, then found from frame 21 on. Below: evidence of the "
        "place in 101 and of its double in 102 are both near 1 until frame 20, when the double's falls and ends."
    ),
    "trade-off": (
        "Left: false alarms rise from 0 at a ratio of 0.7 to over 30 percent by the score alone, and stay 0 with "
        "the second condition. Right: the delay falls from two frames at 0.6 to one at most; below 0.6 comes no "
        "alarm."
    ),
    "break-alike-picture": (
        "The error jumps to 4 m at frame 8. The filter says tracked for 14 frames, then lost when the camera "
        "reaches the corridor, and is right again from frame 25 on."
    ),
    "break-door": (
        "The filter is right until frame 12, though it says lost in six frames; it searches in frames 13 to 15, "
        "and from frame 16 on it says tracked at 4 m from the truth."
    ),
}
