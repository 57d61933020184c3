"""The sound of phrases: slurs, trills, slides, vibrato, tremolo, plucked notes, ends, no clicks."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pitch import cents, frame_pitch, hertz, pitch_of
from sound import run_for

from yehu_server.core.engine.instrument import Instrument
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.playing.player import Player

RATE = 44100


class Stand:
    """A player and an instrument; times in seconds."""

    def __init__(self, **commands: float) -> None:
        self.instrument: Instrument = Instrument(
            PlayingOptions().spec(RATE, calibration_for(float(RATE)))
        )
        self.player: Player = PlayingOptions().player(self.instrument)
        self.command(0.0, variation=0.0, **commands)

    def command(self, seconds: float, **commands: float) -> None:
        for name, value in commands.items():
            self.player.write(f"/playing/{name}", value, frame=round(seconds * RATE))

    def on(self, seconds: float, note: int) -> None:
        self.player.note_on(Key(0, note), frame=round(seconds * RATE))

    def off(self, seconds: float, note: int) -> None:
        self.player.note_off(Key(0, note), frame=round(seconds * RATE))

    def slur(self, seconds: float, note: int, target: int) -> None:
        self.on(seconds, target)
        self.off(seconds + 0.005, note)

    def play(self, seconds: float) -> np.ndarray:
        return run_for(self.instrument, seconds)


def heard(sound: np.ndarray, start_s: float, seconds: float) -> float:
    """Pitch (fractional MIDI note) of a part of a sound.

    The search begins at F4: both strings ring, and share longer periods.
    """
    part = sound[round(start_s * RATE) : round((start_s + seconds) * RATE)]
    frequency = frame_pitch(part, RATE, lo=330.0)
    return 69.0 + 12.0 * math.log2(frequency / 440.0)


def brightest(sound: np.ndarray, start_s: float, seconds: float) -> float:
    """The largest jump between two samples."""
    part = sound[round(start_s * RATE) : round((start_s + seconds) * RATE)]
    return float(np.abs(np.diff(part)).max())


# ---------------------------------------------------------------- slurs and trills


SLURS = [(66, 68), (70, 71), (71, 70), (70, 68), (72, 74), (74, 72), (74, 76), (76, 74), (81, 79)]


def test_a_slurred_note_is_at_its_pitch_within_60_milliseconds():
    for note, target in SLURS:
        stand = Stand()
        stand.on(0.0, note)
        stand.slur(0.4, note, target)
        sound = stand.play(0.7)
        off = [heard(sound, start_s, 0.03) - target for start_s in (0.46, 0.49, 0.52, 0.6)]
        assert np.abs(off).max() < 0.15, (note, target)


def test_a_slur_is_a_step_and_a_slide_only_with_portamento():
    pitches = {}
    for slides in (0.0, 1.0):
        stand = Stand(portamento=slides, portamento_time=200.0)
        stand.on(0.0, 74)
        stand.slur(0.4, 74, 79)
        pitches[slides] = heard(stand.play(0.7), 0.49, 0.03)
    assert pitches[0.0] == pytest.approx(79.0, abs=0.15)
    assert 75.0 < pitches[1.0] < 78.5


@pytest.mark.parametrize("low", [70, 74, 79])
def test_a_trill_alternates_between_two_notes(low):
    stand = Stand()
    stand.on(0.0, low)
    times = [0.4 + 0.1 * n for n in range(8)]
    for n, time in enumerate(times):
        (stand.off if n % 2 else stand.on)(time, low + 2)
    sound = stand.play(1.3)
    played = [low if n % 2 else low + 2 for n in range(8)]
    off = [heard(sound, t + 0.06, 0.04) - note for t, note in zip(times, played, strict=True)]
    # The open string, just released, bends some of these while it decays, by 10 cents on one
    # processor and by 44 on another, as it depends on rounding; of a thousand such notes one has no
    # clear pitch yet. A whole tone is meant.
    assert np.isnan(off).sum() <= 1
    assert np.nanmedian(np.abs(off)) < 0.15
    assert np.nanmax(np.abs(off)) < 0.8


# ---------------------------------------------------------------- bends and pressing


def test_a_slow_bend_is_followed():
    for note in (73, 75, 77, 84):
        stand = Stand()
        stand.on(0.0, note)
        for n in range(101):
            stand.command(0.4 + 0.01 * n, bend=0.02 * n)
        sound = stand.play(1.6)
        for n in (20, 40, 60, 80, 100):
            time = 0.4 + 0.01 * n  # 12 ms late, by the smoothing; in the middle of 40 ms
            off = heard(sound, time - 0.008, 0.04) - (note + min(0.02 * n, 2.0))
            assert abs(100.0 * off) < 15.0, (note, n)


def test_pressing_harder_raises_the_pitch_as_silk_does():
    stand = Stand(listening=0.0)  # who listens corrects it
    stand.on(0.0, 75)
    stand.command(0.5, press=5.0)
    sound = stand.play(1.0)
    rise = 100.0 * (heard(sound, 0.7, 0.25) - heard(sound, 0.25, 0.2))
    assert 3.0 < rise < 40.0


# ---------------------------------------------------------------- vibrato, tremolo, dynamics


def test_vibrato_is_as_wide_and_as_fast_as_requested():
    stand = Stand(vibrato=30.0, vibrato_rate=6.0, vibrato_delay=0.0)
    stand.on(0.0, 76)
    sound = stand.play(1.6)
    times = np.arange(0.5, 1.5, 0.01)
    track = np.array([heard(sound, t, 0.03) for t in times])
    track -= track.mean()
    turns = np.abs(np.fft.rfft(track * np.hanning(len(track)), 4096))
    rate = np.argmax(turns) / 4096 / 0.01
    assert rate == pytest.approx(6.0, abs=0.4)
    assert 100.0 * np.ptp(track) == pytest.approx(60.0, abs=18.0)


def test_tremolo_is_heard_as_strokes_on_one_pitch():
    stand = Stand(tremolo=8.0)
    stand.on(0.0, 76)
    sound = stand.play(1.5)[RATE // 2 :]
    loudness = np.sqrt(np.convolve(sound.astype(float) ** 2, np.ones(882) / 882.0, "valid"))
    beats = np.abs(np.fft.rfft(loudness[::100] - loudness.mean(), 1 << 14))
    assert np.argmax(beats[150:]) + 150 == pytest.approx(8.0 * (1 << 14) / 441.0, rel=0.1)
    assert abs(cents(pitch_of(sound, RATE), hertz(76))) < 30.0


def test_dynamics_are_heard_as_loudness_and_silence():
    levels = []
    for dynamics in (1.0, 0.6, 0.3, 0.0):
        stand = Stand(dynamics=dynamics)
        stand.on(0.0, 76)
        levels.append(level_db(stand.play(0.8)[RATE // 2 :]))
    assert np.all(np.diff(levels) < -5.0)
    assert levels[-1] < -100.0


def level_db(sound: np.ndarray) -> float:
    return 20.0 * math.log10(np.std(sound) + 1e-12)


def test_a_faster_bow_and_a_higher_level_are_louder():
    levels = []
    for speed, volume in ((0.1, 1.0), (0.2, 1.0), (0.2, 0.7)):
        stand = Stand(speed=speed, volume=volume)
        stand.on(0.0, 75)
        levels.append(level_db(stand.play(1.0)[RATE // 2 :]))
    slow, fast, fast_but_low = levels
    assert fast > max(slow, fast_but_low) + 2.0


@pytest.mark.parametrize("note", [65, 70, 72, 80])
def test_a_note_ends_or_is_silenced_within_five_milliseconds(note):
    stand = Stand()
    stand.on(0.0, note)
    loud = level_db(stand.play(0.5)[RATE // 4 :])
    stand.off(0.5, note)
    assert level_db(stand.play(3.0)[-RATE // 2 :]) < loud - 50.0
    stand.on(3.5, note)
    stand.play(0.5)
    stand.player.notes_off(stand.player.held())
    stand.player.stop_sound()
    assert np.abs(stand.play(0.5)[round(0.005 * RATE) + 1 :]).max() < 1e-3  # -60 dBFS
    stand.on(4.5, note)  # and the next note speaks
    assert abs(heard(stand.play(1.0), 0.5, 0.4) - note) < 0.35


@pytest.mark.parametrize("note", [65, 70, 72, 79])
def test_a_plucked_note_begins_at_once_and_dies_away(note):
    stand = Stand(pizzicato=1.0)
    stand.on(0.1, note)
    sound = stand.play(1.6)
    assert np.abs(sound[: RATE // 10]).max() < 1e-3
    early, late = (np.std(sound[round(s * RATE) :][: RATE // 20]) for s in (0.12, 1.5))
    assert early > 1e-3
    assert late < 0.2 * early
    assert abs(heard(sound, 0.13, 0.08) - note) < 0.6


# ---------------------------------------------------------------- no clicks


@pytest.mark.parametrize("slurred", [True, False])
@pytest.mark.parametrize(
    ("note", "target"), [(66, 68), (69, 67), (70, 74), (76, 69), (72, 79), (81, 72), (65, 72)]
)
def test_where_notes_meet_nothing_jumps_as_a_click_would(note, target, slurred):
    """A new note's first slips may be two thirds sharper than its later ones, and no more."""
    stand = Stand()
    stand.on(0.0, note)
    if slurred:
        stand.slur(0.5, note, target)
    else:
        stand.off(0.5, note)
        stand.on(0.5, target)
    stand.off(1.0, target)
    sound = stand.play(1.3)
    usual = max(brightest(sound, 0.3, 0.15), brightest(sound, 0.75, 0.2))
    assert brightest(sound, 0.495, 0.1) < 1.67 * usual
    assert brightest(sound, 0.995, 0.3) < 1.05 * brightest(sound, 0.75, 0.2)
