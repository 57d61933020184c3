"""One rendering, as the options of ``yehu-server render`` ask for it."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli import sound_options
from yehu_server.cli.arguments import check_output, picture_output
from yehu_server.cli.ensemble_parts import Players, players_of
from yehu_server.cli.playing_options import playing_options_of
from yehu_server.cli.terminal import calibrating, compile_all, progress_bar, warn
from yehu_server.errors import OutputError
from yehu_server.rendering import PIPE
from yehu_server.scores.phrasing import PHRASING
from yehu_server.scores.score import Score, check_duration
from yehu_server.util.files import check_distinct, make_folder, replace_any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from yehu_server.core.physics.default_quantities import Quantities
    from yehu_server.playing.options import PlayingOptions
    from yehu_server.rendering.options import Options, Part
    from yehu_server.rendering.summary import PartSummary, Summary


@dataclass(frozen=True)
class Rendered:
    """A rendering: what it was, what --json says of it, and all files that it was made from."""

    summary: Summary
    fields: dict[str, Any]
    read: Sequence[Path]


def rendered(arguments: argparse.Namespace) -> Rendered:
    """Render what the options ask for.

    Raises YehuError where it fails; no partial file is left.
    """
    from yehu_server.playing.calibration import calibration_key
    from yehu_server.rendering.to_files import render

    sound_options.check_stage(arguments)
    playing = sound_options.in_room(playing_options_of(arguments), arguments).shaping(PHRASING)
    outputs = {} if arguments.output is PIPE else {"-o": arguments.output}
    outputs |= picture_output(arguments)
    check_distinct(outputs, [*arguments.midi, *playing.files])
    form = _format(arguments)
    may_replace = replace_any if arguments.output is PIPE else check_output(arguments)
    _warn_of_own(arguments, playing)
    options = sound_options.sound_options_of(arguments, form)
    scores = cache(partial(_scores, arguments, playing))
    own = playing.quantities, playing.mapping.key_switches
    if arguments.ensemble is None:
        players = Players((_part(scores(*own), playing),))
    else:
        players = players_of(arguments, scores, playing)
    read = [*arguments.midi, *playing.files, *players.files]
    stems = _stems(arguments, options, players)
    check_distinct({**outputs, **{f"stem {stem.name}": stem for stem in stems}}, read)
    remarks, warnings = _remarks(arguments, players, scores(*own))
    for line in warnings if arguments.quiet else (*remarks, *warnings):
        warn(line)
    compile_all(arguments)
    parts = players.parts
    with calibrating(arguments, options.rate) as progress:
        for part in parts:
            part.playing.calibration(float(options.rate), progress)
    key = calibration_key(float(options.rate), playing.quantities, playing.a4)
    watch = None
    if arguments.plot is not None:
        from yehu_server.rendering.plot_data import PlotData

        longest_s = max(part.score.duration_s for part in parts)
        watch = PlotData(float(options.rate), longest_s, len(parts), playing.a4)
        options = replace(options, block=sound_options.PLOTTED_BLOCK)
    with progress_bar(arguments, "rendering") as progress:
        summary = render(parts, arguments.output, options, progress, may_replace, stems, watch)
    if watch is not None:
        from yehu_server.plot.sound_panels import write_picture

        watch.finish()
        voices = "" if len(parts) == 1 else f"{len(parts)} parts, "
        title = f"{parts[0].score.name}: {voices}{options.rate / 1000.0:g} kHz"
        write_picture(watch, arguments.plot, title, overwrite=arguments.overwrite)
    summary = replace(summary, percussion_notes=summary.percussion_notes + players.percussion_notes)
    shaped = {"phrasing": playing.phrasing, "rubato": playing.rubato}
    fields = {**_fields(summary, playing, stems), **shaped, "calibration": key}
    fields["warnings"] = [*remarks, *warnings]  # as a folder's manifest has them
    return Rendered(summary, fields, read)


def _part(scores: Sequence[Score], playing: PlayingOptions) -> Part:
    """The only player, by the name of the part, if it has one; else that of the scores."""
    from yehu_server.rendering.options import Part

    names = [part.name for score in scores for part in score.parts]
    is_named = len(names) == 1 and not names[0].startswith(("channel ", "track "))
    part = Part.shaped(scores, playing, names[0] if is_named else "")
    part.check_is_heard()
    return part


def _format(arguments: argparse.Namespace) -> str:
    """The format to write; raises OutputError where the output cannot have it."""
    from yehu_server.rendering.pipe import check_pipe
    from yehu_server.util.sound_file import format_of

    form = str(arguments.format or "")
    if arguments.output is PIPE:
        check_pipe(form or "wav")
        return form or "wav"
    if form == "raw":
        raise OutputError(f"{arguments.output}: --format raw is for -o -; use .wav or .flac")
    return form or format_of(arguments.output)


def _stems(arguments: argparse.Namespace, options: Options, players: Players) -> list[Path]:
    """The files of the stems that are asked for; checks that they may be written."""
    if arguments.stems is None:
        return []
    from yehu_server.rendering.to_files import stem_files

    form = "wav" if options.format_name == "raw" else options.format_name
    stems = stem_files(arguments.stems, players.parts, form, is_dry=options.is_dry)
    make_folder(arguments.stems)
    for stem in stems:
        check_output(arguments, stem)
    return stems


def _fields(summary: Summary, playing: PlayingOptions, stems: Sequence[Path]) -> dict[str, Any]:
    """What --json says of a rendering."""
    fields = _counts(summary)
    fields["parts"] = [*map(_counts, summary.parts)]
    fields["stems"] = [*map(str, stems)]
    fields["policy"] = summary.policy.value
    fields["mapping"] = {"name": playing.mapping.name, "files": [*map(str, playing.mapping.files)]}
    fields["preset"] = None if playing.preset is None else str(playing.preset)
    fields["practice"] = "shipped" if playing.practice is None else str(playing.practice)
    return fields


def _counts(summary: Summary | PartSummary) -> dict[str, Any]:
    """The fields of a summary, with channels counted from 1."""
    fields = dict(vars(summary))
    notes_by_channel = fields.pop("notes_by_channel")
    fields["channels"] = {str(channel + 1): notes for channel, notes in notes_by_channel.items()}
    return fields


def _scores(
    arguments: argparse.Namespace,
    playing: PlayingOptions,
    quantities: Quantities | None,
    key_switches: int | None,
) -> list[Score]:
    """Read all files, moved to fit an instrument of some quantities, or with None as written.

    `key_switches`: of the mapping.

    Raises DamagedError where --strict refuses one; ScoreError where one cannot be read, or they
    last too long together.
    """
    from yehu_server.scores.reading import ReadOptions, read_any

    longest = arguments.max_duration
    whole = arguments.ensemble is not None or arguments.channel is not None
    own = replace(playing, quantities=quantities or playing.quantities)
    how = ReadOptions.by(own, arguments.part, all_parts=whole)
    how = replace(how, key_switches=key_switches)
    if quantities is None:
        how = replace(how, in_range=False)
    read = partial(read_any, song=arguments.song, strict=arguments.strict, max_duration_h=longest)
    scores = []
    for path in arguments.midi:
        scores.append(read(path, how))
        check_duration(sum(each.duration_s for each in scores), longest, "all scores last")
    return scores


def _remarks(
    arguments: argparse.Namespace, players: Players, scores: Sequence[Score]
) -> tuple[list[str], list[str]]:
    """What a player should know of the scores, and what is wrong in them."""
    from yehu_server.rendering.options import bends_without_range, unheard_line
    from yehu_server.scores.reading import channels_with_notes

    played = [part.score for part in players.parts]
    remarks = [line for score in played for line in score.remarks]
    unheard = unheard_line(arguments.channel or (), channels_with_notes(scores))
    is_mpe = players.parts[0].playing.mapping.mpe  # whose members may be without notes
    remarks += [] if is_mpe else filter(None, [unheard])
    if any(map(bends_without_range, players.parts)):
        remarks.append(
            "no bend range in the file: 2 semitones taken; --set /playing/bend_range=12 changes it"
        )
    return [*dict.fromkeys(remarks)], [*dict.fromkeys(played[0].warnings)]


def _warn_of_own(arguments: argparse.Namespace, playing: PlayingOptions) -> None:
    """Warn where serve would use the user's own mapping of this name."""
    from yehu_server.playing.mapping import MINE, user_mappings

    own = playing.mapping.files[0].stem
    if (arguments.mapping or own) == own and own in user_mappings() and not arguments.quiet:
        warn(f"mapping {own}: the shipped one; --mapping {MINE}{own} is your own")
