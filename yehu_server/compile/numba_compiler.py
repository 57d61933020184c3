"""numba, as this package uses it. Imported only where something has to be compiled.

What is compiled names other functions and intrinsics as `jit.Deferred`; numba sees what these stand
for. In the place of a `jit.Native` it sees an external function.
"""

import contextlib
from collections.abc import Callable
from functools import cache
from typing import Any

import numba
from numba import types
from numba.core.bytecode import FunctionIdentity
from numba.core.ccallback import CFunc
from numba.core.cpu_options import FastMathOptions
from numba.core.registry import cpu_target

from yehu_server.compile import jit, levels
from yehu_server.compile.cache_folder import IS_CACHED, cache_folder, key_beside
from yehu_server.compile.function_cache import CodeCache, code_of, short_hash
from yehu_server.compile.libraries import ColdPartLibrary, PartLibrary, SourceLibrary

# The numba whose inner parts these two know. Another one compiles the same in twice the time.
if numba.__version__.startswith("0.68."):
    from yehu_server.compile import numba_shortcuts  # noqa: F401
    from yehu_server.compile.numba_passes import LeanCompiler
else:
    from numba.core.compiler import Compiler as LeanCompiler  # type: ignore[no-redef]

# Before numba makes its code generator, and whatever the environment says to numba of processors.
numba.config.CPU_NAME, numba.config.CPU_FEATURES = levels.cpu(levels.level()), ""
cpu_target.target_context.codegen()

OPTIONS = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}


class NoAliasCompiler(LeanCompiler):
    """numba's compiler for functions whose arguments do not overlap, as with C's `restrict`.

    Else each loop over several rows of one record first compares their addresses, a tenth of the
    kernel's time.
    """

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.state.flags.noalias = True


class SourceCompiler(LeanCompiler):
    """numba's compiler, into a library that can be made again for another level."""

    library = SourceLibrary

    def compile_extra(self, function: Callable[..., Any]) -> Any:
        """Compile a function, with numba's name for this."""
        self.state.library = self.library(self.state.targetctx.codegen(), function.__qualname__)
        return super().compile_extra(function)


_identify = FunctionIdentity.from_function.__func__


def _identify_by_code(kind: Any, function: Any) -> Any:
    """Let all processes name a function alike, and numba's own that it calls.

    numba names it by a number of this process. What is kept of a function names others, whose files
    another process may have written. Functions without a source of theirs may differ by more
    than their code.
    """
    named = _identify(kind, function)
    if not named.filename.startswith("<"):
        with contextlib.suppress(Exception):  # what it closes over cannot be written
            named.unique_id = short_hash(named.modname, code_of(named.func))
            named.unique_name = f"{named.func_qualname}${named.unique_id}"
    return named


FunctionIdentity.from_function = classmethod(_identify_by_code)
_hash_of = cache(short_hash)  # names of large records have thousands of letters
# numba names a record's type by a number of this process, which would be in the names of functions.
types.Record.mangling_args = property(lambda record: ("Record", (_hash_of(record.name),)))
# These, too, are in the names of functions, and a set's text has another order in each process.
FastMathOptions.encode = lambda options: str(sorted(options.flags))


class PartCompiler(SourceCompiler):
    """numba's compiler, for functions that only become parts of others; see `PartLibrary`."""

    library = PartLibrary


class NoAliasPartCompiler(NoAliasCompiler, PartCompiler):
    """Both at once."""


class ColdPartCompiler(SourceCompiler):
    """numba's compiler, for parts that are not called for each sample."""

    library = ColdPartLibrary


@cache
def type_of(deferred: jit.Deferred) -> Any:
    """numba's type of what a deferred value stands for."""
    value, typing = deferred.value, cpu_target.typing_context
    cpu_target.target_context.refresh()  # which imports what numba itself defines
    typing.refresh()  # numba knows only then of an intrinsic that is new
    return typing.resolve_value_type(value)


def dispatcher(
    function: Callable[..., Any], *, no_alias: bool, one_version: bool, **options: Any
) -> Any:
    """numba's object for a function that others call.

    `no_alias`: whether no two of its arguments overlap.
    `one_version`: whether constants make no versions of their own.
    """
    is_part = "no_cpython_wrapper" in options
    if is_part:
        is_hot = "forceinline" in options
        options["pipeline_class"] = (
            NoAliasPartCompiler if no_alias else PartCompiler if is_hot else ColdPartCompiler
        )
    elif no_alias:
        options["pipeline_class"] = NoAliasCompiler
    how = {name: sorted(each) if isinstance(each, set) else each for name, each in options.items()}
    made = _cached(numba.njit(**OPTIONS, **options)(function), function, repr(how))
    if one_version:
        versions = made.get_call_template
        made.get_call_template = lambda arguments, named: versions(
            [types.unliteral(argument) for argument in arguments], named
        )
    return made


def type_of_native(native: jit.Native) -> Any:
    """numba's type of a function that is called by its name."""
    returned, *arguments = _types(native)
    return types.ExternalFunction(native.name, returned(*arguments))


def c_function(native: jit.Native) -> Any:
    """numba's object for a function that is called by address."""
    options = {"nopython": True, "error_model": "numpy", "fastmath": jit.FASTMATH}
    returned, *arguments = _types(native)
    made = CFunc(native.function, (tuple(arguments), returned), {}, options, SourceCompiler)
    return _cached(made, native.function, "")


def _types(native: jit.Native) -> list[Any]:
    return [
        getattr(types, kind) if isinstance(kind, str) else numba.from_dtype(kind)
        for kind in native.types
    ]


def _cached(made: Any, function: Callable[..., Any], how: str) -> Any:
    """Give numba's object for a function our cache, before anything is compiled."""
    if IS_CACHED:
        cache = CodeCache(cache_folder(), function, how + key_beside(function.__module__))
        made._cache = cache  # noqa: SLF001 - there is no other way
    return made
