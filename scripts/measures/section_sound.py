"""The sound of a section: its tuning, its spectrum, its loudness."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from measures.life import pitch_track
from measures.section_take import SectionTake
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.player.note_tables import OPEN_NOTES
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.playing.parts import section_specs
from yehu_server.playing.pitch_and_level import a_weighted_db, cents, pitch_hz

PLAYERS = 8
NOTES = range(65, 90)  # F4 to F6
NOTE_S, BEAT_S, STEADY_S = 1.0, 1.2, 0.4
WINDOW_S = 0.1
TAKES = 3
ROCKED, ROCKED_CENTS, LONG_S = 16, 30.0, 3.0  # players with a vibrato, its depth, their notes
ROCKED_NOTES = (67, 71, 74, 79)
LATE_S = 0.025  # the last of the late copies
CENTRES_HZ = 1000.0 * 2.0 ** (np.arange(-4, 11) / 3.0)


def scale(rate: float, seed: int, players: int) -> Any:
    """Return the sound of each player, on a chromatic scale."""
    take = SectionTake(rate, seed, players)
    for number, note in enumerate(NOTES):
        take.note(note, number * BEAT_S, number * BEAT_S + NOTE_S)
    return take.play(len(NOTES) * BEAT_S)


def steady_parts(sound: Any, rate: float) -> list[Any]:
    """Return the steady part of each note of a scale."""
    begins = [round((number * BEAT_S + STEADY_S) * rate) for number in range(len(NOTES))]
    return [sound[begin : begin + round((NOTE_S - STEADY_S) * rate)] for begin in begins]


def tuning(rate: float, seed: int) -> dict[str, Any]:
    """See scripts/section.py."""
    sounds = scale(rate, seed, PLAYERS)
    errors = np.array(
        [
            [
                cents(pitch_hz(part.astype(float), rate), 440.0 * 2.0 ** ((note - 69) / 12.0))
                for note, part in zip(NOTES, steady_parts(sound, rate), strict=True)
            ]
            for sound in sounds
        ]
    )
    apart = errors - errors.mean(axis=0)
    worst = np.unravel_index(np.argmax(abs(errors)), errors.shape)
    return {
        "cents from the pitch, standard deviation": round(float(errors.std()), 2),
        "cents from each other, standard deviation": round(float(apart.std()), 2),
        "mean of each player": [round(float(mean), 1) for mean in errors.mean(axis=1)],
        "within 5 cents": round(float(np.mean(abs(errors) <= 5.0)), 3),
        "within 10 cents": round(float(np.mean(abs(errors) <= 10.0)), 3),
        "open strings, of each player": [
            [round(float(cents_of), 1) for cents_of in errors[:, note - NOTES[0]]]
            for note in OPEN_NOTES
        ],
        "farthest": f"{errors[worst]:.1f} cents, player {worst[0] + 1}, note {NOTES[worst[1]]}",
    }


def over_powers(sounds: Any, rate: float) -> Any:
    """Return the power of a sum over the sum of powers (dB) [shape=(windows, third octaves)]."""
    size = round(WINDOW_S * rate)
    window = np.hanning(size)
    bins = np.fft.rfftfreq(size, 1.0 / rate)
    bands = [(bins >= f * 2 ** (-1 / 6)) & (bins < f * 2 ** (1 / 6)) for f in CENTRES_HZ]
    parts = [steady_parts(sound, rate) for sound in sounds]
    rows = []
    for note in range(len(NOTES)):
        for begin in range(0, len(parts[0][note]) - size + 1, size // 2):
            cut = np.array([own[note][begin : begin + size] for own in parts])
            spectra = np.fft.rfft(cut * window, axis=1)
            both = abs(spectra.sum(axis=0)) ** 2, (abs(spectra) ** 2).sum(axis=0)
            rows.append([[power[band].sum() for band in bands] for power in both])
    return np.array(rows)


def chorus(rate: float, seed: int) -> dict[str, Any]:
    """See scripts/section.py."""
    takes = [scale(rate, seed + number, PLAYERS) for number in range(TAKES)]
    late = np.round(np.linspace(0.0, LATE_S, PLAYERS) * rate).astype(int)
    ways: dict[str, Callable[[Any], Any]] = {
        "section": lambda sounds: sounds,
        "copies": lambda sounds: np.repeat(sounds[:1], PLAYERS, axis=0),
        "late copies": lambda sounds: np.array([np.roll(sounds[0], by) for by in late]),
    }
    figures = {}
    for name, way in ways.items():
        rows = np.concatenate([over_powers(way(take), rate) for take in takes])
        whole = 10.0 * np.log10(rows[:, 0].sum(axis=0) / rows[:, 1].sum(axis=0))
        by_note = 10.0 * np.log10(rows[:, 0] / rows[:, 1])
        by_note = by_note.reshape(TAKES * len(NOTES), -1, len(CENTRES_HZ))
        figures[name] = {
            "dB over powers, by third octave": [round(float(db), 1) for db in whole],
            "mean dB": round(float(10 * np.log10(rows[:, 0].sum() / rows[:, 1].sum())), 2),
            "changes within a note, dB": round(float(by_note.std(axis=1).mean()), 2),
        }
    return figures


def loudness(rate: float, seed: int) -> dict[str, Any]:
    """See scripts/section.py."""
    levels: dict[int, tuple[float, float]] = {}
    for players in (1, 2, 4, 8):
        alone = scale(rate, seed, players).sum(axis=0)
        playing = PlayingOptions(seed=seed)
        specs = section_specs(playing, rate, calibration_for(rate), players=players)
        ensemble = Ensemble(specs)
        player = playing.mapped(playing.player(ensemble.instruments))
        for number, note in enumerate(NOTES):
            player.key_on(Key(0, note), 80, frame=round(number * BEAT_S * rate))
            player.key_off(Key(0, note), frame=round((number * BEAT_S + NOTE_S) * rate))
        out = np.zeros((len(alone), 2), np.float32)
        ensemble.process(out)
        power = [10.0 ** (0.1 * a_weighted_db(ear.astype(float), rate)) for ear in out.T]
        levels[players] = a_weighted_db(alone.astype(float), rate), 10 * np.log10(np.mean(power))
    return {
        f"{players} players": {
            "alone dB": round(levels[players][0] - levels[1][0], 2),
            "in the room dB": round(float(levels[players][1] - levels[1][1]), 2),
        }
        for players in levels
    }


def swing(track: Any) -> float:
    """How far a pitch swings (cents), from the 5th to the 95th of a hundred."""
    low, high = np.quantile(track, (0.05, 0.95))
    return float(high - low)


def vibrato(rate: float, seed: int) -> dict[str, Any]:
    """See scripts/section.py."""
    take = SectionTake(rate, seed, ROCKED)
    take.player.write("/playing/vibrato", ROCKED_CENTS, frame=0, hold=True)
    each_s = LONG_S + 0.2
    for number, note in enumerate(ROCKED_NOTES):
        take.note(note, number * each_s, number * each_s + LONG_S)
    sounds = take.play(len(ROCKED_NOTES) * each_s)
    own, mean, mixed = [], [], []
    for number, note in enumerate(ROCKED_NOTES):
        begin, end = ((number + part) * each_s * rate for part in (0.3, 0.92))
        steady = sounds[:, round(begin) : round(end)].astype(float)
        hertz = 440.0 * 2.0 ** ((note - 69) / 12.0)
        tracks = np.array([pitch_track(sound, rate, hertz) for sound in steady])
        own += [swing(track) for track in tracks]
        mean.append(swing(tracks.mean(axis=0)))
        mixed.append(swing(pitch_track(steady.sum(axis=0), rate, hertz)))
    return {
        "people": ROCKED,
        "swing of each, cents": [round(float(x)) for x in np.quantile(own, (0.1, 0.5, 0.9))],
        "swing of the mean of all, cents": [round(value) for value in mean],
        "swing of the sound of all, cents": [round(value) for value in mixed],
    }
