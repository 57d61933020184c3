"""How well `yehu-server follow` hears: pitch, onsets and level of sounds whose notes are known.

    .venv/bin/python bench/following.py --save bench/results/following.json

The sounds are this instrument, instruments of a General MIDI bank by FluidSynth (Debian's packages
fluidsynth and timgm6mb-soundfont), and a sung vowel made by rule; plain, and with noise, room and
clicks. Pitch is counted as mir_eval counts raw pitch and chroma accuracy, but a frame in which no
pitch is heard is wrong.
"""

import argparse
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mido
import numpy as np
import report
import soundfile

import yehu_server as yehu

Array = Any

RATE = 44100
BANK = Path("/usr/share/sounds/sf2/TimGM6mb.sf2")
PROGRAMS = {"violin": 40, "voice": 53, "trumpet": 56, "flute": 73}
# Pitch, seconds, and whether it is slurred to the one before; 0.15 s of rest otherwise.
TUNE = (
    (67, 0.6, False), (69, 0.4, False), (72, 0.8, False), (72, 0.3, False), (74, 0.5, True),
    (76, 0.9, False), (74, 0.3, False), (72, 0.3, True), (69, 0.3, True), (67, 0.8, False),
    (79, 0.7, False), (77, 0.3, True), (76, 1.0, False), (72, 0.4, False), (67, 1.2, False),
)  # fmt: skip
REST_S, VIBRATO_HZ, VIBRATO_CENTS, VIBRATO_FROM_S = 0.15, 5.5, 25.0, 0.35
HOP_S = 0.005
NEAR_CENTS, FINE_CENTS, OCTAVE_CENTS, ONSET_S = 50.0, 10.0, 600.0, 0.05


def written() -> tuple[list[tuple[float, float, int, bool]], float]:
    """Notes as start, end, pitch and whether slurred; and the length of all."""
    found, time = [], 0.3
    for pitch, length, is_slurred in TUNE:
        time += 0.0 if is_slurred else REST_S
        found.append((time, time + length, pitch, is_slurred))
        time += length
    return found, time + 0.4


def truth() -> tuple[Array, Array, Array]:
    """Pitch (fractional MIDI note; NaN in rests) and loudness (dB) of each 5 ms, and onsets (s)."""
    notes, length = written()
    times = np.arange(0.0, length, HOP_S)
    pitch, level = np.full(len(times), np.nan), np.full(len(times), np.nan)
    for start, end, note, _ in notes:
        here = (times >= start) & (times < end)
        since = times[here] - start
        swing = np.clip((since - VIBRATO_FROM_S) / 0.1, 0.0, 1.0)
        swing *= VIBRATO_CENTS / 100.0 * np.sin(2.0 * np.pi * VIBRATO_HZ * since)
        pitch[here] = note + swing
        level[here] = -20.0 + 20.0 * np.sin(np.pi * times[here] / length)
    return pitch, level, np.array([note[0] for note in notes])


def midi_events() -> list[tuple[float, mido.Message]]:
    pitch, level, _ = truth()
    events: list[tuple[float, mido.Message]] = []
    for start, end, note, _ in written()[0]:
        events.append((start, mido.Message("note_on", note=note, velocity=90)))
        events.append((end, mido.Message("note_off", note=note)))
        for frame in range(round(start / HOP_S), round(end / HOP_S), 2):
            if not np.isfinite(pitch[frame]):
                continue
            bend = round(8191 * (pitch[frame] - note) / 2.0)
            events.append((frame * HOP_S, mido.Message("pitchwheel", pitch=bend)))
            value = round(127 * 10.0 ** (level[frame] / 40.0))  # amplitude is its square
            events.append((frame * HOP_S, mido.Message("control_change", control=11, value=value)))
    return sorted(events, key=lambda each: each[0])


