"""Apply tunings in MIDI files: RPN 1 and 2, and system exclusive of all notes or the scale.

Master fine and coarse tuning (device control), and scale/octave tuning in its one-byte and two-byte
forms (MIDI Tuning Standard) are supported: notes move by semitones, and the rest is a bend. Tunings
of single keys and their dumps are not. [MIDI 1.0 Detailed Specification; MIDI Tuning Standard,
RP-020]
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from yehu_server.core.midi import registered_parameters as rpn
from yehu_server.core.midi.registered_parameters import CENTRE
from yehu_server.scores.events import (
    BEND,
    CONTROL,
    NOTE_OFF,
    NOTE_ON,
    PITCHWHEEL,
    Events,
    ScoreEvent,
    Setting,
)
from yehu_server.scores.score import Score

UNIVERSAL = (0x7E, 0x7F)  # not in real time, in real time
DEVICE_CONTROL, TUNING = 4, 8
MASTER_FINE, MASTER_COARSE = 3, 4
SCALE_1, SCALE_2 = 8, 9  # bytes for each note of the scale
MAX_BYTES, MAX_MESSAGES = 512, 1000  # of a message; messages of a track
FINE_CENTRE = 8192
SELECTORS = [rpn.RPN_COARSE, rpn.RPN_FINE, rpn.NRPN_COARSE, rpn.NRPN_FINE, rpn.DATA_ENTRY]
SINGLE_KEYS = "tuning of single keys by system exclusive is not supported"
BENDS_TOO = "tuning by system exclusive is rounded to semitones on channels with pitch bends"


def is_tuning(body: bytes) -> bool:
    """Whether the bytes after F0 are a tuning."""
    if len(body) < 5 or len(body) > MAX_BYTES or body[0] not in UNIVERSAL:
        return False
    return body[2] == TUNING or (
        body[2] == DEVICE_CONTROL and body[3] in (MASTER_FINE, MASTER_COARSE)
    )


@dataclass
class _Tuned:
    """The tuning of notes (semitones)."""

    coarse: float = 0.0
    fine: float = 0.0
    scales: dict[int, list[float]] = field(default_factory=dict)  # by channel, of twelve notes

    def take(self, body: bytes) -> bool:
        """Let a message hold from here on; False where it is not understood."""
        kind, form, data = body[2], body[3], body[4:].rstrip(b"\xf7")
        if kind == DEVICE_CONTROL and len(data) >= 2:
            if form == MASTER_COARSE:
                self.coarse = float(data[1] - CENTRE)
            else:
                self.fine = (data[1] << 7 | data[0]) / FINE_CENTRE - 1.0
            return True
        if kind != TUNING or form not in (SCALE_1, SCALE_2):
            return False
        size = 1 if form == SCALE_1 else 2
        values = data[3:]
        if len(values) < 12 * size:
            return False
        if form == SCALE_1:
            scale = [(value - CENTRE) / 100.0 for value in values[:12]]
        else:
            pairs = zip(values[0:24:2], values[1:24:2], strict=True)
            scale = [(high << 7 | low) / FINE_CENTRE - 1.0 for high, low in pairs]
        chosen = (data[0] & 3) << 14 | data[1] << 7 | data[2]
        self.scales |= {channel: scale for channel in range(16) if chosen >> channel & 1}
        return True

    def offset(self, channel: int, key: int) -> float:
        """Semitones that a key sounds higher."""
        scale = self.scales.get(channel)
        return self.coarse + self.fine + (scale[key % 12] if scale else 0.0)


def retuned(
    events: Events, tunings: Sequence[tuple[float, bytes]]
) -> tuple[Events, tuple[str, ...]]:
    """Return events as `tunings` (s, in order, of `is_tuning`) move them, and remarks."""
    if not tunings:
        return events, ()
    codes = events.code.copy()
    bent = {*(codes[events.kind == PITCHWHEEL] >> 16 & 15).tolist()}
    tuned, left = _Tuned(), list(tunings)[::-1]
    moved: dict[int, int] = {}  # by channel and key as written, where it sounds
    bends: dict[int, float] = {}
    remarks: dict[str, None] = {}
    before: list[tuple[int, ScoreEvent]] = []  # places of notes, and settings before them

    def take(time_s: float) -> None:
        while left and left[-1][0] <= time_s:
            if not tuned.take(left.pop()[1]):
                remarks[SINGLE_KEYS] = None

    places = np.flatnonzero((events.kind == NOTE_ON) | (events.kind == NOTE_OFF))
    columns = places, events.time_s[places], codes[places] >> 8, events.is_struck[places]
    sounding = []
    for place, time_s, at, is_struck in zip(*(each.tolist() for each in columns), strict=True):
        take(time_s)
        channel, note = at >> 8 & 15, at & 127
        source = channel << 7 | note
        if is_struck:
            offset = tuned.offset(channel, note)
            key = min(max(note + round(offset), 0), 127)
            moved[source] = key
            bend = round(offset - round(offset), 9)
            if bend and channel in bent:
                remarks[BENDS_TOO] = None
            elif bend != bends.get(channel, 0.0):
                bends[channel] = bend
                setting = Setting(BEND, bend or None, channel)
                beat, track = float(events.beat[place]), int(events.track[place])
                before.append((place, ScoreEvent(time_s, setting, beat, track)))
        else:
            key = moved.pop(source, note)
        sounding.append(key)
    if len(codes):
        take(events.time_s[-1])
    codes[places] = codes[places] & ~0x7F00 | np.array(sounding, np.int64) << 8
    return events.with_codes(codes).with_before(before), tuple(remarks)


def transposed_keys(score: Score) -> dict[int, float]:
    """Return the semitones above their keys of notes that are tuned, by the numbers of events."""
    events = score.events
    kind, first = events.kind, events.first
    is_control = (kind == CONTROL) & np.isin(first, SELECTORS)
    if not (is_control & (first == rpn.DATA_ENTRY)).any():
        return {}
    selected: dict[int, list[int]] = {}  # by channel: coarse and fine half of the parameter
    coarse: dict[int, float] = {}
    fine: dict[int, float] = {}
    found: dict[int, float] = {}
    numbers = np.flatnonzero(events.is_struck | is_control | (kind < 0))
    for number, code in zip(numbers.tolist(), events.code[numbers].tolist(), strict=True):
        channel, control, value = code >> 16 & 15, code >> 8 & 127, code & 127
        if code < 0:
            if events.others[-1 - code].type == "reset":
                for held in (selected, coarse, fine):
                    held.clear()
        elif code >> 20 == NOTE_ON:
            if (coarse or fine) and (by := coarse.get(channel, 0.0) + fine.get(channel, 0.0)):
                found[number] = by
        elif control in (rpn.RPN_COARSE, rpn.RPN_FINE):
            selected.setdefault(channel, [-1, -1])[control == rpn.RPN_FINE] = value
        elif control in (rpn.NRPN_COARSE, rpn.NRPN_FINE):
            selected[channel] = [-1, -1]
        elif selected.get(channel) == [0, rpn.COARSE_TUNING]:
            coarse[channel] = float(value - CENTRE)
        elif selected.get(channel) == [0, rpn.FINE_TUNING]:
            fine[channel] = (value - CENTRE) / CENTRE
    return found
