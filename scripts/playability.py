"""Play every note in many ways and measure intonation, timing, clicks and loudness.

    .venv/bin/python scripts/playability.py [MEASURE] [--rate HZ]

grid      Pitch of 500 notes of 0.8 s: F4 to F6 with the keyboard mapping, at velocities 20 to 127,
          with the mod wheel untouched and at 0, 64 and 127. Marks: `.` within 10 cents (open
          strings 12) from 0.1 s on; `a` in tune only after a longer attack; a number is the
          final error in cents; `O` a higher register, `U` a lower one, `?` no pitch.
steady    Pitch error in the steady state, at velocities 40 to 127 and six wheel positions.
legato    Time until a slurred note stays within 10 cents (open strings 12), after steps of 1 to
          5 semitones.
bends     Pitch error while the bend wheel moves: by two semitones and back within a second, and
          by a fourth.
clicks    Largest step between two samples where notes meet, relative to the largest inside them.
evenness  Loudness (dB, A-weighted) of every note at several dynamics.
velocity  Loudness (dB, A-weighted) of every note at velocities from 1 to 127.
shuffled  Share of 300 notes in random order, three times, that speak as the others of their pitch
          do: level within 4 dB of the pitch's median, pitch within 15 cents in the second half,
          harmonics over all else within 15 dB of the pitch's median; in many ways of bowing.
strings   Share of notes within 5 cents from 0.4 s on, on strings that nobody calibrated for.
presets   Share of notes in tune, loudness and spectral centroid (Hz) of every shipped preset, on
          F4 to F6 at velocities 30, 64 and 110, measured from 0.3 s on (plucked: from 0.05 s).
"""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any

import mido
import numpy as np

from yehu_server.analysis.level import a_weighted_db
from yehu_server.analysis.pitch import cents, pitch_hz
from yehu_server.params.table import STRING_NAMES
from yehu_server.physics.quantities import Quantities
from yehu_server.player.calibration import OPEN_NOTES, Calibration, frequency_hz
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.mapping import load
from yehu_server.playing.presets import Presets
from yehu_server.playing.style import Style

NOTES = range(65, 90)
VELOCITIES = (20, 50, 80, 110, 127)
WHEELS = (None, 0, 64, 127)
LISTEN_S = 0.06
NONE = 9999.0
Sound = Any


@cache
def calibrated(rate: float) -> Calibration:
    """Return the calibration for a sample rate."""
    return calibration_for(rate)


class Take:
    """One performance on one instrument, with the keyboard mapping and no random variation."""

    def __init__(
        self,
        rate: float,
        preset: str = "ordinary",
        *,
        mapping: str = "keyboard",
        settings: Mapping[str, float] | None = None,
        strings: Quantities | None = None,
    ) -> None:
        self.rate = rate
        start = tuple(Presets().load(preset).values.items()) if mapping == "keyboard" else ()
        style = Style(start=start, mapping=load(mapping))
        self.instrument = style.instrument(rate, calibrated(rate), strings)
        self.wishes = style.wishes(self.instrument)
        self.wishes.write("/playing/variation", 0.0, frame=0, hold=True)
        self.midi = style.midi(self.wishes)
        for address, value in (settings or {}).items():
            self.wishes.write(address, value, frame=0, hold=True)

    def at(self, seconds: float, kind: str, **fields: int) -> None:
        """Schedule a MIDI message for a time."""
        frame = self.instrument.frames(1e3 * seconds)
        self.midi.receive(mido.Message(kind, **fields), frame=frame)

    def on(self, seconds: float, note: int, velocity: int = 80) -> None:
        """Schedule a note-on."""
        self.at(seconds, "note_on", note=note, velocity=velocity)

    def off(self, seconds: float, note: int) -> None:
        """Schedule a note-off."""
        self.at(seconds, "note_off", note=note)

    def wheel(self, place: int | None) -> None:
        """Set the mod wheel before the first note; None leaves it untouched."""
        if place is not None:
            self.at(0.0, "control_change", control=1, value=place)

    def play(self, seconds: float) -> Sound:
        """Return the sound of the performance."""
        out = np.zeros(self.instrument.frames(1e3 * seconds), np.float32)
        self.instrument.process(out)
        return out


