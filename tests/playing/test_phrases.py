"""The sound of phrases: slurs, trills, slides, vibrato, tremolo, plucked notes, ends, no clicks."""

import math

import numpy as np
import pytest
from pitch import frame_pitch
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


# ---------------------------------------------------------------- vibrato, tremolo, dynamics


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
