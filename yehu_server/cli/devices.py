"""List the audio outputs, audio inputs and MIDI inputs that serve can use.

  yehu-server devices
  yehu-server serve --audio-device JACK --midi-in keystep

serve plays on the first output, and follows the first input. To choose another, give words of its
name, or a host API alone, such as JACK, for the first of its devices.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import add_command, add_options
from yehu_server.cli.terminal import print_json
from yehu_server.errors import DeviceError, one_line

if TYPE_CHECKING:
    from yehu_server.live.audio.devices import AudioDevice


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "devices", __doc__, run)
    add_options(parser, "--json: print one JSON object")


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.live.audio.devices import INPUT, OUTPUT, devices, load_portaudio, quiet
    from yehu_server.live.midi.input_process import list_inputs

    outputs, inputs, problem = [], [], ""
    with quiet():
        try:
            sounddevice = load_portaudio()
            outputs, inputs = devices(sounddevice, OUTPUT), devices(sounddevice, INPUT)
        except DeviceError as error:
            problem = str(error)
        api, midi, midi_problem = list_inputs()
    if arguments.json:
        found = {"audio": _rows(outputs), "audio_inputs": _rows(inputs), "audio_problem": problem}
        print_json({**found, "midi": midi, "midi_api": api, "midi_problem": midi_problem})
    else:
        devices_report(outputs, inputs, problem, api, midi, midi_problem)
    return 0


def _rows(devices: Sequence[AudioDevice]) -> list[dict[str, Any]]:
    fields = ("full_name", "name", "host_api", "channels", "rate", "latency_ms")
    return [
        {field: getattr(device, field) for field in fields} | {"is_default": device is devices[0]}
        for device in devices
    ]


def devices_report(
    outputs: Sequence[AudioDevice],
    inputs: Sequence[AudioDevice],
    problem: str,
    midi_api: str,
    midi: Sequence[str],
    midi_problem: str,
) -> None:
    """Print tables of audio outputs and inputs, and of MIDI inputs."""
    from rich.console import Console
    from rich.table import Table

    from yehu_server.live.audio.devices import ADVICE

    console = Console(markup=False, emoji=False)
    nothing = f"no audio outputs{_because(problem)}; {ADVICE}"
    console.print(
        _audio_table("audio outputs", outputs) if outputs else one_line(nothing),
        soft_wrap=not outputs,
    )
    nothing = f"no audio inputs{_because(problem)}"
    console.print(
        _audio_table("audio inputs", inputs) if inputs else one_line(nothing), soft_wrap=not inputs
    )
    table = Table(title=f"MIDI inputs ({midi_api})", title_justify="left")
    table.add_column("name", overflow="fold")
    for name in midi:
        table.add_row(one_line(name))
    console.print(
        table if midi else one_line(f"no MIDI inputs{_because(midi_problem)}"), soft_wrap=not midi
    )


def _audio_table(title: str, devices: Sequence[AudioDevice]) -> Any:
    from rich.table import Table

    table = Table(title=title, title_justify="left")
    for column in ("name", "host API", "channels", "rate", "latency", ""):
        table.add_column(column, overflow="fold")
    for device in devices:
        numbers = (str(device.channels), f"{device.rate:g} Hz", f"{device.latency_ms:.1f} ms")
        mark = "default" if device is devices[0] else ""
        table.add_row(one_line(device.name), one_line(device.host_api), *numbers, mark)
    return table


def _because(problem: str) -> str:
    return f": {problem}" if problem else ""
