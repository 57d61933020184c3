"""Choose the parts of a score that are played: those asked for by name, else the default ones."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import cache
from operator import attrgetter
from typing import Any

import numpy as np

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import ScoreError, did_you_mean
from yehu_server.scores.octaves import NoteSpan, octaves_of
from yehu_server.scores.score import (
    REST_S,
    Score,
    ScoreEvent,
    ScoreNote,
    ScorePart,
    transposed,
)
from yehu_server.scores.slides import ARTICULATION
from yehu_server.scores.smf.tunings import transposed_keys
from yehu_server.scores.tune_part import melodic_part, take_turns
from yehu_server.scores.written.in_range import line_of
from yehu_server.scores.written.notated import Written, listed

MELODIC = frozenset(range(16)) - {PERCUSSION_CHANNEL}
DRUMS = "channel 10 is percussion: its keys name drums, and are played as pitches"
MAX_NAMED = 8  # parts in a line
ONE_BY_ONE = "--part NAME plays one of them, --ensemble all, each on a yehu of its own"


def numbers_of(names: Sequence[str], asked: Sequence[str]) -> list[int]:
    """Return the numbers, from 0, of the parts that are asked for, in their order.

    A part is named as it is, in capitals or not; by its beginning, where no other begins alike; or
    by its number from 1. Raises ScoreError where there is no such part, or several.
    """
    found: set[int] = set()
    for text in asked:
        word = text.strip().casefold()
        same = [at for at, name in enumerate(names) if name.casefold() == word]
        begun = [at for at, name in enumerate(names) if name.casefold().startswith(word)]
        if not (same or begun) and word.isdecimal() and 0 < int(word[:6]) <= len(names):
            same = [int(word[:6]) - 1]
        chosen = same or begun
        if not chosen:
            more = did_you_mean(text, names) or f"; it has {listed(names, MAX_NAMED)}"
            raise ScoreError(f"has no part {text}{more}")
        if len(chosen) > 1:
            raise ScoreError(
                f"part {text} may be {listed([names[at] for at in chosen], MAX_NAMED)}"
            )
        found.add(chosen[0])
    return sorted(found)


def default_midi_part(score: Score, within: NoteRange = YEHU) -> Score:
    """Return the part of a score of MIDI that carries the tune, and name the others in a remark.

    Parts that take turns stay together.
    """
    tune = tune_of(score, within)
    if tune is None:
        return score
    names = [part.name for part in score.parts]
    others = [name for at, name in enumerate(names) if at != tune]
    line = f"plays {names[tune]}; also there: {listed(others, MAX_NAMED)} ({ONE_BY_ONE})"
    return replace(_only(score, [score.parts[tune]]), remarks=(*score.remarks, line))


def tune_of(score: Score, within: NoteRange = YEHU) -> int | None:
    """The number, from 0, of the part of a score of MIDI that carries the tune; None if all do."""
    if len(score.parts) < 2:
        return None
    parts: list[list[NoteSpan]] = [[] for _ in score.parts]
    find = finder_of(score.parts)
    for note in score.notes:
        at = find(note.channel, note.track)
        if at is not None:
            parts[at].append(NoteSpan(note.start_s, note.end_s, (float(note.key),)))
    if take_turns(parts):
        return None
    return melodic_part([part.name for part in score.parts], parts, within)


def others_line(written: Written, plays: Sequence[int]) -> str:
    """A line that names the parts that are played and the others; empty where there are none."""
    names = written.names
    others = [names[at] for at, part in enumerate(written.parts) if part.notes and at not in plays]
    if not others:
        return ""
    played = listed([names[at] for at in plays], MAX_NAMED)
    return f"plays {played}; also there: {listed(others, MAX_NAMED)} ({ONE_BY_ONE})"


def parts_chosen(score: Score, asked: Sequence[str]) -> Score:
    """The parts of a score of MIDI that are asked for. Raises ScoreError where one is not there."""
    names = [part.name for part in score.parts]
    try:
        numbers = numbers_of(names, asked)
    except ScoreError as error:
        has_drums = any(note.channel == PERCUSSION_CHANNEL for note in score.notes)
        more = "; percussion is no part: --channel 10 plays it" if has_drums else ""
        raise ScoreError(f"{error}{more}") from None
    return _only(score, [score.parts[number] for number in numbers])


def _only(score: Score, kept: Sequence[ScorePart]) -> Score:
    """A score with the notes of some of its parts alone, and the key switches that they have.

    Switches in a track without notes are for all that play on their channel. Percussion stays, so
    that it is counted: nobody plays it unasked.
    """
    find = finder_of(kept)
    places = {(note.channel, note.track) for note in score.notes}
    sounding = {track for _, track in places}
    channels = {channel for channel, track in places if find(channel, track) is not None}

    def is_kept(event: ScoreEvent) -> bool:
        message = event.message
        if message.type == "setting" and message.address == ARTICULATION:
            is_own = event.track not in sounding or find(message.channel, event.track) is not None
            return is_own and message.channel in channels
        is_note = message.type == "note_on" and message.velocity > 0
        is_drum = is_note and message.channel == PERCUSSION_CHANNEL
        return not is_note or is_drum or find(message.channel, event.track) is not None

    return replace(score, events=tuple(filter(is_kept, score.events)), parts=tuple(kept))


def midi_in_range(
    score: Score,
    channels: Collection[int] | None = None,
    *,
    is_mpe: bool = False,
    within: NoteRange = YEHU,
) -> Score:
    """Return a score of MIDI with each part moved by octaves into range, and a remark of that.

    With `is_mpe` the notes of a part are on channels of their own, and all are one part. The range
    is that of `within`. Only what `channels` play moves, by default all but percussion.
    """
    channels = MELODIC if channels is None else channels
    tuned, events = transposed_keys(score), list(score.events)
    by_part: dict[str, list[ScoreNote]] = {}
    by_place: dict[tuple[int, int], list[ScoreNote]] = {}  # the same, by channel and track
    find = finder_of(score.parts)
    notes = [note for note in score.notes if note.channel in channels]
    for note in notes:
        place = note.channel, note.track
        if place not in by_place:
            at = find(*place)
            own_name = f"channel {note.channel + 1}" if at is None else score.parts[at].name
            by_place[place] = by_part.setdefault("" if is_mpe else own_name, [])
        by_place[place].append(note)
    if not is_mpe and any(note.channel == PERCUSSION_CHANNEL for note in notes):
        score = replace(score, remarks=(*score.remarks, DRUMS))
    struck = np.zeros(len(events) + 1, bool)  # of each event; -1 is none
    struck[_column(notes, "begins")] = struck[-1] = True
    moves = np.zeros(len(events), np.int64)  # octaves, of each event
    parts = []
    for name, own in by_part.items():
        spans = [(n.start_s, n.end_s, (n.key + tuned.get(n.begins, 0.0),)) for n in own]
        octaves = octaves_of([*map(NoteSpan._make, spans)], REST_S, within)
        if octaves.summary and (is_mpe or own[0].channel in MELODIC):
            parts.append((name, octaves))
        by, keys = np.array(octaves.of_notes), _column(own, "key")
        by[(keys + 12 * by < 0) | (keys + 12 * by > 127)] = 0
        ends = _column(own, "ends")
        moves[_column(own, "begins")] = by
        moves[ends[~struck[ends]]] = by[~struck[ends]]  # not where the key is struck again
    if not moves.any():
        return score
    moved: dict[tuple[int, int], Any] = {}  # messages, by those they were and octaves
    numbers = moves.nonzero()[0]
    for number, octave in zip(numbers.tolist(), moves[numbers].tolist(), strict=True):
        time_s, message, beat, track = events[number]
        higher = moved.get((id(message), octave))
        if higher is None:
            higher = moved[id(message), octave] = transposed(message, 12 * octave)
        events[number] = ScoreEvent._make((time_s, higher, beat, track))
    is_one = len(by_part) == 1
    line = line_of([("" if is_one else name, octaves) for name, octaves in parts], within)
    remarks = (*score.remarks, *filter(None, (line,)))
    return replace(score, events=tuple(events), remarks=remarks)


def _column(notes: Sequence[ScoreNote], name: str) -> Any:
    """A number of each note [shape=(notes,)]."""
    return np.fromiter(map(attrgetter(name), notes), np.int64, len(notes))


def finder_of(parts: Sequence[ScorePart]) -> Callable[[int, int], int | None]:
    """A function of a channel and a track: the number, from 0, of the part that plays there."""
    first: dict[tuple[int | None, int | None], int] = {}
    for at, part in enumerate(parts):
        first.setdefault((part.channel, part.track), at)

    @cache
    def find(channel: int, track: int) -> int | None:
        places = ((channel, track), (channel, None), (None, track), (None, None))
        return min((first[place] for place in places if place in first), default=None)

    return find