def off_by(sound: Sound, rate: float, start_s: float, seconds: float, pitch: float) -> float:
    """Return the error (cents) from a pitch (fractional MIDI note); NONE if no pitch is found."""
    wanted = frequency_hz(pitch, 440.0)
    part = sound[round(start_s * rate) : round((start_s + seconds) * rate)]
    found = pitch_hz(part, rate, lo=0.4 * wanted, hi=3.2 * wanted)
    return cents(found, wanted) if math.isfinite(found) else NONE


def bound(note: int) -> float:
    """Return the largest error (cents) with which a note counts as in tune."""
    return 12.0 if note in OPEN_NOTES else 10.0


def in_parallel(work: Callable[..., Any], jobs: Iterable[Sequence[Any]]) -> list[Any]:
    """Run jobs in threads and return their results; the model runs without the GIL."""
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        return list(workers.map(lambda job: work(*job), jobs))


# ---------------------------------------------------------------- grid

MOMENTS_S = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
STEADY = 4  # index of the first moment in the steady state


def struck(rate: float, note: int, wheel: int | None, velocity: int) -> str:
    """Play one note and return its mark in the grid."""
    take = Take(rate)
    take.wheel(wheel)
    take.on(0.0, note, velocity)
    sound = take.play(0.8)
    found = [off_by(sound, rate, moment, LISTEN_S, note) for moment in MOMENTS_S]
    if all(abs(error) <= bound(note) for error in found):
        return "."
    settled = found[STEADY:]
    if all(abs(error) <= bound(note) for error in settled):
        return "a"
    if NONE in settled:
        return "?"
    middle = float(np.median(settled))
    if abs(middle) < 100.0:
        return f"{middle:+.0f}"
    return "O" if middle > 0.0 else "U"


def grid(rate: float) -> None:
    """Print the marks of all notes and the share of notes in tune."""
    jobs = [(rate, n, w, v) for n in NOTES for w in WHEELS for v in VELOCITIES]
    marks = in_parallel(struck, jobs)
    print("note   wheel untouched       wheel 0               wheel 64              wheel 127")
    per_note = len(WHEELS) * len(VELOCITIES)
    for row in range(0, len(jobs), per_note):
        cells = marks[row : row + per_note]
        groups = [cells[at : at + len(VELOCITIES)] for at in range(0, per_note, len(VELOCITIES))]
        lines = ["".join(f"{cell:>4}" for cell in group) for group in groups]
        print(f"{jobs[row][1]:4} {'  '.join(lines)}")
    good = marks.count(".")
    print(f"{good} of {len(marks)} ({100.0 * good / len(marks):.1f} %)")


# ---------------------------------------------------------------- steady

STEADY_WHEELS = (None, 0, 32, 64, 96, 127)
STEADY_VELOCITIES = (40, 60, 80, 100, 127)


def sustained(rate: float, note: int, wheel: int | None, velocity: int) -> float:
    """Return the error (cents) of a note in the steady state."""
    take = Take(rate)
    take.wheel(wheel)
    take.on(0.0, note, velocity)
    return off_by(take.play(0.75), rate, 0.45, 0.3, note)


def steady(rate: float) -> None:
    """Print the largest steady-state error of each note."""
    cases = [(w, v) for w in STEADY_WHEELS for v in STEADY_VELOCITIES]
    errors = in_parallel(sustained, [(rate, note, *case) for note in NOTES for case in cases])
    table = np.abs(np.array(errors)).reshape(len(NOTES), len(cases))
    right = 0
    for note, row in zip(NOTES, table, strict=True):
        allowed = 12.0 if note in OPEN_NOTES else 5.0
        right += int((row <= allowed).sum())
        print(f"{note}: {row.max():6.1f} cents at most, {(row > allowed).sum():2} over {allowed:g}")
    print(f"{right} of {table.size} ({100.0 * right / table.size:.1f} %)")


# ---------------------------------------------------------------- legato

SPEED_WHEELS = (26, 84, 122)  # 0.14, 0.2 and 0.25 m/s
STEP_S, WINDOW_S = 0.4, 0.02


def slurred(rate: float, note: int, target: int, wheel: int) -> float:
    """Return the time (ms, at most 200) after which a slurred note stays in tune."""
    take = Take(rate)
    take.wheel(wheel)
    take.on(0.0, note)
    take.on(STEP_S, target)
    take.off(STEP_S + 0.01, note)
    sound = take.play(STEP_S + 0.3)
    late = 0.0
    for ms in range(0, 200, 2):
        if abs(off_by(sound, rate, STEP_S + 1e-3 * ms, WINDOW_S, target)) > bound(target):
            late = ms + 2.0
    return late


