"""Findings: inputs that break a contract, one for each place in the code."""

from __future__ import annotations

import re
import time
import traceback
from pathlib import Path

from fuzz.bounds import TooSlowError
from fuzz.target import Target

SMALLER_FOR_S = 10.0
SHOWN_BYTES = 300


def broken(target: Target, data: bytes) -> BaseException | None:
    """The error that breaks the contract, if any."""
    try:
        target.check(data)
    except (Exception, TooSlowError) as error:  # noqa: BLE001 - whatever it is
        return error
    return None


def place(error: BaseException) -> str:
    """The type of an error and where it was raised; of a timeout, the type alone."""
    if isinstance(error, TooSlowError):
        return "TooSlowError"
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if re.search("yehu_(server|lab)", frame.filename)] or frames
    return f"{type(error).__name__} at {Path(own[-1].filename).name}:{own[-1].lineno}"


class Findings:
    """The findings of one target, each kept in a file of the folder as it is found."""

    def __init__(self, target: Target, folder: Path) -> None:
        self._target = target
        self._folder = folder
        self._known: set[str] = set()

    def take(self, data: bytes) -> None:
        """Try some bytes; keep them if they break the contract at a new place."""
        error = broken(self._target, data)
        if error is None or place(error) in self._known:
            return
        self._known.add(place(error))
        (self._folder / f"{self._target.name}-{len(self._known)}").write_bytes(data)


def smaller(target: Target, data: bytes) -> bytes:
    """The smallest part of the data found that breaks at the same place."""
    error = broken(target, data)
    if error is None:
        return data
    wanted, until = place(error), time.monotonic() + SMALLER_FOR_S
    size = len(data)
    while (size := size // 2) > 0:
        start = 0
        while start < len(data):
            less = data[:start] + data[start + size :]
            if time.monotonic() > until:
                return data
            error = broken(target, less)
            if error is not None and place(error) == wanted:
                data = less
            else:
                start += size
    return data


def described(target: Target, data: bytes) -> str:
    """A finding as text: the error, where it was raised, and the bytes."""
    error = broken(target, data)
    if error is None:
        return f"{target.name}: breaks only after other inputs"
    trace = "".join(traceback.format_exception(error)[-8:]).rstrip()
    shown = repr(data) if len(data) <= SHOWN_BYTES else f"{data[:SHOWN_BYTES]!r}..."
    return f"{target.name}: {target.contract}\n{trace}\n{len(data)} bytes: {shown}"
