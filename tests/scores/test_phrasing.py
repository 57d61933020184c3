"""Files with bare notes are shaped; what they mark stays, and so do pitches and onsets."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import mido
import numpy as np
import pytest
from shaping import phrased

from yehu_server.playing.options import PlayingOptions
from yehu_server.rendering.options import Part
from yehu_server.scores.events import Events, ScoreEvent
from yehu_server.scores.phrasing import MIN_FOR_BOWS, is_fingered
from yehu_server.scores.reading import ReadOptions, read_any
from yehu_server.scores.score import COMMON_TIME, Score, phrases_of

BEAT_S = 0.5
EXAMPLES = Path(__file__).parents[2] / "examples"


def bare(*notes, velocity=80, extra=(), metres=(COMMON_TIME,)) -> Score:
    """A score of (start, length in beats, key), and messages at beats."""
    events = []
    for start, length, key in notes:
        on = mido.Message("note_on", note=key, velocity=velocity)
        events.append((start, 1, on))
        events.append((start + length, 0, mido.Message("note_off", note=key)))
    events += [(beat, 2, message) for beat, message in extra]
    events.sort(key=lambda each: each[:2])
    score = [ScoreEvent(beat * BEAT_S, message, beat) for beat, _, message in events]
    return Score(Events.of(score), score[-1].time_s, metres=metres)


SCALE = [(n * 0.5, 0.5, 67 + 2 * (n % 4)) for n in range(16)]
CONTROLLER = mido.Message("control_change", control=11, value=90)


def sounding(score: Score) -> list[tuple[float, int]]:
    return [(note.start_s, note.key) for note in score.notes]


def velocities(score: Score) -> list[int]:
    return [note.velocity for note in score.notes]


def slurs(score: Score) -> int:
    return sum(after.start_s < note.end_s for note, after in pairwise(score.notes))


def test_pitches_and_onsets_stay_and_at_nothing_all():
    score = bare(*SCALE, (9.0, 2.0, 72), (12.0, 0.25, 74), (12.25, 0.25, 76))
    assert phrased(score, 0.0) is score
    for amount in (0.1, 0.5, 1.0):
        assert sounding(phrased(score, amount)) == sounding(score)
        assert phrased(score, amount).duration_s == score.duration_s


def test_a_phrase_is_an_arch_with_accents_about_what_was_written():
    shaped = velocities(phrased(bare(*SCALE), 1.0))
    assert sum(shaped) / len(shaped) == pytest.approx(80.0, abs=4.0)
    # Of like pitch, off the beat: the middle is louder than the ends.
    assert shaped[7] > max(shaped[3], shaped[15])
    assert shaped[8] > shaped[4]  # the first beat of the second bar, of like pitch
    assert shaped[5] > shaped[4]  # higher
    spans = [np.ptp(velocities(phrased(bare(*SCALE), amount))) for amount in (0.3, 0.6, 1.0)]
    assert spans[0] < spans[1] < spans[2]


def test_marked_loudness_stays():
    score = bare(*SCALE, extra=[(0.0, CONTROLLER)])
    assert velocities(phrased(score, 1.0)) == velocities(score)
    louder = bare(*SCALE)
    events = [
        ScoreEvent(event.time_s, event.message.copy(velocity=60 + n), event.beat)
        if event.message.type == "note_on"
        else event
        for n, event in enumerate(louder.events)
    ]
    played = Score(Events.of(events), louder.duration_s)
    assert velocities(phrased(played, 1.0)) == velocities(played)


QUICK = [(n * 0.25, 0.25, 67 + n % 5) for n in range(16)]


def test_short_notes_of_a_beat_share_a_bow():
    shaped = phrased(bare(*QUICK), 0.5)
    assert slurs(shaped) >= 8
    for note, after in pairwise(shaped.notes):
        overlaps = after.start_s < note.end_s
        assert not (overlaps and int(note.beat) != int(after.beat))
        assert note.end_s - after.start_s < 0.02


def test_long_notes_leaps_repeated_notes_and_marked_bows_have_bows_of_their_own():
    pedal = mido.Message("control_change", control=64, value=127)
    for score in (
        bare(*[(n, 1.0, 67 + n % 3) for n in range(8)]),
        bare(*[(n * 0.25, 0.25, 67 + 7 * (n % 2)) for n in range(8)]),
        bare(*[(n * 0.25, 0.25, 67) for n in range(8)]),
        bare(*QUICK, extra=[(0.0, pedal)]),
    ):
        assert slurs(phrased(score, 1.0)) == 0
    marked = bare((0.0, 0.3, 67), (0.25, 0.25, 69), (0.5, 0.25, 71), (0.75, 0.25, 72))
    assert slurs(phrased(marked, 1.0)) == slurs(marked) == 1
    assert slurs(phrased(bare(*QUICK), MIN_FOR_BOWS - 0.01)) == 0


def test_phrases_end_with_rests_long_notes_and_after_four_bars():
    rest = bare((0.0, 1.0, 67), (1.0, 1.0, 69), (3.0, 1.0, 71))
    assert [len(phrase) for phrase in phrases_of(rest.notes)] == [2, 1]
    held = bare(*[(n * 0.5, 0.5, 67) for n in range(6)], (3.0, 3.0, 72), (6.0, 0.5, 67))
    assert [len(phrase) for phrase in phrases_of(held.notes)] == [7, 1]
    even = bare(*[(float(n), 1.0, 67) for n in range(20)])
    assert [len(phrase) for phrase in phrases_of(even.notes)] == [16, 4]


def test_the_bow_breathes_between_phrases_but_not_where_bows_are_marked():
    phrases = [(n * 0.5, 0.5, 67 + n % 3) for n in range(6)], (3.0, 3.0, 72), (6.0, 1.0, 67)
    notes = [*phrases[0], *phrases[1:]]
    ends = [note.end_s for note in phrased(bare(*notes), 0.5).notes]
    assert ends[6] == pytest.approx(3.0 - 0.05)
    assert ends[-1] == pytest.approx(3.5)
    pedal = mido.Message("control_change", control=64, value=0)
    pedalled = phrased(bare(*notes, extra=[(0.0, pedal)]), 0.5).notes
    assert pedalled[6].end_s == 3.0
    slurred = [*phrases[0], (3.0, 3.02, 72), (6.0, 1.0, 67)]
    assert phrased(bare(*slurred), 0.5).notes[6].end_s == pytest.approx(3.01)


def test_bends_of_what_is_not_played_leave_the_left_hand_free():
    """The example has bends in parts beside the one that is played, and that one has none."""
    usual = PlayingOptions()
    how = ReadOptions.by(usual, all_parts=False)
    score = read_any(EXAMPLES / "mo_li_hua.mid", how)
    bent = {event.message.channel for event in score.events if event.message.type == "pitchwheel"}
    played = {note.channel for note in score.notes}
    assert bent
    assert bent.isdisjoint(played)
    assert not is_fingered(score, usual)
    assert dict(Part.shaped([score], replace(usual, phrasing=0.5)).playing.start) == {}
    [bones] = sorted(bent)[:1]
    everything = read_any(EXAMPLES / "mo_li_hua.mid", ReadOptions.by(usual, all_parts=True))
    assert is_fingered(everything, usual)
    assert is_fingered(everything, replace(usual, channels=frozenset({bones})))
    assert not is_fingered(everything, replace(usual, channels=frozenset(played)))


def test_under_mpe_the_bends_of_the_whole_surface_count():
    score = read_any(EXAMPLES / "mpe_phrase.mid")
    assert is_fingered(score, PlayingOptions())


def test_a_fingered_file_keeps_its_left_hand_and_has_a_bow_arm():
    bend = mido.Message("pitchwheel", pitch=900)
    part = Part.shaped([bare(*SCALE, extra=[(0.1, bend)])], PlayingOptions(phrasing=0.5))
    assert part.playing.phrasing == 0.5
    assert dict(part.playing.start)["/playing/left_hand"] == 0.0
