"""Tables of pages, by their names. What was measured is read from bench/results/."""

import json
import re
import tomllib
from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path
from typing import Any

from yehu_server.live.osc.status import PART_STATUS, STATUS
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.spec import Place
from yehu_server.params.table import TABLE, offered
from yehu_server.playing.mapping import load
from yehu_server.scores.gesture import CONTROLS

ROOT = Path(__file__).resolve().parents[2]
ALL_STATUS = {row.name: row.doc for row in STATUS}


def table(head: str, rows: Iterable[Iterable[str]]) -> str:
    titles = head.split(", ")
    lines = [titles, *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    head, *rest = [f"| {' | '.join(line)} |" for line in lines]
    return "\n".join([head, "|" + "---|" * len(titles), *rest])


def layers() -> str:
    """The layers of pyproject.toml, with what the docstring of each package says it is for."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        contract = tomllib.load(file)["tool"]["importlinter"]["contracts"][0]
    rows = [["`yehu_lab`", purpose("yehu_lab")]]
    for layer in contract["layers"]:
        names = re.findall(r"\w+", layer)
        if "(" in layer:  # no layer of its own
            continue
        words = " ".join(purpose(f"yehu_server.{name}") for name in names)
        rows.append([", ".join(f"`{name}`" for name in names), words])
    return table("layer, what it is for", rows)


def purpose(module: str) -> str:
    """What a module is for, by the first paragraph of its docstring."""
    doc = import_module(module).__doc__ or ""
    return " ".join(doc.split("\n\n")[0].split()).replace("``", "`")


def parameters(place: Place) -> str:
    return table(
        "address, symbol, range, default, what",
        (
            [f"`{row.address}`", row.symbol, offered(row).range_text, f"{row.default:g}", row.doc]
            for row in TABLE
            if row.place is place and not re.match("/finger/[2-9]/", row.address)
        ),
    )


def articulations() -> str:
    """The table of articulations, with the keys of the mapping that has key switches."""
    first = load("keyboard-articulations").key_switches or 0
    return table(
        "number, key (MIDI), name, 中文, what both hands do",
        (
            [
                str(number),
                f"{name_of(first + number)} ({first + number})",
                f"`{row.name}`",
                row.chinese,
                row.about,
            ]
            for number, row in enumerate(ARTICULATIONS)
        ),
    )


def name_of(key: int) -> str:
    """The name of a key (MIDI note); 60 is C4."""
    names = ["C", "C♯", "D", "D♯", "E", "F", "F♯", "G", "G♯", "A", "A♯", "B"]
    return f"{names[key % 12]}{key // 12 - 1}"


def measured(name: str) -> dict[str, Any]:
    """The figures that a program of bench/ saved."""
    text = (ROOT / "bench" / "results" / f"{name}.json").read_text(encoding="utf-8")
    found: dict[str, Any] = json.loads(text)["figures"]
    return found


def to(low: float, high: float, form: str) -> str:
    return f"{low:{form}} to {high:{form}}"


def ratios() -> str:
    return table(
        "of, plain C++ over ours, range, ours: times real time, plain C++: times real time",
        (
            [
                name,
                f"{row['median']:.2f}",
                to(row["from"], row["to"], ".2f"),
                f"{row['ours, x real time']:.0f}",
                f"{row['plain C++, x real time']:.0f}",
            ]
            for name, row in measured("run")["ratios"].items()
        ),
    )


def kernels() -> str:
    return table(
        "of, times real time, range",
        (
            [name, f"{row['median']:.0f}", to(row["from"], row["to"], ".0f")]
            for name, row in measured("run")["kernels"].items()
        ),
    )


def budget() -> str:
    return table(
        "row, ns a frame, adds",
        (
            [
                name,
                f"{row['ns a frame']:.0f}",
                to(row["adds, from"], row["adds, to"], ".0f") if "adds" in row else "",
            ]
            for name, row in measured("budget").items()
        ),
    )


FOLLOWED = ("RPA", "RCA", "within 10 cents", "octave errors", "onsets F1", "level")
FOLLOWED_AGAIN = ("within 5 cents", "within 10 cents", "onsets F1", "level")


def followed() -> str:
    """How well sounds are followed: the plain ones, and those with the loudest noise."""
    rows = measured("following")
    head = "sound, pitch, chroma, within 10 cents, wrong octave, onsets, level"
    return table(
        head,
        (
            [name, *(f"{100.0 * row[each]:.1f} %" for each in FOLLOWED[:4])]
            + [f"{row[each]:.2f}" for each in FOLLOWED[4:]]
            for name, row in rows.items()
            if "RPA" in row and name.endswith(("plain", "noise, 10 dB"))
        ),
    )


def followed_again() -> str:
    return table(
        "sound, within 5 cents, within 10 cents, median, later, onsets, level",
        (
            [
                name.partition(",")[0],
                *(f"{100.0 * row[each]:.0f} %" for each in FOLLOWED_AGAIN[:2]),
                f"{row['median, cents']:.1f} cents",
                f"{row['later, ms']:.0f} ms",
                *(f"{row[each]:.2f}" for each in FOLLOWED_AGAIN[2:]),
            ]
            for name, row in measured("following").items()
            if "later, ms" in row
        ),
    )


def followed_live() -> str:
    return table(
        "sound, pitch, within 10 cents, wrong octave, for at most, later, onsets",
        (
            [
                name,
                *(f"{100.0 * row[each]:.1f} %" for each in ("RPA", "within 10 cents")),
                f"{100.0 * row['octave errors']:.1f} %",
                f"{row['longest, ms']:.0f} ms",
                f"{row['later, ms']:.0f} ms",
                f"{row['onsets F1']:.2f}",
            ]
            for name, row in measured("following_live")["heard"].items()
            if name.endswith("plain")
        ),
    )


def followed_soon() -> str:
    parts, shares = ("bow", "heard", "half"), ("median", "95 %")
    columns = [f"{part}, {share}" for part in parts for share in shares]
    return table(
        "sung to, bow: median, 95 %, heard: median, 95 %, half as loud: median, 95 %",
        (
            [name, *(f"{row[column]:.0f} ms" for column in columns)]
            for name, row in measured("following_live")["soon"].items()
        ),
    )


TABLES: dict[str, Callable[[], str]] = {
    "layers": layers,
    "parameters-of-the-player": lambda: parameters(Place.PLAYER),
    "parameters-of-the-engine": lambda: parameters(Place.ENGINE),
    "status": lambda: table("name, what", ([f"`{row.name}`", row.doc] for row in STATUS)),
    "status-of-a-part": lambda: table(
        "of a part, what",
        (
            [f"`{row.name}`", row.doc if ALL_STATUS.get(row.name) != row.doc else "as above"]
            for row in PART_STATUS
        ),
    ),
    "articulations": articulations,
    "ratios": ratios,
    "kernels": kernels,
    "budget": budget,
    "followed": followed,
    "followed-again": followed_again,
    "followed-live": followed_live,
    "followed-soon": followed_soon,
    "controls-of-gestures": lambda: table(
        "control, unit, range, default, what",
        (
            [f"`{name}`", row.unit, f"{row.lo:g} to {row.hi:g}", f"{row.default:g}", row.doc]
            for name, row in CONTROLS.items()
        ),
    ),
}
