"""Write the tables of docs/playability.md, from the kept maps."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from maps import NEVER, Maps, bands, median, slope, usual

from yehu_server.playing.pitch_and_level import note_name

Array = Any

STRINGS = ("F4 string", "C5 string")
SOON, PERFECT = 20, 5  # periods
FAST = 3.0  # m/s^2
BETA, NEAR = 0.13, 4  # where forces are compared, and cells about it
PAGE = Path(__file__).resolve().parents[2] / "docs" / "playability.md"
VALIDATION = Path(__file__).resolve().parents[1] / "validation" / "results.json"
MARK = "<!-- table {name} -->"


def write_tables(found: Mapping[str, Sequence[Maps]]) -> None:
    """Write all tables that come of the maps."""
    errors = Errors.of(found["repeats"])
    write_table("strokes", strokes(found))
    write_table("schelleng", [*schelleng(found["schelleng"]), *errors.rows(3)])
    write_table("notes", [*notes(found["schelleng"], found["guettler"]), *errors.rows(9)])
    write_table("guettler", guettler(found["guettler"]))
    write_table("repeats", repeats(found["repeats"]))
    write_table("speeds", speeds(found["speeds"]))


@dataclass(frozen=True)
class Errors:
    """Error bars of a map's share of Helmholtz motion (points), and of its cells (share).

    Those of the sample rate are of the four notes of docs/validation.md, 352.8 kHz in place of
    44.1; that of the hair is the larger deviation of the maps made again with other bows.
    """

    by_rate: float
    by_rate_at_most: float
    by_hair: float
    cells: float

    @classmethod
    def of(cls, repeated: Sequence[Maps]) -> Errors:
        """The errors, by the measurements that are kept."""
        notes = json.loads(VALIDATION.read_text("utf-8"))["convergence"].values()
        maps = [{row["map"]: row for row in rows} for rows in notes]
        shares = [
            100.0 * abs(found["rate 44100"]["helmholtz"] - found["rate 352800"]["helmholtz"])
            for found in maps
        ]
        hair = max(100.0 * each.helmholtz.mean(axis=(1, 2)).std(ddof=1) for each in repeated)
        cells = 1.0 - np.mean([found["rate 44100"]["same"] for found in maps])
        return cls(float(np.mean(shares)), max(shares), float(hair), float(cells))

    @property
    def text(self) -> str:
        """The errors in a line."""
        return (
            f"error of a share of Helmholtz motion: ± {self.by_rate:.1f} points by the sample rate "
            f"(at most {self.by_rate_at_most:.1f}), ± {self.by_hair:.1f} by other hair; at another "
            f"rate {self.cells:.0%} of cells are of another regime"
        )

    def rows(self, columns: int) -> list[str]:
        """Rows for the end of a table whose shares of Helmholtz motion are in the second column."""
        told = (
            ("error of a share, by the sample rate", f"± {self.by_rate:.1f} points"),
            ("error of a share, by other hair", f"± {self.by_hair:.1f} points"),
        )
        return table([], [[name, bar, *[""] * (columns - 2)] for name, bar in told])[2:]


def write_table(name: str, rows: Sequence[str]) -> None:
    """Replace the table of the page that stands between two marks of its name."""
    mark = MARK.format(name=name)
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(mark)
    text = "\n".join([before + mark, *rows, mark]) + rest.partition(mark)[2]
    PAGE.write_text(text, encoding="utf-8")


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return ["| " + " | ".join(line) + " |" for line in lines]


def named(note: float, string: int) -> str:
    """A note, and the string (0 or 1) that it is on."""
    return f"{note_name(float(note))}, {STRINGS[string][:2]}".replace("#", "♯")


def strokes(found: Mapping[str, Sequence[Maps]]) -> list[str]:
    """How many strokes there are of each study."""
    rows = []
    for kind, both in found.items():
        for maps in both:
            shape = " x ".join(str(length) for length in maps.regime.shape)
            about = maps.facts["about"]
            rows.append([kind, about, f"{maps.facts['strokes']:,}", shape])
    total = sum(maps.facts["strokes"] for both in found.values() for maps in both)
    faults = sum(maps.facts["faults"] for both in found.values() for maps in both)
    rows.append(["all", f"{faults} of them with a numerical fault", f"{total:,}", ""])
    return table(["study", "what", "strokes", "finest grid"], rows)


def schelleng(both: Sequence[Maps]) -> list[str]:
    """What Schelleng's diagrams say of each string."""
    rows: list[list[str]] = []
    columns = []
    for maps in both:
        hit, inside, near = maps.helmholtz, maps.inside, usual(maps)
        least, greatest = bands(maps)
        low, high = (least / maps.lower)[:, near], (greatest / maps.upper)[:, near]
        at = maps.places[near]
        columns.append([
            f"{100 * hit.mean():.1f} %",
            f"{100 * hit[inside].mean():.1f} %",
            f"{100 * hit[~inside].mean():.1f} %",
            f"{100 * (hit == inside).mean():.1f} %",
            f"{np.nanmedian(low):.2f}",
            f"{np.nanmedian(high):.2f}",
            f"{np.nanmedian([slope(at, row) for row in least[:, near]]):.2f}",
            f"{np.nanmedian([slope(at, row) for row in greatest[:, near]]):.2f}",
            *correlations(maps, least),
        ])  # fmt: skip
    words = (
        "Helmholtz motion, share of the map",
        "of what lies between the limits",
        "of what lies beyond them",
        "cells where map and limits agree",
        "least force over its limit, median",
        "greatest force over its limit, median",
        "least force goes as β to the power of (theory: -2)",
        "greatest force goes as β to the power of (theory: -1)",
        "least force and its limit over the notes at β = 0.13: correlation of logarithms",
        "their distance: spread over the notes, dB",
    )
    for i, word in enumerate(words):
        rows.append([word, *(column[i] for column in columns)])
    return table(["", *STRINGS[: len(both)]], rows)


