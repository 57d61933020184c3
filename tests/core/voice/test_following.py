"""What a voice comes to as it is sung: pitches, notes, strokes; how soon, and with which errors."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np
import pytest

from yehu_server.core.engine.voice_callback import COMMAND_NUMBERS, follow_voice, voice_prepare
from yehu_server.core.player.commands import BEGIN, END, SLIDE, WRITE
from yehu_server.core.player.note_range import HIGHEST_NOTE, LOWEST_NOTE
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.core.voice.note_detection import FOLLOWER, MAX_TRANSPOSE

RATE = 48000.0
BLOCK = 128
LOUDER = -1  # stands for WRITE of the dynamics
PERIOD_OF_F4_S = 1.0 / 349.2


@dataclass
class Followed:
    """Commands (kind, pitch or value) with their times (s), and pitch and level of each block."""

    commands: list[tuple[float, int, float]]
    times: np.ndarray
    pitch: np.ndarray  # NaN: no note sounds

    def of(self, *kinds: int) -> list[tuple[float, float]]:
        return [(time, value) for time, kind, value in self.commands if kind in kinds]


def followed(
    sound: np.ndarray, rate: float = RATE, transpose: float = math.nan, correct: float = 0.0
) -> Followed:
    voice, into = np.zeros(1, FOLLOWER), np.zeros((256, COMMAND_NUMBERS))
    voice_prepare.call(voice.ctypes.data, rate, transpose, correct)
    sound = np.ascontiguousarray(sound, np.float32)
    commands, times, pitch = [], [], []
    for start in range(0, len(sound) + 1, BLOCK):
        block = sound[start : start + BLOCK]
        count = follow_voice.call(
            voice.ctypes.data, block.ctypes.data, len(block), into.ctypes.data, 256
        )
        time = (start + len(block)) / rate
        for kind, index, value, other in into[:count].tolist():
            is_louder = (int(kind), int(index)) == (WRITE, PLAYING.dynamics)
            pitch_or_value = other if int(kind) == BEGIN else value
            commands.append((time, LOUDER if is_louder else int(kind), pitch_or_value))
        times.append(time)
        pitch.append(voice["followed"][0] if voice["is_sounding"][0] else math.nan)
    return Followed(commands, np.array(times), np.array(pitch))


def vowel(pitch: np.ndarray, rate: float = RATE) -> np.ndarray:
    """A sung vowel: pulses through three formants, up to 12 kHz; at most 1."""
    hz = 440.0 * 2.0 ** ((pitch - 69.0) / 12.0)
    turn, sound = np.exp(2j * np.pi * np.cumsum(hz) / rate), np.zeros(len(pitch))
    partial = np.ones_like(turn)
    for k in range(1, int(min(0.45 * rate, 12e3) / hz.max()) + 1):
        gain = sum(1.0 / (1.0 + ((k * hz - f) / 90.0) ** 2) + 0.03 for f in (700.0, 1200.0, 2600.0))
        partial *= turn
        sound += gain / k * (partial * np.exp(0.3j * k * k)).imag
    return sound / np.abs(sound).max()


def sung(
    pitch: Callable[[np.ndarray], np.ndarray],
    seconds: float = 1.0,
    *,
    rate: float = RATE,
    level: float = 0.1,
    noise_db: float = 40.0,
    seed: int = 3,
) -> np.ndarray:
    """A voice after 0.3 s of its room's noise, and that again."""
    time = np.arange(int(seconds * rate)) / rate
    ramp = np.clip(np.minimum(time, time[::-1]) / 0.015, 0.0, 1.0)
    voice = level * ramp * vowel(pitch(time), rate)
    rms = math.sqrt(np.square(voice).mean())
    rest = np.zeros(int(0.3 * rate))
    whole = np.concatenate((rest, voice, rest))
    random = np.random.default_rng(seed)
    return whole + random.normal(0.0, rms * 10.0 ** (-noise_db / 20.0), len(whole))


