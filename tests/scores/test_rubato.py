"""The tempo of scores gives way within phrases, which begin on time; all parts move together."""

from fractions import Fraction
from itertools import pairwise

import mido
import numpy as np
import pytest
from shaping import phrased

from yehu_server.scores.reading import ReadOptions, performed_part, read_any
from yehu_server.scores.score import Score
from yehu_server.scores.written.notated import Note, Part, Span, Tempo, Written

QUARTER = 480  # ticks; at 120 a minute half a second
PHRASE = [1.0] * 7 + [3.0]  # quarters: the last one ends a phrase


def midi(folder, *parts, jitter=0.0, tempi=()):
    """A file of parts of (quarters, key); onsets come later and sooner by a share of a quarter."""
    file = mido.MidiFile(ticks_per_beat=QUARTER)
    track = file.add_track()
    now = 0
    for beat, tempo in tempi:
        at = round(QUARTER * beat)
        track.append(mido.MetaMessage("set_tempo", tempo=mido.bpm2tempo(tempo), time=at - now))
        now = at
    chance = np.random.default_rng(1)
    for channel, notes in enumerate(parts):
        track = file.add_track()
        track.append(mido.MetaMessage("track_name", name=f"part {channel + 1}"))
        now, beat = 0, 0.0
        for quarters, key in notes:
            on = max(round(QUARTER * (beat + jitter * chance.uniform(-1.0, 1.0))), now)
            off = round(QUARTER * (beat + 0.9 * quarters))
            own = {"channel": channel, "note": key, "velocity": 80}
            track.append(mido.Message("note_on", time=on - now, **own))
            track.append(mido.Message("note_off", time=off - on, **own))
            now, beat = off, beat + quarters
    path = folder / "score.mid"
    file.save(path)
    return path


def tune(*, low=0, phrases=3):
    return [(each, 72 + low + number % 5) for number, each in enumerate(phrases * PHRASE)]


def later(score: Score, **how) -> np.ndarray:
    """How much later than written (s) each note begins."""
    played = phrased(score, 0.5, **how).notes
    return np.array([b.start_s - a.start_s for a, b in zip(score.notes, played, strict=True)])


def test_phrases_begin_on_time_and_are_slower_at_their_ends_than_in_their_middle(tmp_path):
    delays = later(read_any(midi(tmp_path, tune())))
    assert delays[[0, 8, 16]] == pytest.approx(0.0, abs=1e-9)
    first = delays[:8]
    assert 0.01 < first.max() < 0.035
    assert -0.035 < first.min() < -0.01
    steps = np.diff(first)
    assert steps[0] > 0.0 > steps[3]
    assert np.array([delays[8]]) - delays[7] > 0.0  # the last note is longer


def test_rubato_goes_with_phrasing_or_as_far_as_is_asked_and_notes_keep_their_order(tmp_path):
    score = read_any(midi(tmp_path, tune()))
    usual = later(score)
    assert later(score, rubato=1.0) == pytest.approx(2.0 * usual)
    assert (later(score, rubato=0.0) == 0.0).all()
    assert phrased(score, 0.0) is score
    alone = [note.start_s for note in phrased(score, 0.0, rubato=0.5).notes]
    assert alone == pytest.approx([note.start_s for note in phrased(score, 0.5).notes])
    most = phrased(score, 1.0)
    times = [event.time_s for event in most.events]
    assert times == sorted(times)
    for note, after in pairwise(most.notes):
        assert note.start_s < note.end_s <= after.start_s + 0.013


def test_all_parts_move_together_whichever_is_read(tmp_path):
    slow = [(2.0, 67 + number % 3) for number in range(15)]
    path = midi(tmp_path, tune(), slow)
    times = [each.start_s for each in read_any(path, ReadOptions(all_parts=True)).notes]
    every = dict(zip(times, later(read_any(path, ReadOptions(all_parts=True))), strict=True))
    assert len({*every.values()}) > 10
    for name in ("part 1", "part 2"):
        score = read_any(path, ReadOptions((name,)))
        for note, delay in zip(score.notes, later(score), strict=True):
            assert delay == pytest.approx(every[note.start_s], abs=1e-9)


def test_what_a_person_played_or_gave_a_tempo_of_its_own_stays(tmp_path):
    played = midi(tmp_path, tune(), jitter=0.05)
    assert read_any(played).delays == ()
    shaped = midi(tmp_path, tune(), tempi=[(n, 120 + 10 * (n % 2)) for n in range(24)])
    assert read_any(shaped).delays == ()
    two = midi(tmp_path, tune(), tempi=[(0, 120), (16, 90)])
    assert read_any(two).delays != ()


def written(*spans: Span, lengths=PHRASE) -> Score:
    beat, notes = Fraction(0), []
    for number, each in enumerate(lengths):
        length = Fraction(each)
        notes.append(Note(beat, length, 72.0 + number % 4))
        beat += length
    part = Part("", tuple(notes), spans)
    return performed_part(Written((part,), (Tempo(Fraction(0), 120.0),)))


def test_the_end_is_slower_unless_its_tempo_is_written():
    """The last beats ever more, the last note by a share of one beat."""
    score = written()
    delays = later(score)
    steps = np.diff(delays)
    assert steps[-1] > steps[-2] > steps[-3]
    longer = phrased(score, 0.5).duration_s - score.duration_s
    assert 0.05 < longer < 0.15
    few = written(lengths=[1, 1, 4])
    assert later(few) == pytest.approx([0.0] * 3)
    slower = written(Span("ritardando", Fraction(4), Fraction(10)))
    assert phrased(slower, 0.5).duration_s == pytest.approx(slower.duration_s)
