"""Compile functions in processes of their own, which report their progress.

Functions call each other by name, so they can be compiled at a time. A process that plays does not
even import numba then: it loads what these leave in the cache.
"""

import contextlib
import gc
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib import import_module
from typing import Any

from yehu_server.compile import machine_code
from yehu_server.compile.cache_folder import cache_folder, source_hash
from yehu_server.compile.jit import Native, parts_of
from yehu_server.util.processes import python_command

Progress = Callable[[float, float], None]
DONE, KEEP = "done", "keep"
LLVM_FASTER = 3.0  # with a function than numba with all its parts, by the bytes of their bytecode
DEARER_TWICE = 2.0  # what both processes make, than that one of them has less to do for a while
# The compiler leaves little garbage, of which a third of its time went into searching for more.
COLLECT_AFTER = 50_000, 20, 100


def compile_apart(
    functions: Sequence[Native], what: str, processes: int, progress: Progress | None = None
) -> None:
    """Compile functions into the cache, and keep their machine code in the file `what` is for.

    `functions`: each after those that it calls.
    `processes`: how many compile at a time, if there are as many processors.
    `progress`: called with the weight of what is done, and of all.

    Where a process fails, some are not kept.
    """
    work = _Work(functions, progress)
    with contextlib.ExitStack() as stack:
        helpers, threads = [], []
        for _ in range(min(processes, os.cpu_count() or 1, len(functions))):
            helper = subprocess.Popen(  # noqa: S603 - our own
                python_command("yehu_server.compile.worker_processes"),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
            )
            stack.callback(_end, helper)  # also where we are interrupted
            helpers.append(helper)
            threads.append(threading.Thread(target=work.hand_out, args=(helper,), daemon=True))
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        with contextlib.suppress(OSError):
            list(_ask(helpers[0], " ".join([KEEP + what, *map(_name, functions)])))


def _end(helper: subprocess.Popen[str]) -> None:
    helper.kill()
    with contextlib.suppress(BrokenPipeError):  # an order that it did not live to read
        helper.communicate()


def _name(function: Native) -> str:
    return f"{function.function.__module__}:{function.function.__name__}"


def _ask(helper: subprocess.Popen[str], order: str) -> Iterator[str]:
    """Have a helper do something; yield what it reports meanwhile. OSError: it has ended."""
    if helper.stdin is None or helper.stdout is None:
        raise BrokenPipeError
    print(order, file=helper.stdin, flush=True)
    while (line := helper.stdout.readline().strip()) != DONE:
        if not line:
            raise BrokenPipeError
        yield line


def weights(function: Native) -> dict[Callable[..., Any], float]:
    """How much there is to compile of a function and of each of its parts, which it takes in."""
    parts = (part.py_func for part in parts_of(function))
    return {each: float(len(each.__code__.co_code)) for each in (function.function, *parts)}


class _Work:
    """What is to be compiled, and what is done."""

    def __init__(self, functions: Iterable[Native], progress: Progress | None) -> None:
        self._queue, self._progress = {each: weights(each) for each in functions}, progress
        self._turn = threading.Lock()
        self._begun: set[Callable[..., Any]] = set()  # by any helper
        self._left: dict[str, float] = {}
        for function, own in self._queue.items():
            self._left[function.name] = sum(own.values()) / LLVM_FASTER
            self._left |= {part.__qualname__: length for part, length in own.items()}
        self._total = sum(self._left.values())

    def hand_out(self, helper: subprocess.Popen[str]) -> None:
        """Give a helper one function after another, for as long as it works."""
        own: set[Callable[..., Any]] = set()
        with contextlib.suppress(OSError):
            while (function := self._next(own)) is not None:
                for name in _ask(helper, _name(function)):
                    self._report(name)
                self._report(function.name)

    def _next(self, own: set[Callable[..., Any]]) -> Native | None:
        """Take the heaviest function of the queue whose parts no other helper has begun.

        `own`: what the helper has begun.
        """

        def worth(function: Native) -> float:
            parts, others = self._queue[function], self._begun - own
            return sum(parts.values()) - DEARER_TWICE * sum(
                parts[each] for each in others & {*parts}
            )

        with self._turn:
            if not self._queue:
                return None
            function = max(self._queue, key=worth)
            begun = self._queue.pop(function).keys()
            own.update(begun)
            self._begun.update(begun)
            return function

    def _report(self, name: str) -> None:
        with self._turn:
            if self._left.pop(name, 0.0) and self._progress is not None:
                self._progress(self._total - sum(self._left.values()), self._total)


def main() -> None:
    """Compile the functions that the input names, one a line; report each that is ready."""
    from yehu_server.compile import function_cache

    output = sys.stdout
    function_cache.on_ready.append(lambda name: print(name, file=output, flush=True))
    gc.freeze()
    gc.set_threshold(*COLLECT_AFTER)
    for line in sys.stdin:
        order, *names = line.split()
        if order.startswith(KEEP):
            what = order.removeprefix(KEEP)
            functions = [_named(name) for name in names]  # which registers their package
            machine_code.keep(cache_folder(), source_hash(what), functions, what)
        else:
            _named(order).keep()
        print(DONE, file=output, flush=True)


def _named(name: str) -> Native:
    module, _, attribute = name.partition(":")
    found: Native = getattr(import_module(module), attribute)
    return found


if __name__ == "__main__":
    main()