def test_each_voice_is_heard_at_each_rate(everything):
    wrong = []
    rates = (8000.0, 22050.0, 44100.0, 48000.0, 96000.0, 192000.0)
    cases = list(product(rates, (42.0, 57.0, 72.0, 90.0)))
    for rate, pitch in cases if everything else cases[::3]:  # each rate, and each pitch
        heard = followed(sung(lambda t, p=pitch: np.full(len(t), p), 0.6, rate=rate), rate)
        steady = heard.pitch[(heard.times > 0.4) & (heard.times < 0.85)]
        cents = 100.0 * np.abs(steady - pitch)
        if not (np.isfinite(steady).all() and np.quantile(cents, 0.9) < 6.0):
            wrong.append((rate, pitch, np.isfinite(steady).mean(), np.median(cents)))
    assert wrong == []


def test_a_note_begins_within_two_periods_of_f4_and_20_ms():
    late = {}
    for pitch in (60.0, 65.0, 69.0, 74.0):
        [(time, _)] = followed(sung(lambda t, p=pitch: np.full(len(t), p))).of(BEGIN)
        late[pitch] = 1e3 * (time - 0.3)
    bound = 1e3 * (2.0 * PERIOD_OF_F4_S + 0.02)
    assert max(late.values()) < bound, late


def test_noise_and_silence_play_nothing():
    random = np.random.default_rng(5)
    hum = 0.02 * np.sin(2.0 * np.pi * 50.0 * np.arange(96000) / RATE)
    for sound in (np.zeros(96000), random.normal(0.0, 0.1, 96000), hum):
        assert followed(sound).commands == []


def test_vibrato_and_slides_are_one_note_that_slides():
    def pitch(time: np.ndarray) -> np.ndarray:
        slide = 5.0 * np.clip((time - 0.8) / 0.4, 0.0, 1.0)
        return 57.0 + slide + 0.5 * np.sin(2.0 * np.pi * 5.5 * time)

    heard = followed(sung(pitch, 1.6))
    assert len(heard.of(BEGIN)) == len(heard.of(END)) == 1
    times, played = np.array(heard.of(SLIDE)).T
    late = 0.014  # half of what is compared, and a block
    error = 100.0 * (played - 12.0 - pitch(times - 0.3 - late))
    inside = (times > 0.4) & (times < 1.85)
    assert np.quantile(np.abs(error[inside]), 0.9) < 25.0
    assert abs(np.median(error[inside])) < 5.0


