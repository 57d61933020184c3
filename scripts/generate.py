"""Write what pages and modules take from other code: tables, figures in prose, types of records.

    .venv/bin/python scripts/generate.py

In a page, a table stands between `<!-- table NAME -->` and `<!-- end -->`. A figure of a sentence
stands behind `<!--=CONSTANT-->` or `<!--=CONSTANT:UNIT-->`: a constant by its path in yehu_server,
such as `playing.delay.HANDLING_MS`, in a unit of UNITS where that is another than its own. What was
measured is read from bench/results/.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.physics import layout
from yehu_server.core.physics.power import TABLES as POWER_TABLES
from yehu_server.live.osc.status import PART_STATUS, STATUS
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.spec import Place
from yehu_server.params.table import TABLE
from yehu_server.playing.mapping import load
from yehu_server.scores.gesture import CONTROLS

ROOT = Path(__file__).resolve().parent.parent
PAGES = ("*.md", "docs/**/*.md", "mappings/*.md", "presets/*.md", "tunings/*.md")
RECORDS = ROOT / "yehu_server" / "core" / "physics" / "records.py"
UNITS: dict[str, Callable[[float], float]] = {
    "kB": lambda value: value / 1024,
    "MB": lambda value: value / 1024**2,
    "ms": lambda value: 1e3 * value,
    "percent": lambda value: 100.0 * value,
    "a_second": lambda value: 1.0 / value,
    "part": lambda value: 1.0 / value,
}
_TABLE = re.compile(r"(<!-- table ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
_FIGURE = re.compile(r"(<!--=([\w.]+?)\.(\w+)(?::(\w+))?-->)(?:\d[\d,.]*\d|\d)?")

# ---------------------------------------------------------------- pages


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
            [f"`{row.address}`", row.symbol, row.range_text, f"{row.default:g}", row.doc]
            for row in TABLE
            if row.place is place
        ),
    )


def articulations() -> str:
    """The table of articulations, with the keys of the mapping that has key switches."""
    first = load("keyboard-articulations").key_switches or 0
    return table(
        "number, key, name, 中文, what both hands do, from",
        (
            [
                str(number),
                name_of(first + number),
                f"`{row.name}`",
                row.chinese,
                row.about,
                row.source,
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


FIGURES: dict[str, tuple[str, str]] = {
    "rise": ("rise", "ms"), "lasts": ("lasts", "ms"), "sounds": ("sounds", "% of the note"),
    "strokes": ("strokes", ""), "stroke_rate": ("strokes", "a second"),
    "dip": ("between strokes", "dB down"), "begins": ("begins", "semitones"),
    "ends": ("ends", "semitones"), "low": ("lowest", "semitones"),
    "high": ("highest", "semitones"), "arrives": ("on its pitch after", "ms"),
    "beats": ("beats", ""), "beat_rate": ("beats", "a second"), "width": ("width", "cents"),
    "swell": ("swells by", "dB"), "loudest": ("loudest at", "of the note"),
    "fade": ("fades by", "dB"),
}  # fmt: skip


def articulations_heard() -> str:
    """What scripts/articulations.py heard of each articulation, beside what is stated."""
    rows = []
    for name, row in measured("articulations").items():
        heard, stated = [], []
        for key, each in row["figures"].items():
            words, unit = FIGURES[key]
            heard.append(f"{words} {to(each['from'], each['to'], '.3g')} {unit}".strip())
            low, high, _ = each["stated"]
            stated.append(to(low, high, "g"))
        wrong = f"{row['wrong']} of {row['notes']}"
        rows.append([f"`{name}`", "; ".join(heard), ", ".join(stated), row["source"], wrong])
    return table("name, heard: medians of tempi and dynamics, stated, from, wrong notes", rows)


FOLLOWED = ("RPA", "RCA", "within 10 cents", "octave errors", "onsets F1", "level")
FOLLOWED_AGAIN = ("within 5 cents", "within 10 cents", "onsets F1", "level")


def followed() -> str:
    """How well sounds are followed, from bench/results/following.json."""
    rows = measured("following")
    head = "sound, pitch, chroma, within 10 cents, wrong octave, onsets, level"
    return table(
        head,
        (
            [name, *(f"{100.0 * row[each]:.1f} %" for each in FOLLOWED[:4])]
            + [f"{row[each]:.2f}" for each in FOLLOWED[4:]]
            for name, row in rows.items()
            if "RPA" in row
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


MADE: dict[str, Callable[[], str]] = {
    "layers": layers,
    "parameters-of-the-player": lambda: parameters(Place.PLAYER),
    "parameters-of-the-engine": lambda: parameters(Place.ENGINE),
    "status": lambda: table("name, what", ([f"`{row.name}`", row.doc] for row in STATUS)),
    "status-of-a-part": lambda: table(
        "of a part, what", ([f"`{row.name}`", row.doc] for row in PART_STATUS)
    ),
    "articulations": articulations,
    "articulations-heard": articulations_heard,
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


def figure(module: str, name: str, unit: str | None) -> str:
    value = getattr(import_module(f"yehu_server.{module}"), name)
    if unit:
        value = UNITS[unit](value)
    return f"{value:,.10g}" if value >= 10000 else f"{value:.10g}"


def page(text: str) -> str:
    """Return a page with the tables and figures that the code has now."""
    if lost := re.search(r"^\s*<!--=.*", text, re.MULTILINE):
        raise ValueError(f"{lost[0]}: at the start of a line, Markdown ends the paragraph there")
    text = _TABLE.sub(lambda found: f"{found[1]}\n{MADE[found[2]]()}\n\n{found[3]}", text)
    return _FIGURE.sub(lambda found: found[1] + figure(*found.group(2, 3, 4)), text)


# ---------------------------------------------------------------- types of the model's records

KINDS = {
    "Tables": (POWER_TABLES, "Tables of one power, power.py."),
    "Model": (layout.MODEL, "Coefficients of one sample rate."),
    "Motion": (layout.MOTION, "The state of the instrument."),
    "Contacts": (layout.CONTACTS, "Where bow and fingers touch the strings."),
    "Work": (layout.WORK, "Intermediate results of one step."),
    "State": (layout.STATE, "All that a step changes."),
    "Refined": (layout.REFINED, "What an instrument with torsion, or with wide hair, has besides."),
}
HEAD = '''"""Types of the model's records; written by scripts/generate.py from layout.py.

