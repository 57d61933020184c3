"""Apply tunings in MIDI files: RPN 1 and 2, and system exclusive of all notes or the scale.

Master fine and coarse tuning (device control), and scale/octave tuning in its one-byte and two-byte
forms (MIDI Tuning Standard) are supported: notes move by semitones, and the rest is a bend. Tunings
of single keys and their dumps are not. [MIDI 1.0 Detailed Specification; MIDI Tuning Standard,
RP-020]
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

from yehu_server.core.midi import registered_parameters as rpn
from yehu_server.core.midi.registered_parameters import CENTRE
from yehu_server.scores.score import BEND, Score, ScoreEvent, Setting

UNIVERSAL = (0x7E, 0x7F)  # not in real time, in real time
DEVICE_CONTROL, TUNING = 4, 8
MASTER_FINE, MASTER_COARSE = 3, 4
SCALE_1, SCALE_2 = 8, 9  # bytes for each note of the scale
MAX_BYTES, MAX_MESSAGES = 512, 1000  # of a message; messages of a track
FINE_CENTRE = 8192
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
    events: Sequence[ScoreEvent], tunings: Sequence[tuple[float, bytes]]
) -> tuple[tuple[ScoreEvent, ...], tuple[str, ...]]:
    """Return events as `tunings` (s, in order, of `is_tuning`) move them, and remarks."""
    if not tunings:
        return tuple(events), ()
    bent = {e.message.channel for e in events if e.message.type == "pitchwheel"}
    tuned, left = _Tuned(), list(tunings)[::-1]
    moved: dict[tuple[int, int], int] = {}  # by channel and key as written, where it sounds
    bends: dict[int, float] = {}
    remarks: dict[str, None] = {}
    found: list[ScoreEvent] = []
    for event in events:
        while left and left[-1][0] <= event.time_s:
            if not tuned.take(left.pop()[1]):
                remarks[SINGLE_KEYS] = None
        message = event.message
        if message.type not in ("note_on", "note_off"):
            found.append(event)
            continue
        at = (message.channel, message.note)
        if message.type == "note_on" and message.velocity > 0:
            offset = tuned.offset(*at)
            key = min(max(message.note + round(offset), 0), 127)
            moved[at] = key
            bend = round(offset - round(offset), 9)
            if bend and message.channel in bent:
                remarks[BENDS_TOO] = None
            elif bend != bends.get(message.channel, 0.0):
                bends[message.channel] = bend
                setting = Setting(BEND, bend or None, message.channel)
                found.append(event._replace(message=setting))
        else:
            key = moved.pop(at, message.note)
        same = key == message.note
        found.append(event if same else event._replace(message=message.copy(note=key)))
    return tuple(found), tuple(remarks)


def transposed_keys(score: Score) -> dict[int, float]:
    """Return the semitones above their keys of notes that are tuned, by the numbers of events."""
    selected: dict[int, list[int]] = {}  # by channel: coarse and fine half of the parameter
    coarse: dict[int, float] = {}
    fine: dict[int, float] = {}
    found: dict[int, float] = {}
    for number, event in enumerate(score.events):
        message = event.message
        kind = message.type
        if kind == "note_on":
            if (coarse or fine) and message.velocity > 0:
                by = coarse.get(message.channel, 0.0) + fine.get(message.channel, 0.0)
                if by:
                    found[number] = by
        elif kind == "reset":
            for held in (selected, coarse, fine):
                held.clear()
        elif kind == "control_change":
            channel, value = message.channel, message.value
            chosen = selected.get(channel) if message.control == rpn.DATA_ENTRY else None
            if message.control in (rpn.RPN_COARSE, rpn.RPN_FINE):
                selected.setdefault(channel, [-1, -1])[message.control == rpn.RPN_FINE] = value
            elif message.control in (rpn.NRPN_COARSE, rpn.NRPN_FINE):
                selected[channel] = [-1, -1]
            elif chosen == [0, rpn.COARSE_TUNING]:
                coarse[channel] = float(value - CENTRE)
            elif chosen == [0, rpn.FINE_TUNING]:
                fine[channel] = (value - CENTRE) / CENTRE
    return found
