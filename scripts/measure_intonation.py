"""Bow every stopped note and print how far it lands from where c/2f says.

The figures in yehu_server/playing/intonation.py come from here.

    .venv/bin/python scripts/measure_intonation.py
"""

from __future__ import annotations

import numpy as np

from yehu_server.engine.instrument import Instrument
from yehu_server.physics.quantities import Quantities
from yehu_server.playing.intonation import HIGHEST_X, OPEN_NOTES, ideal_position

RATE = 44100
SECONDS = 1.5


def pitch_hz(samples: np.ndarray, near_hz: float) -> float:
    """Fundamental by autocorrelation, refined over many periods."""
    n = len(samples)
    spectrum = np.fft.rfft(samples - samples.mean(), 2 * n)
    correlation = np.fft.irfft(np.abs(spectrum) ** 2)[: n // 2] / np.arange(n, n - n // 2, -1)
    period = RATE / near_hz
    for multiple in (1, 3, 9, 27):
        reach = 0.12 * RATE / near_hz if multiple == 1 else 0.4 * RATE / near_hz / 3.0
        start = max(1, round(period * multiple - reach))
        stop = round(period * multiple + reach) + 1
        at = start + int(np.argmax(correlation[start:stop]))
        left, here, right = correlation[at - 1 : at + 2]
        period = (at + 0.5 * (left - right) / (left - 2.0 * here + right)) / multiple
    return RATE / period


def bowed_pitch(string: int, x_f: float, near_hz: float) -> float:
    """Pitch (Hz) of a stopped string, bowed as the default mapping does at medium dynamics."""
    instrument = Instrument(float(RATE))
    instrument.write("/finger/1/position", x_f, ramp_ms=0.0)
    instrument.write("/finger/1/press", 1.5)
    instrument.write("/bow/side", 1.0 if string == 0 else -1.0)
    instrument.write("/bow/speed", 0.2, ramp_ms=40.0)
    out = np.zeros(round(SECONDS * RATE), np.float32)
    instrument.process(out)
    return pitch_hz(out[len(out) // 2 :].astype(float), near_hz)


def main() -> None:
    """Print the table: two rounds, so that the second is measured where the finger will be."""
    quantities = Quantities()
    for string, open_note in enumerate(OPEN_NOTES):
        corrections = []
        for note in range(open_note + 1, 90):
            target = 440.0 * 2.0 ** ((note - 69) / 12)
            cents = 0.0
            for _ in range(4):
                x_f = ideal_position(quantities, string, note - cents / 100.0)
                if not 0.0 < x_f <= HIGHEST_X:
                    break
                cents += 1200.0 * np.log2(bowed_pitch(string, x_f, target) / target)
            else:
                corrections.append(round(float(cents), 1))
                continue
            break
        print(f"string {string + 1}: {tuple(corrections)}", flush=True)


if __name__ == "__main__":
    main()
