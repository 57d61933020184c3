"""How this package compiles its hot code: one decorator, one cache.

numba does not notice when a compiled function's callee changes in another file,
so the cache folder is keyed by all sources that may be compiled.
"""

from __future__ import annotations

import errno
import os
import shutil
import time
from collections.abc import Callable, Iterable, Sequence
from functools import cache, cached_property
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

import numba
from llvmlite import binding
from numba import extending, types
from numba.core import sigutils
from numba.core.ccallback import CFunc
from numba.core.compiler import Compiler
from platformdirs import user_cache_dir

from yehu_server.compile.bitcode import start
from yehu_server.compile.bitcode.capture import Capture
from yehu_server.compile.cache import CodeCache
from yehu_server.errors import YehuError
from yehu_server.util import PACKAGE
from yehu_server.util.source_key import key_of

# NUMBA_DISABLE_JIT=1: what would be compiled runs as plain Python, under a debugger or coverage.
IS_PLAIN = bool(numba.config.DISABLE_JIT)

P = ParamSpec("P")
R = TypeVar("R")

# Sums may be reordered and multiply-adds fused, which lets loops vectorise. NaN and
# infinity keep their meaning: a lost state has to be seen.
FASTMATH = {"contract", "reassoc", "nsz", "arcp"}
# Of all source that is compiled, or that compiled code reads constants of.
FOLDERS = ("core", "params", "compile", "lab/regimes")


@cache
def source_hash() -> str:
    """Key of all source that compiled code comes from or reads constants of (16 hex digits)."""
    sources = [source for folder in FOLDERS for source in sorted((PACKAGE / folder).rglob("*.py"))]
    return key_of(sources, numba.__version__)


def cache_folder() -> Path:
    """Where compiled code is kept; ``NUMBA_CACHE_DIR`` moves it."""
    root = os.environ.get("NUMBA_CACHE_DIR") or user_cache_dir("yehu-server", appauthor=False)
    return Path(root) / f"{FOLDER}{source_hash()}"


def data_folder() -> Path:
    """Where else is kept what takes long to find, such as calibrations."""
    return cache_folder().parent


def _open_cache() -> str:
    """Make the cache folder and drop what older sources left; return why nothing can be kept."""
    folder = cache_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        os.utime(folder)
        for other in folder.parent.glob(f"{FOLDER}*"):
            if time.time() - other.stat().st_mtime > UNUSED_AFTER_S:
                shutil.rmtree(other, ignore_errors=True)
    except OSError as error:
        return error.strerror or repr(error)
    return "" if os.access(folder, os.W_OK) else os.strerror(errno.EACCES)


FOLDER = "compiled-"
UNUSED_AFTER_S = 14 * 24 * 3600.0
WHY_NOT_CACHED = _open_cache()
IS_CACHED = not WHY_NOT_CACHED  # else everything is compiled anew at each start


def _cached(made: Any, function: Callable[..., Any]) -> Any:
    """Give numba's object for a function our cache, before anything is compiled."""
    if IS_CACHED:
        made._cache = CodeCache(cache_folder(), function)  # noqa: SLF001 - there is no other way
    return made


class NoAliasCompiler(Compiler):  # type: ignore[misc]
    """numba's compiler, told that no two arguments of a function overlap, as C's `restrict` does.

    Else each loop over several rows of one record first compares their addresses, a tenth of the
    kernel's time.
    """

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.state.flags.noalias = True


def _compiled(function: Callable[P, R], **options: Any) -> Callable[P, R]:
    if IS_PLAIN:
        return function
    # Without forced inlining, arrays cross calls as ten words each: a fifth of the time. A wrapper
    # for callbacks in C, which `Native` makes where it is wanted, would be compiled with all of
    # what it calls: a third of the time that a first start takes.
    jit = numba.njit(
        nogil=True,
        error_model="numpy",
        fastmath=FASTMATH,
        forceinline=True,
        no_cfunc_wrapper=True,
        **options,
    )
    return cast("Callable[P, R]", _cached(jit(function), function))


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function for the audio thread: no Python objects, no GIL, no exceptions.

    What it writes must be reached by one of its arguments only: see `NoAliasCompiler`. Division by
    zero follows IEEE 754 (``error_model="numpy"``), since a compiled callback has nobody to
    raise to. It makes no arrays, so none are counted (``_nrt``): each row taken of one would be
    two atomic additions, by calls that put away all registers.
    """
    return _compiled(function, pipeline_class=NoAliasCompiler, _nrt=False)


def compiled_with_aliasing(function: Callable[P, R]) -> Callable[P, R]:
    """Compile as `compiled` does, for a function whose arguments overlap, or that makes views."""
    return _compiled(function)


def compiled_exactly(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that decides: with Python's arithmetic, to the bit.

    No sum is reordered and no multiply-add fused, so that a decision doesn't depend on the
    processor. Constants make no versions of their own.
    """
    return _compiled_exactly(function)


