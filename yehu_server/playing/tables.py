"""Converts mapping, tuning and presets to tables for compiled code (``midi.tables``)."""

import hashlib
import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from yehu_server.core.midi import tables
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.params.preset_file import Preset
from yehu_server.params.table import find
from yehu_server.playing import sources
from yehu_server.playing.bind import CURVES, Bind, Breakpoints
from yehu_server.playing.mapping import Mapping as Binds
from yehu_server.playing.tuning import KEYS, RangePolicy, Tuning

Array = Any

WORDS = {
    sources.BEND: tables.BEND, sources.PRESSURE: tables.PRESSURE,
    sources.POLY_PRESSURE: tables.POLY_PRESSURE, sources.VELOCITY: tables.VELOCITY,
    sources.NOTE: tables.NOTE,
}  # fmt: skip


class Controls:
    """Numbers of the named controls of mappings: their OSC addresses, as they come."""

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}

    def number(self, address: str) -> int:
        """The number of an address; a new one for a new address."""
        return self._numbers.setdefault(address, len(self._numbers))


def make_tables(
    mapping: Binds,
    controls: Controls,
    *,
    start: Iterable[tuple[str, float]] = (),
    tuning: Tuning,
    a4: float,
    policy: RangePolicy,
    notes: NoteRange = YEHU,
    received: Iterable[int] | None = None,
    programs: Mapping[int, Preset] | None = None,
) -> Array:
    """Make the tables of a part: ndarray [shape=(1,), dtype=TABLES].

    `mapping`: with no more binds and points than there is room for, as ``playing.mapping`` reads
    it.
    `start` (iterable of (address, value)): start values of parameters, over those of the mapping.
    `notes`: those of the instrument.
    `received`: channels to receive, counted from 0; by default all but percussion.
    `programs`: the presets of MIDI programs, from 1. Without it program changes are ignored.
    """
    made = tables.plain_tables()
    t = made[0]
    _write_binds(t, mapping, controls)
    t["mpe"] = float(mapping.mpe)
    t["first_switch"] = math.nan if mapping.key_switches is None else mapping.key_switches
    for address, value in mapping.start:
        t["usual"][INDEX[address]] = value
    starts = dict(mapping.start) | dict(start)
    t["starts"] = len(starts)
    for place, (address, value) in enumerate(starts.items()):
        t["start_row"][place] = INDEX[address]
        t["start_value"][place] = find(address).clamped(value)
    t["is_equal"] = float(tuning.keys is None)
    pitches = (tuning.pitch(float(key), a4) for key in KEYS)
    t["pitch"] = [math.nan if pitch is None else pitch for pitch in pitches]
    t["policy"] = policy.code
    t["lowest"], t["highest"] = notes.ends
    t["received"] = -1 if received is None else sum(1 << channel for channel in set(received))
    _write_programs(t, programs)
    return made


def _write_binds(t: Array, mapping: Binds, controls: Controls) -> None:
    t["binds"] = len(mapping.binds)
    firsts: dict[str, int] = {}
    points = 0
    for n, bind in enumerate(mapping.binds):
        t["source"][n] = source_code(bind.source, controls)
        t["first"][n] = firsts.setdefault(bind.source, n)
        t["target"][n] = INDEX[bind.target]
        t["lo"][n], t["hi"][n] = bind.ends
        if isinstance(bind.curve, Breakpoints):
            end = points + len(bind.curve.points)
            t["curve"][n], t["first_point"][n] = tables.POINTS, points
            t["points"][n] = len(bind.curve.points)
            t["x"][points:end], t["y"][points:end] = np.transpose(bind.curve.points)
            points = end
        else:
            t["curve"][n] = CURVES[bind.curve]
        t["invert"][n] = float(bind.invert)
        t["smoothing_ms"][n] = bind.smoothing_ms
        t["channels"][n] = sum(1 << channel - 1 for channel in bind.channels)
        t["soft"][n] = float(bind.is_soft)
        t["by_range"][n] = float(bind.is_by_range)
        t["for_all"][n] = float(bind.is_global)
        t["input_lo"][n], t["input_hi"][n] = bind.input_range
        t["same"][n] = _mark(bind)


def source_code(source: str, controls: Controls) -> int:
    """The code of a source (``midi.tables``)."""
    if source in WORDS:
        return WORDS[source]
    if sources.is_address(source):
        return tables.CONTROL + controls.number(source)
    kind, number = source.split(" ")
    if kind == "nrpn":
        return tables.NRPN + int(number)
    coarse, _, fine = number.partition("/")
    return tables.PAIR + int(coarse) if fine else int(coarse)


def _mark(bind: Bind) -> float:
    """A number that equal binds have, and no others."""
    return float(int(hashlib.sha256(repr(bind).encode()).hexdigest()[:12], 16))


def _write_programs(t: Array, programs: Mapping[int, Preset] | None) -> None:
    t["has_programs"] = float(programs is not None)
    for program, preset in (programs or {}).items():
        t["has_program"][program - 1] = 1.0
        for place, (address, value) in enumerate(preset.values.items()):
            t["program_row"][program - 1, place] = INDEX[address]
            t["program_value"][program - 1, place] = find(address).clamped(value)
