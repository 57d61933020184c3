"""How this package compiles its hot code: decorators of functions, and what they make of them."""

from __future__ import annotations

import ctypes
import dis
import importlib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextvars import ContextVar
from functools import cache, cached_property, update_wrapper
from pathlib import Path
from types import ModuleType, NoneType
from typing import Annotated, Any, ParamSpec, TypeVar, cast, get_args, get_type_hints

from yehu_server.compile import levels, machine_code
from yehu_server.compile.cache_folder import IS_CACHED, cache_folder
from yehu_server.errors import YehuError

# NUMBA_DISABLE_JIT=1: what would be compiled runs as plain Python, under a debugger or coverage.
IS_PLAIN = os.environ.get("NUMBA_DISABLE_JIT", "0") not in {"", "0"}

imported = importlib.import_module
P = ParamSpec("P")
R = TypeVar("R")

# Sums may be reordered and multiply-adds fused, which lets loops vectorise. NaN and
# infinity keep their meaning: a lost state has to be seen.
FASTMATH = {"contract", "reassoc", "nsz", "arcp"}


_is_uncompiled = ContextVar("_is_uncompiled", default=False)


def uncompiled(function: Callable[P, R]) -> Callable[P, R]:
    """The Python function that a compiled one was made of, for use without numba.

    What it calls runs as Python, too. Records have their fields as attributes
    (``memory.with_attributes``).
    """

    def plain(*arguments: P.args, **named: P.kwargs) -> R:
        before = _is_uncompiled.set(True)
        try:
            return function(*arguments, **named)
        finally:
            _is_uncompiled.reset(before)

    return plain


class Deferred:
    """Stands for something of numba's, made when it is first needed.

    Where machine code is kept nothing is, and numba is not even imported.
    """

    def __init__(self, make: Callable[[], Any]) -> None:
        self._make = make

    @cached_property
    def value(self) -> Any:
        """What it stands for."""
        return self._make()

    @property
    def _numba_type_(self) -> Any:  # which numba asks for
        return imported("yehu_server.compile.numba_compiler").type_of(self)

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
        super().__init__(lambda: self._dispatcher(no_cpython_wrapper=True, **options))
        update_wrapper(self, function)
        self.py_func = function
        self._options = options

    def _dispatcher(self, **options: Any) -> Any:
        return imported("yehu_server.compile.numba_compiler").dispatcher(self.py_func, **options)

    @cached_property
    def _for_python(self) -> Any:
        """numba's object with a wrapper for Python, which takes a third of the time to compile.

        Few functions are called from Python, and then mostly by tests.
        """
        return self._dispatcher(**self._options)

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """Call it from Python, compiled once more; as Python within `uncompiled`."""
        return (self.py_func if _is_uncompiled.get() else self._for_python)(*arguments, **named)


class Arithmetic(Compiled):
    """A compiled function that is run as Python where Python calls it."""

    def __call__(self, *arguments: Any) -> Any:
        """Run it as Python."""
        return self.py_func(*arguments)


# fastmath is said, as a function without the word has its caller's.
EXACTLY = {"fastmath": False, "one_version": True, "_nrt": False}


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


