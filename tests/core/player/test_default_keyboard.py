"""What the default mapping's wheel and pedal do to the sound, measured."""

import mido
import numpy as np
import pytest

from yehu_server.core.engine.instrument import Instrument
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.player import Player

RATE = 44_100
NOTE = 74
OLD = "keyboard-bow-speed"


def steady(mapping: str, *controls: tuple[int, int]) -> np.ndarray:
    """A second of a held note, once its vibrato has come in."""
    instrument = Instrument(PlayingOptions().spec(float(RATE), calibration_for(float(RATE))))
    commands = Player(instrument)
    commands.write("/playing/variation", 0.0, frame=0, hold=True)
    midi = commands.mapped(load(mapping))
    for control, value in controls:
        midi.receive(mido.Message("control_change", control=control, value=value), frame=0)
    midi.receive(mido.Message("note_on", note=NOTE, velocity=80), frame=0)
    out = np.zeros(round(2.5 * RATE), np.float32)
    instrument.process(out)
    return out[-RATE:].astype(float)


def level_db(sound: np.ndarray) -> float:
    return 10.0 * np.log10(np.mean(sound**2) + 1e-20)


def vibrato_cents(sound: np.ndarray) -> float:
    """Depth to either side, from the phase of the fundamental."""
    f = 440.0 * 2.0 ** ((NOTE - 69) / 12.0)
    window = np.hanning(round(0.03 * RATE))
    turned = sound * np.exp(-2j * np.pi * f * np.arange(len(sound)) / RATE)
    phase = np.unwrap(np.angle(np.convolve(turned, window, "same")))
    cents = 1200.0 * np.log2(1.0 + np.gradient(phase) * RATE / (2.0 * np.pi * f))
    low, high = np.percentile(cents[4000:-4000], [2, 98])
    return float(high - low) / 2.0


def test_the_wheel_is_vibrato() -> None:
    depths = [vibrato_cents(steady("keyboard", (1, value))) for value in (0, 64, 127)]
    assert depths == pytest.approx([0.0, 20.0, 38.0], abs=6.0)


def test_the_pedal_has_the_dynamics() -> None:
    levels = [level_db(steady("keyboard", (11, value))) for value in (0, 16, 64, 127)]
    assert levels[0] < -100.0
    assert levels[3] - levels[1] > 28.0
    assert sorted(levels) == levels


def test_where_neither_moves_it_sounds_as_with_the_old_mapping_which_keeps_its_wheel() -> None:
    assert np.array_equal(steady("keyboard"), steady(OLD))
    soft, loud = (steady(OLD, (1, value)) for value in (0, 127))
    assert 3.0 < level_db(loud) - level_db(soft) < 6.0
