"""What `yehu.compare` finds between sounds that are made to differ."""

from dataclasses import replace

import numpy as np
import pytest
import soundfile

import yehu_server as yehu

RATE = 22050


def tones(hertz=(440.0, 550.0), tilt=1.0, rate=RATE, rest_s=0.1):
    """Notes of 0.4 s with eight harmonics, whose amplitudes fall by a power of their number."""
    parts = []
    for f in hertz:
        time = np.arange(round(0.4 * rate)) / rate
        tone = sum(np.sin(2.0 * np.pi * f * n * time) / n**tilt for n in range(1, 9))
        fade = np.minimum(1.0, np.minimum(time, time[::-1]) / 0.02)
        parts += [0.1 * fade * tone, np.zeros(round(rest_s * rate))]
    return np.concatenate(parts)


def test_the_same_sound_differs_in_nothing_at_any_rate_and_level(tmp_path):
    soundfile.write(tmp_path / "a.wav", tones(rate=44100), 44100, subtype="FLOAT")
    found = yehu.compare(tmp_path / "a.wav", 0.25 * tones(), RATE)
    assert found.spectrum_db < 0.5
    assert found.level_db < 1.5  # windows of 46 ms lie a little otherwise at ends of notes
    assert found.pitch_cents == pytest.approx(0.0, abs=1.0)
    assert found.louder == pytest.approx(20.0 * np.log10(0.25), abs=0.3)
    assert found.later == 0.0


def test_a_rendering_that_begins_early_or_late_is_moved():
    late = np.concatenate([np.zeros(round(0.3 * RATE)), tones()])
    assert yehu.compare(late, tones(), RATE).later == pytest.approx(0.3, abs=0.011)
    found = yehu.compare(tones(), late, RATE)
    assert found.later == pytest.approx(-0.3, abs=0.011)
    assert (found.spectrum_db, found.level_db) == pytest.approx((0.0, 0.0), abs=1.0)


def test_brightness_and_pitch_are_distinguished():
    brighter = yehu.compare(tones([440.0], tilt=2.0), tones([440.0], tilt=1.0), RATE)
    low, high = (np.argmin(np.abs(brighter.frequencies - f)) for f in (440.0, 3520.0))
    more = brighter.spectra[1] - brighter.spectra[0]
    assert more[high] - more[low] == pytest.approx(20.0 * np.log10(8.0), abs=1.5)
    sharper = [hertz * 2.0 ** (20.0 / 1200.0) for hertz in (440.0, 550.0)]
    found = yehu.compare(tones(), tones(sharper), RATE)
    assert found.pitch_cents == pytest.approx(20.0, abs=2.0)
    assert repr(found).endswith("pitch +20 cents>")
    unpitched = replace(found, pitches=np.full_like(found.pitches, np.nan))
    assert repr(unpitched).endswith("no common pitch>")


def test_what_cannot_be_compared_is_reported(refused):
    refused("sample_rate", yehu.compare, tones(), tones())
    refused("nowhere.wav", yehu.compare, "nowhere.wav", tones(), RATE)
    refused("rendering: is silent", yehu.compare, tones(), np.zeros(RATE), RATE)
    refused("rendering: ", yehu.compare, tones(), np.full(RATE, np.nan), RATE)
    refused("recording: is silent", yehu.compare, np.zeros(0), tones(), RATE)