In compiled code a record of an array of layout.MODEL, layout.STATE or layout.REFINED has these
attributes.
docs/notation.md has their symbols and units.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Records = NDArray[np.void]  # of layout.MODEL or layout.STATE
'''


def annotation(kind: np.dtype[np.void], name: str) -> str:
    field = kind[name]
    for record, (other, _) in KINDS.items():
        if field == other:
            return record
    scalar = field.base.type.__name__
    if field.shape:
        return "Array" if scalar == "float64" else f"NDArray[np.{scalar}]"
    return "float" if scalar == "float64" else "int"


def records() -> str:
    """Return the source text of the module of records."""
    parts = [HEAD]
    for record, (kind, doc) in KINDS.items():
        fields = [f"    {name}: {annotation(kind, name)}\n" for name in kind.names or ()]
        parts.append(f'\n\nclass {record}(Protocol):\n    """{doc}"""\n\n{"".join(fields)}')
    return "".join(parts)


def written() -> Iterator[tuple[Path, str]]:
    """Yield each file that has something written by this, and the text it should have."""
    yield RECORDS, records()
    for pattern in PAGES:
        for path in sorted(ROOT.glob(pattern)):
            text = path.read_text(encoding="utf-8")
            if "<!-- table " in text or "<!--=" in text:
                yield path, page(text)


if __name__ == "__main__":
    for path, text in written():
        path.write_text(text, encoding="utf-8")
