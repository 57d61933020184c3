"""Find the part of a score that carries the tune, by its name and its notes."""

import re
from collections.abc import Sequence
from itertools import pairwise
from operator import itemgetter

from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.scores.octaves import NoteSpan, octaves_of

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


def melodic_part(
    names: Sequence[str], parts: Sequence[Sequence[NoteSpan]], within: NoteRange = YEHU
) -> int | None:
    """Return the number, from 0, of the first part that is a melody; else the first with notes.

    A part that is named as one goes before others, one that is named as an accompaniment after
    them, and most of a melody fits `within`. Names and parts are those of all parts: the notes of
    each, in any one unit of time.
    """
    lasting = [*map(_sounds, parts)]
    least = LONG_ENOUGH * max(lasting, default=0.0)
    sounding = [at for at, notes in enumerate(parts) if notes]
    may_be = [at for at in sounding if not ACCOMPANIES.search(names[at])]
    tunes = [at for at in may_be if lasting[at] > least and _is_tune(parts[at], within)]
    named = [at for at in tunes if NAMED.search(names[at])]
    return next(iter([*named, *tunes, *may_be, *sounding]), None)


def take_turns(parts: Sequence[Sequence[NoteSpan]]) -> bool:
    """Whether no two of the parts sound at once, so that one instrument can play them all."""
    sounds = [sum(note.end - note.begin for note in notes) for notes in parts]
    if sum(sound > 0.0 for sound in sounds) < 2:
        return True
    placed = [(note.begin, note.end, at) for at, notes in enumerate(parts) for note in notes]
    shared: dict[tuple[int, int], float] = {}  # by pair of parts, for how long notes of both sound
    held: list[tuple[float, int]] = []  # ends and parts of notes that sound
    pairs = 0
    for begin, end, at in sorted(placed, key=itemgetter(0)):
        held = [each for each in held if each[0] > begin]
        pairs += len(held)
        if pairs > MAX_PAIRS:
            return False
        for until, other in held:
            if at != other:
                pair = (at, other) if at < other else (other, at)
                shared[pair] = shared.get(pair, 0.0) + min(end, until) - begin
                if shared[pair] > OVERLAP * min(sounds[at], sounds[other]):
                    return False
        if end > begin:
            held.append((end, at))
    return True


def _sounds(notes: Sequence[NoteSpan]) -> float:
    """For how long there is a note: one of a chord's counts, else chords are the longest part."""
    sounds, until = 0.0, float("-inf")
    for begin, end, _ in sorted(notes, key=itemgetter(0)):
        if end > until:
            sounds += max(0.0, end - max(begin, until))
            until = end
    return sounds


def _is_tune(notes: Sequence[NoteSpan], within: NoteRange) -> bool:
    pitches = [max(note.pitches) for note in notes if note.pitches]
    if not pitches:
        return False
    chords = sum(after.begin - note.begin < TOGETHER for note, after in pairwise(notes))
    same = sum(one == other for one, other in pairwise(pitches))
    octaves = octaves_of([note for note in notes if note.pitches], float("inf"), within)
    return (
        sum(pitches) / len(pitches) >= LOWEST_TUNE
        and chords <= MAX_TOGETHER * len(notes)
        and same <= REPEATED * len(pitches)
        and octaves.outside <= (1.0 - IN_RANGE) * len(notes)
    )