def of_bank(program: int) -> Array:
    """An instrument of the bank, dry."""
    track = mido.MidiTrack([mido.Message("program_change", program=program)])
    last = 0
    for time, message in midi_events():
        tick = round(960 * time / 0.5)
        track.append(message.copy(time=tick - last))
        last = tick
    with tempfile.TemporaryDirectory() as folder:
        midi, wav = Path(folder, "a.mid"), Path(folder, "a.wav")
        mido.MidiFile(ticks_per_beat=960, tracks=[track]).save(midi)
        command = ["fluidsynth", "-q", "-ni", "-R", "0", "-C", "0", "-r", str(RATE), "-F", str(wav)]
        subprocess.run(  # noqa: S603 - our own command
            [*command, str(BANK), str(midi)], check=True, capture_output=True
        )
        return soundfile.read(wav)[0].mean(axis=1)


def of_this_instrument() -> Array:
    """Play the tune on this instrument, dry: bow and finger are asked for swell and vibrato."""
    from yehu_server.scores.events import Events, ScoreEvent
    from yehu_server.scores.score import Score

    events = Events.of(ScoreEvent(time, message) for time, message in midi_events())
    score = Score(events, written()[1], "tune")
    sound = yehu.render(score, dry=True, mono=True, settings={"/playing/variation": 0.0}).sound
    return np.asarray(sound, np.float64)


def sung() -> Array:
    """A vowel by rule, an octave and a fifth below: harmonics under formants, breath between."""
    pitch, level, _ = truth()
    times = np.arange(round(len(pitch) * HOP_S * RATE)) / RATE
    at = np.minimum((times / HOP_S).astype(int), len(pitch) - 1)
    is_on = np.isfinite(pitch[at]).astype(np.float64)
    hz = 440.0 * 2.0 ** ((np.nan_to_num(pitch[at], nan=69.0) - 19.0 - 69.0) / 12.0)
    phase = 2.0 * np.pi * np.cumsum(hz) / RATE
    sound = np.zeros(len(times))
    for n in range(1, 40):
        weight = sum(g / (1.0 + ((n * hz - f) / w) ** 2) for f, w, g in FORMANTS)
        sound += np.where(n * hz < 6000.0, weight / n**0.5 * np.sin(n * phase), 0.0)
    smooth = np.hanning(round(0.03 * RATE))
    smooth /= smooth.sum()
    loud = np.convolve(is_on * 10.0 ** (np.nan_to_num(level[at], nan=-40.0) / 20.0), smooth, "same")
    breath = 0.01 * np.random.default_rng(3).normal(size=len(times))
    return sound * loud + breath


FORMANTS = ((700.0, 120.0, 1.0), (1200.0, 150.0, 0.5), (2600.0, 250.0, 0.25))


def with_noise(snr_db: float) -> Callable[[Array], Array]:
    def worse(sound: Array) -> Array:
        scale = np.sqrt(np.mean(np.square(sound))) * 10.0 ** (-snr_db / 20.0)
        return sound + scale * np.random.default_rng(1).normal(size=len(sound))

    return worse


def in_room(sound: Array) -> Array:
    """0.5 s of reverberation, 12 dB below."""
    time = np.arange(round(0.6 * RATE)) / RATE
    tail = np.random.default_rng(2).normal(size=len(time)) * 10.0 ** (-3.0 * time / 0.5)
    tail *= 10.0 ** (-12.0 / 20.0) / np.sqrt(np.square(tail).sum())
    size = 1 << (len(sound) + len(tail)).bit_length()
    wet = np.fft.irfft(np.fft.rfft(sound, size) * np.fft.rfft(tail, size), size)[: len(sound)]
    return sound + wet


def with_clicks(sound: Array) -> Array:
    clicked = sound.copy()
    places = np.random.default_rng(4).integers(0, len(sound), 40)
    clicked[places] += 0.7 * np.abs(sound).max()
    return clicked


CONDITIONS: dict[str, Callable[[Array], Array]] = {
    "plain": lambda sound: sound,
    "noise, 30 dB": with_noise(30.0),
    "noise, 20 dB": with_noise(20.0),
    "noise, 10 dB": with_noise(10.0),
    "room": in_room,
    "clicks": with_clicks,
}


