"""What `demo rooms` prints of rooms that look alike: answers within half a metre and 10 degrees."""

from __future__ import annotations

from course_lib.experiments.look_alikes import KINDS, LARGEST_ERROR_M, LARGEST_TURN_DEG

HEAD = (
    f"  {'':24}{'n':>5}{'correct':>20}{'wrong':>18}{'unanswered':>20}{'all matches right':>22}"
    f"{'dx [m]':>9}{'dy [m]':>9}{'dtheta [deg]':>14}"
)


def answer_tables(answers: dict) -> str:
    """Shares in percent with Wilson's 95 % intervals; mean errors of the correct ones."""
    lines = [*_what_is_counted("both heights, from images"), *_group("One view", answers["one_view"])]
    if "several_views" in answers:
        lines += _several(answers)
        lines += _group("Half of all observations left out", answers["thinned_views"])
    for which, tables in answers.get("ablation", {}).items():
        lines += _group(f"Evidence switched off, {which.replace('_', ' ')}", tables)
    return "\n".join(lines)


def views_table(found: dict) -> str:
    """Several views alone: n_views and several_views of a summary."""
    return "\n".join([*_what_is_counted("both experiments, from images"), *_several(found)])


def _what_is_counted(of: str) -> list[str]:
    return [
        f"Answers [%]: correct within {LARGEST_ERROR_M:g} m and {LARGEST_TURN_DEG:g} degrees, wrong when given out and "
        f"not; {of};",
        "95 % intervals as if poses were independent; mean errors when correct",
    ]


def _several(found: dict) -> list[str]:
    return _group(f"{found['n_views']} views, consistent", found["several_views"])


def _group(title: str, tables: dict) -> list[str]:
    return ["", title, HEAD, *(_row(name, table) for name, table in tables.items())]


def _row(name: str, table: dict) -> str:
    shares = [_share(table, kind) for kind in KINDS]
    right = _share(table, "all_matches_right") if table["all_matches_right_percent"] is not None else "-"
    errors = [table[f"mean_{error}"] for error in ("dx_m", "dy_m", "dtheta_deg")]
    texts = ["-" if error is None else f"{error:.3f}" for error in errors]
    return (
        f"  {name.replace('_', ' '):24}{table['n']:5d}{shares[0]:>20}{shares[1]:>18}{shares[2]:>20}{right:>22}"
        f"{texts[0]:>9}{texts[1]:>9}{texts[2]:>14}"
    )


def _share(table: dict, kind: str) -> str:
    low, high = table[f"{kind}_wilson_percent"]
    return f"{table[f'{kind}_percent']:.1f} ({low:.1f}-{high:.1f})"
