"""`hunting`: whether the pitch of a held note swings about its place, with and without listening.

A finger that corrects by ear may hunt: overshoot, turn back, and overshoot again. The pitch is
tracked each 10 ms, from 1 s to the end of a note of 3 s, in windows of 40 ms. The wander is the
error less its straight line; its largest periodic component is the highest peak of its Fourier
transform from 0.5 to 20 Hz (peak amplitude in cents; Hann window). In two seconds a component
below 0.7 Hz may come out as little as half as large as it is, and a single step of the pitch
counts by a third of its height.

A window of `T` seconds shows a swing of `f` Hz smaller by sinc^2(f T / 2), because the pitch is
found by comparing its two halves; the amplitude is corrected for it. At 20 Hz and 40 ms that is a
factor of 1.7; with 60 ms it would be 4.

A note loses its pitch where another line is about as strong as its own harmonics: what the other
string sounds, or half the frequency.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from measures.intonation import NONE, off_by
from measures.shares import Share, share_line
from measures.take import NOTES, Setup, Sound, held, in_parallel

VELOCITIES = (50, 100)
WHEELS = (None, 0, 127)
START_S, END_S = 1.0, 3.0
WINDOW_S, HOP_S = 0.04, 0.01
LOWEST_HZ, HIGHEST_HZ = 0.5, 20.0
FINER = 8  # Fourier bins for each of the track's own
STILL_CENTS = 1.0
REGISTER_CENTS = 300.0
WAYS: dict[str, dict[str, Any]] = {
    "listening": {},
    "without listening": {"settings": {"/playing/listening": 0.0}},
}


def pitch_track(sound: Sound, rate: float, note: int) -> list[float]:
    """Return the errors (cents) of a held note, each 10 ms."""
    starts = np.arange(START_S, END_S - WINDOW_S + 1e-9, HOP_S)
    return [off_by(sound, rate, float(start), WINDOW_S, note) for start in starts]


def component(errors: Sequence[float]) -> tuple[float, float]:
    """Return amplitude (cents) and frequency (Hz) of the largest periodic component of a track.

    NONE and 0 where a part has no pitch, or one in another register.
    """
    wander = np.array(errors)
    if np.abs(wander).max() > REGISTER_CENTS:
        return NONE, 0.0
    steps = np.arange(len(wander))
    wander -= np.polyval(np.polyfit(steps, wander, 1), steps)
    window = np.hanning(len(wander))
    size = FINER * len(wander)
    amplitudes = 2.0 * np.abs(np.fft.rfft(wander * window, size)) / window.sum()
    frequencies = np.fft.rfftfreq(size, HOP_S)
    amplitudes /= np.sinc(0.5 * frequencies * WINDOW_S) ** 2
    heard = (frequencies >= LOWEST_HZ) & (frequencies <= HIGHEST_HZ)
    largest = int(np.argmax(np.where(heard, amplitudes, 0.0)))
    return float(amplitudes[largest]), float(frequencies[largest])


def _swing(
    setup: Setup, note: int, wheel: int | None, velocity: int, how: dict[str, Any]
) -> tuple[float, float]:
    """Hold a note; return amplitude (cents) and frequency (Hz) of its largest swing."""
    sound, _ = held(setup, note, velocity, END_S, wheel, **how)
    return component(pitch_track(sound, setup.rate, note))


def _in_words(swing: tuple[float, float]) -> str:
    amplitude, frequency = swing
    return (
        "loses its pitch" if amplitude == NONE else f"{amplitude:.1f} cents at {frequency:.1f} Hz"
    )


def hunting(setup: Setup) -> list[Share]:
    """Print the share of held notes that swing by 1 cent at most, and the others."""
    cases = [(n, w, v) for n in NOTES for w in WHEELS for v in VELOCITIES]
    parts = []
    for name, how in WAYS.items():
        found = in_parallel(setup, _swing, [(*case, how) for case in cases])
        amplitudes = np.array([amplitude for amplitude, _ in found])
        print(
            f"{name}: median {np.median(amplitudes):.2f} cents, "
            f"95 % below {np.quantile(amplitudes, 0.95):.2f}"
        )
        words = [
            f"{n} wheel {w} velocity {v} {_in_words(swing)}"
            for (n, w, v), swing in zip(cases, found, strict=True)
        ]
        parts.append(share_line(name, amplitudes <= STILL_CENTS, words, counts=name == "listening"))
    return parts
