"""Render scores, one after another, to a sound file; or those of a folder, each to its own.

  yehu-server render tune.mid -o tune.wav
  yehu-server render tune.mid -o tune.flac --rate 48000 --normalize
  yehu-server render suite-1.mid suite-2.mid -o suite.wav --channel 1
  yehu-server render tune.mid -o close.wav --set /playing/bow_position=0.08 --gain-db 6
  yehu-server render quartet.mid --ensemble -o quartet.wav --stems stems
  yehu-server render songs -o sounds --format flac
  yehu-server render songs -o sounds --dask tcp://10.0.0.1:8786
  yehu-server render - -o - --format raw < tune.mid > tune.f32

A folder is rendered on all cores; files that are up to date stay (docs/folders.md).
docs/ensemble.md is about ensembles, docs/midi_files.md about damaged MIDI files, docs/cluster.md
about clusters.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

from yehu_server.cli import render_folder
from yehu_server.cli.arguments import (
    add_cluster,
    add_command,
    add_instrument,
    add_options,
    add_output,
    add_reporting,
)
from yehu_server.cli.converters import channel, hours, number_within, positive, target
from yehu_server.cli.playing_options import add_controllers, add_playing
from yehu_server.cli.render_one import rendered
from yehu_server.cli.render_pipe import piped_in, quiet_pipe, score_source, sound_target
from yehu_server.cli.sound_options import add_sound, add_stage
from yehu_server.cli.terminal import print_json, print_result, warn
from yehu_server.rendering import PIPE
from yehu_server.scores.score import MAX_DURATION_H
from yehu_server.util.subtypes import FORMATS, SUBTYPES


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "render", __doc__, run)
    add_options(
        parser,
        "midi SCORE: files of MIDI, MusicXML, ABC or jianpu, or one folder; - reads standard input",
        midi={"nargs": "+", "type": score_source},
    )
    add_output(parser, sound_target, "; - for standard output; for a folder of scores, a folder")
    add_reporting(parser)
    add_options(
        parser,
        f"""
        --plot PNG: also draw level, pitch (as wanted and as measured) and spectrogram
        --strict: refuse damaged MIDI files, and marks that are not understood, with exit code 1
            (default: warn)
        --max-duration HOURS: refuse scores that last longer in total (default: {MAX_DURATION_H:g})
        """,
        max_duration={"type": hours, "default": MAX_DURATION_H},
        plot=target,
    )
    add_cluster(parser)
    add_options(
        parser.add_argument_group("the score"),
        """
        --channel N: play only this MIDI channel, 1 to 16; may be repeated (default: those of the
            part that plays, but 10)
        --part NAME ...: play this part, by its name, the beginning of its name, or its number; may
            be repeated (default: the part that carries the tune; all, where tracks of a MIDI file
            take turns)
        --song N: play only the N-th song of each file (default: all songs, one after another)
        --phrasing SHARE: how much the player shapes plain notes (phrases, accents, slurs, vibrato,
            slides), 0 to 1; 0 plays exactly what is written, marks of the score stay (default: 0.5)
        --rubato SHARE: tempo flexibility within phrases and at the end, 0 to 1; 0 is strict time
            (default: the value of --phrasing)
        """,
        channel={"type": channel, "action": "append"},
        phrasing=number_within(0.0, 1.0, ""),
        rubato=number_within(0.0, 1.0, ""),
        song=positive,
    )
    group = parser.add_argument_group("the sound")
    add_options(
        group,
        """
        --format: file format (default: by the ending of OUT); raw: samples alone, for -o -
        --subtype: sample format (default: 24 bits; float for raw)
        """,
        format={"choices": (*FORMATS, "raw")},
        subtype={"choices": tuple(SUBTYPES)},
    )
    add_sound(group)
    group = parser.add_argument_group("playing")
    add_instrument(group)
    add_controllers(group)
    add_playing(group)
    add_stage(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    if render_folder.is_for_folder(arguments):
        return render_folder.run(arguments)
    from yehu_server.scores.smf.track import DamagedError

    try:
        with piped_in(arguments), quiet_pipe(arguments.output):
            done = rendered(arguments)
    except DamagedError as error:
        warn(str(error))
        return 1
    is_piped = arguments.output is PIPE  # the sound is on standard output
    if arguments.json:
        print_json(done.fields, sys.stderr if is_piped else sys.stdout)
    elif not arguments.quiet:
        from yehu_server.cli.report import render_report

        where = Path("standard output") if is_piped else arguments.output
        for line in render_report(where, done.summary).split("\n"):
            (warn if is_piped else print_result)(line)
    return 0
