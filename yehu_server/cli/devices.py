"""``yehu-server devices``."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import add_command, add_options
from yehu_server.errors import one_line

if TYPE_CHECKING:
    from yehu_server.live.audio.devices import AudioDevice

EXAMPLES = """\
examples:
  yehu-server devices
  yehu-server serve --audio-device "system, JACK" --midi-in keystep

A device may be named by any words that no other device has.
"""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(
        commands,
        "devices",
        run=run,
        help="list audio outputs and MIDI inputs",
        description="List the audio outputs and MIDI inputs that serve can use.",
        epilog=EXAMPLES,
    )
    add_options(parser, "--json: print one JSON object")


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.errors import DeviceError
    from yehu_server.live.audio.devices import load_portaudio, outputs, quiet
    from yehu_server.live.midi.input_process import list_inputs

    audio, audio_problem = [], ""
    with quiet():
        try:
            audio = outputs(load_portaudio())
        except DeviceError as error:
            audio_problem = str(error)
        api, midi, midi_problem = list_inputs()
    if arguments.json:
        fields = ("full_name", "name", "host_api", "channels", "rate", "latency_ms", "is_default")
        rows = [{field: getattr(device, field) for field in fields} for device in audio]
        found = {"audio": rows, "audio_problem": audio_problem}
        print(json.dumps({**found, "midi": midi, "midi_api": api, "midi_problem": midi_problem}))
    else:
        devices_report(audio, audio_problem, api, midi, midi_problem)
    return 0


def devices_report(
    audio: Sequence[AudioDevice],
    audio_problem: str,
    midi_api: str,
    midi: Sequence[str],
    midi_problem: str,
) -> None:
    """Print tables of audio outputs and MIDI inputs."""
    from rich.console import Console
    from rich.table import Table

    from yehu_server.live.audio.devices import ADVICE

    console = Console(markup=False, emoji=False)
    table = Table(title="audio outputs", title_justify="left")
    for column in ("name", "host API", "channels", "rate", "latency", ""):
        table.add_column(column, overflow="fold")
    for device in audio:
        numbers = (str(device.channels), f"{device.rate:g} Hz", f"{device.latency_ms:.1f} ms")
        mark = "default" if device.is_default else ""
        table.add_row(one_line(device.name), one_line(device.host_api), *numbers, mark)
    nothing = f"no audio outputs{_because(audio_problem)}; {ADVICE}"
    console.print(table if audio else one_line(nothing))
    table = Table(title=f"MIDI inputs ({midi_api})", title_justify="left")
    table.add_column("name", overflow="fold")
    for name in midi:
        table.add_row(one_line(name))
    console.print(table if midi else one_line(f"no MIDI inputs{_because(midi_problem)}"))


def _because(problem: str) -> str:
    return f": {problem}" if problem else ""
