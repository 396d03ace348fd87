"""The bars that the shipped model is held to, against what was measured."""

from __future__ import annotations

from dataclasses import dataclass

from evaluation.tables import grid, number

SHIPPED = "shipped at strength 1"
LOOSE = "shipped at strength 0"
NETWORK = "rollout"
# Of the mean pose distance, last minute against first: what counts as drift.
MOST_DRIFT = 1.25


@dataclass
class Bar:
    """One figure: what the page makes, and the network alone where that means something."""

    figure: str
    keys: str
    low: float | None
    high: float | None
    shipped: float | None
    network: float | None = None
    unit: str = ""

    def met(self, value: float | None) -> bool | None:
        """Whether a value is within the bar; None without a value."""
        if value is None or value != value:
            return None
        return (self.low is None or value >= self.low) and (self.high is None or value <= self.high)

    @property
    def text(self) -> str:
        if self.low is not None and self.high is not None:
            return f"{self.low:g} to {self.high:g}{self.unit}"
        return f">= {self.low:g}{self.unit}" if self.low is not None else f"<= {self.high:g}{self.unit}"

    def as_dict(self) -> dict:
        return {
            "figure": self.figure,
            "keys": self.keys,
            "bar": self.text,
            "shipped": self.shipped,
            "shipped_met": self.met(self.shipped),
            "network": self.network,
            "network_met": self.met(self.network),
        }


def bars(table: dict, long: dict | None) -> list[dict]:
    """The bars as far as they were measured: `table` as core_table gives it, `long` as endurance does."""
    found: list[Bar] = []
    for seconds, least in (("1", 15.0), ("2", 20.0)):
        if seconds in table:
            found += _with_keys(table[seconds]["all"], f"{seconds} s", least)
    if long:
        found += _without_keys(long)
    return [bar.as_dict() for bar in found]


def _with_keys(rows: dict, keys: str, least: float) -> list[Bar]:
    def of(kind: str, name: str) -> float | None:
        return rows[kind][name] if kind in rows else None

    def below_slerp(kind: str) -> float | None:
        return None if kind not in rows else 100 * (1 - rows[kind]["position_cm"] / rows["slerp"]["position_cm"])

    def hits(kind: str) -> float | None:
        return None if kind not in rows else rows[kind]["hit3"] / rows["real"]["hit3"]

    return [
        Bar("E_c at strength 0", keys, None, 0.03, of(LOOSE, "E_c"), of(NETWORK, "E_c")),
        Bar("E_c at strength 1", keys, None, 1e-6, of(SHIPPED, "E_c")),
        Bar("position error below SLERP", keys, least, None, below_slerp(SHIPPED), below_slerp(NETWORK), " %"),
        Bar("mean joint speed / real", keys, 0.85, 1.15, of(SHIPPED, "speed_ratio"), of(NETWORK, "speed_ratio")),
        Bar("jerk / real", keys, 0.7, 1.3, of(SHIPPED, "jerk_ratio"), of(NETWORK, "jerk_ratio")),
        Bar("beat hit rate, delta 3 / real", keys, 0.9, None, hits(SHIPPED), hits(NETWORK)),
        Bar("foot skate / real, after clean-up", keys, None, 1.0, of(SHIPPED, "skate_ratio")),
    ]


def _without_keys(long: dict) -> list[Bar]:
    def worst(kind: str, name: str) -> float | None:
        return max((figures[name] for figures in long[kind].values()), default=None) if kind in long else None

    page, network, keys = "shipped, fillers on", "network, no fillers", f"none, {long['minutes']:g} min"
    figures = (
        ("pose distance, last minute / first", None, MOST_DRIFT, "distance_ratio", ""),
        ("pose distance, last minute (bar: 95 % of real frames)", None, long["real_95"], "distance_last_minute", ""),
        ("longest freeze", None, 1.0, "freeze_s", " s"),
    )
    return [Bar(name, keys, low, high, worst(page, of), worst(network, of), unit) for name, low, high, of, unit in figures]


def markdown(found: list[dict]) -> str:
    """The table of bars."""
    said = {True: "yes", False: "**no**", None: "-"}
    rows = [
        [
            bar["figure"],
            bar["keys"],
            bar["bar"],
            number(bar["shipped"]),
            said[bar["shipped_met"]],
            number(bar["network"]),
            said[bar["network_met"]],
        ]
        for bar in found
    ]
    return grid(["figure", "keys every", "bar", "value, as shipped", "met", "value, network alone", "met"], rows)
