"""Writes npz files, and reads those of anybody: no more than such a file may hold."""

import contextlib
import os
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

import numpy as np

from yehu_server.errors import OutputError, ScoreError
from yehu_server.util.files import (
    error_reason,
    open_regular,
    replace_any,
    replace_none,
    replacing,
)

T = TypeVar("T")

# What a file may claim, so that a small one cannot fill the memory: results are noise, mostly.
MIN_CLAIM, MAX_RATIO = 2**26, 30  # bytes; times the bytes of the file


def read_npz(path: Path, build: Callable[[dict[str, Any]], T], what: str) -> T:
    """Build something from the arrays of a file, by their names.

    `build` raises whatever it likes where the arrays are wrong; `what` the file should be, the
    error tells. Raises ScoreError where it cannot be read, or is something else.
    """
    try:
        with open_regular(path) as opened:
            _check_sizes(opened)
            with np.load(opened, allow_pickle=False) as file:
                return build({name: file[name] for name in file.files})
    except OSError as error:
        raise ScoreError(f"{path}: {error_reason(error)}") from error
    except Exception as error:  # damaged archives raise whatever they lead to
        raise ScoreError(f"{path}: is not {what}") from error


def check_npz(target: Path) -> None:
    """Raise OutputError where the ending of a file is that of another kind."""
    if target.suffix.lower() not in ("", ".npz"):
        raise OutputError(f"{target}: arrays are written; name an .npz file")


@contextlib.contextmanager
def writing_npz(target: Path, *, overwrite: bool) -> Iterator[BinaryIO]:
    """Open a file to write, as `replacing` does; raises OutputError as that and `check_npz`."""
    check_npz(target)
    may_replace = replace_any if overwrite else replace_none
    with replacing(target, may_replace) as partial, partial.open("wb") as file:
        yield file


def _check_sizes(file: BinaryIO) -> None:
    """Refuse an archive that claims to hold much more than results in so many bytes do."""
    with zipfile.ZipFile(file) as archive:
        claimed = sum(entry.file_size for entry in archive.infolist())
    most = max(MIN_CLAIM, MAX_RATIO * os.fstat(file.fileno()).st_size)
    if claimed > most:
        raise ValueError("it claims to hold more than it can")
    file.seek(0)
