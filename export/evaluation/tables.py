"""Markdown of the results."""

from __future__ import annotations

import math

from evaluation.tally import COLUMNS, DELTAS

SHOWN_DISTANCES = (1, 2, 3, 5, 8, 10, 15, 20, 25, 30)


def number(value: float) -> str:
    """Three digits, readable."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "-"
    if value and abs(value) < 1e-3:
        return f"{value:.0e}"
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def grid(head: list[str], rows: list[list[str]]) -> str:
    """A Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(lines + ["| " + " | ".join(cells) + " |" for cells in rows])


def core(result: dict) -> str:
    """One table a group."""
    head = ["keys every", "dance", *(title for _, title in COLUMNS)]
    parts = []
    for group in next(iter(result.values())):
        rows = [
            [f"{seconds} s", kind, *(number(values[name]) for name, _ in COLUMNS)]
            for seconds, groups in result.items()
            for kind, values in groups.get(group, {}).items()
        ]
        parts.append(f"**{group}**\n\n{grid(head, rows)}")
    return "\n\n".join(parts)


def by_distance(result: dict, group: str = "all") -> str:
    """Position error (and rotation error) against the distance to the nearest key."""
    rows = []
    for seconds, groups in result.items():
        for kind, values in groups[group].items():
            if kind == "real":
                continue
            curve = values["by_distance"]
            cells = []
            for distance in SHOWN_DISTANCES:
                if distance in curve["frames"]:
                    at = curve["frames"].index(distance)
                    cells.append(f"{curve['position_cm'][at]:.2f} ({curve['rotation_deg'][at]:.1f})")
                else:
                    cells.append("")
            rows.append([f"{seconds} s", kind, *cells])
    return grid(["keys every", "dance", *(f"{distance}" for distance in SHOWN_DISTANCES)], rows)


def paper_a(result: dict, seconds: str = "1", group: str = "all") -> str:
    """Table 5 of paper A: beat hit rate in percent; motion beats as minima and as the paper's extrema."""
    rows = []
    for kind, values in result[seconds][group].items():
        rows.append([kind, "minima", *(f"{100 * values[f'hit{delta}']:.1f}" for delta in DELTAS)])
        rows.append([kind, "extrema", *(f"{100 * share:.1f}" for share in values["hit_extrema"])])
    return grid(["dance", "motion beats", *(str(delta) for delta in DELTAS)], rows)


def endurance(result: dict) -> str:
    """Long dances without keys. Pose distance: Mahalanobis over sqrt(dimensions) to the training poses (joints, pelvis height)."""
    names = ("distance_first_minute", "distance_last_minute", "distance_largest", "freeze_s", "speed_first_minute", "speed_last_minute")
    rows = [
        [kind, song, *(number(figures[name]) for name in names)]
        for kind, songs in result.items()
        if isinstance(songs, dict)
        for song, figures in songs.items()
    ]
    head = ["dance", "song, looped", "pose distance, first minute", "last minute", "largest", "longest freeze, s"]
    head += ["speed, first minute, m/s", "last minute"]
    note = f"Real training frames: mean {result['real_mean']}, 95 % below {result['real_95']}. {result['minutes']:g} minutes each."
    return f"{note}\n\n{grid(head, rows)}"


def diversity(result: dict) -> str:
    """Distances between dances that differ in their seed only."""
    rows = [
        [f"{seconds} s", *(number(result[seconds][kind]) if kind in result[seconds] else "-" for kind in ("network", "shipped"))]
        for seconds in ("1", "2", "4")
        if seconds in result
    ]
    note = f"{result['seeds']} dances of {result['clip']}. Different real dances are {result['real, different dances']} cm apart."
    return f"{note}\n\n{grid(['keys every', 'network, other seed motions', 'shipped, other seeds at variation 1'], rows)}"
