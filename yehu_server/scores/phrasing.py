"""Shape scores of plain notes as a player would: phrases, accents, and bows of several notes.

docs/playing.md has the rules and their sources. Pitches stay, and onsets but for ``rubato``. What
a file marks itself is left alone, channel by channel: velocities that differ,
controllers of loudness, notes that overlap. A page marks loudness in few places: between them
phrases are shaped, but less.
"""

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby, pairwise
from typing import Any

import numpy as np

from yehu_server.playing.options import PlayingOptions
from yehu_server.scores.rubato import delayed
from yehu_server.scores.score import Score, ScoreNote, phrases_of, says_mpe
from yehu_server.scores.slides import with_slides

PHRASING = 0.5  # of files, where nothing else is asked for
LOUDNESS = {1, 2, 7, 11}  # controllers: modulation, breath, volume, expression
PEDALS = {64, 68}  # sustain, legato
LEFT_HAND = {1, 5, 65, 76, 77, 78, 84}  # modulation, portamento, vibrato
LEFT_HAND_MESSAGES = {"pitchwheel", "aftertouch", "polytouch"}
FEW_VELOCITIES = 3  # so many different ones are no dynamics
MARKED_SPAN = 12  # between the softest and the loudest

# In steps of velocity at full phrasing: from the ends of a phrase to its middle, and on the beats;
# for each semitone above the mean pitch of all, and at most.
ARCH, DOWNBEAT, HALF_BAR, BEAT = 100.0, 12.0, 7.0, 4.0
HIGHER, MAX_HIGHER = 6.0, 50.0
BETWEEN_MARKS = 0.6  # so much of arches and accents, between the marks of a page
WIDER = 2.0  # marks lie so much farther from their mean than a page writes them, at full phrasing
# Notes in one bow: so many, each no longer, in steps no wider (semitones), nothing between them.
MAX_IN_A_BOW, SHORT_S, STEP, GAP_S = 4, 0.3, 4, 0.03
MIN_FOR_BOWS = 0.25  # of phrasing, from which notes share a bow
OVERLAP_S = 0.012  # of slurred notes
# Between phrases the bow leaves the string, at full phrasing for so long, or this share of the note
# that ends one, which lasts so long at least.
BREATH_S, BREATH_SHARE, LONG_S = 0.1, 0.2, 0.3
SAME_BEAT = 1e-3


def phrased(score: Score, playing: PlayingOptions) -> Score:
    """Return a score as a player's phrasing and rubato, 0 to 1, shape it; at 0 as it is."""
    amount = playing.phrasing or 0.0
    score = _phrased(score, amount, playing) if amount else score
    return delayed(score, amount if playing.rubato is None else playing.rubato)


def _phrased(score: Score, amount: float, playing: PlayingOptions) -> Score:
    by_channel: dict[int, list[ScoreNote]] = defaultdict(list)
    for note in score.notes:
        by_channel[note.channel].append(note)
    velocities: dict[int, int] = {}
    ends_s: dict[int, float] = {}
    for channel, notes in by_channel.items():
        controllers = {
            event.message.control
            for event in score.events
            if event.message.type == "control_change" and event.message.channel == channel
        }
        phrases = phrases_of(notes)
        mean_key = sum(note.key for note in notes) / len(notes)
        mean_velocity = sum(note.velocity for note in notes) / len(notes)
        is_marked = is_shaped(notes, controllers)
        if score.is_written or not is_marked:
            depth = amount * (BETWEEN_MARKS if is_marked else 1.0)
            for phrase in phrases:
                velocities.update(shaped(phrase, score, depth, mean_key, is_marked=is_marked))
            if is_marked:
                for note in notes:
                    more = WIDER * amount * (note.velocity - mean_velocity)
                    velocities[note.begins] = in_range(velocities[note.begins] + more)
        is_free = not is_bowed(notes, controllers)
        if amount >= MIN_FOR_BOWS and is_free:
            for phrase in phrases:
                ends_s.update(slurred(phrase))
        if score.is_written or is_free:
            ends_s.update(breaths(phrases, amount))
    changed = _changed(score, velocities, ends_s)
    if is_fingered(score, playing):
        return changed
    return with_slides(changed, amount, playing)


def is_shaped(notes: Sequence[ScoreNote], controllers: Iterable[int]) -> bool:
    """Whether loudness is marked: by controllers, or by velocities that differ."""
    velocities = {note.velocity for note in notes}
    differ = len(velocities) > FEW_VELOCITIES or max(velocities) - min(velocities) > MARKED_SPAN
    return differ or not LOUDNESS.isdisjoint(controllers)


def is_bowed(notes: Sequence[ScoreNote], controllers: Iterable[int]) -> bool:
    """Whether bows are marked: by notes that overlap, or by a pedal."""
    overlap = any(after.start_s < note.end_s for note, after in pairwise(notes))
    return overlap or not PEDALS.isdisjoint(controllers)


