"""The tables of bench/results/validation.md, and of docs/validation.md."""

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from validation import monochord
from validation.ideal import exponent

ROOT = Path(__file__).resolve().parents[2]
PAGES = (ROOT / "bench" / "results" / "validation.md", ROOT / "docs" / "validation.md")
FINEST = "rate 352800"
KINDS = {
    "rate 44100": "44.1 kHz",
    "rate 88200": "88.2 kHz",
    "rate 176400": "176.4 kHz",
    "rate 352800": "352.8 kHz",
    "soft 44100": "44.1 kHz, bristles an eighth as stiff",
}


def page(text: str, found: Mapping[str, Any]) -> str:
    """A page with its tables as they were measured."""
    made = {
        "helmholtz": helmholtz(found["ideal"]),
        "limits": limits(found["ideal"]),
        "convergence": convergence(found["convergence"]),
        "bars": bars(found["convergence"]),
        "energy": energy(found["energy"]),
        "laws": laws(found["laws"]),
        "published": published(found["published"]),
        "monochord": monochord_strokes(found["monochord"]),
    }
    for name, rows in made.items():
        pattern = re.compile(rf"(<!-- (?:table|measured) {name} -->\n).*?(?=\1)", re.DOTALL)
        text = pattern.sub(lambda found: "\n".join([found[1] + rows[0], *rows[1:], ""]), text)  # noqa: B023
    return text


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """A table in Markdown."""
    lines = [list(head), ["---"] * len(head), *map(list, rows)]
    return [f"| {' | '.join(line)} |" for line in lines]


def helmholtz(found: Mapping[str, Any]) -> list[str]:
    """A steady note on rigid ends, against Helmholtz's motion."""
    head = ["β", "slips a period", "share of slipping, over β", "slipping velocity, over v/β"]
    rows = [
        [
            f"{row['beta']:.3f}",
            f"{row['slips']:.2f}",
            f"{row['slip_share']:.3f}",
            f"{row['slip_velocity']:.3f}",
            f"{row['sawtooth']:.3f}",
        ]
        for row in found["helmholtz"]
    ]
    return table([*head, "sawtooth at the bridge, over 2 Z v/β"], rows)


def limits(found: Mapping[str, Any]) -> list[str]:
    """Where Helmholtz motion ends, against Schelleng's limits."""
    head = ["β", "least force, N", "over its limit", "μ reached", "greatest force, N"]
    rows = [
        [
            f"{least['beta']:.3f}",
            f"{least['limit']:.3f}",
            f"{least['limit'] / least['schelleng']:.2f}",
            f"{least['reached']:.2f}",
            *(
                ["over", "10", ""]  # where the force of the ramp ended
                if math.isnan(great["limit"])
                else [
                    f"{great['limit']:.2f}",
                    f"{great['limit'] / great['schelleng']:.2f}",
                    f"{great['reached']:.2f}",
                ]
            ),
        ]
        for least, great in zip(found["least"], found["greatest"], strict=True)
    ]
    rows.append(["power of β", f"{exponents(found, 'least'):.2f} (theory: -2)", *[""] * 5])
    return table([*head, "over its limit", "μ reached"], rows)


def exponents(found: Mapping[str, Any], name: str) -> float:
    """The power of beta by which the forces at a limit go."""
    return exponent(*([row[key] for row in found[name]] for key in ("beta", "limit")))


def convergence(found: Mapping[str, Any]) -> list[str]:
    """What a map is at each rate, and how far it is from that at 352.8 kHz."""
    head = ["note", "at", "Helmholtz", "aperiodic", "cells alike", "pitch, cents", "onset, ms"]
    rows = [
        [
            note if place == 0 else "",
            KINDS[row["map"]],
            f"{row['helmholtz']:.1%}",
            f"{row['aperiodic']:.1%}",
            *([""] * 3 if row["map"] == FINEST else _against_finest(row)),
        ]
        for note, maps in found.items()
        for place, row in enumerate(each for each in maps if each["map"] in KINDS)
    ]
    return table(head, rows)


def _against_finest(row: Mapping[str, Any]) -> list[str]:
    return [
        f"{row['same']:.0%}",
        f"{row['cents']:+.1f} (90 % within {row['cents_90']:.0f})",
        f"{row['onset_ms']:+.1f} (90 % within {row['onset_ms_90']:.0f})",
    ]


