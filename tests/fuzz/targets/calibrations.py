"""Calibrations kept in the cache."""

from __future__ import annotations

import functools
import math
from pathlib import Path
from unittest.mock import patch

from fuzz.instrument import CALIBRATION
from fuzz.target import scratch, target

from yehu_server.playing import calibration
from yehu_server.playing.calibration import PITCHES, Calibration, calibration_for

RATE = 31_000.0  # not one that comes along


def asked() -> Calibration:
    """The calibration of the cache, or what stands for one that is measured."""
    with (
        patch.object(calibration, "data_folder", lambda: scratch() / "cache"),
        patch.object(calibration, "calibration_key", lambda *_: "fuzzed"),
        patch.object(calibration, "calibrate", lambda *_, **__: CALIBRATION),
    ):
        return calibration_for(RATE)


@functools.cache
def kept() -> tuple[Path, bytes]:
    """Where a calibration is kept, and as what."""
    folder = scratch() / "cache"
    folder.mkdir()
    asked()
    (file,) = folder.glob("calibration*")
    return file, file.read_bytes()


@target(
    "calibration",
    words=(
        b'"tensions": [',
        b'"a4": 440.0',
        b'"sharpening": [',
        b'"levels": [',
        b"NaN",
        b"1e308",
        b"null",
    ),
)
def calibration_cache(data: bytes) -> None:
    """A file of the cache is a whole calibration of this instrument, or it is measured again.

    Where the first byte is 0, the rest is changes to what is kept: three bytes for the place and
    one that is put there.
    """
    file, whole = kept()
    if data[:1] == b"\0":
        changed = bytearray(whole)
        for at in range(1, len(data) - 3, 4):
            changed[int.from_bytes(data[at : at + 3], "big") % len(changed)] = data[at + 3]
        data = bytes(changed)
    file.write_bytes(data)
    found = asked()
    assert found.a4 == CALIBRATION.a4
    assert all(0.0 < tension < math.inf for tension in found.tensions)
    for tables in (found.sharpening, found.levels):
        assert len(tables) == len(PITCHES)
    for has, needs in (
        (found.sharpening, CALIBRATION.sharpening),
        (found.levels, CALIBRATION.levels),
    ):
        for table, like in zip(has, needs, strict=True):
            assert [len(row) for row in table] == [len(row) for row in like]
            assert all(math.isfinite(value) for row in table for value in row)
    assert asked() == found