def compiled_exactly_apart(function: Callable[P, R]) -> Callable[P, R]:
    """Compile as `compiled_exactly` does, for loops over rows that do not overlap.

    It becomes a part of its callers, where loops over several rows become vectors.
    """
    return _compiled_exactly(function, forceinline=True, pipeline_class=NoAliasCompiler)


def _compiled_exactly(function: Callable[P, R], **options: Any) -> Callable[P, R]:
    if IS_PLAIN:
        return function
    made = numba.njit(
        nogil=True,
        error_model="numpy",
        fastmath=False,  # said, as a function without the word has its caller's
        no_cfunc_wrapper=True,
        _nrt=False,
        **options,
    )(function)
    versions = made.get_call_template

    def one_version(arguments: Any, named: Any) -> Any:
        return versions([types.unliteral(argument) for argument in arguments], named)

    made.get_call_template = one_version
    return cast("Callable[P, R]", _cached(made, function))


def intrinsic(plain: Callable[..., Any]) -> Callable[[Callable[..., Any]], Any]:
    """numba's ``intrinsic``; without the JIT, a plain function instead."""
    if IS_PLAIN:
        return lambda _function: plain
    return cast("Callable[..., Any]", extending.intrinsic)


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
    def _made(self) -> Any:
        signature = sigutils.normalize_signature(self.signature)
        options = {"nopython": True, "error_model": "numpy", "fastmath": FASTMATH}
        return _cached(CFunc(self.function, signature, {}, options), self.function)

    @cached_property
    def compiled(self) -> Any:
        """numba's object for it, with ``inspect_llvm()``."""
        make_of_shipped([self])
        for other in self.calls:
            binding.add_symbol(other.name, other.address)
        self._made.compile()
        return self._made

    def keep(self) -> None:
        """Compile it into the cache, in a process that won't call it."""
        for other in self.calls:
            binding.add_symbol(other.name, 1)  # an address is wanted to finish, not to call
        self._made.compile()

    def capture(self, into: Capture) -> None:
        """Compile it to be shipped, in a process that won't call it."""
        into.export(self._made, self.full_name)
        self.keep()

    @property
    def file(self) -> Path:
        """Its file in the cache."""
        return Path(self._made._cache.path(self._made._sig))  # noqa: SLF001

    @property
    def is_cached(self) -> bool:
        """Whether its code is in the cache, so that its first use takes no time."""
        return IS_CACHED and self._made._cache.holds(self._made._sig)  # noqa: SLF001

    @cached_property
    def call(self) -> Callable[..., Any]:
        """The function for Python, which runs without the GIL."""
        if IS_PLAIN:
            return self.function
        return cast("Callable[..., Any]", self.compiled.ctypes)

    @property
    def symbol(self) -> Any:
        """The function for other compiled ones, which find it by its name.

        It is compiled apart from them: in a process of its own, where there is one to spare.
        """
        if IS_PLAIN:
            return self.function
        arguments, returned = sigutils.normalize_signature(self.signature)
        return types.ExternalFunction(self.name, returned(*arguments))

    @property
    def address(self) -> int:
        """The function's address, for C.

        Raises
        ------
        YehuError
            Where nothing is compiled.
        """
        if IS_PLAIN:
            raise YehuError("NUMBA_DISABLE_JIT: plain Python has no address for C")
        return int(self.compiled.address)


_asked_for: set[str] = set()  # of this process: each is made of what is shipped, or not, once


def make_of_shipped(functions: Iterable[Native]) -> None:
    """Make machine code of what is shipped for those that are not in the cache, where possible."""
    wanted = [
        function
        for function in functions
        if IS_CACHED and function.full_name not in _asked_for and not function.is_cached
    ]
    _asked_for.update(function.full_name for function in wanted)
    if wanted:
        start.make({function.full_name: function.file for function in wanted}, source_hash())


def native(signature: str, calls: Sequence[Native] = ()) -> Callable[[Callable[..., Any]], Native]:
    """Compile a function to be called by address; see `Native`."""
    return lambda function: Native(signature, function, calls)
