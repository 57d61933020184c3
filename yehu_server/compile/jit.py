"""How this package compiles its hot code: decorators of functions, and what they make of them."""

from __future__ import annotations

import ctypes
import importlib
import os
import re
from collections.abc import Callable, Sequence
from functools import cached_property, update_wrapper
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

from yehu_server.compile import machine_code
from yehu_server.compile.cache_folder import IS_CACHED, cache_folder, source_hash
from yehu_server.errors import YehuError

# NUMBA_DISABLE_JIT=1: what would be compiled runs as plain Python, under a debugger or coverage.
IS_PLAIN = os.environ.get("NUMBA_DISABLE_JIT", "0") not in {"", "0"}

imported = importlib.import_module
P = ParamSpec("P")
R = TypeVar("R")

# Sums may be reordered and multiply-adds fused, which lets loops vectorise. NaN and
# infinity keep their meaning: a lost state has to be seen.
FASTMATH = {"contract", "reassoc", "nsz", "arcp"}


class Deferred:
    """Stands for something of numba's, made when it is first needed.

    Where machine code is kept nothing is, and numba is not even imported.

    Parameters
    ----------
    make : callable
        Makes it.
    """

    def __init__(self, make: Callable[[], Any]) -> None:
        self._make = make

    @cached_property
    def value(self) -> Any:
        """What it stands for."""
        return self._make()

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """Call what it stands for."""
        return self.value(*arguments, **named)

    def __getattr__(self, name: str) -> Any:
        """An attribute of what it stands for."""
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.value, name)


class Compiled(Deferred):
    """A function that is compiled when it is first called, or with the first that calls it."""

    def __init__(self, function: Callable[..., Any], **options: Any) -> None:
        compiler = "yehu_server.compile.numba_compiler"
        super().__init__(lambda: imported(compiler).dispatcher(function, **options))
        update_wrapper(self, function)
        self.py_func = function


def _compiled(function: Callable[P, R], **options: Any) -> Callable[P, R]:
    if IS_PLAIN:
        return function
    # Without forced inlining, arrays cross calls as ten words each: a fifth of the time. A wrapper
    # for callbacks in C, which `Native` makes where it is wanted, would be compiled with all of
    # what it calls: a third of the time that a first start takes.
    options |= {"fastmath": FASTMATH, "forceinline": True, "one_version": False}
    return cast("Callable[P, R]", Compiled(function, **options))


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function for the audio thread: no Python objects, no GIL, no exceptions.

    What it writes must be reached by one of its arguments only: see `NoAliasCompiler`. Division by
    zero follows IEEE 754 (``error_model="numpy"``), since a compiled callback has nobody to
    raise to. It makes no arrays, so none are counted (``_nrt``): each row taken of one would be
    two atomic additions, by calls that put away all registers.
    """
    return _compiled(function, no_alias=True, _nrt=False)


def compiled_with_aliasing(function: Callable[P, R]) -> Callable[P, R]:
    """Compile as `compiled` does, for a function whose arguments overlap, or that makes views."""
    return _compiled(function, no_alias=False)


def compiled_exactly(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that decides: with Python's arithmetic, to the bit.

    No sum is reordered and no multiply-add fused, so that a decision doesn't depend on the
    processor. Constants make no versions of their own.
    """
    return _compiled_exactly(function, no_alias=False)


def compiled_exactly_apart(function: Callable[P, R]) -> Callable[P, R]:
    """Compile as `compiled_exactly` does, for loops over rows that do not overlap.

    It becomes a part of its callers, where loops over several rows become vectors.
    """
    return _compiled_exactly(function, forceinline=True, no_alias=True)


def _compiled_exactly(function: Callable[P, R], **options: Any) -> Callable[P, R]:
    if IS_PLAIN:
        return function
    # fastmath is said, as a function without the word has its caller's.
    options |= {"fastmath": False, "one_version": True, "_nrt": False}
    return cast("Callable[P, R]", Compiled(function, **options))


def intrinsic(plain: Callable[..., Any]) -> Callable[[Callable[..., Any]], Any]:
    """numba's ``intrinsic``; without the JIT, a plain function instead."""
    if IS_PLAIN:
        return lambda _function: plain
    return lambda function: Deferred(lambda: imported("numba.extending").intrinsic(function))


C_TYPES: dict[str, Any] = {
    "void": None,
    "voidptr": ctypes.c_void_p,
    "int32": ctypes.c_int32,
    "int64": ctypes.c_int64,
    "uint64": ctypes.c_uint64,
    "float64": ctypes.c_double,
}


class Native:
    """A function compiled on its first use, to be called by address, from C or by ctypes.

    Parameters
    ----------
    calls : sequence of Native
        Those that it calls by their `symbol`.
    """

    def __init__(
        self, signature: str, function: Callable[..., Any], calls: Sequence[Native] = ()
    ) -> None:
        self.signature = signature
        self.function = function
        self.calls = calls
        self.name = f"yehu_{function.__name__}"
        self.full_name = f"{function.__module__}.{function.__qualname__}"

    @cached_property
    def made(self) -> Any:
        """numba's object for it, which may not be compiled yet."""
        return imported("yehu_server.compile.numba_compiler").c_function(
            self.function, self.signature
        )

    @cached_property
    def compiled(self) -> Any:
        """numba's object for it, with ``inspect_llvm()``."""
        for other in self.calls:
            machine_code.add_symbol(other.name, other.address)
        self.made.compile()
        return self.made

    def keep(self) -> None:
        """Compile it into the cache, in a process that won't call it."""
        for other in self.calls:
            machine_code.add_symbol(other.name, 1)  # one is wanted to finish, not to call
        self.made.compile()

    @property
    def file(self) -> Path:
        """Its file in the cache."""
        return Path(self.made._cache.path(self.made._sig))  # noqa: SLF001

    @property
    def is_cached(self) -> bool:
        """Whether its code is in the cache, so that its first use takes no time."""
        return IS_CACHED and self.made._cache.holds(self.made._sig)  # noqa: SLF001

    @cached_property
    def call(self) -> Callable[..., Any]:
        """The function for Python, which runs without the GIL."""
        if IS_PLAIN:
            return self.function
        returned, *arguments = (C_TYPES[word] for word in re.findall(r"\w+", self.signature))
        return ctypes.CFUNCTYPE(returned, *arguments)(self.address)

    @property
    def symbol(self) -> Any:
        """The function for other compiled ones, which find it by its name.

        It is compiled apart from them: in a process of its own, where there is one to spare.
        """
        if IS_PLAIN:
            return self.function
        compiler = "yehu_server.compile.numba_compiler"
        return Deferred(lambda: imported(compiler).external(self.name, self.signature))

    @cached_property
    def address(self) -> int:
        """The function's address, for C.

        Raises
        ------
        YehuError
            Where nothing is compiled.
        """
        if IS_PLAIN:
            raise YehuError("NUMBA_DISABLE_JIT: plain Python has no address for C")
        kept = machine_code.loaded(cache_folder(), source_hash()).get(self.name)
        return int(self.compiled.address) if kept is None else kept


def native(signature: str, calls: Sequence[Native] = ()) -> Callable[[Callable[..., Any]], Native]:
    """Compile a function to be called by address; see `Native`."""
    return lambda function: Native(signature, function, calls)
