"""Fuzz targets: a reader and its contract, as a function of bytes.

A target gives bytes to a reader and checks the result. It returns if the reader accepts or refuses
them as documented; any other error is a finding.
"""

import atexit
import functools
import os
import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from fuzz.bounds import bounded

ROOT = Path(__file__).parents[2]
SEEDS = Path(__file__).parent / "seeds"
MAX_BYTES = 1 << 16  # of an input

Read = Callable[[bytes], None]


@dataclass(frozen=True)
class Target:
    """One reader under one contract.

    Parameters
    ----------
    refusals : tuple of exception types
        What the reader says that it raises for bad input.
    words : tuple of bytes
        What its inputs are made of, for mutations.
    also : tuple of str
        Files of the repository that are seeds too, as glob patterns.
    """

    name: str
    read: Read
    refusals: tuple[type[Exception], ...] = ()
    words: tuple[bytes, ...] = ()
    also: tuple[str, ...] = ()

    @property
    def contract(self) -> str:
        """The law that holds for any bytes, in one line."""
        return (self.read.__doc__ or "").strip().partition("\n")[0]

    def check(self, data: bytes) -> None:
        """Read some bytes. Errors: whatever breaks the contract."""
        with bounded():
            try:
                self.read(data)
            except self.refusals as refusal:
                reason = str(refusal)
            else:
                return
        assert reason.strip(), "a refusal without a reason"

    def seeds(self) -> dict[str, bytes]:
        """Inputs to begin with, by name."""
        files = [*(SEEDS / self.name).glob("*")]
        files += [file for pattern in self.also for file in ROOT.glob(pattern)]
        return {file.name: file.read_bytes() for file in sorted(files)}


TARGETS: dict[str, Target] = {}


def target(
    name: str, *refusals: type[Exception], words: tuple[bytes, ...] = (), also: tuple[str, ...] = ()
) -> Callable[[Read], Read]:
    """Make a target of a function; its docstring states the contract."""

    def add(read: Read) -> Read:
        TARGETS[name] = Target(name, read, refusals, words, also)
        return read

    return add


def words(*rows: bytes) -> tuple[bytes, ...]:
    """Words for mutations, from rows with a bar between two words."""
    return tuple(b"|".join(rows).split(b"|"))


@functools.cache
def scratch() -> Path:
    """A folder for this run's files, in memory if possible."""
    shared = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # noqa: S108 - within it
    folder = Path(tempfile.mkdtemp(prefix="yehu-fuzz-", dir=shared))
    owner = os.getpid()

    def remove() -> None:
        if os.getpid() == owner:  # not in a process forked off
            shutil.rmtree(folder, ignore_errors=True)

    atexit.register(remove)
    return folder


def written(data: bytes, name: str) -> Path:
    """The path of a file that holds the data."""
    path = scratch() / name
    path.write_bytes(data)
    return path


class Program:
    """Bytes as a sequence of choices; zeros follow their end."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._place = 0

    def __bool__(self) -> bool:
        return self._place < len(self._data)

    def take(self, count: int) -> bytes:
        """The next bytes, at most those that are left."""
        taken = self._data[self._place : self._place + count]
        self._place += count
        return taken

    def byte(self) -> int:
        """The next byte."""
        return (self.take(1) or b"\0")[0]

    def full(self, count: int) -> bytes:
        """The next bytes, as many as asked for."""
        return self.take(count).ljust(count, b"\0")
