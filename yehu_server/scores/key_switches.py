"""Find the keys of a MIDI file that are key switches, of a mapping or of another library."""

from collections.abc import Collection
from dataclasses import replace
from typing import Any

import numpy as np

from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import ScoreError
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.scores.chords import is_single, tops_of
from yehu_server.scores.events import NOTE_OFF, NOTE_ON, Setting
from yehu_server.scores.score import Score, without_notes
from yehu_server.scores.slides import ARTICULATION

Array = Any

FAR = 12  # semitones


def with_key_switches(score: Score, first: int | None, channels: Collection[int]) -> Score:
    """Return a score whose keys from `first` (MIDI note) on choose articulations.

    They become settings, so that nothing takes them for notes, and a remark counts them; parts of
    them alone are none. None: there are no such keys. Other channels than `channels` stay as they
    are. Raises ScoreError where no other note is left.
    """
    if first is None:
        return score
    events = score.events
    played = ((events.kind == NOTE_ON) | (events.kind == NOTE_OFF)) & np.isin(
        events.code >> 16 & 15, [*channels]
    )
    chosen = events.first - first
    is_key = played & (chosen >= 0) & (chosen < len(ARTICULATIONS))
    taken = np.flatnonzero(is_key & events.is_struck)
    if not len(taken):
        return score
    code, settings = events.code.copy(), dict[Setting, int]()
    for place, key, channel in zip(
        taken.tolist(), chosen[taken].tolist(), (code[taken] >> 16 & 15).tolist(), strict=True
    ):
        setting = Setting(ARTICULATION, float(key), channel)
        code[place] = settings.setdefault(setting, -1 - len(events.others) - len(settings))
    count = len(np.unique(chosen[taken]))
    remark = f"notes taken as key switches: {len(taken)} (articulations: {count})"
    switched = events.with_codes(code, tuple(settings)).where(~is_key | (code < 0))
    read = replace(score, events=switched, remarks=(*score.remarks, remark))
    if not len(read.note_columns.key):
        raise ScoreError(f"has no other note: {remark}")
    notes = read.note_columns
    sounding = {*zip(notes.channel.tolist(), notes.track.tolist(), strict=True)}
    parts = [
        part
        for part in score.parts
        if any(part.channel in (c, None) and part.track in (t, None) for c, t in sounding)
    ]
    return replace(read, parts=tuple(parts))


def low_keys(score: Score, channels: Collection[int], within: NoteRange = YEHU) -> Array:
    """The events that begin notes which seem to be key switches of another library.

    They are below the range, and an octave or more below all others of their channel and track.
    """
    notes = score.note_columns
    notes = notes.where(np.isin(notes.channel, [*channels]))
    place = notes.track << 4 | notes.channel
    order = np.argsort(place, kind="stable")
    found = [np.zeros(0, np.int64)]
    for own in np.split(order, np.flatnonzero(np.diff(place[order])) + 1):
        keys = np.unique(notes.key[own])
        below = keys[:-1][(np.diff(keys) >= FAR) & (keys[:-1] < within.lowest)]
        low = own[notes.key[own] <= below.max(initial=-1)]
        if 2 * len(low) <= len(own):
            found.append(notes.begins[low])
    return np.concatenate(found)


def with_low_keys_told(score: Score, channels: Collection[int], within: NoteRange = YEHU) -> Score:
    """A score with a remark that counts its `low_keys`, but for the lower notes of chords."""
    low = low_keys(score, channels, within)
    notes = score.note_columns
    notes = notes.where(np.isin(notes.channel, [*channels]))
    if len(low):
        low = low[np.isin(low, notes.begins[is_single(tops_of(notes))])]
    if not len(low):
        return score
    remark = f"may be key switches, far below the tune: {len(low)} notes (--range skip)"
    return replace(score, remarks=(*score.remarks, remark))


def without_low_keys(score: Score, channels: Collection[int], within: NoteRange) -> Score:
    """A score without its `low_keys`, and a remark that counts them."""
    low = low_keys(score, channels, within)
    if not len(low):
        return score
    remark = f"notes far below the tune left out, as key switches: {len(low)}"
    return replace(without_notes(score, low), remarks=(*score.remarks, remark))
