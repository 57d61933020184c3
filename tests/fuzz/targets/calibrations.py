"""Calibrations kept in the cache."""

import functools
import math
import sys
from pathlib import Path
from unittest.mock import patch

from fuzz.instrument import CALIBRATION
from fuzz.target import scratch, target

from yehu_server.core.player.note_tables import NoteTables, Tables
from yehu_server.playing.calibration_store import calibration_for

RATE = 31_000.0  # no shipped calibration has it
HOME = sys.modules[calibration_for.__module__]


def asked() -> NoteTables:
    """The calibration from the cache, or the one that stands for a measurement."""
    with (
        patch.object(HOME, "data_folder", lambda: scratch() / "cache"),
        patch.object(HOME.calibration, "calibration_key", lambda *_: "fuzzed"),
        patch.object(HOME.calibration, "calibrate", lambda *_, **__: CALIBRATION),
    ):
        return calibration_for(RATE)


@functools.cache
def kept() -> tuple[Path, bytes]:
    """The file of a cached calibration, and its content."""
    folder = scratch() / "cache"
    folder.mkdir(exist_ok=True)
    asked()
    (file,) = folder.glob("calibration*")
    return file, file.read_bytes()


WORDS = (b'"tensions": [', b'"a4": 440.0', b'"sharpening": [', b'"levels": [', b"NaN", b"1e308")


@target("calibration", words=WORDS)
def calibration(data: bytes) -> None:
    """A file of the cache that differs from what was written is not used.

    If the first byte is 0, the rest changes bytes of the file: three bytes for a place, and one
    to put there.
    """
    file, whole = kept()
    if data[:1] == b"\0":
        changed = bytearray(whole)
        for at in range(1, len(data) - 3, 4):
            changed[int.from_bytes(data[at : at + 3], "big") % len(changed)] = data[at + 3]
        data = bytes(changed)
    file.write_bytes(data)
    assert asked() == CALIBRATION
    assert file.read_bytes() == whole  # it is repaired


def shape_of(tables: Tables) -> list[list[int]]:
    """Numbers of columns of all rows, which hold finite numbers."""
    assert all(math.isfinite(value) for table in tables for row in table for value in row)
    return [[len(row) for row in table] for table in tables]


@target("calibration-data", words=WORDS)
def calibration_data(data: bytes) -> None:
    """A file with a right checksum holds a whole calibration, or it is measured again."""
    file, _ = kept()
    file.write_bytes(data)
    with patch.object(HOME, "read_checksummed", lambda _path: data, create=True):
        found = asked()
    assert found.a4 == CALIBRATION.a4
    assert all(0.0 < tension < math.inf for tension in found.tensions)
    assert shape_of(found.sharpening) == shape_of(CALIBRATION.sharpening)
    assert shape_of(found.levels) == shape_of(CALIBRATION.levels)
    for tables, usual in (
        (found.centroids, CALIBRATION.centroids),
        (found.louder, CALIBRATION.louder),
    ):
        assert not tables or shape_of(tables) == shape_of(usual)