def bars(found: Mapping[str, Any]) -> list[str]:
    """Error bars of a map at 44.1 kHz: of rate, grid and hair."""
    rows = []
    for what, name, of in (
        ("sample rate: 352.8 kHz in place of 44.1", "rate", ("rate 44100",)),
        ("grid: three other numbers of nodes at 44.1 kHz", "grid", None),
        ("hair: three others, rough as the player's, at 44.1 kHz", "seed", None),
    ):
        all_of = [
            [
                row
                for row in maps
                if row["map"].startswith(name) and row["map"] in (of or [row["map"]])
            ]
            for maps in found.values()
        ]
        plain = [next(row for row in maps if row["map"] == "rate 44100") for maps in found.values()]
        finest = [next(r for r in maps if r["map"] == "rate 352800") for maps in found.values()]
        shares = [
            abs(row["helmholtz"] - (finest[i] if name == "rate" else plain[i])["helmholtz"])
            for i, each in enumerate(all_of)
            for row in each
        ]
        other = [1.0 - row["same"] for each in all_of for row in each]
        cents = [abs(row["cents"]) for each in all_of for row in each]
        wide = [row["cents_90"] for each in all_of for row in each]
        onset = [row["onset_ms_90"] for each in all_of for row in each]
        rows.append(
            [
                what,
                f"{np.mean(other):.0%} ({min(other):.0%} to {max(other):.0%})",
                f"{100.0 * np.mean(shares):.1f} points, at most {100.0 * max(shares):.1f}",
                f"{np.mean(cents):.1f}, 90 % within {np.mean(wide):.0f}",
                f"90 % within {np.mean(onset):.0f}",
            ]
        )
    head = ["changed", "cells of another regime", "share of Helmholtz motion", "pitch, cents"]
    return table([*head, "onset, ms"], rows)


def energy(found: Sequence[Mapping[str, Any]]) -> list[str]:
    """The worst energy error of ten seconds."""
    rows = [
        [
            f"{row['rate'] / 1e3:g} kHz",
            row["kind"],
            str(row["runs"]),
            f"{row['worst_w']:.1e} W",
            f"{row['median_w']:.1e} W",
            f"{row['power_w']:.1f} W",
        ]
        for row in found
    ]
    return table(["rate", "playing", "runs", "worst", "median", "greatest power"], rows)


def laws(found: Sequence[Mapping[str, Any]]) -> list[str]:
    """What maps are like with each law of friction."""

    def known(text: str) -> str:
        return "" if "nan" in text else text

    rows = [
        [
            row["note"],
            row["law"],
            f"{row['helmholtz']:.1%}",
            f"{row['aperiodic']:.1%}",
            f"{row['same']:.0%}",
            known(f"{row['least']:.2f} to {row['greatest']:.2g}"),
            known(f"{row['flatter']:.0f}"),
            known(f"{row['cents']:+.1f}"),
            known(f"{row['brighter'] - 1.0:+.0%}"),
            known(f"{row['onset_ms']:.0f}"),
        ]
        for row in found
    ]
    head = ["note", "law", "Helmholtz", "aperiodic", "cells alike", "force at β = 0.13, N"]
    head += ["flattening, cents", "pitch, cents", "centroid", "onset, ms"]
    return table(head, rows)


def published(found: Mapping[str, Any]) -> list[str]:
    """How far the published scale is, by what is changed here."""
    rows = [
        [
            row["changed"],
            f"{row['r']:.2f}",
            f"{row['own']:.1f}",
            f"{row['common']:.1f}",
            f"{row['common_median']:.1f}",
        ]
        for row in found["changes"]
    ]
    saw = found["sawtooth"]
    rows.append(["a sawtooth, no model", "", "", f"{saw['rms']:.1f}", f"{saw['median']:.1f}"])
    head = ["changed", "r of levels", "rms by our filter, dB", "rms by a common filter"]
    return table([*head, "its median"], rows)


def monochord_strokes(found: Mapping[str, Any]) -> list[str]:
    """Guettler's wedge, and Helmholtz motion at beta = 0.1, as measured and here."""

    def wedge(each: monochord.Wedge) -> list[str]:
        needed = [each.at_zero + each.slope * acceleration for acceleration in (1.0, 2.0)]
        line = f"{each.slope:.2f} a + {each.at_zero:.2f}"
        return [line, *(f"{force:.1f}" for force in needed), f"{each.share:.0%}"]

    def ends(row: str) -> str:
        forces = monochord.SWEPT[[mark == "#" for mark in row]]
        if not len(forces):
            return "none"
        top = f"over {forces[-1]:.0f}" if row.endswith("#") else f"{forces[-1]:.1f}"
        return f"{forces[0]:.2f} to {top}, {row.count('#') / len(row):.0%}"

    least, greatest = monochord.MEASURED_LEAST, monochord.MEASURED_GREATEST
    seen = [f"from {least[0]}", f"{least[1]} to {greatest}", f"from {least[2]}"]
    rows = [
        [f"measured, string {name}", *wedge(each), *(seen if name == "A" else [""] * 3)]
        for name, each in monochord.MEASURED.items()
    ]
    rows += [
        [name, *wedge(monochord.Wedge(**each["wedge"])), *map(ends, each["helmholtz"])]
        for name, each in found.items()
    ]
    head = ["", "least force, N", "at 1 m/s²", "at 2 m/s²", "begin soon"]
    return table([*head, *(f"Helmholtz at {speed:g} m/s" for speed in monochord.SPEEDS)], rows)