def arithmetic(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function of numbers alone as `compiled_exactly` does.

    From Python it runs as Python, which gives the same bits.
    """
    if IS_PLAIN:
        return function
    return cast("Callable[P, R]", Arithmetic(function, **EXACTLY, no_alias=False))


def _compiled_exactly(function: Callable[P, R], **options: Any) -> Callable[P, R]:
    if IS_PLAIN:
        return function
    return cast("Callable[P, R]", Compiled(function, **EXACTLY, **options))


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
C_TYPE_OF = {NoneType: "void", Any: "voidptr", bool: "int64", int: "int64", float: "float64"}
Int32 = Annotated[int, "int32"]
UInt64 = Annotated[Any, "uint64"]


class Native:
    """A function compiled apart: compiled code calls it by its name, C and ctypes by its address.

    `function`: its annotations are its types: int, float, None, Any for an address, and what is in
    ``Annotated``, a name of `C_TYPES` or the dtype of a record, which is passed by address. A bool
    is passed as an int, since WebAssembly and numba pass bits in different ways.
    `calls` (sequence of Native): those that it calls, where that is not what its code names.
    """

    def __init__(self, function: Callable[..., Any], calls: Sequence[Native] | None = None) -> None:
        self.function = function
        self.name = f"yehu_{function.__name__}"
        self._calls = calls

    @property
    def types(self) -> list[Any]:
        """What it returns and takes: names of `C_TYPES`, and dtypes of records."""
        hints = get_type_hints(self.function, include_extras=True)
        hints = {"return": hints.pop("return"), **hints}
        return [C_TYPE_OF.get(hint) or get_args(hint)[1] for hint in hints.values()]

    @property
    def _numba_type_(self) -> Any:  # which numba asks for
        return imported("yehu_server.compile.numba_compiler").type_of_native(self)

    @cached_property
    def calls(self) -> Sequence[Native]:
        """Those that it calls, itself or by functions that are compiled into it."""
        if self._calls is not None:
            return self._calls
        return [value for value in _reached(self.function) if isinstance(value, Native)]

    @cached_property
    def made(self) -> Any:
        """numba's object for it, which may not be compiled yet."""
        return imported("yehu_server.compile.numba_compiler").c_function(self)

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

    @property
    def is_kept(self) -> bool:
        """Whether its machine code is kept, or was shipped, so that it runs without numba."""
        return self._kept is not None

    @property
    def _kept(self) -> int | None:
        return machine_code.address_of(self.name, cache_folder())

    @property
    def is_ready(self) -> bool:
        """Whether nothing has to be compiled for its first use."""
        # Kept code has all that it calls; to find that out takes a while.
        return self.is_kept or all(part.is_kept or part.is_cached for part in with_called([self]))

    def __call__(self, *arguments: Any) -> Any:
        """Run it as Python, as other functions do that are plain (`IS_PLAIN`)."""
        return self.function(*arguments)

    @cached_property
    def call(self) -> Callable[..., Any]:
        """The function for Python, which runs without the GIL, and takes addresses of records."""
        if IS_PLAIN:
            carray = imported("yehu_server.compile.memory").carray
            kinds = self.types[1:]
            return lambda *values: self.function(
                *(
                    value if isinstance(kind, str) else carray(value, (1,), kind)[0]
                    for value, kind in zip(values, kinds, strict=True)
                )
            )
        c_types = [
            C_TYPES[kind] if isinstance(kind, str) else ctypes.c_void_p for kind in self.types
        ]
        return ctypes.CFUNCTYPE(*c_types)(self.address)

    @cached_property
    def address(self) -> int:
        """The function's address, for C.

        Raises YehuError where nothing is compiled, or this processor cannot run it.
        """
        if IS_PLAIN:
            raise YehuError("NUMBA_DISABLE_JIT: plain Python has no address for C")
        levels.check_processor()
        kept = self._kept
        return int(self.compiled.address) if kept is None else kept


def native(function: Callable[..., Any]) -> Native:
    """Compile a function apart from those that call it; see `Native`."""
    return Native(function)


def with_called(functions: Iterable[Native]) -> dict[Native, None]:
    """Functions and all that they call, each once and after those that it calls."""
    found: dict[Native, None] = {}
    for function in functions:
        if function not in found:
            found |= with_called(function.calls) | {function: None}
    return found


def parts_of(native: Native) -> list[Compiled]:
    """The functions that are compiled into one."""
    return [value for value in _reached(native.function) if isinstance(value, Compiled)]


@cache
def _reached(function: Callable[..., Any]) -> tuple[Native | Compiled, ...]:
    """What a function calls, itself or by functions that are compiled into it."""
    found: dict[Any, None] = {}
    ahead = [function]
    while ahead:
        for value in _named_in(ahead.pop()):
            if value not in found:
                found[value] = None
                ahead += [value.py_func] if isinstance(value, Compiled) else []
    return tuple(found)


@cache
def _named_in(function: Callable[..., Any]) -> tuple[Any, ...]:
    """The compiled functions that a function's code names, each once."""
    kinds = (Native, Compiled)
    return tuple(
        dict.fromkeys(value for value in _values_named_in(function) if isinstance(value, kinds))
    )


def _values_named_in(function: Callable[..., Any]) -> Iterator[Any]:
    """What a function's code names: global values, those of modules, and what it closes over."""
    yield from (cell.cell_contents for cell in function.__closure__ or ())
    value = None
    for step in dis.get_instructions(function):
        if step.opname == "LOAD_GLOBAL":
            value = function.__globals__.get(step.argval)
        else:  # of a module, or of no interest
            value = vars(value).get(step.argval) if isinstance(value, ModuleType) else None
        yield value
