"""``yehu-server serve``."""

from __future__ import annotations

import argparse
import contextlib
import json
import logging
import signal
import sys
import threading
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import (
    add_command,
    add_playing,
    compiling,
    mapping_of,
    positive,
    progress_bar,
    style_of,
    target,
    whole,
    within,
)
from yehu_server.control.addresses import HTTP_ADDRESS, OSC_ADDRESS, shown
from yehu_server.limits import allow_files
from yehu_server.lines import one_line
from yehu_server.params.table import PREFIX

EXAMPLES = """\
examples:
  yehu-server serve
  yehu-server serve --midi-in keystep --audio-device "hifi, ALSA" --latency 0.01
  yehu-server serve --osc 192.168.1.5:9000 --osc-allow 192.168.1.0/24
  yehu-server serve --http 192.168.1.5:9001 --http-allow 192.168.1.0/24
  yehu-server serve --record take.wav --capture take.jsonl

The OSC messages are described in docs/osc.md,
OSCQuery in docs/oscquery.md. Ctrl-C ends it.
"""

FILES_NEEDED = 40  # open ones: 30 by itself, and some clients
LEVELS = ("debug", "info", "warning", "error")
REFRESHES_PER_SECOND = 10
INTERRUPTED = 130  # exit code


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(
        commands,
        "serve",
        run=run,
        help="play live, by MIDI and OSC",
        description="Play the instrument live, by MIDI and OSC.",
        epilog=EXAMPLES,
    )
    _add_audio(parser.add_argument_group("audio"))
    _add_midi(parser.add_argument_group("MIDI"))
    _add_osc(parser.add_argument_group("OSC"))
    _add_web(parser.add_argument_group("OSCQuery"))
    _add_playing(parser.add_argument_group("playing"))
    _add_running(parser.add_argument_group("running"))


def _add_audio(group: Any) -> None:
    group.add_argument(
        "--audio-device",
        metavar="NAME",
        help="words of the output's name and host API (see yehu-server devices), or null for a "
        "silent clock (default: the system's output)",
    )
    group.add_argument(
        "--rate", type=_rate, metavar="HZ", help="sample rate (default: the device's)"
    )
    group.add_argument(
        "--blocksize",
        type=_blocksize,
        default=128,
        metavar="FRAMES",
        help="how much to compute at a time; JACK keeps its own period (default: 128)",
    )
    group.add_argument(
        "--latency",
        type=_latency,
        default="low",
        metavar="low|high|SECONDS",
        help="how much the device may buffer (default: low)",
    )
    group.add_argument(
        "--channels",
        type=positive,
        default=2,
        metavar="N",
        help="all get the same signal (default: 2, or what the device has)",
    )


def _add_midi(group: Any) -> None:
    group.add_argument(
        "--midi-in",
        action="append",
        default=[],
        metavar="PATTERN",
        help="open inputs with these words in their name; may be repeated (default: all but "
        "through ports)",
    )
    group.add_argument("--virtual-midi", metavar="NAME", help="also be a MIDI input of this name")
    group.add_argument(
        "--midi-api",
        choices=("alsa", "jack", "core", "windows", "none"),
        help="the MIDI system (default: the first there is)",
    )


def _add_osc(group: Any) -> None:
    group.add_argument(
        "--osc",
        default=shown(*OSC_ADDRESS),
        metavar="HOST:PORT",
        help=f"where to listen, UDP and TCP (default: {shown(*OSC_ADDRESS)}; this machine only)",
    )
    group.add_argument(
        "--osc-allow",
        action="append",
        default=[],
        metavar="CIDR",
        help="hear only senders of this network, such as 192.168.1.0/24; may be repeated",
    )


def _add_web(group: Any) -> None:
    group.add_argument(
        "--http",
        default=shown(*HTTP_ADDRESS),
        metavar="HOST:PORT",
        help="where to listen for OSCQuery, HTTP and WebSocket "
        f"(default: {shown(*HTTP_ADDRESS)}; this machine only), or none",
    )
    group.add_argument(
        "--no-http", dest="http", action="store_const", const="none", help="no OSCQuery"
    )
    group.add_argument(
        "--http-allow",
        action="append",
        default=[],
        metavar="CIDR",
        help="answer only this network; may be repeated",
    )
    group.add_argument(
        "--announce",
        action=argparse.BooleanOptionalAction,
        help="let others find the server by zeroconf (default: where it listens beyond this "
        "machine)",
    )


