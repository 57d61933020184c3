"""Play the instrument live, by MIDI and OSC.

  yehu-server serve
  yehu-server serve --midi-in keystep --audio-device "hifi, ALSA" --latency 0.01
  yehu-server serve --lan --open
  yehu-server serve --osc 192.168.1.5:9000 --osc-allow 192.168.1.0/24
  yehu-server serve --http 192.168.1.5:9001 --http-allow 192.168.1.0/24
  yehu-server serve --record take.wav --capture take.jsonl
  yehu-server serve --parts 2 --part 1=keystep --part 2=seaboard --part-mapping 2=mpe

The OSC messages are described in docs/osc.md,
OSCQuery in docs/oscquery.md. Ctrl-C ends it.
"""

from __future__ import annotations

import argparse
import contextlib
import logging
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import add_command
from yehu_server.cli.serve_options import add_arguments, options_of
from yehu_server.cli.terminal import (
    compile_all,
    ending_at_once,
    interrupt,
    progress_bar,
    set_up_log,
)
from yehu_server.errors import YehuError
from yehu_server.live.network import lan_address, lan_interface
from yehu_server.system import processes
from yehu_server.system.processes import on_termination, wait_for

if TYPE_CHECKING:
    from yehu_server.live.page.pages import PageOptions

MAX_FILES = 4096  # more than all clients together need


def allow_files(needed: int) -> None:
    """Raise the limit of open files as far as allowed; raises YehuError where it is too low."""
    allowed = processes.allow_files(MAX_FILES)
    if allowed is not None and allowed < needed:
        raise YehuError(
            f"{allowed} open files are too few: {needed} are needed (raise the limit: ulimit -n)"
        )


FILES_NEEDED = 44  # open files: 34 of the server, and some for clients
REFRESHES_PER_SECOND = 10


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "serve", __doc__, run)
    add_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    allow_files(FILES_NEEDED)
    ending = _Ending()
    signal.signal(signal.SIGINT, ending)
    on_termination(ending)
    set_up_log(arguments)
    return _serve(arguments, ending)


class _Ending:
    """Handles Ctrl-C and other signals that end the server.

    Before there is a server, as while it compiles, any exits at once. Then the first Ctrl-C ends
    playing, the second also ends the fade-out, and the third exits at once. Recordings and captures
    are complete in any case.
    """

    def __init__(self) -> None:
        self.requested = threading.Event()
        self.server: Any = None  # set once it is made
        self._times = 0

    def __call__(self, number: int, _frame: Any) -> None:
        """Handle a signal."""
        if self.server is None:
            interrupt()
        self._times += number == signal.SIGINT
        self.requested.set()
        if self._times < 2:
            return
        self.server.skip_fade_out()
        if self._times > 2 and self.server.is_interruptible:
            raise KeyboardInterrupt("the sound cut off")


def _serve(arguments: argparse.Namespace, ending: _Ending) -> int:
    """Serve until a signal or the end of --duration; return the exit code."""
    from yehu_server.cli.report import connect_lines, query_line
    from yehu_server.live.audio.devices import ADVICE, NO_OUTPUT
    from yehu_server.live.server import Server
    from yehu_server.playing.mapping import is_own

    log = logging.getLogger("yehu_server")
    report = log.info
    options = options_of(arguments)
    compile_all(arguments)
    with progress_bar(arguments, "calibrating", "notes") as progress, ending_at_once():
        server = ending.server = Server(options, report, progress)
    if server.output.state.problem and arguments.audio_device != "null":
        report(f"{server.output.state.problem}: playing on a silent clock")
        if server.output.state.problem == NO_OUTPUT:
            report("listen in the page, which opens" if arguments.open else ADVICE)
    mappings = [part.playing.mapping for part in options.parts]
    for mapping in {each.name: each for each in mappings}.values():
        if is_own(mapping):
            report(f"mapping {mapping.name}, your own: {mapping.files[0]}")
    server.start()
    try:
        lan = lan_interface()
        where = (server.osc.host, server.osc.port, lan)
        for line in connect_lines(*where, is_open=not arguments.osc_allow):
            report(line)
        if server.web is not None:
            report(query_line(server.web.host, server.web.port, str(lan.ip)))
        if server.pages is not None and options.page is not None:
            _report_page(server.pages, options.page, report, arguments)
        buffer_kb = server.osc.traffic.buffer_bytes // 1000
        log.debug("the receive buffer for OSC has %d kB", buffer_kb)
        log.info("Ctrl-C ends")
        with _status_line(server):
            wait_for(ending.requested, arguments.duration)
    finally:
        server.stop()
    return 0 if server.is_whole else 2


def _report_page(
    pages: Any, options: PageOptions, report: Callable[[str], None], arguments: argparse.Namespace
) -> None:
    from yehu_server.cli.page import open_in_browser, show
    from yehu_server.cli.report import page_for_phones, page_lines

    where = (pages.host, pages.port, lan_address())
    lines = page_lines(*where, networks=options.networks, guests=options.guests)
    for line in lines:
        report(line)
    phones = page_for_phones(*where, options.guests)
    if phones and not arguments.quiet:
        show(phones, sys.stderr)  # where the lines of the log are
    if arguments.open:
        open_in_browser(lines[0].rpartition(" ")[2])


@contextlib.contextmanager
def _status_line(server: Any) -> Iterator[None]:
    """Show the status of the server in one line, on a terminal."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.live import Live
    from rich.text import Text

    from yehu_server.cli.report import status_line

    with Live(
        get_renderable=lambda: Text(
            status_line(server.status()), no_wrap=True, overflow="ellipsis"
        ),
        refresh_per_second=REFRESHES_PER_SECOND,
        console=Console(stderr=True),
        transient=True,
    ):
        yield
