"""Listen to one voice or instrument in a sound file, and play its tune on the yehu.

  yehu-server follow hum.wav -o played.wav
  yehu-server follow hum.wav -o played.wav --preset flautando --correct 1 --keep-vibrato
  yehu-server follow hum.wav -o hum.mid
  yehu-server follow hum.wav -o hum.jsonl
  yehu-server follow hum.wav -o played.flac --plot played.png

The ending of OUT says what to write: .wav or .flac the sound, .mid the notes, .jsonl all that the
player does, for replay. This needs the extra yehu-server[follow]. docs/follow.md says how well it
hears.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli import sound_options
from yehu_server.cli.arguments import (
    add_command,
    add_instrument,
    add_options,
    add_output,
    add_reporting,
    check_new,
    check_output,
    picture_output,
)
from yehu_server.cli.converters import hours, number_within, target
from yehu_server.cli.playing_options import add_playing, playing_options_of
from yehu_server.cli.terminal import (
    calibrating,
    compile_all,
    print_report,
    progress_bar,
    warn,
    warn_of_lost,
)
from yehu_server.errors import OutputError
from yehu_server.scores.score import MAX_DURATION_H
from yehu_server.util.files import check_distinct, write_bytes
from yehu_server.util.subtypes import SUBTYPES

if TYPE_CHECKING:
    from yehu_server.following.heard import Heard
    from yehu_server.following.performance import Performed
    from yehu_server.playing.options import PlayingOptions
    from yehu_server.rendering.options import Options

STYLES = ("exact", "gentle", "even")
MIDI, CAPTURE = (".mid", ".midi"), (".jsonl",)


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "follow", __doc__, run)
    add_options(
        parser, "recording IN: a sound file of one voice, such as WAV or FLAC", recording=Path
    )
    add_output(parser)
    add_options(
        parser,
        f"""
        --plot PNG: also draw pitch and level, as heard and as played
        --max-duration HOURS: refuse a longer recording (default: {MAX_DURATION_H:g})
        """,
        max_duration={"type": hours, "default": MAX_DURATION_H},
        plot=target,
    )
    add_reporting(parser)
    add_options(
        parser.add_argument_group("following"),
        """
        --transpose SEMITONES: transpose the tune, -60 to 60 (default: by octaves, into the range of
            the instrument)
        --correct SHARE: pitch correction, 0 (as sung) to 1 (in tune) (default: 0)
        --keep-vibrato: correct the pitch of notes only, not their vibrato and slides
        --style: how much of the recording's loudness and attacks is played: exact (all), gentle
            (some) or even (none) (default: exact)
        """,
        transpose=number_within(-60.0, 60.0, "semitones"),
        correct={"type": number_within(0.0, 1.0, ""), "default": 0.0},
        style={"choices": STYLES, "default": STYLES[0]},
    )
    group = parser.add_argument_group("the sound")
    sound_options.add_sound(group)
    add_options(group, "--subtype: sample format (default: 24)", subtype={"choices": (*SUBTYPES,)})
    sound_options.add_space(group)
    group = parser.add_argument_group("playing")
    add_instrument(group)
    add_playing(group)
    parser.set_defaults(mapping=None, mpe=False, programs=False)  # a voice has no controllers


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.cli.report import follow_report
    from yehu_server.following.heard import hear
    from yehu_server.following.notes import strokes_of
    from yehu_server.following.performance import STYLES as ALL
    from yehu_server.following.performance import FollowOptions, performed
    from yehu_server.following.recording import need_follow, recording_of_file
    from yehu_server.playing.stringing import notes_of, range_text

    start = time.perf_counter()
    need_follow("follow")
    playing, options = _options(arguments)
    recording = recording_of_file(arguments.recording, arguments.max_duration)
    with progress_bar(arguments, "listening") as progress:
        heard = hear(recording, progress=progress)
    wanted = FollowOptions(
        transpose=arguments.transpose,
        correct=arguments.correct,
        keeps_vibrato=arguments.keep_vibrato,
        style=ALL[arguments.style],
        tuning=playing.tuning,
        a4=playing.a4,
        within=notes_of(playing.quantities),
    )
    found = performed(heard, strokes_of(heard), wanted)
    for warning in heard.warnings:
        warn(f"{arguments.recording}: {warning}")
    _write(arguments, playing, options, heard, found)
    fields = {
        "duration_s": heard.duration_s,
        "voiced_s": float(heard.is_voiced.sum() * heard.times_s[1]),
        "notes": found.notes,
        "strokes": found.strokes,
        "transposed": found.semitones,
        "notes_moved": found.notes_moved,
        "range": range_text(wanted.within),
        "warnings": list(heard.warnings),
        "elapsed_s": time.perf_counter() - start,
    }
    print_report(arguments, fields, follow_report(arguments.output, fields))
    return 0


def _options(arguments: argparse.Namespace) -> tuple[PlayingOptions, Options]:
    """How to play and to render; raises YehuError where something is wrong, before listening."""
    from yehu_server.util.sound_file import format_of

    ending = arguments.output.suffix.lower()
    sound_options.check_sound(arguments)
    playing = sound_options.in_room(playing_options_of(arguments), arguments)
    if arguments.plot is not None and ending in (*MIDI, *CAPTURE):
        raise OutputError("--plot shows what is played: name a sound file with -o")
    outputs = {"-o": arguments.output, **picture_output(arguments)}
    check_distinct(outputs, [arguments.recording, *playing.files])
    form = "wav"
    if ending in (*MIDI, *CAPTURE):
        check_new(arguments)
    else:
        form = format_of(arguments.output)
        check_output(arguments)
    return playing, sound_options.sound_options_of(arguments, form)


def _write(
    arguments: argparse.Namespace,
    playing: PlayingOptions,
    options: Options,
    heard: Heard,
    found: Performed,
) -> None:
    """Write the file that is asked for."""
    ending = arguments.output.suffix.lower()
    if ending in MIDI:
        from yehu_server.following.performance import QUARTER_S
        from yehu_server.scores.midi_export import midi_of_performance

        data, lost = midi_of_performance(found.score, QUARTER_S)
        write_bytes(arguments.output, data, overwrite=arguments.overwrite)
        warn_of_lost(arguments.output, lost)
        return
    compile_all(arguments)
    with calibrating(arguments, options.rate) as progress:
        playing.calibration(float(options.rate), progress)
    from yehu_server.rendering.options import Part
    from yehu_server.rendering.plot_data import PlotData
    from yehu_server.rendering.to_files import render, render_capture

    parts, output = [Part(found.score, playing)], arguments.output
    watch = None
    if arguments.plot is not None:
        watch = PlotData(float(options.rate), found.score.duration_s, 1, playing.a4)
        options = replace(options, block=sound_options.PLOTTED_BLOCK)
    with progress_bar(arguments, "playing") as progress:
        if ending in CAPTURE:
            render_capture(parts, output, options, progress, overwrite=arguments.overwrite)
        else:
            render(parts, output, options, progress, check_output(arguments), watch=watch)
    if watch is not None:
        from yehu_server.plot.followed import write_followed

        watch.finish()
        write_followed(heard, found.semitones, watch, arguments.plot, overwrite=arguments.overwrite)