def legato(rate: float) -> None:
    """Print how long slurred notes take to be in tune, for each target note."""
    steps = [step for size in range(1, 6) for step in (-size, size)]
    jobs = [
        (rate, target + step, target, wheel)
        for target in NOTES
        for step in steps
        for wheel in SPEED_WHEELS
        if target + step in NOTES
    ]
    times = np.array(in_parallel(slurred, jobs))
    for target in NOTES:
        own = times[[job[2] == target for job in jobs]]
        print(
            f"to {target}: median {np.median(own):3.0f} ms, {100.0 * (own <= 60.0).mean():3.0f} %"
        )
    within = 100.0 * (times <= 60.0).mean()
    print(f"{within:.1f} % of {len(times)} within 60 ms, median {np.median(times):.0f} ms")


# ---------------------------------------------------------------- bends


def bent(rate: float, note: int, semitones: float) -> list[float]:
    """Return the errors (cents) while a bend goes up and back, allowing a delay of 12 ms."""
    take = Take(rate)
    take.wishes.write("/playing/bend_range", abs(semitones), frame=0, hold=True)
    take.on(0.0, note)
    begin, length, lag, window = 0.3, 1.0, 0.012, 0.03

    def curve(t: float) -> float:
        rise = 0.5 - 0.5 * math.cos(2.0 * math.pi * min(max((t - begin) / length, 0.0), 1.0))
        return math.copysign(rise, semitones)

    for step in range(200):
        time = begin + length * step / 199
        take.at(time, "pitchwheel", pitch=round(8191 * curve(time)))
    sound = take.play(begin + length + 0.2)
    times = np.arange(begin, begin + length, 0.02)
    aims = [note + abs(semitones) * curve(t + 0.5 * window - lag) for t in times]
    return [off_by(sound, rate, t, window, aim) for t, aim in zip(times, aims, strict=True)]


def bends(rate: float) -> None:
    """Print how closely the pitch follows bends."""
    for semitones in (2.0, -2.0, 5.0):
        notes = [n for n in NOTES if n + semitones in NOTES and n not in OPEN_NOTES]
        found = np.abs(np.array(in_parallel(bent, [(rate, n, semitones) for n in notes])))
        print(f"{semitones:+g} semitones: {100.0 * (found <= 10.0).mean():.1f} % within 10 cents")
        for note, row in zip(notes, found, strict=True):
            if (row > 10.0).any():
                worst = "no pitch" if row.max() == NONE else f"{row.max():.0f} cents at most"
                print(f"   {note}: {100.0 * (row > 10.0).mean():.0f} % of the time off, {worst}")


# ---------------------------------------------------------------- clicks


def jump(rate: float, note: int, target: int, gap_s: float | None) -> float:
    """Return the largest step between samples where notes meet or end.

    It is relative to the largest step inside the notes. A gap of None slurs them.
    """
    take = Take(rate)
    take.on(0.0, note)
    if gap_s is None:
        take.on(0.5, target)
        take.off(0.505, note)
    else:
        take.off(0.5 - gap_s, note)
        take.on(0.5, target)
    take.off(1.0, target)
    steps = np.abs(np.diff(take.play(1.3)))

    def largest(start_s: float, end_s: float) -> float:
        return float(steps[round(start_s * rate) : round(end_s * rate)].max())

    meeting = largest(0.5 - (gap_s or 0.0) - 0.001, 0.58)
    return max(
        meeting / max(largest(0.3, 0.46), largest(0.75, 0.98)),
        largest(0.999, 1.25) / largest(0.75, 0.98),
    )


def clicks(rate: float) -> None:
    """Print the jumps of slurred, rebowed and detached pairs of notes."""
    steps = (-12, -7, -5, -3, -2, -1, 1, 2, 3, 5, 7, 12)
    pairs = [(n, n + step) for n in NOTES for step in steps if n + step in NOTES]
    for name, gap_s in (("slurred", None), ("bow changes", 0.0), ("detached", 0.02)):
        ratios = np.array(in_parallel(jump, [(rate, *pair, gap_s) for pair in pairs]))
        worst = pairs[int(ratios.argmax())]
        print(
            f"{name}: median {np.median(ratios):.2f}, 95 % below {np.quantile(ratios, 0.95):.2f}, "
            f"largest {ratios.max():.2f} ({worst[0]} to {worst[1]})"
        )


# ---------------------------------------------------------------- evenness


