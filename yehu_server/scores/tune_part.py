"""Find the part of a score that carries the tune, by its name and its notes."""

import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.scores.octaves import NoteSpans, outside_by_octaves

Array = Any

NAMED = re.compile(
    r"melod|\btune\b|\blead\b|\bvocals?\b|^voice\b|\bsing|\bsolo\b|旋律|主奏|领奏|領奏|唱"
    r"|mélod|メロディ|歌|멜로디|주선율|노래|독주|мелоди|соло|голос|вокал",
    re.IGNORECASE,
)
ACCOMPANIES = re.compile(
    r"\bbass\b|chords|accomp|\bpad\b|drum|perc|伴奏|和弦|低音|鼓"
    r"|ベース|ドラム|반주|베이스|드럼|аккомпанемент|\bбас\b|ударн",  # noqa: RUF001
    re.IGNORECASE,
)
# By ear.
LOWEST_TUNE = 50.0  # mean of MIDI notes, below which a part is a bass
LONG_ENOUGH = 0.25  # of the time that the longest part sounds
IN_RANGE = 0.9  # of its notes, moved by octaves as a whole
TOGETHER, MAX_TOGETHER = 0.02, 0.15  # quarters or seconds apart, and share of notes: chords
REPEATED = 0.8  # share of notes equal to the one before, from which a part is an accompaniment
OVERLAP = 0.05  # of the shorter part's sound, from which two parts sound at once
MAX_PAIRS = 1_000_000  # of notes that overlap, in parts that take turns


def melodic_part(names: Sequence[str], notes: NoteSpans, within: NoteRange = YEHU) -> int | None:
    """Return the number, from 0, of the first part that is a melody; else the first with notes.

    A part that is named as one goes before others, one that is named as an accompaniment after
    them, and most of a melody fits `within`. Names and notes are those of all parts, the notes of
    each in order.
    """
    sounding = np.unique(notes.part).tolist()
    may_be = [at for at in sounding if not ACCOMPANIES.search(names[at])]
    are_tunes = _are_tunes(notes, len(names), within)
    tunes = [at for at in may_be if are_tunes[at]]
    named = [at for at in tunes if NAMED.search(names[at])]
    return next(iter([*named, *tunes, *may_be, *sounding]), None)


def take_turns(notes: NoteSpans) -> bool:
    """Whether no two parts sound at once, so that one instrument can play them all."""
    part, begins, ends = notes.part, notes.begin, notes.end
    sounds = np.bincount(part, ends - begins)
    if np.count_nonzero(sounds > 0.0) < 2:
        return True
    # Each note with those that sound as it begins.
    has_length = ends > begins
    order = np.argsort(begins, kind="stable")
    so_far = np.cumsum(has_length[order]) - has_length[order]
    over = np.searchsorted(np.sort(ends[has_length]), begins[order], side="right")
    if (so_far - over).sum() > MAX_PAIRS:
        return False
    shared: dict[tuple[int, int], float] = {}  # by pair of parts, for how long notes of both sound
    held: list[tuple[float, int]] = []  # ends and parts of notes that sound
    most = (OVERLAP * sounds).tolist()
    columns = begins[order].tolist(), ends[order].tolist(), part[order].tolist()
    for begin, end, at in zip(*columns, strict=True):
        held = [each for each in held if each[0] > begin]
        for until, other in held:
            if at != other:
                pair = (at, other) if at < other else (other, at)
                shared[pair] = shared.get(pair, 0.0) + min(end, until) - begin
                if shared[pair] > min(most[at], most[other]):
                    return False
        if end > begin:
            held.append((end, at))
    return True


def _lasting(notes: NoteSpans, parts: int) -> Array:
    """For how long each part has a note: one of a chord's counts, else chords last longest."""
    lasting, until = [0.0] * parts, [-math.inf] * parts
    order = np.argsort(notes.begin, kind="stable")
    columns = (column[order].tolist() for column in (notes.begin, notes.end, notes.part))
    for begin, end, at in zip(*columns, strict=True):
        if end > until[at]:
            lasting[at] += max(0.0, end - max(begin, until[at]))
            until[at] = end
    return np.array(lasting)


def _are_tunes(notes: NoteSpans, parts: int, within: NoteRange) -> Array:
    """Whether each part may be a melody, by its notes."""
    lasting = _lasting(notes, parts)
    notes = notes.where(np.argsort(notes.part, kind="stable"))

    def count(of: NoteSpans, is_so: Array) -> Array:
        """Of how many notes something is so of it and the one before, by part."""
        part = of.part
        return np.bincount(part[1:][is_so & (part[1:] == part[:-1])], minlength=parts)

    counts = np.bincount(notes.part, minlength=parts)
    chords = count(notes, np.diff(notes.begin) < TOGETHER)
    pitched = notes.where(~np.isnan(notes.high))
    pitches = pitched.high
    same = count(pitched, pitches[1:] == pitches[:-1])
    part, starts, of_part = np.unique(pitched.part, return_index=True, return_counts=True)
    found = np.zeros(parts, bool)
    if not len(part):
        return found
    outside = outside_by_octaves(pitched, starts, within).min(axis=0)
    found[part] = (
        (np.add.reduceat(pitches, starts) / of_part >= LOWEST_TUNE)
        & (chords[part] <= MAX_TOGETHER * counts[part])
        & (same[part] <= REPEATED * of_part)
        & (outside <= (1.0 - IN_RANGE) * of_part)
    )
    return found & (lasting > LONG_ENOUGH * lasting.max(initial=0.0))
