"""Player and callback also run as plain Python, under a debugger; `serve` does not."""

import os
import subprocess
import sys

import numpy as np

from yehu_server.core.engine.instrument import Instrument
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key

RATE = 44100.0
FRAMES = 160
PLAIN = {**os.environ, "NUMBA_DISABLE_JIT": "1"}


def phrase() -> tuple[Instrument, np.ndarray]:
    """Play two notes, a bend, their ends, a bow by hand, panic and one more, in small blocks."""
    playing = PlayingOptions(seed=1)
    instrument = Instrument(playing.spec(RATE, calibration_for(RATE)))
    commands = playing.player(instrument)
    midi = playing.mapped(commands)
    commands.note_on(Key(0, 70), {"/playing/pressure": 0.5}, frame=0)
    commands.write("/playing/bend", 0.3, frame=20)
    commands.write("/playing/vibrato", 30.0, frame=20)
    commands.write("/body/blend", 0.7, frame=30, hold=True)
    commands.note_on(Key(0, 74), frame=40)
    commands.note_off(Key(0, 70), frame=50)
    commands.note_off(Key(0, 74), frame=60)
    commands.release(frame=65)
    commands.slide(72.5, frame=70)
    commands.draw(0.2, 0.4, frame=75)
    commands.lift(frame=95)
    commands.stop_sound(frame=100)
    midi.key_on(Key(1, 83), 0.8 * 127.0, frame=110)
    midi.end_all(frame=150)
    out = np.zeros(FRAMES, np.float32)
    for start in range(0, FRAMES, 37):
        instrument.process(out[start : start + 37])
    return instrument, out


def signals() -> dict[str, np.ndarray]:
    """The samples of a phrase, the model's displacements, and what its player did and told."""
    instrument, out = phrase()
    rig = instrument._rig[0]
    told = [instrument.meters()[what] for what in ("pitch", "applied", "next_frame")]
    player = [
        rig["player"][what] for what in ("held", "sounding", "direction", "random_count", "finger")
    ]
    return {
        "samples": out,
        "displacements": rig["state"]["motion"]["z"].copy(),
        "values": rig["controls"]["value"].copy(),
        "targets": rig["controls"]["target"].copy(),
        "player": np.array(player),
        "requested": rig["player"]["value"].copy(),
        "told": np.array(told, np.float64),
    }


def test_an_uncompiled_phrase_is_that_of_the_compiled_player_and_callback(tmp_path):
    target = tmp_path / "plain.npz"
    run = subprocess.run(
        [sys.executable, __file__, str(target)], env=PLAIN, check=True, capture_output=True
    )
    assert run.stderr == b""  # no warning either
    compiled, plain = signals(), np.load(target)
    assert np.abs(compiled["samples"]).max() > 1e-5
    for what, expected in compiled.items():
        size = np.abs(np.nan_to_num(expected)).max()
        np.testing.assert_allclose(plain[what], expected, rtol=0.0, atol=1e-12 * size, err_msg=what)


def test_serve_says_in_one_line_that_it_needs_compiled_code(refused, monkeypatch):
    monkeypatch.setattr("yehu_server.live.server.IS_PLAIN", True)
    words = ("serve", "--audio-device", "null", "--midi-api", "none", "--osc", "127.0.0.1:0")
    assert "NUMBA_DISABLE_JIT" in refused(*words, "--no-http")


if __name__ == "__main__":
    np.savez(sys.argv[1], **signals())
