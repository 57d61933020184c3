"""What commands print: results, warnings, progress bars, and the log of serve."""

from __future__ import annotations

import argparse
import contextlib
import json
import logging
import os
import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, TextIO

from yehu_server.errors import YehuError, one_line

if TYPE_CHECKING:
    from yehu_server.core.engine.warming import Compiled

INTERRUPTED = 130  # exit code
ENDING = (signal.SIGINT, signal.SIGTERM)


def print_result(text: str, *, flush: bool = False) -> None:
    """Print a result."""
    for line in text.split("\n"):
        print(one_line(line), flush=flush)


def print_json(fields: Any, file: TextIO | None = None) -> None:
    """Print JSON on a line, with letters as they are where the output can hold them."""
    file = file or sys.stdout
    text = json.dumps(fields, ensure_ascii=False)
    try:
        text.encode(file.encoding or "ascii")
    except UnicodeEncodeError:
        text = json.dumps(fields)
    print(text, file=file, flush=True)


def print_report(arguments: argparse.Namespace, fields: dict[str, Any], text: str) -> None:
    """Print what a command did: as JSON with --json, else in words; with --quiet, nothing."""
    if arguments.json:
        print_json(fields)
    elif not arguments.quiet:
        print_result(text)


def warn(text: str) -> None:
    """Print a warning or an error on one line."""
    print(f"yehu-server: {one_line(text)}", file=sys.stderr)


def warn_of(error: YehuError, hint: str = "") -> None:
    """Print an error, with a hint, and all that is wrong beside it."""
    first, *others = error.lines
    for line in (first + hint, *others):
        warn(line)


def check_files(files: Iterable[Path], read: Callable[[Path], tuple[str, Iterable[str]]]) -> int:
    """Print what is in each file, and remarks, or all that is wrong; return the exit code."""
    code = 0
    for file in files:
        try:
            found, remarks = read(file)
        except YehuError as error:
            code = 2
            warn_of(error)
        else:
            for line in remarks:
                warn(line)
            print_result(f"{file}: valid, {found}")
    return code


def warn_of_lost(output: Path, lost: Mapping[str, int]) -> None:
    """Warn of settings of parameters, by address, that a MIDI file is without."""
    if lost:
        what = ", ".join(f"{address} ({count})" for address, count in sorted(lost.items()))
        warn(f"{output}: written, without {what}: MIDI has no controllers for them")


def interrupt(*_: object) -> NoReturn:
    """Handle a signal that ends a command: by KeyboardInterrupt."""
    # A compiler that is interrupted leaves objects half made, which Python would report.
    sys.unraisablehook = lambda _unraisable: None
    raise KeyboardInterrupt


AT_ONCE_S = 1.0


