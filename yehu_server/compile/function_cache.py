"""Compiled code on disk, with a checksum; replaces numba's cache, which does not check its files.

One file for each function, signature, processor and Python, sealed: so no index can name the
wrong one, and processes that compile at once leave each other's files whole. What fails is
told in one line and compiled anew; what cannot be kept is played all the same.
"""

from __future__ import annotations

import hashlib
import io
import logging
import pickle
import sys
from pathlib import Path
from typing import Any

from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.registry import cpu_target
from numba.core.serialize import dumps

from yehu_server.compile.part_library import BITCODE_OF_PART, PartLibrary
from yehu_server.util.sealed import SealError, read_sealed, write_sealed

log = logging.getLogger(__name__)

TYPES_REPORT = 5  # its place in what numba keeps besides the machine code

DAMAGED, FULL = "is damaged", "cannot be kept"
_reported: set[str] = set()  # of this process: each is told once


def _tell(trouble: str, line: str) -> None:
    if trouble not in _reported:
        _reported.add(trouble)
        log.warning("%s", line)


def parts_of(result: Any) -> tuple[Any, bytes]:
    """What numba keeps of what it compiled: the machine code, and the rest, which is not for it.

    The rest has no path of this machine in it: numba's report on types, which has some, stays out.
    """
    code, *rest = result._reduce()  # noqa: SLF001 - there is no other way
    rest[TYPES_REPORT] = ""
    return code, dumps(tuple(rest))


def _result(context: Any, code: Any, function: Any, environment: Any, *rest: Any) -> Any:
    """What numba had compiled, of `parts_of` it."""
    if code[1] != BITCODE_OF_PART:
        return CompileResult._rebuild(context, code, function, environment, *rest)  # noqa: SLF001
    part = PartLibrary.kept_as(context.codegen(), code)
    signature, objectmode, lifted, type_annotation, reload_init, referenced_envs = rest
    return CompileResult(
        target_context=context,
        typing_context=context.typing_context,
        library=part,
        environment=environment,
        entry_point=context.get_executable(part, function, environment),
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


def payload_of(code: Any, rest: bytes) -> bytes:
    """What a file of the cache holds."""
    return bytes(dumps(code)) + rest


class CodeCache(NullCache):  # type: ignore[misc]
    """The cache of one function, compiled as the text `how` says, with the methods numba calls."""

    def __init__(self, folder: Path, function: Any, how: str) -> None:
        self._folder = folder
        module = function.__module__.rpartition(".")[2]
        tag = sys.implementation.cache_tag
        self._stem = f"{module}.{function.__qualname__}-{tag}".translate({60: None, 62: None})
        # What tells functions of one name apart: the code but for its docstring, and what it
        # closes over. Not its line: a comment above would move it.
        code = function.__code__
        constants = [value for value in code.co_consts if value != function.__doc__]
        cells = [cell.cell_contents for cell in function.__closure__ or ()]
        self._own = (how, code.co_code, code.co_names, dumps((constants, cells)))

    @property
    def cache_path(self) -> str:
        """The folder, which numba tells of."""
        return str(self._folder)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the code for a signature; None where it has to be compiled."""
        target_context.refresh()
        path = self.path(sig)
        try:
            payload = read_sealed(path)
            if payload is None:
                return None
            parts = io.BytesIO(payload)
            code, rest = pickle.load(parts), pickle.load(parts)  # noqa: S301 - it is sealed
            return _result(target_context, code, *rest)
        except Exception as error:  # noqa: BLE001 - nothing in a cache is worth not playing
            reason = error if isinstance(error, SealError) else repr(error)
            _tell(DAMAGED, f"{path}: {reason}; compiling anew")
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled for a signature, where there is room for it."""
        if FULL in _reported or data.library.has_dynamic_globals or data.lifted:
            return
        try:
            write_sealed(self.path(sig), payload_of(*parts_of(data)))
        except Exception as error:  # noqa: BLE001 - neither a full disk nor a numba unlike ours
            reason = getattr(error, "strerror", None) or repr(error)
            _tell(FULL, f"{self._folder}: {reason}; compiled code is not kept for the next start")

    def holds(self, sig: Any) -> bool:
        """Whether the code for a signature is there and sound."""
        try:
            return read_sealed(self.path(sig)) is not None
        except SealError:
            return False

    def path(self, sig: Any) -> Path:
        """The file for a signature, on this processor."""
        processor = cpu_target.target_context.codegen().magic_tuple()
        key = repr((sig, processor, self._own))
        return self._folder / f"{self._stem}-{hashlib.sha256(key.encode()).hexdigest()[:16]}.code"
