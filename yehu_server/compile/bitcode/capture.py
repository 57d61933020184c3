"""Captures what numba's front end makes of functions, so that it can be shipped."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

from numba.core.caching import NullCache
from numba.core.codegen import JITCodeLibrary
from numba.core.registry import cpu_target

from yehu_server.compile.bitcode.shipped import Export, Library, Shipped
from yehu_server.compile.cache import parts_of


class CaptureError(Exception):
    """What was compiled cannot be shipped."""


class _Export(NullCache):  # type: ignore[misc]
    """In the place of one function's cache: it holds nothing, and is given what was compiled."""

    def __init__(self, capture: Capture, name: str) -> None:
        self._capture = capture
        self._name = name

    def save_overload(self, _sig: Any, data: Any) -> None:
        self._capture.add(self._name, data)


class Capture:
    """Libraries as they were before the passes over whole modules, and those that are exported."""

    def __init__(self) -> None:
        self._before: dict[Any, bytes] = {}  # in the order in which they were finished
        self._exports: dict[str, tuple[Any, bytes]] = {}

    def export(self, made: Any, name: str) -> None:
        """Make numba's object for a function, which is compiled next, an export."""
        made._cache = _Export(self, name)  # noqa: SLF001 - as `jit` gives it ours

    def note(self, library: Any) -> None:
        """Keep a library's bitcode, now that nothing was linked into it."""
        self._before[library] = library._final_module.as_bitcode()  # noqa: SLF001

    def add(self, name: str, result: Any) -> None:
        """Keep what was compiled as an export.

        Raises
        ------
        CaptureError
            Where its code holds addresses of this process.
        """
        if result.library.has_dynamic_globals:
            raise CaptureError(f"{name}: its code holds addresses of this process")
        _, rest = parts_of(result)
        self._exports[name] = (result.library, rest)

    def shipped(self) -> Shipped:
        """What is to be shipped: the exports, and all libraries that they are made of.

        Raises
        ------
        CaptureError
            Where some of them were compiled before, or came from the cache.
        """
        places: dict[Any, int] = {}
        wanted = {library for library, _ in self._exports.values()}
        for library in reversed(self._before):
            if library in wanted:
                wanted.update(library._linking_libraries)  # noqa: SLF001
        if missing := wanted - self._before.keys():
            names = ", ".join(sorted(library.name for library in missing))
            raise CaptureError(f"compiled before, or taken from the cache: {names}")
        libraries: list[Library] = []
        for library in self._before:
            if library in wanted:
                places[library] = len(libraries)
                links = tuple(places[link] for link in library._linking_libraries)  # noqa: SLF001
                libraries.append(Library(library.name, links, self._before[library]))
        exports = {
            name: Export(places[library], rest) for name, (library, rest) in self._exports.items()
        }
        return Shipped(tuple(libraries), exports)


@contextlib.contextmanager
def capturing() -> Iterator[Capture]:
    """Capture what numba compiles within the block."""
    capture = Capture()

    class Noted(JITCodeLibrary):  # type: ignore[misc]
        """numba's library, which is noted before anything is linked into it."""

        def finalize(self) -> None:
            capture.note(self)
            super().finalize()

    codegen = cpu_target.target_context.codegen()
    codegen._library_class = Noted  # noqa: SLF001 - numba has no other place for it
    try:
        yield capture
    finally:
        del codegen._library_class  # noqa: SLF001