def loudness(rate: float, note: int, wheel: int | None, velocity: int) -> float:
    """Return the loudness of a held note (dB, A-weighted)."""
    take = Take(rate)
    take.wheel(wheel)
    take.on(0.0, note, velocity)
    return a_weighted_db(take.play(0.8)[round(0.3 * rate) :], rate)


def evenness(rate: float) -> None:
    """Print the loudness range of all notes, and the largest difference of neighbours."""
    for wheel, velocity in ((None, 80), (0, 80), (64, 110), (127, 127)):
        levels = np.array(in_parallel(loudness, [(rate, n, wheel, velocity) for n in NOTES]))
        print(
            f"wheel {'untouched' if wheel is None else wheel}, velocity {velocity}: "
            f"within {np.ptp(levels):.1f} dB, neighbours {np.abs(np.diff(levels)).max():.1f} dB"
        )


# ---------------------------------------------------------------- velocity

STRUCK = (1, 20, 50, 80, 110, 127)


def velocity(rate: float) -> None:
    """Print how the level of each note rises with velocity."""
    cases = [(rate, note, None, struck) for note in NOTES for struck in STRUCK]
    levels = np.array(in_parallel(loudness, cases)).reshape(len(NOTES), len(STRUCK))
    right = 0
    for note, row in zip(NOTES, levels, strict=True):
        rise, above = row[-1] - row[0], row[-1] - row[STRUCK.index(80)]
        is_right = 16.0 <= rise <= 24.0 and above >= 3.0
        right += is_right
        steps = " ".join(f"{level:6.1f}" for level in row)
        print(
            f"{note}: {steps} dB; {rise:.1f} in all, {above:.1f} above 80{'' if is_right else ' !'}"
        )
    print(f"{right} of {len(NOTES)} rise by 16 to 24 dB, and by 3 or more above 80")


# ---------------------------------------------------------------- shuffled

EACH_S, REST_S = 0.4, 0.02
SHUFFLED, SEEDS = 300, (1, 2, 3)
WAYS: dict[str, dict[str, Any]] = {
    "default": {},
    "bow at 0.08": {"settings": {"/playing/bow_position": 0.08}},
    "bow at 0.1": {"settings": {"/playing/bow_position": 0.1}},
    "bow at 0.2": {"settings": {"/playing/bow_position": 0.2}},
    "flautando": {"preset": "flautando"},
    "sul tasto": {"preset": "sul-tasto"},
    "sul ponticello": {"preset": "sul-ponticello"},
    "wind": {"mapping": "wind"},
}


def harmonics_db(sound: Sound, rate: float, pitch: float) -> float:
    """Return the power of the harmonics (dB) relative to all between them."""
    size = 4 * len(sound)
    power = np.abs(np.fft.rfft(sound * np.hanning(len(sound)), size)) ** 2
    bins = np.arange(len(power)) * rate / size / frequency_hz(pitch, 440.0)
    near = np.abs(bins - np.rint(bins)) * frequency_hz(pitch, 440.0) < 4.0 * rate / len(sound)
    heard = (bins > 0.5) & (bins * frequency_hz(pitch, 440.0) < 10000.0)
    return 10.0 * math.log10(power[heard & near].sum() / (power[heard & ~near].sum() + 1e-30))


def in_order(rate: float, seed: int, how: dict[str, Any]) -> list[tuple[int, float, float, float]]:
    """Play notes in an order; return pitch, level (dB), error (cents), harmonics (dB) of each."""
    notes = np.random.default_rng(seed).choice(NOTES, SHUFFLED).tolist()
    take = Take(rate, **how)
    for i, note in enumerate(notes):
        take.on(i * EACH_S, note)
        take.off((i + 1) * EACH_S - REST_S, note)
    sound = take.play(len(notes) * EACH_S)
    found = []
    for i, note in enumerate(notes):
        end = round(((i + 1) * EACH_S - REST_S) * rate)
        half = sound[end - round(0.5 * EACH_S * rate) : end]
        error = off_by(half, rate, 0.0, 0.5 * EACH_S, note)
        found.append((note, a_weighted_db(half, rate), error, harmonics_db(half, rate, note)))
    return found


