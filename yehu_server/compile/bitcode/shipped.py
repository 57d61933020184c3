"""The file of bitcode that is shipped: what is in it, and what it was made for.

It is sealed. Inside are a line of JSON, which tells all sizes, and compressed bytes.
"""

from __future__ import annotations

import io
import json
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import llvmlite
import numba
from llvmlite import binding

from yehu_server.util.sealed import SealError, read_sealed, write_sealed

FORMAT = 1


class UnfitError(Exception):
    """Nothing is shipped for this machine, these versions and these sources."""


@dataclass(frozen=True)
class Library:
    """One of numba's libraries: a compiled function, before any pass over its whole module.

    Attributes
    ----------
    links : tuple of int
        The libraries that are linked into it first, in order. Each comes before it in the file.
    """

    name: str
    links: tuple[int, ...]
    bitcode: bytes


@dataclass(frozen=True)
class Export:
    """A function that can be called by address: its library, and what the cache keeps beside."""

    library: int
    rest: bytes


@dataclass(frozen=True)
class Shipped:
    """What the file holds."""

    libraries: tuple[Library, ...]
    exports: dict[str, Export]

    def needed(self, names: Iterable[str]) -> list[int]:
        """The libraries that some exports are made of, each after those that it links."""
        needed: set[int] = set()
        waiting = [self.exports[name].library for name in names]
        while waiting:
            index = waiting.pop()
            if index not in needed:
                needed.add(index)
                waiting.extend(self.libraries[index].links)
        return sorted(needed)


def kind_of_machine() -> str:
    """What all machines have in common that one file is for, such as x86_64-unknown-linux-gnu."""
    return str(binding.get_process_triple())


def shipped_file() -> Path:
    """Where the file for this kind of machine is, if there is one."""
    return Path(__file__).parent / f"{kind_of_machine()}.bitcode"


def _made_for(sources: str) -> dict[str, Any]:
    # Python is not among them: a test runs what one made under another.
    return {
        "format": FORMAT,
        "machine": kind_of_machine(),
        "numba": numba.__version__,
        "llvmlite": llvmlite.__version__,
        "LLVM": ".".join(map(str, binding.llvm_version_info)),
        "sources": sources,
    }


def write_shipped(path: Path, shipped: Shipped, sources: str) -> None:
    """Write the file; of the same contents the same bytes.

    Parameters
    ----------
    sources : str
        Key of the source that it was made from.

    Raises
    ------
    OSError
        Where it cannot be written.
    """
    exports = sorted(shipped.exports.items())
    head = {
        "made for": _made_for(sources),
        "libraries": [[one.name, one.links, len(one.bitcode)] for one in shipped.libraries],
        "exports": [[name, one.library, len(one.rest)] for name, one in exports],
    }
    parts = [one.bitcode for one in shipped.libraries] + [one.rest for _, one in exports]
    body = zlib.compress(b"".join(parts), 9)
    write_sealed(path, json.dumps(head).encode() + b"\n" + body)


def read_shipped(path: Path, sources: str) -> Shipped:
    """Read the file.

    Parameters
    ----------
    sources : str
        Key of the source that it has to be made from.

    Raises
    ------
    UnfitError
        Where there is no file, or one that was made for something else.
    SealError
        Where it is damaged or cannot be read.
    """
    payload = read_sealed(path)
    if payload is None:
        raise UnfitError("this copy came without code made in advance")
    try:
        return _read(payload, sources)
    except (ValueError, LookupError, TypeError, zlib.error) as error:
        raise SealError("it is none of ours") from error


def _read(payload: bytes, sources: str) -> Shipped:
    line, _, body = payload.partition(b"\n")
    head = json.loads(line)
    made_for = dict(head["made for"])
    for what, here in _made_for(sources).items():
        there = made_for.get(what)
        if there != here:
            told = "of other sources" if what == "sources" else f"for {what} {there}"
            raise UnfitError(f"the code made in advance is {told}")
    parts = io.BytesIO(zlib.decompress(body))
    libraries = tuple(
        Library(name, tuple(links), parts.read(size)) for name, links, size in head["libraries"]
    )
    exports = {name: Export(library, parts.read(size)) for name, library, size in head["exports"]}
    return Shipped(libraries, exports)
