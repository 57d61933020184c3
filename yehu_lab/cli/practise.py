"""Find how each note of an instrument is best bowed, and write a bowing table for --practice.

Each note is played after others, at several places, speeds and pressures of the bow. Other commands
find NAME.practice.json by themselves beside an instrument file NAME.toml.

  yehu-server practise -o mine.json
  yehu-server practise --instrument heavy_bridge.toml -o heavy_bridge.practice.json
  yehu-server practise --preset sul-ponticello -o near.json
  yehu-server practise --tuning chaozhou-seven-equal --keyboard-map chaozhou-keys -o chaozhou.json
  yehu-server render tune.mid -o tune.wav --practice mine.json

It takes a quarter of an hour or more on two cores. It begins with the table beside the instrument
file, or with the shipped one. The yehu itself is practised already.
"""

import argparse
from typing import Any

from yehu_server.cli.arguments import (
    add_command,
    add_instrument,
    add_options,
    add_reporting,
    check_new,
    instrument_of,
)
from yehu_server.cli.converters import target
from yehu_server.cli.playing_options import add_tuning, tuning_of
from yehu_server.cli.terminal import compile_all, print_report, progress_bar
from yehu_server.util.files import check_distinct


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "practise", __doc__, run)
    add_options(
        parser,
        """
        -o --output OUT.json: the file to write
        --overwrite: replace OUT.json if it exists
        --rate HZ: sample rate (default: 44100)
        """,
        output={"required": True, "type": target},
        rate={"type": float, "default": 44100.0},
    )
    add_instrument(parser)
    add_options(parser, "--preset NAME: practise for the bow of a preset alone, in less time")
    add_tuning(parser)
    add_reporting(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_lab.practising.bowing_search import BowingSearch
    from yehu_lab.practising.candidates import DEFAULT
    from yehu_lab.practising.practice_file import write_bowing_table
    from yehu_server.core.physics.grid import check_rate
    from yehu_server.core.player.bowing import BOW_POSITIONS
    from yehu_server.playing.bowing_tables import (
        bowing_table_beside,
        read_bowing_table,
        shipped_bowing_table,
    )
    from yehu_server.playing.calibration_store import calibration_for
    from yehu_server.playing.preset_folders import Presets
    from yehu_server.playing.tuning import STANDARD_A4

    check_rate(arguments.rate)
    tuning = tuning_of(arguments)
    own = [*tuning.files, *([] if arguments.instrument is None else [arguments.instrument])]
    check_distinct({"-o": arguments.output}, own)
    check_new(arguments)
    values = {} if arguments.preset is None else Presets().load(arguments.preset).values
    quantities = instrument_of(arguments)
    beside = bowing_table_beside(arguments.instrument)
    known = shipped_bowing_table(arguments.rate) if beside is None else read_bowing_table(beside)
    compile_all(arguments)
    table, improved = known, 0
    others = set(range(len(BOW_POSITIONS))) - {DEFAULT}
    for places in ({DEFAULT}, others):  # the instrument is calibrated at the usual place
        with progress_bar(arguments, "calibrating", "notes") as progress:
            calibration = calibration_for(
                arguments.rate, quantities, bowing=table, progress=progress
            )
        search = BowingSearch(
            *(arguments.rate, quantities, calibration, values),
            lambda key: tuning.pitch(key, STANDARD_A4),
        )
        with progress_bar(arguments, "practising", "notes") as progress:
            table = search.learn(progress, table=table, places=places)
        improved += search.notes_changed
    write_bowing_table(arguments.output, table, arguments.rate, overwrite=arguments.overwrite)
    fields = {"rate": arguments.rate, "improved": improved}
    text = f"{arguments.output}: {improved} notes at places of the bow are bowed otherwise now"
    print_report(arguments, fields, text)
    return 0
