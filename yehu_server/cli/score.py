"""Show how a score is read and what will be played, or write it in another format.

  yehu-server score show tune.musicxml
  yehu-server score show tune.jianpu --json
  yehu-server score show tune.mxl --export-midi tune.mid
  yehu-server score show tune.jianpu --plot tune.png
  yehu-server score write tune.mid -o tune.musicxml
  yehu-server score write session.jsonl -o tune.jianpu --tempo 72

The marks that are understood are listed in docs/scores.md.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import (
    add_action,
    add_actions,
    add_command,
    add_instrument,
    add_options,
    instrument_of,
    picture_output,
)
from yehu_server.cli.converters import number_within, positive, target
from yehu_server.cli.terminal import compile_all, print_json, print_result, warn, warn_of_lost
from yehu_server.errors import OutputError, ScoreError
from yehu_server.scores.score import errors_name
from yehu_server.util.files import check_distinct, write_bytes

if TYPE_CHECKING:
    from yehu_server.scores.written.notated import Written

MUSICXML, JIANPU = (".musicxml", ".xml"), (".jianpu", ".txt")
LOWEST_TEMPO, HIGHEST_TEMPO = 5.0, 1000.0


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "score", __doc__)
    actions = add_actions(parser)
    show = add_action(actions, "show", _show, "show the notes of a score, and its marks")
    add_options(
        show,
        """
        score SCORE: a score: MusicXML, ABC, jianpu, MIDI or a capture
        --song N: the N-th tune of an ABC file, or song of a MIDI file (default: the first)
        --json: print one JSON object
        --plot OUT.png: draw the part that plays, with its bowing, in jianpu
        --part NAME: the part to draw (default: the one that plays)
        --export-midi OUT.mid: write a MIDI file of what is played, and list what MIDI cannot hold
        --overwrite: replace OUT.mid or OUT.png if it exists
        """,
        score=Path,
        song=positive,
        plot=target,
        export_midi=target,
    )
    add_instrument(show)
    write = add_action(actions, "write", _write, "write a score as MusicXML or jianpu")
    add_options(
        write,
        """
        score SCORE: a score: MIDI, a capture, MusicXML, ABC or jianpu
        -o --output OUT: the file to write: .musicxml or .xml; .jianpu or .txt
        --part NAME ...: write this part, by its name, the beginning of that, or its number; may be
            repeated (default: all)
        --song N: the N-th song of a MIDI file, or tune of an ABC file
        --tempo TEMPO: tempo of a capture, in quarter notes a minute (default: the one that fits its
            notes)
        --overwrite: replace OUT if it exists
        """,
        score=Path,
        output={"required": True, "type": target},
        song=positive,
        tempo=number_within(LOWEST_TEMPO, HIGHEST_TEMPO, "quarters a minute"),
    )


def _show(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.stringing import notes_of
    from yehu_server.scores.transcription import UNPLAYED, read_as_written
    from yehu_server.scores.written.notated import times
    from yehu_server.scores.written.text import fields_of, lines_of

    written, left = read_as_written(arguments.score, arguments.song)
    unplayed = {name: left.pop(name) for name in UNPLAYED if name in left}
    what = {"not played": unplayed, "played, but not shown here": left}
    for how, names in what.items():
        line = ", ".join(times(name, count) for name, count in sorted(names.items()))
        if line:
            written = replace(written, warnings=(*written.warnings, f"{how}: {line}"))
    if arguments.export_midi is not None:
        _export(arguments, written)
    if arguments.plot is not None:
        _plot(arguments, written)
    if arguments.json:
        print_json(fields_of(written))
    else:
        for line in lines_of(written, notes_of(instrument_of(arguments))):
            print_result(line)
    return 0


def _plot(arguments: argparse.Namespace, written: Written) -> None:
    from yehu_server.playing.stringing import notes_of
    from yehu_server.plot.bowed_score import write_bowed_score
    from yehu_server.scores.chosen_parts import numbers_of
    from yehu_server.scores.written.in_range import default_parts

    check_distinct(picture_output(arguments), [arguments.score])
    quantities = instrument_of(arguments)
    within = notes_of(quantities)
    with errors_name(arguments.score):
        asked = [arguments.part] if arguments.part else []
        numbers = numbers_of(written.names, asked) if asked else default_parts(written, within)
        if not numbers or not written.parts[numbers[0]].notes:
            raise ScoreError("has no note to draw")
    compile_all(argparse.Namespace(quiet=False))
    write_bowed_score(
        written, numbers[0], arguments.plot, quantities, overwrite=arguments.overwrite
    )


def _write(arguments: argparse.Namespace) -> int:
    from yehu_server.scores.chosen_parts import numbers_of
    from yehu_server.scores.jianpu.writer import jianpu_of
    from yehu_server.scores.musicxml.writer import musicxml_of
    from yehu_server.scores.transcription import read_as_written
    from yehu_server.scores.written.notated import times

    output, ending = arguments.output, arguments.output.suffix.lower()
    if ending not in (*MUSICXML, *JIANPU):
        midi = "; for MIDI: score show --export-midi" if output.suffix in (".mid", ".midi") else ""
        known = ", ".join((*MUSICXML, *JIANPU))
        raise OutputError(f"{output}: its ending is not one of {known}{midi}")
    check_distinct({"-o": output}, [arguments.score])
    written, left = read_as_written(arguments.score, arguments.song, arguments.tempo)
    with errors_name(arguments.score):
        if arguments.part:
            numbers = numbers_of(written.names, arguments.part)
            written = replace(written, parts=tuple(written.parts[at] for at in numbers))
        if not any(part.notes for part in written.parts):
            raise ScoreError("has no note to write")
    if ending in MUSICXML:
        data, lost = musicxml_of(written)
    else:
        text, lost = jianpu_of(written)
        data = text.encode()
    write_bytes(output, data, overwrite=arguments.overwrite)
    for warning in (*written.warnings, *written.not_understood):
        warn(f"{arguments.score}: {warning}")
    if lost := {**left, **lost}:
        what = ", ".join(times(name, count) for name, count in sorted(lost.items()))
        warn(f"{output}: written, without {what}")
    return 0


def _export(arguments: argparse.Namespace, written: Written) -> None:
    from yehu_server.playing.stringing import notes_of
    from yehu_server.scores.midi_export import midi_file
    from yehu_server.scores.written.performed import performed

    output = arguments.export_midi
    check_distinct({"--export-midi": output}, [arguments.score])
    with errors_name(arguments.score):
        score = performed(written, within=notes_of(instrument_of(arguments)))
    data, lost = midi_file(written, score)
    write_bytes(output, data, overwrite=arguments.overwrite)
    warn_of_lost(output, lost)
