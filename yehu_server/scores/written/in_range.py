"""Choose the part of a written score that plays, and move parts by octaves into range."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.playing.stringing import range_text
from yehu_server.scores.octaves import NoteSpans, Octaves, octaves_of
from yehu_server.scores.tune_part import melodic_part
from yehu_server.scores.written.mark_settings import harmonic_of
from yehu_server.scores.written.notated import Note, Part, Written

REST = 0.5  # quarters of silence between phrases
FAR_UP = 2  # octaves, from which on a part is no longer a bass
DEEPER_FIDDLE = "docs/ensemble.md"
MOVED = "moved to fit"  # begins a line of moves


def default_parts(written: Written, within: NoteRange = YEHU) -> list[int]:
    """The number, from 0, of the part that plays where none is asked for, if any has notes."""
    sounding = [number for number, part in enumerate(written.parts) if part.notes]
    if len(sounding) < 2:
        return sounding
    tune = written.tune
    if tune is None:
        tune = melodic_part(written.names, spans_of(written.parts, within), within)
    return [] if tune is None else [tune]


def moved_part(part: Part, within: NoteRange = YEHU) -> tuple[Part, Octaves]:
    """Return a part in the range of an instrument, and by how many octaves its notes were moved."""
    octaves = octaves_of(spans_of([part], within), REST, within)
    if not octaves.of_notes.any():
        return part, octaves
    moves = (12.0 * octaves.of_notes).tolist()
    notes = tuple(_moved(note, by) for note, by in zip(part.notes, moves, strict=True))
    found = replace(part, notes=notes)
    vars(found).update(begins_at=part.begins_at, ends_at=part.ends_at, names=part.names)
    return found, octaves


def moved(written: Written, plays: Sequence[int], within: NoteRange = YEHU) -> tuple[Written, str]:
    """A score with the parts of some numbers in range, and a line about their moves, if any."""
    parts = list(written.parts)
    moves = []
    for number in plays:
        parts[number], octaves = moved_part(parts[number], within)
        if octaves.summary:
            moves.append((written.names[number], octaves))
    return replace(written, parts=tuple(parts)), line_of(moves, within)


def line_of(moves: Sequence[tuple[str, Octaves]], within: NoteRange = YEHU) -> str:
    """A line that names the parts that were moved, their moves, and where a deeper fiddle is."""
    if not moves:
        return ""
    text = "; ".join(f"{name} {octaves.summary}".lstrip() for name, octaves in moves)
    low = [name for name, octaves in moves if octaves.whole >= FAR_UP]
    names = ", ".join(filter(None, low)) or "it"
    deeper = f" (a deeper fiddle for {names}: {DEEPER_FIDDLE})" if low else ""
    own = within.transposed(-within.transposed_by)
    return f"{MOVED} {range_text(own)}: {text}{deeper}"


def spans_of(parts: Sequence[Part], within: NoteRange = YEHU) -> NoteSpans:
    """When the notes of parts sound (quarters), and their pitches."""
    pitches = [
        _pitches(note, names, within)
        for part in parts
        for note, names in zip(part.notes, part.names, strict=True)
    ]
    low, high = np.array(pitches, float).reshape(-1, 2).T
    begins = np.concatenate([np.zeros(0), *(part.begins_at for part in parts)])
    ends = np.concatenate([np.zeros(0), *(part.ends_at for part in parts)])
    number = np.repeat(np.arange(len(parts)), [len(part.notes) for part in parts])
    return NoteSpans(begins, ends, low, high, number)


def _pitches(note: Note, names: frozenset[str], within: NoteRange) -> tuple[float, float]:
    """The lowest and the highest pitch of a note; NaN where it has none.

    A harmonic is as high as it is written: its finger touches an open string.
    """
    if not (note.before or note.after or "harmonic" in names):
        return note.pitch, note.pitch
    pitches = [grace.pitch for grace in (*note.before, *note.after)]
    if harmonic_of(note, within) is None:
        pitches.append(note.pitch)
    return min(pitches, default=math.nan), max(pitches, default=math.nan)


def _moved(note: Note, by: float) -> Note:
    pitch = note.pitch + by
    if not (note.before or note.after):
        return Note(note.beat, note.length, pitch, note.marks, contour=note.contour)
    before, after = (
        tuple(grace._replace(pitch=grace.pitch + by) for grace in graces)
        for graces in (note.before, note.after)
    )
    return note._replace(pitch=pitch, before=before, after=after)
