"""Calibrations are measured once and kept; a damaged or absurd one is measured again."""

import errno
import json
import os
from dataclasses import asdict, replace

import numpy as np
import pytest

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.note_tables import GAINS
from yehu_server.errors import ParameterError
from yehu_server.playing import calibration_store
from yehu_server.playing.calibration import PITCHES, SPEEDS, NoteTables
from yehu_server.playing.calibration_store import calibration_for, read_calibration
from yehu_server.util import checksummed
from yehu_server.util.checksummed import write_checksummed

MEASURED = NoteTables(
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

    def measure(self, *_, **__) -> NoteTables:
        self.measured += 1
        return MEASURED

    def ask(self) -> NoteTables:
        return calibration_for(50000.0, a4=441.0)

    @property
    def file(self):
        (file,) = self.folder.iterdir()
        return file


@pytest.fixture
def kept(monkeypatch, tmp_path) -> Kept:
    kept = Kept(tmp_path)
    monkeypatch.setattr(calibration_store.calibration, "calibrate", kept.measure)
    monkeypatch.setattr(calibration_store, "data_folder", lambda: tmp_path)
    monkeypatch.setattr(calibration_store, "_unkept", {})
    return kept


def test_what_was_measured_once_is_kept(kept, caplog):
    assert kept.ask() == kept.ask() == MEASURED
    assert kept.measured == 1
    assert not caplog.messages


def test_a_damaged_calibration_is_measured_anew_and_reported_in_one_line(kept, caplog):
    kept.ask()
    whole = kept.file.read_bytes()
    absurd = json.dumps(asdict(replace(MEASURED, tensions=(50.0, 200.0)))).encode()
    for measured, (data, told) in enumerate(
        [
            (whole[:-100], "damaged; measuring anew"),
            (b"", "damaged; measuring anew"),
            (whole.replace(b"50.0", b"51.0"), "damaged; measuring anew"),
            (bytes([whole[0] ^ 1]) + whole[1:], "damaged; measuring anew"),
            (None, "tension of 200 N"),
        ],
        start=2,
    ):
        caplog.clear()
        if data is None:
            write_checksummed(kept.file, absurd)
        else:
            kept.file.write_bytes(data)
        assert kept.ask() == kept.ask() == MEASURED  # healed
        assert kept.measured == measured
        (line,) = caplog.messages
        assert told in line


def test_on_a_full_disk_it_is_measured_and_reported_in_one_line(kept, caplog, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(checksummed.Path, "write_bytes", full)
    assert kept.ask() == MEASURED
    (line,) = caplog.messages
    assert "no space left on device" in line


def spoiled(**changes):
    return {**json.loads(json.dumps(asdict(MEASURED))), **changes}


SHORT = asdict(MEASURED)["levels"][:1]
WRONG = np.array(MEASURED.sharpening)


def test_what_no_measuring_could_have_found_is_no_calibration(subtests):
    assert read_calibration(spoiled(), Quantities(), 441.0) == MEASURED
    for data in [
        *(None, [], {}),
        *(spoiled(a4=value) for value in (440.0, "high")),
        *(spoiled(tensions=[50.0, *more]) for more in ([], [float("nan")], [-66.0], [10**400])),
        spoiled(tensions=[5.0, 66.0]),
        *(spoiled(levels=levels) for levels in (SHORT, [[[[]]], []])),
        spoiled(louder=SHORT),
        spoiled(centroids=[]),
        spoiled(centroids=np.full((2, len(PITCHES[0]) + 1, len(GAINS)), -1.0).tolist()),
        *(
            spoiled(sharpening=np.where(WRONG > 0, value, 0.0).tolist())
            for value in (np.inf, 1e6, None)
        ),
    ]:
        with subtests.test(data=data), pytest.raises(ParameterError):
            read_calibration(data, Quantities(), 441.0)
