"""Compiled code on disk, with a checksum; replaces numba's cache, which does not check its files.

One file for each function, signature and Python has what the function was made of: so no index can
name the wrong one, and processes that compile at once leave each other's files whole. A process for
any level of processors makes machine code of it in a third of the time. Another file, for one
level, has the machine code of a function that is called by address. What fails is reported in one
line and compiled anew; what cannot be kept is played all the same.
"""

import hashlib
import io
import logging
import pickle
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.extending import _Intrinsic
from numba.core.serialize import dumps
from numba.core.types import Type

from yehu_server.compile import levels
from yehu_server.compile.libraries import KINDS, PartLibrary, SourceLibrary
from yehu_server.util.checksummed import ChecksumError, read_checksummed, write_checksummed

log = logging.getLogger(__name__)

TYPES_REPORT = 5  # its place in what numba keeps besides the machine code
SOURCE_SUFFIX = ".ir"  # of a file for all levels

DAMAGED, FULL = "is damaged", "cannot be kept"
# Called with the qualified name of each function that is compiled or read.
on_ready: list[Callable[[str], None]] = []
_reported: set[str] = set()  # of this process: each is logged once
_parts: dict[Path, PartLibrary] = {}  # of this process, by the files of what they were made of


def _warn_once(problem: str, line: str) -> None:
    if problem not in _reported:
        _reported.add(problem)
        log.warning("%s", line)


@cache
def _prepare(target_context: Any) -> None:
    """Let it know its own functions; it finds those that come later by itself."""
    target_context.refresh()


def parts_of(result: Any) -> tuple[Any, bytes]:
    """What numba keeps of what it compiled: the machine code, and the rest, which is not for it.

    The rest has no path of this machine in it: numba's report on types, which has some, stays out.
    """
    code, *rest = result._reduce()  # noqa: SLF001 - there is no other way
    rest[TYPES_REPORT] = ""
    return code, dumps(tuple(rest))


def _result(context: Any, library: Any, function: Any, environment: Any, *rest: Any) -> Any:
    """What numba had compiled, of its library and the rest of `parts_of` it."""
    signature, objectmode, lifted, type_annotation, reload_init, referenced_envs = rest
    for prepare in reload_init:
        prepare()
    made = CompileResult(
        target_context=context,
        typing_context=context.typing_context,
        library=library,
        environment=environment,
        entry_point=context.get_executable(library, function, environment),
        fndesc=function,
        type_annotation=type_annotation,
        signature=signature,
        objectmode=objectmode,
        lifted=lifted,
        typing_error=None,
        call_helper=None,
        metadata=None,
        reload_init=reload_init,
        referenced_envs=referenced_envs,
    )
    engine = getattr(library.codegen, "_engine", None)  # a part has none
    for each in referenced_envs:
        if engine is not None and not engine.get_global_value_address(each.env_name):
            raise ValueError(f"has no {each.env_name}")  # numba would write to address 0
        library.codegen.set_env(each.env_name, each)
    return made


def _library(codegen: Any, source: Path, kept: tuple[str, str, Any]) -> Any:
    """A function's library, of what its file has, or the one for all levels, `source`."""

    def part(name: str) -> PartLibrary:
        file = source.with_name(name)
        if file not in _parts:
            payload = _read(file)
            if payload is None:
                raise ChecksumError(f"{name} is gone")
            _library(codegen, file, _unpickled(payload))
        return _parts[file]

    kind = KINDS.get(kept[1])
    if kind is None:
        return codegen.unserialize_library(kept)
    if source in _parts:
        return _parts[source]
    made = kind.made_of(codegen, kept, part)
    _remember(source, made)
    return made


def _remember(source: Path, library: Any) -> None:
    if isinstance(library, PartLibrary):
        library.file = source.name
        _parts[source] = library


def payload_of(code: Any, rest: bytes) -> bytes:
    """What a file of the cache holds."""
    return bytes(dumps(code)) + rest


