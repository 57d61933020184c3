"""Compile what playing needs, before the first sound; or load it from the cache.

Where no machine code is kept or shipped for this level of processors and these sources, all is
compiled, by processes of their own, which leave it in the cache.
"""

from collections.abc import Mapping, Sequence
from functools import cache

from yehu_server.compile import machine_code
from yehu_server.compile.cache_folder import IS_CACHED
from yehu_server.compile.jit import IS_PLAIN, Native, with_called
from yehu_server.compile.worker_processes import Progress, compile_apart
from yehu_server.core.engine import native
from yehu_server.core.engine.event_dispatch import index_notes
from yehu_server.core.engine.mixing import mix_block
from yehu_server.core.engine.sounding import sound_block
from yehu_server.core.physics.kernel import derive

CALLED = (
    native.callback, sound_block, mix_block, derive, native.post, native.post_from,
    native.frame_at, native.read_meters, native.read_reports, native.taped, index_notes,
)  # fmt: skip

Compiled = Mapping[str, Sequence[Native]]


def what_compiles(*called: Sequence[Native]) -> str | None:
    """What of some functions has to be compiled, and for how long, in words; None where nothing."""
    for functions in called:
        if not IS_PLAIN and not all(function.is_ready for function in functions):
            if functions is CALLED:
                return "compiling the instrument for this machine (about a minute)"
            return "compiling what else is needed (some seconds)"
    return None


@cache
def all_functions() -> tuple[Native, ...]:
    """All functions that playing needs, each after those that it calls."""
    return tuple(with_called(CALLED))


def functions_beside(called: Sequence[Native]) -> tuple[Native, ...]:
    """Some functions and those that they call, but for playing's; each after those it calls."""
    return tuple(call for call in with_called(called) if call not in all_functions())


def warm_up(
    processes: int = 2, progress: Progress | None = None, more: Compiled | None = None
) -> None:
    """Compile all functions that playing needs, and more; or load them from the cache.

    `processes`: how many compile at a time. Two are sooner ready where nothing else is done
    meanwhile, and take some more of the processors' time.
    `progress`: called with the weight of what is done, and of all, where something is compiled;
    for each file anew.
    `more`: what else is called, by the file that its machine code is kept in.
    """
    if IS_PLAIN:
        return
    if not is_warm():
        keep_all(all_functions(), machine_code.PLAYING, processes, progress)
    for what, called in (more or {}).items():
        if not all(function.is_kept for function in called):
            keep_all(functions_beside(called), what, processes, progress)


def keep_all(
    functions: Sequence[Native], what: str, processes: int, progress: Progress | None = None
) -> None:
    """Compile functions, each after those that it calls; keep their machine code in one file."""
    if IS_CACHED:
        compile_apart(functions, what, processes, progress)
        machine_code.loaded.cache_clear()
    for function in functions:
        _ = function.address  # which compiles what could not be kept


def is_warm() -> bool:
    """Whether all functions that playing needs are kept, ready to be called."""
    return all(function.is_kept for function in CALLED)
