"""Scala's files: scales and keyboard maps."""

import math
from pathlib import Path

from fuzz.target import ROOT, target, written

from yehu_server.errors import ParameterError
from yehu_server.playing.tuning import KEYS, MAX_SEMITONES, Tuning, read_tuning

SCALE = ROOT / "tunings" / "chaozhou-seven-equal.scl"


def check(tuning: Tuning) -> None:
    assert tuning.keys is not None
    assert len(tuning.keys) == len(KEYS)
    for key in tuning.keys:
        assert key is None or abs(key) <= MAX_SEMITONES
    for note in (0.0, 59.5, 60.0, 69.25, 127.0, 128.0, math.nan):
        pitch = tuning.pitch(note, 442.0)
        assert pitch is None or math.isfinite(pitch)


@target(
    "scale",
    ParameterError,
    words=(b"! x.scl\n", b"2/1\n", b"700.0\n", b"\n12\n"),
    also=("tunings/*.scl",),
)
def scale(data: bytes) -> None:
    """A .scl gives each key a finite pitch or none, or a ParameterError."""
    check(read_tuning(written(data, "file.scl")))


@target(
    "keyboard-map",
    ParameterError,
    words=(b"x\n", b"60\n", b"127\n", b"440.0\n"),
    also=("tunings/*.kbm",),
)
def keyboard_map(data: bytes) -> None:
    """A .kbm gives each key a finite pitch or none, or a ParameterError."""
    check(read_tuning(Path(SCALE), written(data, "file.kbm")))