def is_fingered(score: Score, playing: PlayingOptions) -> bool:
    """Whether vibrato or slides are marked: by bends, aftertouch, or controllers of these.

    Only on channels of notes that are played; under MPE one part has all channels.
    """
    channels = {note.channel for note in score.notes}
    if playing.mapping.mpe or says_mpe(score):
        channels = set(range(16))
    elif playing.channels is not None:
        channels &= playing.channels
    return any(
        getattr(event.message, "channel", None) in channels and _is_of_left_hand(event.message)
        for event in score.events
    )


def _is_of_left_hand(message: Any) -> bool:
    """Whether a message is one that moves the left hand."""
    is_controller = message.type == "control_change" and message.control in LEFT_HAND
    return message.type in LEFT_HAND_MESSAGES or is_controller


def shaped(
    phrase: Sequence[ScoreNote], score: Score, amount: float, mean_key: float, *, is_marked: bool
) -> dict[int, int]:
    """Return the velocities of a phrase's notes, by the numbers of their events.

    An arch whose mean is where the velocities were, accents of the metre, and higher notes louder.
    `mean_key` is that of the part (MIDI note). Where loudness `is_marked`, each run of notes
    that are marked alike keeps its mean, and pitch does nothing.
    """
    begin, end = phrase[0].start_s, phrase[-1].start_s
    velocities = {}
    for _, run in groupby(phrase, key=lambda note: note.velocity if is_marked else 0):
        notes = list(run)
        places = [(n.start_s - begin) / (end - begin) if end > begin else 0.5 for n in notes]
        arch = [4.0 * at * (1.0 - at) for at in places]  # a parabola, 1 in the middle
        middle = sum(arch) / len(arch)
        for note, height in zip(notes, arch, strict=True):
            higher = 0.0 if is_marked else HIGHER * (note.key - mean_key)
            higher = min(max(higher, -MAX_HIGHER), MAX_HIGHER)
            change = amount * (ARCH * (height - middle) + accent(note.beat, score) + higher)
            velocities[note.begins] = in_range(note.velocity + change)
    return velocities


def in_range(velocity: float) -> int:
    """The velocity of MIDI nearest to a number."""
    return min(max(round(velocity), 1), 127)


def accent(beat: float, score: Score) -> float:
    """Return the accent (velocity) of a beat in its bar."""
    if math.isnan(beat):
        return 0.0
    start, quarters = score.bar_at(beat)
    place = (beat - start) % quarters
    if min(place, quarters - place) < SAME_BEAT:
        return DOWNBEAT
    if quarters % 2.0 == 0.0 and abs(place - quarters / 2.0) < SAME_BEAT:
        return HALF_BAR
    return BEAT if abs(place - round(place)) < SAME_BEAT else 0.0


def slurred(phrase: Sequence[ScoreNote]) -> dict[int, float]:
    """Return the new ends (s) of notes that share a bow with the next, by their events' numbers."""
    ends = {}
    in_bow = 1
    for note, after in pairwise(phrase):
        goes_on = (
            0.0 <= after.start_s - note.end_s <= GAP_S
            and note.length_s <= SHORT_S
            and after.length_s <= SHORT_S
            and 0 < abs(after.key - note.key) <= STEP
            and _share_a_beat(note, after)
            and in_bow < MAX_IN_A_BOW
            and note.ends >= 0
        )
        in_bow = in_bow + 1 if goes_on else 1
        if goes_on:
            ends[note.ends] = after.start_s + min(OVERLAP_S, 0.5 * after.length_s)
    return ends


def breaths(phrases: Sequence[Sequence[ScoreNote]], amount: float) -> dict[int, float]:
    """Return the new ends (s) of notes after which a phrase begins at once, by their events."""
    ends = {}
    for phrase, after in pairwise(phrases):
        last, gap_s = phrase[-1], after[0].start_s - phrase[-1].end_s
        breath_s = min(BREATH_S * amount, BREATH_SHARE * last.length_s)
        if 0.0 <= gap_s < breath_s and last.length_s >= LONG_S and last.ends >= 0:
            ends[last.ends] = after[0].start_s - breath_s
    return ends


def _share_a_beat(note: ScoreNote, after: ScoreNote) -> bool:
    if math.isnan(note.beat):
        return False
    return math.floor(after.beat + SAME_BEAT) == math.floor(note.beat + SAME_BEAT)


def _changed(score: Score, velocities: dict[int, int], ends_s: dict[int, float]) -> Score:
    events = score.events
    code, time_s = events.code.copy(), events.time_s.copy()
    struck = [*velocities]
    code[struck] = code[struck] & ~127 | np.array([*velocities.values()], np.int64)
    moved = {place: at_s for place, at_s in ends_s.items() if place not in velocities}
    time_s[[*moved]] = [*moved.values()]
    events = replace(events, code=code, time_s=time_s)
    return replace(score, events=events.where(np.argsort(time_s, kind="stable")))