def test_leaps_are_slurred_notes():
    notes = [60.0, 64.0, 67.0, 65.0, 72.0, 60.0]
    heard = followed(sung(lambda t: np.repeat(notes, len(t) // 6 + 1)[: len(t)], 1.8))
    begun = heard.of(BEGIN)
    assert [round(value) for _, value in begun] == [round(note) + 12 for note in notes]
    gaps = [time for time, _ in heard.of(END)]
    for (_, _), (time, _) in pairwise(begun):
        assert time in gaps  # the note before ends as the next begins: no new stroke


def test_an_octave_that_is_not_sung_is_not_played():
    """A voice whose second partial comes and goes: no wrong octave for longer than 50 ms."""
    time = np.arange(2 * 48000) / RATE
    strong = 0.5 - 0.5 * np.sign(np.sin(2.0 * np.pi * 3.0 * time + 0.1))
    phase = 2.0 * np.pi * 196.0 * time
    sound = 0.1 * ((1.0 - 0.8 * strong) * np.sin(phase) + strong * np.sin(2.0 * phase + 1.0))
    heard = followed(sound + np.random.default_rng(1).normal(0.0, 1e-4, len(sound)))
    off = np.abs(heard.pitch - 55.0) > 1.0
    longest = max(len(run) for run in "".join("x" if one else " " for one in off).split(" "))
    assert longest * BLOCK / RATE < 0.05


def test_the_same_note_sung_again_is_a_new_stroke():
    sound = sung(lambda t: np.full(len(t), 60.0), 2.0)
    time = np.arange(len(sound)) / RATE - 0.3
    is_between = (time > 0.2) & (time < 1.9) & (time % 0.5 < 0.03)
    struck = followed(sound * np.where(is_between, 0.15, 1.0))
    assert len(struck.of(BEGIN)) == 4  # at 0, 0.5, 1.0 and 1.5 s
    swelled = followed(sound * (0.4 + 0.3 * np.sin(2.0 * np.pi * 1.5 * time)))
    assert len(swelled.of(BEGIN)) == 1
    # It rings, and is sung again louder: it stays like itself, and what has rung for long is soon
    # as loud as before.
    level_db = np.interp(time, [0.8, 1.0, 1.04], [-5.0, -22.0, 0.0])
    assert len(followed(sound * 10.0 ** (level_db / 20.0)).of(BEGIN)) == 2


def test_all_is_played_within_the_range_of_the_instrument_and_moved_no_further():
    for pitch in (36.5, 50.0, 88.0):
        heard = followed(sung(lambda t, p=pitch: p + 6.0 * np.sin(2.0 * np.pi * 0.7 * t), 3.0))
        played = [value for _, value in heard.of(BEGIN, SLIDE)]
        assert played
        assert LOWEST_NOTE <= min(played) <= max(played) <= HIGHEST_NOTE
    for pitch, transpose, expected in ((67.0, math.nan, 67.0), (62.0, 7.0, 69.0)):
        sound = sung(lambda t, p=pitch: np.full(len(t), p))
        [(_, key)] = followed(sound, transpose=transpose).of(BEGIN)
        assert key == pytest.approx(expected, abs=0.05)


def test_vibrato_of_a_bowed_string_is_no_new_stroke():
    """Partials come and go under a resonance as the pitch swings, by 8 dB; a breath is one."""
    time = np.arange(int(2.0 * RATE)) / RATE
    swing = np.sin(2.0 * np.pi * 5.5 * time)
    sound = sung(lambda t: 64.0 + 0.2 * np.sin(2.0 * np.pi * 5.5 * t), 2.0)
    inside = slice(14400, 14400 + len(time))
    swinging, breathing = sound.copy(), sound.copy()
    swinging[inside] *= 10.0 ** (4.0 * swing / 20.0)
    breath = np.random.default_rng(2).normal(0.0, 0.02, len(sound))
    at = np.abs(np.arange(len(sound)) / RATE - 1.3) < 0.03
    breathing[at] = 0.2 * breathing[at] + breath[at]
    assert len(followed(swinging).of(BEGIN)) == 1
    assert len(followed(breathing).of(BEGIN)) == 2


def test_a_correction_moves_what_is_played_to_the_tuning():
    def pitch(time: np.ndarray) -> np.ndarray:
        return 67.3 + 0.27 * np.sin(2.0 * np.pi * 5.0 * time)

    off = {}
    for correct in (0.0, 0.5, 1.0):
        heard = followed(sung(pitch), correct=correct)
        played = np.array([value for _, value in heard.of(BEGIN, SLIDE)])
        off[correct] = np.abs(played - 67.0).max()
    assert off[1.0] < 1e-9  # though the voice is nearer to the next note at times
    assert off[0.5] == pytest.approx(0.285, abs=0.03)
    assert off[0.0] == pytest.approx(0.57, abs=0.05)


def test_a_wild_transposition_is_bounded_and_comes_to_notes_in_range():
    sound = sung(lambda t: np.full(len(t), 60.0), 0.3)
    for transpose, correct in ((math.inf, 1.0), (-1e308, math.nan), (1e18, 1e308)):
        voice = np.zeros(1, FOLLOWER)
        voice_prepare.call(voice.ctypes.data, RATE, transpose, correct)
        assert abs(voice["transpose"][0]) <= MAX_TRANSPOSE  # or a note has no end of octaves
        [(_, pitch)] = followed(sound, transpose=transpose, correct=correct).of(BEGIN)
        assert LOWEST_NOTE <= pitch <= HIGHEST_NOTE
