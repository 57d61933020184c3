"""Arguments of serve, and the options of the server made from them."""

import argparse
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import Parser, add_options, chosen
from yehu_server.cli.config import add_config
from yehu_server.cli.converters import number_within, port, positive, target, whole_within, within
from yehu_server.cli.part_options import add_parts, part_options, routes_of
from yehu_server.cli.playing_options import add_controllers, add_playing
from yehu_server.cli.terminal import LEVELS
from yehu_server.errors import ParameterError
from yehu_server.live.network import (
    ANYWHERE,
    HTTP_ADDRESS,
    OSC_ADDRESS,
    Allowed,
    format_address,
    lan_interface,
    parse_address,
)
from yehu_server.live.page.guests import PLAY, ROLES, Guests
from yehu_server.params.preset_file import FIRST_LIVE
from yehu_server.params.table import PREFIX
from yehu_server.util.files import check_distinct

HERE = ("127.0.0.0/8", "::1")
FIRST_NOTE = "first-note"
ANY_INPUT = ""
# Arguments that are something else than the fields of options of their names.
OTHER = ("follow", "http", "osc", "parts")


def add_arguments(parser: Parser) -> None:
    """Add all arguments of serve."""
    add_options(
        parser.add_argument_group("audio"),
        """
        --audio-device NAME: the audio output: words of its name (yehu-server devices lists them),
            or a host API, such as JACK, for its default output; null: no sound (default: JACK's
            where JACK runs, else the system's)
        --rate HZ: sample rate (default: the device's)
        --blocksize FRAMES: frames in a block (buffer); JACK keeps its own period (default: 128)
        --latency low|high|SECONDS: latency to request from the device (default: low)
        --channels N: number of output channels, left and right in turn; 1 is mono (default: 2, or
            what the device has)
        --follow NAME: follow a voice at an audio input, and play what it sings; NAME as for
            --audio-device (default: JACK's input where JACK runs, else the system's)
        --follow-transpose SEMITONES: transpose the voice (default: by octaves, so that the first
            note is in the lower half of the range)
        --follow-correct SHARE: pitch correction, 0 as sung to 1 in tune (default: 0)
        """,
        rate=_rate,
        blocksize={"type": whole_within(1, 8192, "is not within 1 to 8192 frames"), "default": 128},
        latency={"type": _latency, "default": "low"},
        follow={"nargs": "?", "const": ANY_INPUT},
        follow_transpose=number_within(-60.0, 60.0, "semitones"),
        follow_correct=number_within(0.0, 1.0, ""),
        channels={"type": positive, "default": 2},
    )
    add_options(
        parser.add_argument_group("MIDI"),
        """
        --midi-in PATTERN ...: open only inputs with these words in their name; may be repeated
            (default: all but MIDI Through)
        --virtual-midi NAME: also create a virtual MIDI input with this name
        --midi-api: the MIDI system (default: the first available)
        """,
        midi_api={"choices": ("alsa", "jack", "core", "windows", "none")},
    )
    add_options(
        parser.add_argument_group("OSC"),
        f"""
        --osc HOST:PORT: address to listen at, by UDP and TCP (default:
            {format_address(*OSC_ADDRESS)}; this machine only)
        --osc-allow CIDR ...: accept only senders in this network, such as 192.168.1.0/24; may be
            repeated
        """,
        osc={"default": format_address(*OSC_ADDRESS)},
    )
    add_options(
        parser.add_argument_group("OSCQuery"),
        f"""
        --http HOST:PORT: address to listen at for OSCQuery, HTTP and WebSocket (default:
            {format_address(*HTTP_ADDRESS)}; this machine only), or none
        --no-http: no OSCQuery
        --http-allow CIDR ...: answer only clients in this network; may be repeated
        --announce: announce the server by zeroconf (default: if other machines can reach it)
        """,
        http={"default": format_address(*HTTP_ADDRESS)},
        no_http={"dest": "http", "action": "store_const", "const": "none"},
        announce={"action": argparse.BooleanOptionalAction},
    )
    add_options(
        parser.add_argument_group("the page"),
        """
        --panel-port N: port of the page, on the host of --http; 0: any free one (default: the port
            of --http plus 1, or a free one where that is taken; none with --no-http)
        --no-panel: no page
        --open: open the page in the browser
        --lan listen|play|own: open the page to other devices of the local network, by a PIN: they
            may listen, play, or do all that this machine may (own) (default: play)
        """,
        panel_port=port,
        lan={"nargs": "?", "const": PLAY, "choices": ROLES},
    )
    group = parser.add_argument_group("playing")
    add_controllers(group)
    add_playing(group, f"{FIRST_LIVE}; none with --mapping or --mpe")
    add_options(
        group,
        """
        --watch: reload the mapping when its file changes
        --jitter-buffer MS: delay incoming messages by this time, so that they keep their rhythm
            (default: the device's largest block and 1 ms)
        """,
        jitter_buffer={"type": number_within(0.0, 1000.0, "ms"), "dest": "jitter_ms"},
    )
    add_parts(parser.add_argument_group("the stage"))
    group = parser.add_argument_group("running")
    add_options(
        group,
        f"""
        --record OUT: record everything to a new WAV or FLAC file
        --record-from start|first-note: begin --record at once (start, the default) or with the
            first sound
        --capture FILE: write every event to a new file, which yehu-server replay renders
        --overwrite: let --record and --capture replace existing files
        --recordings FOLDER: folder for recordings begun by {PREFIX}/record/start (default:
            "yehu-server" in your music folder)
        --duration SECONDS: end after this time (default: never)
        --log-level: lowest level to log (default: info)
        --verbose: log details; the same as --log-level debug
        --json-log: log as JSON, one object a line
        """,
        record=target,
        record_from={"choices": ("start", FIRST_NOTE), "default": "start"},
        capture=target,
        recordings=Path,
        duration=number_within(0.0, 1e9, "s"),
        log_level={"choices": LEVELS, "default": "info"},
        verbose={"dest": "log_level", "action": "store_const", "const": "debug"},
    )
    add_config(group, parser)


