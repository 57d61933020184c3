"""Calibrations are measured once and kept; a damaged or absurd one is measured again."""

import errno
import json
import os
from dataclasses import asdict, replace

import numpy as np
import pytest

from yehu_server.core.physics.quantities import Quantities
from yehu_server.core.player.bowing import PLACES
from yehu_server.core.player.calibration import GAINS
from yehu_server.errors import ParameterError
from yehu_server.params.table import find
from yehu_server.playing import calibration_store
from yehu_server.playing.calibration import PITCHES, SPEEDS, Calibration
from yehu_server.playing.calibration_store import calibration_for, read_calibration
from yehu_server.playing.practice_files import shipped_practice
from yehu_server.util import sealed
from yehu_server.util.sealed import write_sealed

MEASURED = Calibration(
    441.0,
    (50.0, 66.0),
    tuple(tuple((40.0,) * len(SPEEDS) for _ in pitches) for pitches in PITCHES),
    tuple(tuple((-20.0,) * len(SPEEDS) for _ in (0, *pitches)) for pitches in PITCHES),
    centroids=tuple(tuple((800.0,) * len(GAINS) for _ in (0, *pitches)) for pitches in PITCHES),
    louder=tuple(tuple((1.0,) * len(GAINS) for _ in (0, *pitches)) for pitches in PITCHES),
)


class Kept:
    """A folder of calibrations, and the number of measurements."""

    def __init__(self, folder) -> None:
        self.folder = folder
        self.measured = 0

    def measure(self, *_, **__) -> Calibration:
        self.measured += 1
        return MEASURED

    def ask(self) -> Calibration:
        return calibration_for(50000.0, a4=441.0)

    @property
    def file(self):
        (file,) = self.folder.iterdir()
        return file


@pytest.fixture
def kept(monkeypatch, tmp_path) -> Kept:
    kept = Kept(tmp_path)
    monkeypatch.setattr(calibration_store, "calibrate", kept.measure)
    monkeypatch.setattr(calibration_store, "data_folder", lambda: tmp_path)
    monkeypatch.setattr(calibration_store, "_unkept", {})
    return kept


def test_what_was_measured_once_is_kept(kept, caplog):
    assert kept.ask() == kept.ask() == MEASURED
    assert kept.measured == 1
    assert not caplog.messages


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: data[:-100],
        lambda _: b"",
        lambda data: data.replace(b"50.0", b"51.0"),
        lambda data: bytes([data[0] ^ 1]) + data[1:],
    ],
    ids=["cut short", "emptied", "another tension", "a bit"],
)
def test_a_damaged_calibration_is_measured_anew_and_told_in_one_line(kept, caplog, damage):
    kept.ask()
    kept.file.write_bytes(damage(kept.file.read_bytes()))
    assert kept.ask() == MEASURED
    assert kept.measured == 2
    (line,) = caplog.messages
    assert "damaged; measuring anew" in line
    assert kept.ask() == MEASURED  # healed
    assert kept.measured == 2


def test_a_sealed_calibration_that_is_absurd_is_measured_anew(kept, caplog):
    kept.ask()
    write_sealed(kept.file, json.dumps(asdict(replace(MEASURED, tensions=(50.0, 200.0)))).encode())
    assert kept.ask() == MEASURED
    assert kept.measured == 2
    assert "tension of 200 N" in caplog.text


def test_on_a_full_disk_it_is_measured_and_told_in_one_line(kept, caplog, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(sealed.Path, "write_bytes", full)
    assert kept.ask() == MEASURED
    (line,) = caplog.messages
    assert "No space left on device" in line


def test_without_a_place_to_keep_it_it_is_measured_all_the_same(kept, monkeypatch):
    monkeypatch.setattr(calibration_store, "data_folder", lambda: kept.folder / "none")
    assert kept.ask() == MEASURED


def spoiled(**changes):
    return {**json.loads(json.dumps(asdict(MEASURED))), **changes}


SHORT = asdict(MEASURED)["levels"][:1]
WRONG = np.array(MEASURED.sharpening)


def test_what_no_measuring_could_have_found_is_no_calibration(subtests):
    for data in [
        None,
        [],
        {},
        spoiled(a4=440.0),
        spoiled(a4="high"),
        spoiled(tensions=[50.0]),
        spoiled(tensions=[50.0, float("nan")]),
        spoiled(tensions=[50.0, -66.0]),
        spoiled(tensions=[50.0, 10**400]),
        spoiled(tensions=[5.0, 66.0]),
        spoiled(levels=SHORT),
        spoiled(levels=[[[[]]], []]),
        spoiled(louder=SHORT),
        spoiled(centroids=[]),
        spoiled(centroids=np.full((2, len(PITCHES[0]) + 1, len(GAINS)), -1.0).tolist()),
        spoiled(sharpening=np.where(WRONG > 0, np.inf, 0.0).tolist()),
        spoiled(sharpening=np.where(WRONG > 0, 1e6, 0.0).tolist()),
        spoiled(sharpening=np.where(WRONG > 0, None, None).tolist()),
    ]:
        with subtests.test(data=data), pytest.raises(ParameterError):
            read_calibration(data, Quantities(), 441.0)


def test_what_was_measured_is_a_calibration():
    assert read_calibration(spoiled(), Quantities(), 441.0) == MEASURED


def test_a_calibration_is_of_how_notes_are_bowed_at_the_usual_place(kept):
    bowing = shipped_practice(50000.0)
    usual = PLACES.index(find("/playing/bow_position").default)
    bowing[:, usual - 1] *= 1.1
    calibrations = [calibration_for(50000.0, a4=441.0, bowing=each) for each in (None, bowing)]
    assert kept.measured == 1
    bowing[:, usual] *= 1.1
    calibrations += [calibration_for(50000.0, a4=441.0, bowing=bowing) for _ in range(2)]
    assert kept.measured == 2
    assert calibrations == [MEASURED] * 4


def test_what_cannot_be_written_is_measured_once(kept, monkeypatch):
    """The parts of an ensemble share a calibration, on a disk that is full or read-only, too."""
    nowhere = kept.folder / "file"
    nowhere.touch()
    monkeypatch.setattr(calibration_store, "data_folder", lambda: nowhere)
    assert kept.ask() == kept.ask() == MEASURED
    assert kept.measured == 1
