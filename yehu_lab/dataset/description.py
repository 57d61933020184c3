"""Reads the description of a data set; docs/dataset.md describes the format."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from yehu_lab.dataset.draws import Distribution, chance, constant, read_distribution, shares_of
from yehu_lab.sweeps.note_strokes import played_rate
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.player.note_range import YEHU
from yehu_server.errors import ParameterError, did_you_mean
from yehu_server.params.table import find
from yehu_server.playing.calibration import calibration_key
from yehu_server.playing.stringing import notes_of
from yehu_server.playing.tuning import STANDARD_A4
from yehu_server.scores.gesture import CONTROLS
from yehu_server.util.documents import Document, Fields
from yehu_server.util.files import is_plain_name
from yehu_server.util.values import choice, choices, line, number, whole

LICENCE = "MIT"  # where none is given: that of this program, and of the body it was measured with
KINDS = ("strokes", "notes")
MAX_SOUNDS = 10_000_000
LONGEST_S = 60.0  # of one sound
MAX_NOTES = 32
COUNTS = ("string", "notes")

# By kind: each value that may be drawn, its default, and its bounds.
STROKES = {
    "duration": (0.5, 0.05, LONGEST_S),  # s
    "string": (1.0, 1.0, 2.0),
    "stop": (0.0, 0.0, 24.0),  # semitones above the open string
    "stop_end": (None, 0.0, 24.0),
    "bow_velocity": (0.2, -CONTROLS["bow_velocity"].hi, CONTROLS["bow_velocity"].hi),  # m/s
    "bow_velocity_end": (None, -CONTROLS["bow_velocity"].hi, CONTROLS["bow_velocity"].hi),
    "bow_force": (0.7, 0.0, CONTROLS["bow_force"].hi),  # N
    "bow_force_end": (None, 0.0, CONTROLS["bow_force"].hi),
    "bow_position": (0.12, 0.01, 0.5),  # share of the sounding length, from the bridge
    "bow_position_end": (None, 0.01, 0.5),
    "bow_noise": (0.0, 0.0, 1.0),
    "press_force": (1.5, 0.0, 20.0),  # N
    "attack": (0.03, 0.0, 10.0),  # s
    "force_attack": (0.01, 0.0, 10.0),
}
NOTES = {
    "notes": (1.0, 1.0, float(MAX_NOTES)),
    "pitch": (69.0, *YEHU.ends),  # fractional MIDI notes; of a yehu
    "velocity": (80.0, 1.0, 127.0),
    "length": (0.5, 0.05, LONGEST_S),  # s
    "gap": (0.05, -1.0, 10.0),  # s; below 0 the next note is slurred
    "tail": (0.3, 0.0, 10.0),  # s
}
SIGNALS = (
    "bridge_force", "bridge_force_1", "bridge_force_2", "bridge_velocity", "pressure",
    "friction_force", "relative_velocity", "finger_displacement", "contact_force",
)  # fmt: skip


@dataclass(frozen=True)
class Description:
    """What a data set is made of."""

    kind: str  # of KINDS
    count: int
    seed: int
    rate: float
    # Of each value, by name; for notes, also parameters by their addresses.
    draws: Mapping[str, Distribution]
    splits: tuple[tuple[str, float], ...]  # the shares are sums: the last is 1
    every: int  # samples between two that are kept of each control
    signals: tuple[str, ...]  # of SIGNALS, kept at each sample
    quantities: Quantities  # the instrument before it is tuned
    # Hash of all that a sound depends on beside the code; how many there are is no part of it.
    key: str
    # A sentence for readers, and the licence of the sounds (its SPDX name).
    about: str = ""
    license: str = LICENCE
    data: Mapping[str, Any] = field(default_factory=dict)  # the entries of its file

    def drawn(self, number: int) -> dict[str, float]:
        """The values of a sound, by name."""
        return {name: self.draw(number, name) for name in sorted(self.draws)}

    def draw(self, number: int, name: str, again: int = 0) -> float:
        """A value of a sound; `again` counts those of one name, such as of several notes."""
        share = chance(self.seed, number, f"{name}/{again}" if again else name)
        return self.draws[name].value(share)

    def split(self, number: int) -> str:
        """The split that a sound is in."""
        share = chance(self.seed, number, "split")
        return next(name for name, upto in self.splits if share < upto)


def read_description(path: Path) -> Description:
    """Read the description of a data set. Raises ParameterError, naming the file and the entry."""
    document = Document(path, "a description of a data set").read(path)
    return description_of(document.toml(), path.parent)


def description_of(data: Mapping[str, Any] | Fields, folder: Path = Path()) -> Description:
    """Check the data of a description in a folder. Raises ParameterError, naming the entry."""
    table = Fields.of(data)
    kind = table.read("kind", choice, KINDS[0], KINDS)
    rate = table.read("sample_rate", played_rate, 44100.0)
    keep = table.table("keep")
    quantities = override(Quantities(), table.table("instrument"), folder)
    body = calibration_key(rate, quantities, STANDARD_A4)  # files that are named may change
    neutral = {"count": 0, "about": ""}  # of no matter to a sound
    kept = {name: entry for name, entry in table.data.items() if name != "license"}
    text = json.dumps(kept | neutral, sort_keys=True, default=str)
    description = Description(
        kind=kind,
        count=table.read("count", whole, 100, 1, MAX_SOUNDS),
        seed=table.read("seed", whole, 0, 0, 2**63 - 1),
        rate=rate,
        draws=_draws(table.table("draw"), kind, quantities),
        splits=_splits(table.table("split")),
        every=keep.read("every", whole, 64, 1, 1 << 20),
        signals=tuple(keep.read("signals", choices, [], SIGNALS)),
        quantities=quantities,
        key=hashlib.sha256(f"{text}{body}".encode()).hexdigest(),
        about=table.read("about", line, ""),
        license=table.read("license", line, LICENCE),
        data=table.data,
    )
    keep.refuse_others()
    table.refuse_others()
    return description


def _draws(table: Fields, kind: str, quantities: Quantities) -> dict[str, Distribution]:
    lowest, highest = map(float, notes_of(quantities).ends)
    usual = NOTES["pitch"][0] + lowest - YEHU.lowest
    known = STROKES if kind == "strokes" else NOTES | {"pitch": (usual, lowest, highest)}
    draws: dict[str, Distribution] = {
        name: constant(default) for name, (default, _, _) in known.items() if default is not None
    }

    def draw(name: str, entry: Any) -> Distribution:
        if kind == "notes" and name.startswith("/playing/"):
            param = find(name)
            lo, hi = param.lo, param.hi
        elif name in known:
            _, lo, hi = known[name]
        else:
            more = ", or an address of /playing" if kind == "notes" else ""
            hint = did_you_mean(name, known)
            raise ParameterError(f"unknown entry{hint} (known: {', '.join(known)}{more})")
        found = read_distribution(entry)
        if not lo <= found.lo <= found.hi <= hi:
            raise ParameterError(f"{found.lo:g} to {found.hi:g} is not within {lo:g} to {hi:g}")
        if name in COUNTS and not found.is_whole:
            raise ParameterError('whole numbers only, such as spacing = "whole"')
        return found

    return draws | table.each(draw)


def _splits(table: Fields) -> tuple[tuple[str, float], ...]:
    if not table.data:
        return (("train", 1.0),)
    for name in table.data:
        if not is_plain_name(name):
            table.add_error(name, "is not a plain folder name")
    if len({name.casefold() for name in table.data}) < len(table.data):
        table.add_error("", "names that differ in no more than capitals")
    weights = table.each(lambda _, value: number(value))
    with table.at():
        shares = shares_of(list(weights.values()))
    return tuple(zip(weights, shares, strict=True))