@contextlib.contextmanager
def ending_at_once() -> Iterator[None]:
    """Let signals end this process soon in a block that compiles and writes no file of the user.

    The compiler may be away from Python for half a minute, and handlers of signals run in Python.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    receiving, sending = socket.socketpair()
    sending.setblocking(False)
    is_over = threading.Event()

    def watch() -> None:
        while number := receiving.recv(1):
            if number[0] in ENDING and not is_over.wait(AT_ONCE_S):
                warn("interrupted, nothing written")
                os._exit(INTERRUPTED)

    before = signal.set_wakeup_fd(sending.fileno(), warn_on_full_buffer=False)
    watching = threading.Thread(target=watch, daemon=True)
    watching.start()
    try:
        yield
    finally:
        is_over.set()
        signal.set_wakeup_fd(before)
        sending.close()
        watching.join()
        receiving.close()


def warn_of_compiling(arguments: argparse.Namespace, more: Compiled | None = None) -> None:
    """Warn where functions will be compiled: once, or always if none is cached.

    `more`: those beside playing's, by the file that their machine code is kept in.
    """
    from yehu_server.compile.cache_folder import WHY_NOT_CACHED, cache_folder
    from yehu_server.core.engine.warming import CALLED, what_compiles

    what = None if arguments.quiet else what_compiles(CALLED, *(more or {}).values())
    if what is not None and WHY_NOT_CACHED:
        warn(f"{what}, each time; {cache_folder()}: {WHY_NOT_CACHED}")
    elif what is not None:
        warn(f"{what}, once ...")


def compile_all(arguments: argparse.Namespace, more: Compiled | None = None) -> None:
    """Compile what playing needs, and more, or load it; show where it compiles, and how far it is.

    `more`: see `warn_of_compiling`.
    """
    from yehu_server.core.engine.warming import warm_up

    warn_of_compiling(arguments, more)
    with progress_bar(arguments, "compiling", "%") as progress, ending_at_once():
        warm_up(progress=lambda done, total: progress(100.0 * done / total, 100.0), more=more)


@contextlib.contextmanager
def progress_bar(arguments: argparse.Namespace, what: str, unit: str = "s") -> Iterator[Any]:
    """Show a progress bar on a terminal; yield a function that takes what is done and the total."""
    if arguments.quiet or not sys.stderr.isatty():
        yield lambda _done, _total: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    form = ".1f" if unit.split(maxsplit=1)[0] == "s" else ".0f"
    columns = (
        TextColumn(what),
        BarColumn(),
        TextColumn(f"{{task.completed:{form}}} of {{task.total:{form}}} {unit}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(what, total=0.0, visible=False)  # until something is to be done
        yield lambda done, total: bar.update(
            task, completed=min(done, total), total=total, visible=True
        )


@contextlib.contextmanager
def calibrating(arguments: argparse.Namespace, rate: float) -> Iterator[Any]:
    """Show how far a calibration is, as `progress_bar`; where one is made, say first for what."""
    with progress_bar(arguments, "calibrating", "notes") as progress:
        is_told = arguments.quiet

        def report(done: float, total: float) -> None:
            nonlocal is_told
            if not is_told:
                warn(f"calibrating it for {rate / 1000.0:g} kHz (some seconds), once ...")
            is_told = True
            progress(done, total)

        yield report


LEVELS = ("debug", "info", "warning", "error")


def set_up_log(arguments: argparse.Namespace) -> None:
    """Set up logging by --log-level and --json-log, and set `quiet` for warnings only or JSON."""
    handler = _Handler()
    handler.addFilter(_RepeatFilter().filter)
    plain = _JournalFormatter() if _is_journal() else _PlainFormatter()
    handler.setFormatter(_JsonFormatter() if arguments.json_log else plain)
    logging.basicConfig(handlers=[handler], level=logging.WARNING, force=True)
    logging.getLogger("yehu_server").setLevel(arguments.log_level.upper())
    arguments.quiet = arguments.json_log or arguments.log_level in ("warning", "error")


class _Handler(logging.Handler):
    """Writes to the present sys.stderr, which a status line may have replaced."""

    def emit(self, record: logging.LogRecord) -> None:
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.write(self.format(record) + "\n")
            sys.stderr.flush()


MAX_REPEATS, REPEATS_WITHIN_S = 30, 60.0


class _RepeatFilter:
    """Lets so many lines a minute through of each place in the code, but for debugging all.

    What clients ask for is logged too, and none of them may fill the log.
    """

    def __init__(self) -> None:
        self._logged: dict[tuple[str, int], tuple[float, int]] = {}  # since when, how many

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether a line is to be logged."""
        if record.levelno < logging.INFO:
            return True
        cause = record.pathname, record.lineno
        since, count = self._logged.get(cause, (record.created, 0))
        if record.created - since >= REPEATS_WITHIN_S:
            since, count = record.created, 0
        self._logged[cause] = since, count + 1
        if count + 1 == MAX_REPEATS:
            record.msg = f"{record.getMessage()} (more of this kind are left out for a minute)"
            record.args = None
        return count < MAX_REPEATS


class _PlainFormatter(logging.Formatter):
    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802 - logging's name
        return f"yehu-server: {one_line(record.message)}"

    def formatException(self, ei: Any) -> str:  # noqa: N802 - logging's name
        return "\n".join(map(one_line, super().formatException(ei).split("\n")))


def _is_journal() -> bool:
    """Whether stderr goes to systemd's journal, as its variable says [systemd.exec(5)]."""
    with contextlib.suppress(OSError, ValueError):
        of_stderr = os.fstat(sys.stderr.fileno())
        return os.environ.get("JOURNAL_STREAM") == f"{of_stderr.st_dev}:{of_stderr.st_ino}"
    return False


class _JournalFormatter(_PlainFormatter):
    """Lines that begin with their level [sd-daemon(3)]; the journal adds name and time."""

    LEVELS: ClassVar = {"DEBUG": 7, "INFO": 6, "WARNING": 4, "ERROR": 3, "CRITICAL": 2}

    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802 - logging's name
        return one_line(record.message)

    def format(self, record: logging.LogRecord) -> str:
        level = self.LEVELS[record.levelname]
        return "\n".join(f"<{level}>{line}" for line in super().format(record).split("\n"))


class _JsonFormatter(logging.Formatter):
    def format(self, record: logging.LogRecord) -> str:
        fields = {
            "time": self.formatTime(record, "%Y-%m-%dT%H:%M:%S%z"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": one_line(record.getMessage()),
        }
        if record.exc_info:
            fields["exception"] = self.formatException(record.exc_info)
        return json.dumps(fields)
