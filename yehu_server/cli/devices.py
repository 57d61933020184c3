"""``yehu-server devices``."""

from __future__ import annotations

import argparse
import json
from typing import Any

from yehu_server.cli.arguments import add_command

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
    parser.add_argument("--json", action="store_true", help="print one JSON object")


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
        from yehu_server.cli.report import devices_report

        devices_report(audio, audio_problem, api, midi, midi_problem)
    return 0