def _add_playing(group: Any) -> None:
    add_playing(group)
    group.add_argument(
        "--watch",
        action="store_true",
        help="take up the mapping anew when its file changes",
    )
    group.add_argument(
        "--jitter-buffer",
        type=_jitter,
        metavar="MS",
        help="delay of what comes in, so that it keeps its rhythm (default: as much as the device "
        "asks for at once, and 1 ms)",
    )


def _add_running(group: Any) -> None:
    group.add_argument(
        "--record", type=target, metavar="OUT", help="record everything to a new WAV or FLAC file"
    )
    group.add_argument(
        "--capture",
        type=target,
        metavar="FILE",
        help="write every event to a new file, for yehu-server replay",
    )
    group.add_argument(
        "--overwrite",
        action="store_true",
        help="let --record and --capture take the place of files that are there",
    )
    group.add_argument(
        "--recordings",
        type=Path,
        metavar="FOLDER",
        help=f"where {PREFIX}/record/start writes (default: yehu-server in your music folder)",
    )
    group.add_argument("--duration", type=_duration, metavar="SECONDS", help="end by itself")
    group.add_argument(
        "--config",
        type=Path,
        metavar="FILE",
        help="a TOML file of any of these options, such as rate = 48000; the command line wins",
    )
    group.add_argument("--log-level", choices=LEVELS, default="info", help="default: info")
    group.add_argument(
        "--verbose",
        dest="log_level",
        action="store_const",
        const="debug",
        help="also tell what is no news to a player; the same as --log-level debug",
    )
    group.add_argument("--json-log", action="store_true", help="log lines of JSON")


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    allow_files(FILES_NEEDED)
    ending = _Ending()
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), ending)
    _set_up_log(arguments)
    try:
        with compiling(arguments):
            return _serve(arguments, ending)
    except KeyboardInterrupt:
        if ending.server is None:
            raise
        return INTERRUPTED


class _Ending:
    """What Ctrl-C and other signals ask for.

    The first ends the playing, the second does not wait for what fades, and the third leaves
    at once. None of them harms a take.
    """

    def __init__(self) -> None:
        self.asked = threading.Event()
        self.server: Any = None  # once it plays
        self._times = 0

    def __call__(self, number: int, _frame: Any) -> None:
        """Handle a signal."""
        self._times += number == signal.SIGINT
        self.asked.set()
        if self._times < 2:
            return
        if self.server is not None:
            self.server.hurry()
        if self.server is None or (self._times > 2 and self.server.is_interruptible):
            raise KeyboardInterrupt


def _serve(arguments: argparse.Namespace, ending: _Ending) -> int:
    """Serve until it is enough; return the exit code."""
    from yehu_server.control.addresses import lan_address
    from yehu_server.playing.mapping import is_own
    from yehu_server.report import connect_lines, query_line
    from yehu_server.server import Server

    log = logging.getLogger("yehu_server")
    say = log.info
    options = _options(arguments)
    with progress_bar(arguments, "calibrating", "notes") as progress:
        server = Server(options, say, progress)
    if server.output.state.problem and arguments.audio_device != "null":
        say(f"{server.output.state.problem}: playing on a silent clock")
    mapping = options.style.mapping
    if is_own(mapping):
        say(f"mapping {mapping.name}, as you have it: {mapping.files[0]}")
    server.start()
    ending.server = server
    try:
        where = (server.osc.host, server.osc.port, lan_address())
        for line in connect_lines(*where, is_open=not arguments.osc_allow):
            say(line)
        if server.web is not None:
            say(query_line(server.web.host, server.web.port, lan_address()))
        buffer_kb = server.osc.traffic.buffer_bytes // 1000
        log.debug("the system keeps up to %d kB of OSC that waits to be read", buffer_kb)
        log.info("Ctrl-C ends")
        with _status_line(server):
            _wait(ending.asked, arguments.duration)
    finally:
        server.stop()
    return 0 if server.kept_all else 2


