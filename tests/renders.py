"""Sums of what commands play: the same on every processor of a level.

    .venv/bin/python tests/renders.py [NAME ...]

prints the sums of the named ones, or of all, for this level of processors, as JSON.
"""

import contextlib
import hashlib
import io
import json
import shlex
import sys
import tempfile
from pathlib import Path

import numpy as np
import soundfile

from yehu_server.cli import main
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.commands import BEGIN, COMMAND, DRAW, END, EXPRESS, HOLD, SLIDE
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.scores.capture_header import SessionStart
from yehu_server.scores.capture_writer import CaptureWriter

ROOT = Path(__file__).resolve().parents[1]
EXAMPLES = ROOT / "examples"
# Of each level: name and sum, written by `scripts/render_sums.py`.
SUMS = Path(__file__).with_name("renders.json")

RENDERS = {
    "a MIDI file": "slow_air.mid",
    "another, in mono at 48 kHz": "shi_bei_jiu.mid --mono --rate 48000",
    "an ensemble": "mo_li_hua.mid --ensemble --rate 22050",
    "jianpu, dry at 96 kHz": "shi_bei_jiu.jianpu --dry --rate 96000",
    "slides and a living scale": "huo_wu.jianpu --room hall --seed 3",
    "MusicXML": "marks.musicxml --rate 48000 --normalize",
    "controllers": "bow_pressure.mid --mapping keyboard-expressive",
    "a section by MPE": "mpe_phrase.mid --mapping mpe --rate 22050 --set /playing/section=2",
    "plucked": "tunes/twinkle.jianpu --preset pizzicato --gain-db 6",
}
SIMULATION, CAPTURE = "a simulation", "a capture"
NAMES = (*RENDERS, SIMULATION, CAPTURE)
RATE = 44100


def sum_of(name: str, folder: Path) -> str:
    """The SHA-256 of the samples, in a folder for what the command writes."""
    if name == SIMULATION:
        target = folder / "run.npz"
        run(["simulate", str(EXAMPLES / "gesture.json"), "-o", str(target), "--energy"])
        with np.load(target) as arrays:
            kept = {key: arrays[key] for key in sorted(arrays) if arrays[key].dtype.kind == "f"}
        return hashlib.sha256(b"".join(array.tobytes() for array in kept.values())).hexdigest()
    target = folder / "sound.wav"
    if name == CAPTURE:
        words = ["replay", str(captured(folder / "session.capture"))]
    else:
        file, *options = shlex.split(RENDERS[name])
        words = ["render", str(EXAMPLES / file), *options]
    run([*words, "-o", str(target), "--subtype", "float", "--quiet"])
    samples, _ = soundfile.read(target, dtype="float32")
    return hashlib.sha256(samples.tobytes()).hexdigest()


def run(words: list[str]) -> None:
    """Run a command, which is to work."""
    with contextlib.redirect_stdout(io.StringIO()):
        assert main(words) == 0, words


def captured(path: Path) -> Path:
    """A capture of a player without calibration: notes, a slide, vibrato, a bow drawn by hand."""
    second = RATE
    commands = [
        (0, HOLD, INDEX["/playing/vibrato"], 0.8, 0.0),
        (0, BEGIN, 0, 69.0, 69.0),
        (second, SLIDE, 0, 72.5, 0.0),
        (2 * second, EXPRESS, INDEX["/playing/dynamics"], 0.4, 0.0),
        (2 * second + 7, BEGIN, 0, 76.0, 76.0),
        (3 * second, END, 0, 76.0, 0.0),
        (3 * second + 1, DRAW, 0, -0.25, 0.8),
    ]
    beginning = SessionStart((InstrumentSpec(float(RATE), seed=5),), has_room=True)
    writer = CaptureWriter(path, beginning=beginning)
    writer.commands(np.array(commands, COMMAND))
    writer.close(4 * second)
    return path


def all_sums(names: list[str]) -> dict[str, str]:
    """The sums of renders, by name."""
    with tempfile.TemporaryDirectory() as scratch:
        found = {}
        for number, name in enumerate(names):
            folder = Path(scratch) / str(number)
            folder.mkdir()
            found[name] = sum_of(name, folder)
    return found


if __name__ == "__main__":
    sys.stdout.write(json.dumps(all_sums(sys.argv[1:] or list(NAMES))))
