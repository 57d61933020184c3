"""Arguments of serve, and the options of the server made from them."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import Parser
from yehu_server.cli.config import add_config
from yehu_server.cli.converters import port, positive, target, whole, within
from yehu_server.cli.part_options import add_parts, part_options, routes_of
from yehu_server.cli.style_options import add_playing
from yehu_server.cli.terminal import LEVELS
from yehu_server.live.addresses import (
    ANYWHERE,
    HTTP_ADDRESS,
    OSC_ADDRESS,
    format_address,
    lan_interface,
    parse_address,
)
from yehu_server.params.table import PREFIX

HERE = ("127.0.0.0/8", "::1")


def add_arguments(parser: Parser) -> None:
    """Add all arguments of serve."""
    _add_audio(parser.add_argument_group("audio"))
    _add_midi(parser.add_argument_group("MIDI"))
    _add_osc(parser.add_argument_group("OSC"))
    _add_web(parser.add_argument_group("OSCQuery"))
    _add_page(parser.add_argument_group("the page"))
    _add_playing(parser.add_argument_group("playing"))
    add_parts(parser.add_argument_group("the stage"))
    running = parser.add_argument_group("running")
    _add_running(running)
    add_config(running, parser)


def _add_audio(group: Any) -> None:
    group.add_argument(
        "--audio-device",
        metavar="NAME",
        help="words of the output's name and host API (see yehu-server devices), or null for "
        "silence (default: the system's output)",
    )
    group.add_argument(
        "--rate", type=_rate, metavar="HZ", help="sample rate (default: the device's)"
    )
    group.add_argument(
        "--blocksize",
        type=_blocksize,
        default=128,
        metavar="FRAMES",
        help="number of frames computed at a time; JACK keeps its own period (default: 128)",
    )
    group.add_argument(
        "--latency",
        type=_latency,
        default="low",
        metavar="low|high|SECONDS",
        help="latency requested from the device (default: low)",
    )
    group.add_argument(
        "--channels",
        type=positive,
        default=2,
        metavar="N",
        help="number of channels, left and right in turn; 1 has the mean of both (default: 2, or "
        "as the device has)",
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
    group.add_argument(
        "--virtual-midi", metavar="NAME", help="also create a virtual MIDI input of this name"
    )
    group.add_argument(
        "--midi-api",
        choices=("alsa", "jack", "core", "windows", "none"),
        help="the MIDI system (default: the first available)",
    )


def _add_osc(group: Any) -> None:
    group.add_argument(
        "--osc",
        default=format_address(*OSC_ADDRESS),
        metavar="HOST:PORT",
        help="address to listen at, UDP and TCP "
        f"(default: {format_address(*OSC_ADDRESS)}; this machine only)",
    )
    group.add_argument(
        "--osc-allow",
        action="append",
        default=[],
        metavar="CIDR",
        help="accept only senders of this network, such as 192.168.1.0/24; may be repeated",
    )


def _add_web(group: Any) -> None:
    group.add_argument(
        "--http",
        default=format_address(*HTTP_ADDRESS),
        metavar="HOST:PORT",
        help="address to listen at for OSCQuery, HTTP and WebSocket "
        f"(default: {format_address(*HTTP_ADDRESS)}; this machine only), or none",
    )
    group.add_argument(
        "--no-http", dest="http", action="store_const", const="none", help="no OSCQuery"
    )
    group.add_argument(
        "--http-allow",
        action="append",
        default=[],
        metavar="CIDR",
        help="answer only clients of this network; may be repeated",
    )
    group.add_argument(
        "--announce",
        action=argparse.BooleanOptionalAction,
        help="announce the server by zeroconf (default: if it listens beyond this machine)",
    )


def _add_page(group: Any) -> None:
    group.add_argument(
        "--panel-port",
        type=port,
        metavar="N",
        help="port of the page, on the host of --http; 0: a free one (default: the port of --http "
        "and 1, or a free one where that is taken; none with --no-http)",
    )
    group.add_argument("--no-panel", action="store_true", help="no page")
    group.add_argument("--open", action="store_true", help="open the page in the browser")
    group.add_argument(
        "--lan",
        action="store_true",
        help="offer the page to the local network, whose phones and computers may then play",
    )


def _add_playing(group: Any) -> None:
    add_playing(group)
    group.add_argument(
        "--watch",
        action="store_true",
        help="reload the mapping when its file changes",
    )
    group.add_argument(
        "--jitter-buffer",
        type=_jitter,
        metavar="MS",
        help="delay of incoming messages, so that they keep their rhythm (default: what the device "
        "requests at once, and 1 ms)",
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
        help="let --record and --capture replace existing files",
    )
    group.add_argument(
        "--recordings",
        type=Path,
        metavar="FOLDER",
        help=f"folder that {PREFIX}/record/start writes to "
        "(default: yehu-server in your music folder)",
    )
    group.add_argument(
        "--duration", type=_duration, metavar="SECONDS", help="end after this time (default: never)"
    )
    group.add_argument(
        "--log-level", choices=LEVELS, default="info", help="lowest level to log (default: info)"
    )
    group.add_argument(
        "--verbose",
        dest="log_level",
        action="store_const",
        const="debug",
        help="log details; the same as --log-level debug",
    )
    group.add_argument("--json-log", action="store_true", help="log one JSON object a line")


def options_of(arguments: argparse.Namespace) -> Any:
    """The `ServeOptions` of parsed arguments.

    Raises
    ------
    YehuError
        Where a value or file is wrong.
    """
    from yehu_server.live.addresses import Allowed
    from yehu_server.live.audio.output import OutputOptions
    from yehu_server.live.midi.input_process import check_api
    from yehu_server.live.midi.ports import MidiOptions
    from yehu_server.live.options import ServeOptions
    from yehu_server.live.web.server import WebOptions
    from yehu_server.util.files import check_distinct

    parts = part_options(arguments)
    outputs = {"--record": arguments.record, "--capture": arguments.capture}
    config = [] if arguments.config is None else [arguments.config]
    check_distinct(
        {name: path for name, path in outputs.items() if path is not None},
        [*(file for part in parts for file in part.style.files), *config],
    )
    midi = None
    if arguments.midi_api != "none":
        check_api(arguments.midi_api)
        named = (arguments.midi_in, arguments.virtual_midi, arguments.midi_api)
        midi = MidiOptions(*named, routes=routes_of(arguments, parts))
    options = ServeOptions(
        output=OutputOptions(
            device=arguments.audio_device,
            rate=arguments.rate,
            blocksize=arguments.blocksize,
            latency=arguments.latency,
            channels=arguments.channels,
        ),
        midi=midi,
        osc=parse_address(arguments.osc, *OSC_ADDRESS),
        allowed=Allowed(arguments.osc_allow),
        http=WebOptions(parse_address(arguments.http, *HTTP_ADDRESS), Allowed(arguments.http_allow))
        if arguments.http != "none"
        else None,
        page=_page_of(arguments),
        announce=arguments.announce,
        parts=parts,
        has_room=not arguments.dry,
        jitter_ms=arguments.jitter_buffer,
        record=arguments.record,
        capture=arguments.capture,
        overwrite=arguments.overwrite,
    )
    if arguments.recordings is not None:
        options.recordings = arguments.recordings
    return options


def _page_of(arguments: argparse.Namespace) -> Any:
    """Where the page is served; None where it is not."""
    from yehu_server.errors import ParameterError
    from yehu_server.live.page.pages import PageOptions

    wished = arguments.panel_port
    has_page = arguments.lan or arguments.open or wished is not None or arguments.http != "none"
    if arguments.no_panel or not has_page:
        if arguments.lan or arguments.open:
            raise ParameterError("--no-panel: there is no page to open")
        return None
    given = (
        HTTP_ADDRESS if arguments.http == "none" else parse_address(arguments.http, *HTTP_ADDRESS)
    )
    host, beside = given
    number = wished if wished is not None else (beside + 1) % (1 << 16) if beside else 0
    networks = list(arguments.http_allow)
    if arguments.lan:
        host, networks = ANYWHERE, [*networks, str(lan_interface().network), *HERE]
    return PageOptions((host, number), networks, wished is not None)


# ---------------------------------------------------------------- converters


def _rate(text: str) -> float:
    from yehu_server.core.physics.grid import HIGHEST_RATE, LOWEST_RATE

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