def correlations(maps: Maps, least: Array) -> list[str]:
    """How the measured least force follows its limit from note to note."""
    at = int(np.abs(np.log(maps.places / BETA)).argmin())
    middle = median(least[:, max(0, at - NEAR) : at + NEAR + 1])
    known = np.isfinite(middle)
    limit = maps.lower[known, at]
    r = np.corrcoef(np.log(middle[known]), np.log(limit))[0, 1]
    return [f"{r:.2f}", f"{20 * np.log10(middle[known] / limit).std():.1f}"]


def notes(both: Sequence[Maps], guettlers: Sequence[Maps]) -> list[str]:
    """What the maps say of each note."""
    rows = []
    for k, (maps, starts) in enumerate(zip(both, guettlers, strict=True)):
        least, greatest = bands(maps)
        at = int(np.abs(np.log(maps.places / BETA)).argmin())
        near = slice(max(0, at - NEAR), at + NEAR + 1)
        low, high = median(least[:, near]), median(greatest[:, near])
        for i, note in enumerate(maps.notes):
            own = maps.helmholtz[i]
            rows.append([
                named(note, k),
                f"{100 * own.mean():.0f}",
                f"{100 * own[maps.inside[i]].mean():.0f}",
                number(low[i]), number(maps.lower[i, at]),
                number(high[i]), number(maps.upper[i, at]),
                f"{100 * (starts.periods[i] <= SOON).mean():.0f}",
                f"{100 * (starts.periods[i] <= PERFECT).mean():.0f}",
            ])  # fmt: skip
    head = ["note", "Helmholtz, %", "within limits, %", "least, N", "limit", "greatest, N", "limit",
            f"within {SOON} periods, %", f"within {PERFECT}, %"]  # fmt: skip
    return table(head, rows)


def number(value: float) -> str:
    return f"{value:.2g}" if np.isfinite(value) else "off the map"


def guettler(both: Sequence[Maps]) -> list[str]:
    """What Guettler's diagrams say of each string."""
    words = (
        "Helmholtz motion at the end, share of the map",
        f"begun within {SOON} periods",
        f"begun within {PERFECT} periods",
        "least force for that many goes as the acceleration to the power of, above 3 m/s²",
    )
    columns = [
        [
            f"{100 * (maps.periods != NEVER).mean():.1f} %",
            f"{100 * (maps.periods <= SOON).mean():.1f} %",
            f"{100 * (maps.periods <= PERFECT).mean():.1f} %",
            f"{np.nanmedian([rise(maps, i) for i in range(len(maps.notes))]):.2f}",
        ]
        for maps in both
    ]
    rows = [[word, *(column[i] for column in columns)] for i, word in enumerate(words)]
    return table(["", *STRINGS[: len(both)]], rows)


def rise(maps: Maps, i: int) -> float:
    """The exponent by which the least force grows with the acceleration; NaN for few."""
    quick = maps.periods[i] <= SOON
    least = np.array([
        maps.forces[np.flatnonzero(column)[0]] if column.sum() >= PERFECT else np.nan
        for column in quick.T
    ])  # fmt: skip
    fast = maps.places >= FAST
    return slope(maps.places[fast], least[fast])


def repeats(both: Sequence[Maps]) -> list[str]:
    """How far sixteen bows agree."""
    rows = []
    for maps in both:
        share = maps.helmholtz.mean(axis=0)
        areas = 100 * maps.helmholtz.mean(axis=(1, 2))
        count = len(maps.notes)
        pairs = [(maps.regime[a] == maps.regime[b]).mean() for a in range(count) for b in range(a)]
        same = (maps.regime == maps.regime[:1]).all(axis=0)
        rows.append([
            maps.facts["about"].rpartition(", ")[2].replace("#", "♯"),
            f"{100 * ((share == 0) | (share == 1)).mean():.1f} %",
            f"{100 * same.mean():.1f} %",
            f"{100 * np.mean(pairs):.1f} %",
            f"{areas.mean():.1f} ± {areas.std(ddof=1):.1f} %",
        ])  # fmt: skip
    head = ["note", "all agree on Helmholtz or not", "all agree on the regime", "two agree on it",
            "Helmholtz motion: mean and standard deviation"]  # fmt: skip
    return table(head, rows)


def speeds(both: Sequence[Maps]) -> list[str]:
    """How least and greatest force go with the speed of the bow."""
    rows = []
    for maps, string in zip(both, STRINGS, strict=False):
        least, greatest = bands(maps)
        low = np.nanmedian([slope(maps.places, row) for row in least])
        high = np.nanmedian([slope(maps.places, row) for row in greatest])
        area = 100 * maps.helmholtz.mean()
        rows.append([string, f"{area:.1f} %", f"{low:.2f}", f"{high:.2f}"])
    head = [
        "",
        "Helmholtz motion",
        "least force goes as speed to the power of",
        "greatest (theory: 1, 1)",
    ]
    return table(head, rows)
