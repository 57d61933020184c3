"""Notes and pitches as users write them; notes made a score."""

import re
from collections.abc import Iterable
from numbers import Real
from typing import Any, NamedTuple

import mido
import numpy as np

from yehu_server.api.checks import number
from yehu_server.core.player.fingering import OPEN_WITHIN
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.playing.stringing import range_text
from yehu_server.scores.events import BEND, Events, ScoreEvent, Setting
from yehu_server.scores.score import MAX_DURATION_H, Score
from yehu_server.scores.written.layout import SEMITONES
from yehu_server.util.values import brief

ACCIDENTALS = {"#": 1, "♯": 1, "b": -1, "♭": -1}
_NAME = re.compile(r"([A-Ga-g])([#♯b♭]*)(-?\d{1,2})([+-]\d{1,3}(?:\.\d+)?)?")
HIGHEST_KEY = 127.0


def pitch_of(note: str | float, what: str = "note") -> float:
    """Return the pitch of a note as a fractional MIDI note.

    Raises ParameterError where it is neither, or not within 0 to 127.

    `note`: a name such as ``"A4"``, ``"Bb4"`` or ``"F#5+25"`` (cents), where A4 is MIDI note 69; or
    a MIDI note, which may be fractional.
    `what`: its name in errors.

    Examples
    --------
    >>> pitch_of("A4"), pitch_of("Bb4-50"), pitch_of(60)
    (69.0, 69.5, 60.0)
    """
    found = _NAME.fullmatch(note.strip()) if isinstance(note, str) else None
    if found is None and (isinstance(note, bool) or not isinstance(note, Real)):
        given = brief(note)
        raise ParameterError(f"{what}: expected a note such as 'A4' or 69, got {given}")
    if found is not None:
        letter, signs, octave, cents = found.groups()
        pitch = 12.0 * (int(octave) + 1) + SEMITONES[letter.upper()]
        pitch += sum(ACCIDENTALS[sign] for sign in signs) + 0.01 * float(cents or 0.0)
        note = pitch
    return number(note, what, 0.0, HIGHEST_KEY)


def playable(note: str | float, notes: NoteRange = YEHU) -> float:
    """Return the pitch of a note of an instrument that has some notes; see `pitch_of`.

    Raises ParameterError where it is out of the instrument's range.
    """
    pitch = pitch_of(note)
    lowest, highest = notes.ends
    if not lowest - OPEN_WITHIN < pitch < highest + OPEN_WITHIN:
        ends = f"{range_text(notes)} ({lowest} to {highest})"
        raise ParameterError(f"note: {note} is not within {ends}, which the instrument has")
    return pitch


LONGEST_S = 3600.0 * MAX_DURATION_H


class Note(NamedTuple):
    """A note to `render`.

    Parameters
    ----------
    pitch : str or float
        Such as ``"A4"``, ``"F#5+25"`` (cents) or 69.5.
    start : float
        When it begins (s).
    duration : float
        How long it lasts (s). A note that begins before another ends is slurred to it.
    velocity : float
        How hard it is struck, 1 to 127, as in MIDI; rounded.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> yehu.Note("A4", 0.0, 0.5)
    Note(pitch='A4', start=0.0, duration=0.5, velocity=80.0)
    """

    pitch: str | float
    start: float
    duration: float
    velocity: float = 80.0


def score_of(notes: Iterable[Any] | Any) -> Score:
    """Make a score of notes: rows of pitch, start, duration and, if wanted, velocity.

    Raises ScoreError where there are none; ParameterError, naming the note that is wrong.

    `notes` (iterable of `Note`, of tuple, or ndarray [shape=(notes, 3 or 4)]).
    """
    try:
        rows = list(notes)
    except TypeError:
        kind = type(notes).__name__
        raise ParameterError(f"score: expected the path of a file, or notes, got {kind}") from None
    found = [_note(place, row) for place, row in enumerate(rows)]
    if not found:
        raise ScoreError("there are no notes")
    found.sort(key=lambda note: note[1])
    is_bent = any(pitch != round(pitch) for pitch, *_ in found)
    events: list[tuple[float, int, ScoreEvent]] = []

    def add(time_s: float, rank: int, message: Any) -> None:
        events.append((time_s, rank, ScoreEvent(time_s, message)))

    last = 0.0
    for number_of, (pitch, start, duration, velocity) in enumerate(found):
        key, end = round(pitch), start + duration
        # Where the next note has the same key, it ends this one.
        again = [other[1] for other in found[number_of + 1 :] if round(other[0]) == key]
        if again and again[0] < end:
            end = again[0]
        if is_bent:
            add(start, 1, Setting(BEND, pitch - key))
        add(start, 2, mido.Message("note_on", note=key, velocity=velocity))
        add(end, 0, mido.Message("note_off", note=key))
        last = max(last, end)
    events.sort(key=lambda each: each[:2])
    return Score(Events.of(event for *_, event in events), last, "notes")


def _note(place: int, row: Any) -> tuple[float, float, float, int]:
    """Check a row."""
    if isinstance(row, str) or not isinstance(row, tuple | list | np.ndarray):
        raise ParameterError(f"note {place}: expected pitch, start and duration, got {brief(row)}")
    if not 3 <= len(row) <= len(Note._fields):
        raise ParameterError(f"note {place}: expected pitch, start, duration, and maybe velocity")
    try:
        note = Note(*row)
        return (
            pitch_of(note.pitch, "pitch"),
            number(note.start, "start", 0.0, LONGEST_S),
            number(note.duration, "duration", 1e-3, LONGEST_S),
            round(number(note.velocity, "velocity", 1.0, 127.0)),
        )
    except ParameterError as error:
        raise ParameterError(f"note {place}: {error}") from None
