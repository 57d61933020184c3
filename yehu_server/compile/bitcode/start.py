"""Has machine code made of shipped bitcode, in processes of their own, at the first start."""

from __future__ import annotations

import contextlib
import logging
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from yehu_server.compile.bitcode import shipped
from yehu_server.compile.bitcode.shipped import Shipped, UnfitError, read_shipped
from yehu_server.util.sealed import SealError

log = logging.getLogger(__name__)

INSTEAD = "compiling instead, which takes half a minute"
# The audio callback takes as long as all the rest together, so more would not be faster.
MOST_PROCESSES = 2


def why_not(sources: str) -> str:
    """Why nothing shipped can be used; empty where it can, or where only trying will show it."""
    try:
        read_shipped(shipped.shipped_file(), sources)
    except UnfitError as error:
        return str(error)
    except SealError:
        pass
    return ""


def make(files: Mapping[str, Path], sources: str) -> None:
    """Make the machine code of functions of what is shipped, each into its file of the cache.

    Where that is impossible, one line of the log tells why, and the files are not there.

    Parameters
    ----------
    files : mapping
        The files, by the names of the functions; what is not shipped is left out.
    sources : str
        Key of the sources.
    """
    source = shipped.shipped_file()
    try:
        content = read_shipped(source, sources)
    except UnfitError as error:
        log.debug("%s; %s", error, INSTEAD)  # ordinary, and the commands tell it
        return
    except SealError as error:
        log.warning("%s: %s; %s", source, error, INSTEAD)
        return
    names = [name for name in files if name in content.exports]
    commands = [
        [sys.executable, "-P", "-m", "yehu_server.compile.bitcode.replay", str(source), sources]
        + [word for name in share for word in (name, str(files[name]))]
        for share in _shares(content, names, min(MOST_PROCESSES, os.cpu_count() or 1))
    ]
    if trouble := _run(commands):
        log.warning("%s: %s; %s", source, trouble, INSTEAD)


def _shares(content: Shipped, names: list[str], count: int) -> list[list[str]]:
    """Share functions out, by the size of what they are made of."""
    sizes = {
        name: sum(len(content.libraries[index].bitcode) for index in content.needed([name]))
        for name in names
    }
    shares: list[list[str]] = [[] for _ in range(count)]
    for name in sorted(names, key=lambda name: -sizes[name]):
        min(shares, key=lambda share: sum(sizes[name] for name in share)).append(name)
    return [share for share in shares if share]


def _run(commands: list[list[str]]) -> str:
    """Run commands at a time; return what one of them failed with."""
    trouble = ""
    with contextlib.ExitStack() as stack:
        begun = []
        try:
            for command in commands:
                process = subprocess.Popen(command, stderr=subprocess.PIPE)  # noqa: S603 - our own
                begun.append(stack.enter_context(process))
                stack.callback(process.kill)  # where we are interrupted
        except OSError as error:
            return error.strerror or repr(error)
        for process in begun:
            _, said = process.communicate()
            if process.returncode:
                trouble = _last_line(said) or f"LLVM ended with {process.returncode}"
    return trouble


def _last_line(said: bytes) -> str:
    lines = [line.strip() for line in said.decode(errors="replace").splitlines()]
    return next(filter(None, reversed(lines)), "")
