"""Choose the parts of a score that are played: those asked for by name, else the default ones."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import ScoreError, did_you_mean
from yehu_server.scores.chords import is_single, tops_of
from yehu_server.scores.events import KEY, NoteColumns
from yehu_server.scores.octaves import NO_NOTES, octaves_of_parts
from yehu_server.scores.score import REST_S, Score, ScorePart
from yehu_server.scores.slides import ARTICULATION
from yehu_server.scores.smf.tunings import transposed_keys
from yehu_server.scores.tune_part import melodic_part, take_turns
from yehu_server.scores.written.in_range import line_of
from yehu_server.scores.written.notated import Written, listed

Array = Any

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
    notes = score.note_columns
    part = _parts_at(score.parts, notes.channel, notes.track)
    spans = notes.where(part >= 0).spans(part[part >= 0])
    if take_turns(spans):
        return None
    return melodic_part([part.name for part in score.parts], spans, within)


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
        has_drums = (score.note_columns.channel == PERCUSSION_CHANNEL).any()
        more = "; percussion is no part: --channel 10 plays it" if has_drums else ""
        raise ScoreError(f"{error}{more}") from None
    return _only(score, [score.parts[number] for number in numbers])


def _only(score: Score, kept: Sequence[ScorePart]) -> Score:
    """A score with the notes of some of its parts alone, and the key switches that they have.

    Switches in a track without notes are for all that play on their channel. Percussion stays, so
    that it is counted: nobody plays it unasked.
    """
    notes, events = score.note_columns, score.events
    is_own = _parts_at(kept, notes.channel, notes.track) >= 0
    sounding, channels = {*notes.track.tolist()}, {*notes.channel[is_own].tolist()}
    is_kept = np.ones(len(events), bool)
    is_kept[notes.begins] = is_own | (notes.channel == PERCUSSION_CHANNEL)
    find = finder_of(kept)
    for place in np.flatnonzero(events.code < 0).tolist():
        _, message, _, track = events[place]
        if message.type == "setting" and message.address == ARTICULATION:
            is_own_switch = track not in sounding or find(message.channel, track) is not None
            is_kept[place] = is_own_switch and message.channel in channels
    return replace(score, events=events.where(is_kept), parts=tuple(kept))


def midi_in_range(
    score: Score,
    channels: Collection[int] | None = None,
    *,
    is_mpe: bool = False,
    is_section: bool = False,
    within: NoteRange = YEHU,
) -> Score:
    """Return a score of MIDI with each part moved by octaves into range, and a remark of that.

    With `is_mpe` the notes of a part are on channels of their own, and all are one part. The range
    is that of `within`. Only what `channels` play moves, by default all but percussion. The highest
    notes of chords count, and the others follow them; in a section all notes count.
    """
    channels = MELODIC if channels is None else channels
    events = score.events
    notes = score.note_columns
    notes = notes.where(np.isin(notes.channel, [*channels]))
    if not is_mpe and (notes.channel == PERCUSSION_CHANNEL).any():
        score = replace(score, remarks=(*score.remarks, DRUMS))
    sharper = np.zeros(len(events))
    tuned = transposed_keys(score)
    sharper[[*tuned]] = [*tuned.values()]
    names, part = _named_parts(score.parts, notes)
    if is_mpe:
        names, part = names[:1], np.zeros_like(part)
    order = np.argsort(part, kind="stable")
    notes, part = notes.where(order), part[order]
    tops = np.arange(len(part)) if is_section else tops_of(notes, part)
    counts = is_single(tops)
    found = octaves_of_parts(notes.spans(part, sharper[notes.begins]).where(counts), REST_S, within)
    by = np.zeros(len(part), np.int64)  # octaves
    by[counts] = np.concatenate([octaves.of_notes for octaves in (*found, NO_NOTES)])
    by = by[tops]
    of_first = notes.channel[np.unique(part, return_index=True)[1]].tolist()
    parts = [
        ("" if len(names) == 1 else name, octaves)
        for name, octaves, channel in zip(names, found, of_first, strict=True)
        if octaves.summary and (is_mpe or channel in MELODIC)
    ]
    by[(notes.key + 12 * by < 0) | (notes.key + 12 * by > 127)] = 0
    moves = np.zeros(len(events) + 1, np.int64)  # of each event; -1 is none
    moves[notes.ends] = by
    moves[notes.begins] = by  # also where a key is struck again
    if not moves[:-1].any():
        return score
    remarks = (*score.remarks, *filter(None, (line_of(parts, within),)))
    moved = events.with_codes(events.code + 12 * KEY * moves[:-1])
    return replace(score, events=moved, remarks=remarks)


def _named_parts(parts: Sequence[ScorePart], notes: NoteColumns) -> tuple[list[str], Array]:
    """The names of parts that have notes, in the order of their first; and the part of each note.

    Notes of no part are one, with their channel's name.
    """
    find, numbers = finder_of(parts), dict[str, int]()
    places = notes.track << 4 | notes.channel
    found, first, of_note = np.unique(places, return_index=True, return_inverse=True)
    number_of = np.zeros(len(found), np.int64)
    for number in np.argsort(first).tolist():
        channel, track = int(found[number]) & 15, int(found[number]) >> 4
        at = find(channel, track)
        name = f"channel {channel + 1}" if at is None else parts[at].name
        number_of[number] = numbers.setdefault(name, len(numbers))
    return [*numbers], number_of[of_note]


def _parts_at(parts: Sequence[ScorePart], channel: Array, track: Array) -> Array:
    """The numbers, from 0, of the parts that play at channels and tracks; -1 where none does."""
    find = finder_of(parts)
    places, of_place = np.unique(track << 4 | channel, return_inverse=True)
    found = (find(place & 15, place >> 4) for place in places.tolist())
    return np.array([-1 if at is None else at for at in found], np.int64)[of_place]


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
