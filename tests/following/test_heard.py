"""What is heard of sounds whose pitch is known."""

import itertools

import numpy as np
import pytest
from voices import tune, voice

from yehu_server.errors import YehuError
from yehu_server.following.heard import hear
from yehu_server.following.notes import STEP, _cheapest_path, midi_of, strokes_of
from yehu_server.following.recording import recording_of_samples

RATE = 22050
REST = np.nan


def heard(sound, rate=RATE):
    return hear(recording_of_samples(sound, rate))


def errors_cents(found, pitches, rate=RATE):
    """How far the pitch is off, in frames that have one and should."""
    at = np.clip(np.rint(found.times_s * rate).astype(int), 0, len(pitches) - 1)
    return 100.0 * (midi_of(found.pitch_hz) - pitches[at])


def test_pitches_of_all_voices_are_heard_to_a_cent():
    wrong = []
    for pitch in (40.0, 45.3, 57.5, 69.25, 90.0):
        pitches = tune([(REST, 0.2), (pitch, 0.6), (REST, 0.2)], RATE)
        errors = errors_cents(heard(voice(pitches, RATE)), pitches)[60:140]
        if not np.all(np.abs(errors) < 1.0):
            wrong.append((pitch, errors))
    assert not wrong


def test_in_noise_no_octave_is_wrong():
    noise = np.random.default_rng(1)
    pitches = tune([(REST, 0.2), (50.0, 0.5), (57.0, 0.5), (69.0, 0.5), (REST, 0.2)], RATE)
    sound = voice(pitches, RATE)
    sound += noise.normal(0.0, np.sqrt(np.mean(sound**2)) * 10.0 ** (-20.0 / 20.0), len(sound))
    errors = errors_cents(heard(sound), pitches)
    known = errors[np.isfinite(errors)]
    assert len(known) > 250
    assert np.mean(np.abs(known) > 600.0) < 0.005


def test_levels_are_those_of_the_sound():
    pitches = tune([(69.0, 2.0)], RATE)
    swell = 10.0 ** (np.linspace(-30.0, 0.0, len(pitches)) / 20.0)
    found = heard(voice(pitches, RATE) * swell)
    rise = found.level_db[360] - found.level_db[40]
    assert rise == pytest.approx(30.0 * 1.6 / 2.0, abs=0.5)


def test_strokes_and_slurs_are_distinguished():
    gap = (REST, 0.1)
    notes = [gap, (57.0, 0.4), gap, (57.0, 0.4), gap, (59.0, 0.4), (62.0, 0.4), gap]
    strokes = strokes_of(heard(voice(tune(notes, RATE), RATE)))
    found = [[round(note.pitch) for note in stroke.notes] for stroke in strokes]
    assert found == [[57], [57], [59, 62]]
    starts = [note.start * 0.005 for stroke in strokes for note in stroke.notes]
    assert np.allclose(starts, [0.1, 0.6, 1.1, 1.5], atol=0.03)


def test_a_long_way_is_a_slide_and_a_short_one_a_step():
    slide = np.linspace(57.0, 62.0, round(0.3 * RATE))
    still = tune([(57.0, 0.4)], RATE), tune([(62.0, 0.4)], RATE)
    slid = strokes_of(heard(voice(np.concatenate((still[0], slide, still[1])), RATE)))
    stepped = strokes_of(heard(voice(np.concatenate(still), RATE)))
    assert all(note.is_slide for note in slid[0].notes[1:])
    assert [note.is_slide for note in stepped[0].notes] == [False, False]


# ---------------------------------------------------------------- odd sounds


def test_notes_are_the_cheapest_path_of_all():
    generator = np.random.default_rng(5)
    for _ in range(20):
        cost = generator.uniform(0.0, STEP, (5, 3))
        price = {
            path: cost[range(5), path].sum() + STEP * np.count_nonzero(np.diff(path))
            for path in itertools.product(range(3), repeat=5)
        }
        assert price[tuple(_cheapest_path(cost))] == pytest.approx(min(price.values()))


def test_what_has_no_voice_is_refused():
    for sound, reason in (
        (np.zeros(RATE), "is silent"),
        (np.full(RATE, 0.3), "is silent"),
        (np.zeros(10), "too short"),
        (np.full(RATE, np.nan), "not finite"),
        (np.random.default_rng(1).normal(0.0, 0.1, RATE), "voice"),
        (np.zeros((3, 4, 5)), "expected frames"),
    ):
        with pytest.raises(YehuError, match=reason) as error:
            heard(sound)
        assert "\n" not in str(error.value)