def _wait(ended: threading.Event, duration_s: float | None) -> None:
    deadline = None if duration_s is None else time.monotonic() + duration_s
    while deadline is None or time.monotonic() < deadline:
        left = 0.5 if deadline is None else min(0.5, max(0.0, deadline - time.monotonic()))
        if ended.wait(left):
            return


def _options(arguments: argparse.Namespace) -> Any:
    from yehu_server.audio.output import OutputOptions
    from yehu_server.control.addresses import Allowed, parse_address
    from yehu_server.control.midi_process import check_api
    from yehu_server.control.ports import MidiOptions
    from yehu_server.control.web import WebOptions
    from yehu_server.files import check_apart
    from yehu_server.server import ServeOptions

    style = style_of(arguments, is_live=True)
    outputs = {"--record": arguments.record, "--capture": arguments.capture}
    config = [] if arguments.config is None else [arguments.config]
    check_apart(
        {name: path for name, path in outputs.items() if path is not None},
        [*style.files, *config],
    )
    midi = arguments.midi_api != "none"
    if midi:
        check_api(arguments.midi_api)
    options = ServeOptions(
        output=OutputOptions(
            device=arguments.audio_device,
            rate=arguments.rate,
            blocksize=arguments.blocksize,
            latency=arguments.latency,
            channels=arguments.channels,
        ),
        midi=MidiOptions(arguments.midi_in, arguments.virtual_midi, arguments.midi_api)
        if midi
        else None,
        osc=parse_address(arguments.osc, *OSC_ADDRESS),
        allowed=Allowed(arguments.osc_allow),
        http=WebOptions(parse_address(arguments.http, *HTTP_ADDRESS), Allowed(arguments.http_allow))
        if arguments.http != "none"
        else None,
        announce=arguments.announce,
        style=style,
        reread=partial(mapping_of, arguments, is_live=True) if arguments.watch else None,
        jitter_ms=arguments.jitter_buffer,
        record=arguments.record,
        capture=arguments.capture,
        overwrite=arguments.overwrite,
    )
    if arguments.recordings is not None:
        options.recordings = arguments.recordings
    return options


# ---------------------------------------------------------------- on the terminal


class _Handler(logging.Handler):
    """Writes lines to stderr as it is now: a status line may have taken its place."""

    def emit(self, record: logging.LogRecord) -> None:
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.write(self.format(record) + "\n")
            sys.stderr.flush()


class _PlainFormatter(logging.Formatter):
    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802 - logging's name
        return f"yehu-server: {one_line(record.message)}"

    def formatException(self, ei: Any) -> str:  # noqa: N802 - logging's name
        return "\n".join(map(one_line, super().formatException(ei).split("\n")))


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


def _set_up_log(arguments: argparse.Namespace) -> None:
    handler = _Handler()
    handler.setFormatter(_JsonFormatter() if arguments.json_log else _PlainFormatter())
    logging.basicConfig(handlers=[handler], level=logging.WARNING, force=True)
    logging.getLogger("yehu_server").setLevel(arguments.log_level.upper())
    arguments.quiet = arguments.json_log or arguments.log_level in ("warning", "error")


@contextlib.contextmanager
def _status_line(server: Any) -> Iterator[None]:
    """A line that shows how playing goes, on a terminal."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.live import Live
    from rich.text import Text

    from yehu_server.report import status_line

    with Live(
        get_renderable=lambda: Text(
            status_line(server.status()), no_wrap=True, overflow="ellipsis"
        ),
        refresh_per_second=REFRESHES_PER_SECOND,
        console=Console(stderr=True),
        transient=True,
    ):
        yield


# ---------------------------------------------------------------- reading arguments


def _rate(text: str) -> float:
    from yehu_server.physics.grid import HIGHEST_RATE, LOWEST_RATE

    return within(text, LOWEST_RATE, HIGHEST_RATE, "Hz")


def _blocksize(text: str) -> int:
    frames = whole(text)
    if not 1 <= frames <= 8192:
        raise argparse.ArgumentTypeError(f"{frames} is not within 1 to 8192 frames")
    return frames


def _latency(text: str) -> str | float:
    return text if text in ("low", "high") else within(text, 0.0, 5.0, "s, low or high")


def _jitter(text: str) -> float:
    return within(text, 0.0, 1000.0, "ms")


def _duration(text: str) -> float:
    return within(text, 0.0, 1e9, "s")
