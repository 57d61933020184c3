"""What is done of a study while it runs, so that it goes on after an interruption.

A journal lies beside the result: ``FILE.npz.part``. Its first line is JSON: which study, computed
by which code. Then follow blocks of findings with checksums; one that a crash cut off is dropped.
"""

import hashlib
import json
import os
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.regimes.columns import FINDING
from yehu_lab.sweeps.study import Study
from yehu_server.compile.cache_folder import source_hash
from yehu_server.errors import OutputError
from yehu_server.util import __version__
from yehu_server.util.files import error_reason, open_regular

Array = Any

HEAD = struct.Struct("<II")  # number of points, checksum
ENDING = ".part"
MAX_HEADER = 1 << 24


def journal_of(target: Path) -> Path:
    """The path of the journal of a result."""
    return target.with_name(target.name + ENDING)


def key_of_study(study: Study) -> str:
    """A key of a study and of the code that computes it."""
    code = source_hash("yehu_lab")
    return hashlib.sha256(f"{code} {study.as_text()}".encode()).hexdigest()[:32]


def _header(key: str) -> bytes:
    header = {"journal": "yehu-server sweep", "version": __version__, "key": key}
    return json.dumps(header).encode() + b"\n"


class Done:
    """The points of a study that are done."""

    def __init__(self) -> None:
        self.numbers = [np.zeros(0, np.int64)]
        self.findings = [np.zeros(0, FINDING)]

    @property
    def count(self) -> int:
        """Number of strokes that are done."""
        return sum(map(len, self.numbers))

    def done(self) -> tuple[Array, Array]:
        """The numbers of the points that are done, in order, and their findings."""
        numbers, first = np.unique(np.concatenate(self.numbers), return_index=True)
        return numbers, np.concatenate(self.findings)[first]

    def add(self, numbers: Array, findings: Array) -> None:
        """Add points."""
        self.numbers.append(numbers)
        self.findings.append(findings)


class Journal(Done):
    """The journal of one study: what is done, and a file that more is added to.

    `target` is the result to come. Raises OutputError where there is a journal of another study, or
    it cannot be written.
    """

    def __init__(self, target: Path, study: Study, *, overwrite: bool = False) -> None:
        super().__init__()
        self.path = journal_of(target)
        key = key_of_study(study)
        try:
            if overwrite:
                self.path.unlink(missing_ok=True)
            good = self._read(key) if self.path.exists() else 0
            self._file = self.path.open("r+b" if good else "wb")
            if good:
                self._file.truncate(good)
                self._file.seek(good)
            else:
                self._file.write(_header(key))
                self._file.flush()
        except OSError as error:
            raise OutputError(f"{self.path}: cannot write: {error_reason(error)}") from error

    def add(self, numbers: Array, findings: Array) -> None:
        """Add points, safe against the end of this process; raises OutputError."""
        payload = numbers.astype("<i8").tobytes() + findings.tobytes()
        try:
            self._file.write(HEAD.pack(len(numbers), zlib.crc32(payload)) + payload)
            self._file.flush()
        except OSError as error:
            raise OutputError(f"{self.path}: cannot write: {error_reason(error)}") from error
        super().add(numbers, findings)

    def close(self, *, remove: bool = False) -> None:
        """Close the file; remove it where the result is written."""
        self._file.close()
        if remove:
            self.path.unlink(missing_ok=True)

    def _read(self, key: str) -> int:
        """Read what is done; return how many bytes of the file are good."""
        with open_regular(self.path) as file:
            line = file.readline(MAX_HEADER)
            if not line.endswith(b"\n") and _header(key).startswith(line):
                return 0  # a full disk, or a crash, cut it off
            try:
                found = json.loads(line)["key"]
            except (ValueError, KeyError, TypeError):
                raise OutputError(
                    f"{self.path}: is not the journal of a sweep; remove it"
                ) from None
            if found != key:
                raise OutputError(
                    f"{self.path}: is of another study or version; --overwrite begins anew"
                )
            good = file.tell()
            left = os.fstat(file.fileno()).st_size - good
            each = 8 + FINDING.itemsize
            while len(head := file.read(HEAD.size)) == HEAD.size:
                count, checksum = HEAD.unpack(head)
                if count * each > left:
                    break
                payload = file.read(count * each)
                if len(payload) < count * each or zlib.crc32(payload) != checksum:
                    break
                numbers = np.frombuffer(payload[: 8 * count], "<i8").astype(np.int64)
                super().add(numbers, np.frombuffer(payload[8 * count :], FINDING))
                good = file.tell()
            return good
