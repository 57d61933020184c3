"""Add slides to scores, over leaps and some steps: the finger leaves early, to arrive on the beat.

In a score the next note is known. So the bow that plays the first note carries the slide, and the
second note begins where it is written, on its pitch; live a slide can only follow the beat
(``core.player.phrasing``). The slide is a bend of the first note. Which steps have one, and how
long each lasts, the seed says; without variation no seed changes it.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from random import Random
from typing import NamedTuple

import numpy as np

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.core.physics.elementary import exp
from yehu_server.core.player.fingering import OPEN_WITHIN
from yehu_server.core.player.gestures import BEARS_SLIDE, STEEP
from yehu_server.core.player.note_range import NoteRange
from yehu_server.core.player.phrasing import LONG_S, MAX_LEAP, MIN_LEAP, USUAL_PHRASING
from yehu_server.params.spec import TURNED_ON
from yehu_server.params.table import find
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.stringing import notes_of as range_of
from yehu_server.scores.events import BEND, ScoreEvent, Setting
from yehu_server.scores.score import Score, ScoreNote

ARTICULATION, STRING = "/playing/articulation", "/playing/string"
PHRASING, PIZZICATO, PORTAMENTO = "/playing/phrasing", "/playing/pizzicato", "/playing/portamento"
INNER = 1.0
LEFT_HAND, VARIATION = "/playing/left_hand", "/playing/variation"
SEEN = (ARTICULATION, BEND, LEFT_HAND, PHRASING, PIZZICATO, PORTAMENTO, STRING, VARIATION)
STEP_S = 0.005  # between the points of a slide: the player's own interval
BEND_S = 1e-3 * find(BEND).smooth_ms  # after which the finger is at a point
GAP_S = 0.045  # between two notes that a slide may join
# Time of a slide at USUAL_PHRASING and above, and the most of its note. In recordings of violins 6
# to 25 % of the steps last longer than 60 ms. By ear.
SHORTEST_S, LONGEST_S, MOST = 0.15, 0.3, 0.42
MIN_STEP = 0.5  # semitones
# The share of steps up that slide at USUAL_PHRASING, of narrow ones and of thirds; of steps down.
NARROW, THIRD, THIRD_FROM, FALLING = 0.22, 0.34, 2.5, 0.8


def logistic(part: float) -> float:
    """The share of a slide, 0 to 1, that is done at a share of its time; as `gestures.slid`."""

    def curve(at: float) -> float:
        return 1.0 / (1.0 + exp(-STEEP * (2.0 * at - 1.0)))

    low, high = curve(0.0), curve(1.0)
    return (curve(min(max(part, 0.0), 1.0)) - low) / (high - low)


class Slide(NamedTuple):
    """A slide from one note to the next; `string` is set for both, where it is not 0."""

    note: ScoreNote
    after: ScoreNote
    semitones: float
    string: float
    lasts_s: float


class _State(NamedTuple):
    """The values of the parameters of SEEN, and how often the bend was set until then."""

    values: Mapping[str, float]
    bends: int


def with_slides(score: Score, amount: float, playing: PlayingOptions) -> Score:
    """Return a score with slides over leaps and some steps, as far as phrasing (0 to 1) says."""
    within = range_of(playing.quantities)
    slides = list(_slides(score, amount, playing, within))
    on_strings = {slide.note.begins for slide in slides if slide.string}
    before: list[tuple[int, ScoreEvent]] = []  # each with the number of the event after
    for slide in slides:
        note, after = slide.note, slide.after
        on, then = score.events[note.begins], score.events[after.begins]
        set_on, set_then = (partial(_setting, event, after.channel) for event in (on, then))
        if slide.string:
            before.append((note.begins, set_on(on.time_s, STRING, slide.string)))
            if after.begins not in on_strings:
                before.append((after.begins + 1, set_then(then.time_s, STRING, None)))
        count = math.ceil(slide.lasts_s / STEP_S)
        for number in range(1, count + 1):
            at_s = min(note.end_s, then.time_s) - BEND_S - (count - number) * STEP_S
            place = int(np.searchsorted(score.events.time_s, at_s, side="right"))
            bend = slide.semitones * logistic(number / count)
            before.append((place, set_on(at_s, BEND, bend, is_passing=True)))
    return replace(score, events=score.events.with_before(before))


def _setting(
    at: ScoreEvent,
    channel: int,
    time_s: float,
    address: str,
    value: float | None,
    *,
    is_passing: bool = False,
) -> ScoreEvent:
    setting = Setting(address, value, channel, is_passing)
    return ScoreEvent(time_s, setting, at.beat, at.track)


def _slides(
    score: Score, amount: float, playing: PlayingOptions, within: NoteRange
) -> Iterator[Slide]:
    """The slides that bow and fingers are free for, over leaps and over some steps."""
    notes = [note for note in score.notes if note.channel != PERCUSSION_CHANNEL]
    states = _states(score, playing, amount)
    for note, after in pairwise(notes):
        is_one = note.channel == after.channel and note.ends >= 0
        is_long = note.length_s > LONG_S and after.length_s >= LONG_S
        if not (is_one and is_long and after.start_s - note.end_s <= GAP_S):
            continue
        state, then = states[note.begins], states[after.begins]
        low, high = sorted(_pitch(each, playing, within) for each in (note, after))
        rise = after.key - note.key
        seed = playing.seed if state.values[VARIATION] > 0.0 else 0
        if not _slides_over(high - low, rise > 0, amount, _chance(seed, note, 0)):
            continue
        if not _is_free(state) or not _is_free(then) or state.bends != then.bends:
            continue
        string = _string(low, high, (state, then), within)
        if string is not None:
            semitones = math.copysign(high - low, rise)
            usual_s = SHORTEST_S + (LONGEST_S - SHORTEST_S) * _chance(seed, note, 1)
            lasts_s = min(usual_s * min(amount / USUAL_PHRASING, 1.0), MOST * note.length_s)
            yield Slide(note, after, semitones, string, lasts_s)


def _slides_over(semitones: float, is_up: bool, amount: float, chance: float) -> bool:
    """Whether a slide goes over an interval: over each leap, and some steps by chance (0 to 1)."""
    if MIN_LEAP < semitones < MAX_LEAP:
        return True
    if not MIN_STEP < semitones <= MIN_LEAP:  # nor where it is NaN
        return False
    share = THIRD if semitones > THIRD_FROM else NARROW
    return chance < share * (1.0 if is_up else FALLING) * amount / USUAL_PHRASING


def _chance(seed: int, note: ScoreNote, which: int) -> float:
    """A number from 0 to 1 that a note has under a seed."""
    number = (seed << 32) + 2 * note.begins + which
    return Random(number).random()  # noqa: S311 - no secret


def _pitch(note: ScoreNote, playing: PlayingOptions, within: NoteRange) -> float:
    """The pitch (fractional MIDI note) of a note; NaN where the instrument has none for it."""
    tuned = playing.tuning.pitch(note.key, playing.a4)
    fitted = None if tuned is None else playing.policy.fit(tuned, within)
    return math.nan if fitted is None else fitted


def _states(score: Score, playing: PlayingOptions, amount: float) -> dict[int, _State]:
    """The values of parameters as notes begin, by the numbers of the notes' events."""
    start = {**dict(playing.mapping.start), PHRASING: amount}
    start |= {**dict(playing.start), **dict(playing.settings)}
    defaults = {address: start.get(address, find(address).default) for address in SEEN}
    by_channel: dict[int, _State] = defaultdict(lambda: _State(defaults, 0))
    found = {}
    for number, event in enumerate(score.events):
        message = event.message
        if isinstance(message, Setting) and message.address in SEEN:
            values, bends = by_channel[message.channel]
            value = defaults[message.address] if message.value is None else message.value
            own = _State({**values, message.address: value}, bends + (message.address == BEND))
            by_channel[message.channel] = own
        elif message.type == "control_change":
            for bind in playing.mapping.of(f"cc {message.control}"):
                if bind.target == ARTICULATION:
                    values, bends = by_channel[message.channel]
                    chosen = {ARTICULATION: bind.from_unit(message.value / 127.0)}
                    by_channel[message.channel] = _State({**values, **chosen}, bends)
        elif message.type == "note_on":
            found[number] = by_channel[message.channel]
    return found


def _is_free(state: _State) -> bool:
    """Whether a note has no other slide, bend or gesture, and is bowed."""
    row = round(state.values[ARTICULATION])
    bears = bool(BEARS_SLIDE[row]) if 0 <= row < len(BEARS_SLIDE) else True
    is_on = max(state.values[PIZZICATO], state.values[PORTAMENTO]) >= TURNED_ON
    phrases = min(state.values[PHRASING], state.values[LEFT_HAND]) > 0.0
    return bears and not is_on and state.values[BEND] == 0.0 and phrases


def _string(low: float, high: float, states: Sequence[_State], within: NoteRange) -> float | None:
    """The string to set for a slide between two pitches, 0 for any; None where none has both.

    No finger slides to where a string is open.
    """
    inner, outer = within.open_notes
    requested = [round(state.values[STRING]) for state in states]
    if low < inner + OPEN_WITHIN:
        return None
    if low >= outer + OPEN_WITHIN:
        return None if INNER in requested and high > within.highest_notes[0] else 0.0
    if high <= outer - OPEN_WITHIN or requested == [INNER, INNER]:
        return 0.0
    return INNER if high <= within.highest_notes[0] and requested == [0, 0] else None