def _read(path: Path) -> io.BytesIO | None:
    payload = read_checksummed(path)
    return None if payload is None else io.BytesIO(payload)


def _unpickled(parts: io.BytesIO) -> Any:
    return pickle.load(parts)  # noqa: S301 - with a checksum


def code_of(function: Any) -> tuple[Any, ...]:
    """What distinguishes functions of one name: the code, and what it closes over.

    Not its docstring, nor its line: a comment above would move it.
    """
    code = function.__code__
    constants = [value for value in code.co_consts if value != function.__doc__]
    cells = [_closed_over(cell.cell_contents) for cell in function.__closure__ or ()]
    return code.co_code, code.co_names, dumps((constants, cells))


def _closed_over(value: Any) -> Any:
    """A value as all processes write it: numba numbers types and intrinsics in each anew."""
    if isinstance(value, Type):
        return str(value)
    if isinstance(value, _Intrinsic):
        return code_of(value._defn)  # noqa: SLF001 - there is no other way
    return value


def short_hash(*what: Any) -> str:
    """16 hex digits of what `repr` shows."""
    return hashlib.sha256(repr(what).encode()).hexdigest()[:16]


class CodeCache(NullCache):  # type: ignore[misc]
    """The cache of one function, compiled as the text `how` says, with the methods numba calls."""

    def __init__(self, folder: Path, function: Any, how: str) -> None:
        self._folder = folder
        module = function.__module__.rpartition(".")[2]
        tag = sys.implementation.cache_tag
        self._stem = f"{module}.{function.__qualname__}-{tag}".translate({60: None, 62: None})
        self._own = (how, *code_of(function))
        self._name = function.__qualname__

    @property
    def cache_path(self) -> str:
        """The folder, which numba reports."""
        return str(self._folder)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the code for a signature; None where it has to be compiled."""
        _prepare(target_context)
        source = self.source_path(sig)
        for path in (self.path(sig), source):
            try:
                if (payload := _read(path)) is not None:
                    kept, rest = _unpickled(payload), _unpickled(payload)
                    made = _result(
                        target_context, _library(target_context.codegen(), source, kept), *rest
                    )
                    if path == source and not isinstance(made.library, PartLibrary):
                        self.save_overload(sig, made)
                    self._report_ready()
                    return made
            except Exception as error:  # noqa: BLE001 - nothing in a cache is worth not playing
                reason = error if isinstance(error, ChecksumError) else repr(error)
                _warn_once(DAMAGED, f"{path}: {reason}; compiling anew")
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled for a signature, where there is room for it."""
        self._report_ready()
        library = data.library
        if FULL in _reported or library.has_dynamic_globals or data.lifted:
            return
        try:
            code, rest = parts_of(data)
            if isinstance(library, SourceLibrary) and (source := library.source()) is not None:
                write_checksummed(self.source_path(sig), payload_of(source, rest))
                _remember(self.source_path(sig), library)
            if code is not None:
                write_checksummed(self.path(sig), payload_of(code, rest))
        except Exception as error:  # noqa: BLE001 - neither a full disk nor a numba unlike ours
            reason = getattr(error, "strerror", None) or repr(error)
            _warn_once(
                FULL, f"{self._folder}: {reason}; compiled code is not kept for the next start"
            )

    def _report_ready(self) -> None:
        for report in on_ready:
            report(self._name)

    def holds(self, sig: Any) -> bool:
        """Whether the code for a signature is there and sound."""
        try:
            return read_checksummed(self.path(sig)) is not None
        except ChecksumError:
            return False

    def path(self, sig: Any) -> Path:
        """The file for a signature, for this level."""
        source = self.source_path(sig)
        return source.with_name(f"{source.stem}-{levels.level()}.code")

    def source_path(self, sig: Any) -> Path:
        """The file for a signature, for all levels."""
        return self._folder / f"{self._stem}-{short_hash(sig, self._own)}{SOURCE_SUFFIX}"
