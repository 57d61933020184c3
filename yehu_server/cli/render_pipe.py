"""``yehu-server render - -o -``: a score from standard input, sound to standard output."""

import argparse
import contextlib
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from yehu_server.errors import ParameterError, ScoreError, YehuError
from yehu_server.rendering import PIPE
from yehu_server.util.files import error_reason

STDIN = "standard input"  # also the name of its file
BROKEN_PIPE = 141  # as the shell reports a program that the signal for it has ended
CHUNK = 1 << 20


def sound_target(text: str) -> Path:
    """Convert the argument of -o, which may be ``-``."""
    return PIPE if text == "-" else Path(text)


def score_source(text: str) -> Path | str:
    """Convert a score to read: a path, or ``-``, which no path is (``./-`` is)."""
    return text if text == "-" else Path(text)


@contextlib.contextmanager
def piped_in(arguments: argparse.Namespace) -> Iterator[None]:
    """Keep what is on standard input in a file, where that is to be read, for the time of a block.

    Raises YehuError where it is too large, or asked for twice; errors in the block name it as it
    is.
    """
    from yehu_server.scores.smf.reader import MAX_BYTES

    asked = [path for path in arguments.midi if path == "-"]
    if not asked:
        yield
        return
    if len(asked) > 1:
        raise ParameterError("standard input can be read once only")
    if sys.stdin is None or sys.stdin.isatty():
        raise ScoreError("standard input is a terminal; pipe a score into it")
    with tempfile.TemporaryDirectory(prefix="yehu-server-") as folder:
        path = Path(folder) / STDIN
        size = 0
        try:
            with path.open("wb") as file:
                while data := os.read(0, CHUNK):
                    size += len(data)
                    if size > MAX_BYTES:
                        raise ScoreError(f"{STDIN}: larger than {MAX_BYTES // 2**20} MiB")
                    file.write(data)
        except OSError as error:
            raise ScoreError(f"{STDIN}: {error_reason(error)}") from error
        arguments.midi = [path if each == "-" else each for each in arguments.midi]
        try:
            yield
        except YehuError as error:
            raise type(error)(str(error).replace(str(path), STDIN)) from error


@contextlib.contextmanager
def quiet_pipe(target: Path) -> Iterator[None]:
    """End the program quietly where the reader of its sound has gone."""
    try:
        yield
    except BrokenPipeError:
        if target is not PIPE:
            raise
        raise SystemExit(BROKEN_PIPE) from None