def judged(heard: Any, shift: float) -> dict[str, float]:
    """What share of all was heard right, of a sound that lies so many semitones higher."""
    pitch, level, onsets = truth()
    pitch = pitch + shift
    count = min(len(pitch), len(heard.pitch))
    pitch, level = pitch[:count], level[:count]
    known = np.isfinite(pitch)
    off = 100.0 * (heard.pitch[:count] - pitch)[known]
    both = np.isfinite(off)
    chroma = (off + OCTAVE_CENTS) % (2.0 * OCTAVE_CENTS) - OCTAVE_CENTS
    begun = np.isin(
        np.arange(count) // 20, np.rint(onsets / HOP_S / 20.0)
    )  # attacks have their own
    louder = known & np.isfinite(heard.pitch[:count]) & ~begun
    return {
        "RPA": float(np.mean(both & (np.abs(off) <= NEAR_CENTS))),
        "RCA": float(np.mean(both & (np.abs(chroma) <= NEAR_CENTS))),
        "within 10 cents": float(np.mean(np.abs(off[both]) <= FINE_CENTS)),
        "octave errors": float(np.mean(np.abs(off[both]) > OCTAVE_CENTS)),
        "onsets F1": f1(onsets, heard.onsets),
        "level": float(np.corrcoef(level[louder], heard.level[:count][louder])[0, 1]),
    }


def f1(wanted: Array, found: Array) -> float:
    """The F measure of onsets, each of which counts once."""
    left, hits = list(found), 0
    for onset in wanted:
        near = [each for each in left if abs(each - onset) <= ONSET_S]
        if near:
            left.remove(min(near, key=lambda each: abs(each - onset)))
            hits += 1
    return 2.0 * hits / max(len(wanted) + len(found), 1)


def sounds() -> dict[str, tuple[Array, float]]:
    found = {"this instrument": (of_this_instrument(), 0.0), "sung vowel": (sung(), -19.0)}
    return found | {name: (of_bank(program), 0.0) for name, program in PROGRAMS.items()}


def round_trip(sound: Array) -> dict[str, float]:
    """How near a performance that was followed is to what it follows: both are heard alike."""
    first = yehu.follow(sound, RATE)
    played = first.render(dry=True, mono=True)
    again = yehu.follow(played.sound, played.sample_rate)
    shift = first.transposed
    best: dict[str, float] = {}
    for lag in range(-12, 13):
        one = first.pitch[max(-lag, 0) :]
        other = again.pitch[max(lag, 0) :]
        count = min(len(one), len(other))
        off = 100.0 * np.abs(other[:count] - one[:count] - shift)
        off = off[np.isfinite(off)]
        found = {
            "within 5 cents": float(np.mean(off <= 5.0)),
            "within 10 cents": float(np.mean(off <= 10.0)),
            "median, cents": float(np.median(off)),
            "95 %, cents": float(np.quantile(off, 0.95)),
            "later, ms": 1e3 * HOP_S * lag,
        }
        if not best or found["median, cents"] < best["median, cents"]:
            best = found
    loud = np.isfinite(first.pitch)
    count = min(len(first.level), len(again.level))
    loud = loud[:count] & np.isfinite(again.pitch[:count])
    best["level"] = float(np.corrcoef(first.level[:count][loud], again.level[:count][loud])[0, 1])
    best["onsets F1"] = f1(first.onsets, again.onsets)
    return best


def measure(_arguments: argparse.Namespace) -> dict[str, dict[str, Any]]:
    rows = {}
    for name, (sound, shift) in sounds().items():
        scaled = 0.5 * sound / np.abs(sound).max()
        for condition, worse in CONDITIONS.items():
            heard = yehu.follow(worse(scaled), RATE)
            rows[f"{name}, {condition}"] = judged(heard, shift)
        rows[f"{name}, round trip"] = round_trip(scaled)
    return rows


if __name__ == "__main__":
    report.run(__doc__, measure)