def options_of(arguments: argparse.Namespace) -> Any:
    """The `ServeOptions` of parsed arguments; raises YehuError where a value or file is wrong."""
    from yehu_server.live.audio.output import OutputOptions
    from yehu_server.live.midi.midi_inputs import MidiOptions
    from yehu_server.live.midi.systems import check_api
    from yehu_server.live.options import ServeOptions
    from yehu_server.live.web.server import WebOptions

    parts = part_options(arguments)
    outputs = {"--record": arguments.record, "--capture": arguments.capture}
    config = [] if arguments.config is None else [arguments.config]
    check_distinct(
        {name: path for name, path in outputs.items() if path is not None},
        [*(file for part in parts for file in part.playing.files), *config],
    )
    midi = None
    if arguments.midi_api != "none":
        check_api(arguments.midi_api)
        named = (arguments.midi_in, arguments.virtual_midi, arguments.midi_api)
        midi = MidiOptions(*named, routes=routes_of(arguments, parts))
    return ServeOptions(
        **chosen(ServeOptions, arguments, but=OTHER),
        output=OutputOptions(arguments.audio_device, **chosen(OutputOptions, arguments, but=OTHER)),
        midi=midi,
        follow=_follow_of(arguments),
        osc=parse_address(arguments.osc, *OSC_ADDRESS),
        allowed=Allowed(arguments.osc_allow),
        http=WebOptions(parse_address(arguments.http, *HTTP_ADDRESS), Allowed(arguments.http_allow))
        if arguments.http != "none"
        else None,
        page=_page_of(arguments),
        parts=parts,
        has_room=not arguments.is_dry,
        waits_for_sound=arguments.record_from == FIRST_NOTE,
    )


def _follow_of(arguments: argparse.Namespace) -> Any:
    """The input that is followed; None for none."""
    from yehu_server.live.audio.voice_input import FollowOptions

    if arguments.follow is None:
        for option in ("transpose", "correct"):
            if getattr(arguments, f"follow_{option}") is not None:
                raise ParameterError(f"--follow-{option}: nothing is followed; add --follow")
        return None
    transpose, correct = arguments.follow_transpose, arguments.follow_correct or 0.0
    return FollowOptions(arguments.follow or None, transpose, correct)


def _page_of(arguments: argparse.Namespace) -> Any:
    """Where the page is served; None where it is not."""
    from yehu_server.live.page.pages import PageOptions

    requested = arguments.panel_port
    has_page = arguments.lan or arguments.open or requested is not None or arguments.http != "none"
    if arguments.no_panel or not has_page:
        if arguments.lan or arguments.open:
            raise ParameterError("--open and --lan need the page: leave out --no-panel")
        return None
    http = "" if arguments.http == "none" else arguments.http
    host, beside = parse_address(http, *HTTP_ADDRESS)
    number = requested if requested is not None else (beside + 1) % (1 << 16) if beside else 0
    networks = list(arguments.http_allow)
    guests = None
    if arguments.lan:
        host, networks = ANYWHERE, [*(networks or [str(lan_interface().network)]), *HERE]
        guests = Guests(arguments.lan)
    return PageOptions((host, number), networks, requested is not None, guests)


# ---------------------------------------------------------------- converters


def _rate(text: str) -> float:
    from yehu_server.core.physics.grid import MAX_RATE, MIN_RATE

    return within(text, MIN_RATE, MAX_RATE, "Hz")


def _latency(text: str) -> str | float:
    return text if text in ("low", "high") else within(text, 0.0, 5.0, "s, low or high")