def shuffled(rate: float) -> None:
    """Print the share of notes that speak, and those that do not."""
    for name, how in WAYS.items():
        found = [
            row
            for part in in_parallel(in_order, [(rate, seed, how) for seed in SEEDS])
            for row in part
        ]
        table = np.array(found)
        wrong: list[str] = []
        for note in NOTES:
            own = table[table[:, 0] == note]
            soft = np.abs(own[:, 1] - np.median(own[:, 1])) > 4.0
            off = np.abs(own[:, 2]) > 15.0
            rough = own[:, 3] < np.median(own[:, 3]) - 15.0
            bad = int((soft | off | rough).sum())
            if bad:
                wrong.append(
                    f"{note}: {bad} of {len(own)} ({soft.sum()} {off.sum()} {rough.sum()})"
                )
            table[table[:, 0] == note, 0] = np.where(soft | off | rough, -1.0, note)
        share = 100.0 * (table[:, 0] > 0.0).mean()
        print(f"{name}: {share:.1f} % of {len(table)} speak;", ", ".join(wrong), flush=True)


# ---------------------------------------------------------------- strings

PLAIN = Quantities()
OTHERS: dict[str, dict[str, Any]] = {
    "as calibrated": {},
    "30 cents low": {"settings": {f"/string/{name}/tuning": -30.0 for name in STRING_NAMES}},
    "30 cents high": {"settings": {f"/string/{name}/tuning": 30.0 for name in STRING_NAMES}},
}


def on_string(rate: float, note: int, velocity: int, how: dict[str, Any]) -> float:
    """Return the error (cents) of a stopped note from 0.4 s on."""
    take = Take(rate, **how)
    take.on(0.0, note, velocity)
    return off_by(take.play(0.75), rate, 0.4, 0.35, note)


def strings(rate: float) -> None:
    """Print the share of stopped notes in tune on each kind of strings, and the others."""
    cases = [(note, velocity) for note in NOTES if note not in OPEN_NOTES for velocity in (50, 100)]
    for name, how in OTHERS.items():
        errors = np.array(in_parallel(on_string, [(rate, *case, how) for case in cases]))
        wrong = [
            f"{case[0]}/{case[1]}: {e:+.0f}"
            for case, e in zip(cases, errors, strict=True)
            if abs(e) > 5.0
        ]
        share = 100.0 * (np.abs(errors) <= 5.0).mean()
        print(f"{name}: {share:.1f} % of {len(cases)} in tune;", ", ".join(wrong), flush=True)


# ---------------------------------------------------------------- presets


def in_preset(rate: float, preset: str, note: int, velocity: int) -> tuple[float, float, float]:
    """Return error (cents), loudness (dB, A-weighted) and spectral centroid (Hz) of a note."""
    take = Take(rate, preset)
    take.on(0.0, note, velocity)
    start, seconds = (0.05, 0.2) if preset == "pizzicato" else (0.3, 0.5)
    sound = take.play(start + seconds)
    error = off_by(sound, rate, start, seconds, note)
    heard = sound[round(start * rate) :].astype(np.float64)
    power = np.abs(np.fft.rfft(heard * np.hanning(len(heard)))) ** 2
    middle = float((np.fft.rfftfreq(len(heard), 1.0 / rate) * power).sum() / power.sum())
    return error, a_weighted_db(heard, rate), middle


def presets(rate: float) -> None:
    """Print the results of each preset, and its notes that are out of tune."""
    cases = [(note, velocity) for note in NOTES for velocity in (30, 64, 110)]
    for name in Presets(Path(os.devnull)).names():
        found = np.array(in_parallel(in_preset, [(rate, name, *case) for case in cases]))
        errors, levels, middles = found.T
        right = np.abs(errors) <= np.array([bound(note) for note, _ in cases])
        wrong = [f"{n}/{v}: {e:+.0f}" for (n, v), e in zip(cases, errors, strict=True)]
        print(
            f"{name}: {100.0 * right.mean():.0f} % in tune, {np.median(levels):.1f} dB "
            f"(within {np.ptp(levels):.1f}), {np.median(middles):.0f} Hz"
        )
        print("   ", *(what for what, is_right in zip(wrong, right, strict=True) if not is_right))


MEASURES = {
    each.__name__: each
    for each in (
        grid,
        steady,
        legato,
        bends,
        clicks,
        evenness,
        velocity,
        shuffled,
        strings,
        presets,
    )
}


def main() -> None:
    """Run the measure named on the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("measure", nargs="?", choices=MEASURES, default="grid")
    parser.add_argument("--rate", type=float, default=44100.0)
    arguments = parser.parse_args()
    MEASURES[arguments.measure](arguments.rate)


if __name__ == "__main__":
    main()
