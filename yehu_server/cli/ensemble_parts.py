"""Who plays what in ``render --ensemble``: channels, tracks, or the parts of an ensemble file."""

from __future__ import annotations

import argparse
import contextlib
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from yehu_server.cli.sound_options import BY_MIDI, Values, is_of_room, room_of
from yehu_server.cli.terminal import warn
from yehu_server.errors import EnsembleError, ParameterError, YehuError
from yehu_server.scores.score import Score, concatenate

if TYPE_CHECKING:
    from yehu_server.core.physics.quantities import Quantities
    from yehu_server.core.player.note_range import NoteRange
    from yehu_server.playing.options import PlayingOptions
    from yehu_server.rendering.options import Part
    from yehu_server.scores.ensemble_file import EnsembleFile, PartEntry

SECTION = "/playing/section"


@dataclass(frozen=True)
class Players:
    """The parts of an ensemble, and what concerns all of them."""

    parts: tuple[Part, ...]
    files: tuple[Path, ...] = ()  # all files that they were read from
    percussion_notes: int = 0  # of channel 10, played by nobody


def players_of(
    arguments: argparse.Namespace,
    scores_for: Callable[[NoteRange], list[Score]],
    playing: PlayingOptions,
    quantities: Quantities,
    phrasing: float,
) -> Players:
    """Give each part of some scores, which are played one after another, a player.

    Raises YehuError where there are too many parts, or what a file names is not there.

    `scores_for`: reads the scores, with their parts moved into the range of an instrument.
    `playing`, `quantities`, `phrasing`: of all players, where an ensemble file does not say
    otherwise.
    """
    from yehu_server.core.physics.quantities import read_quantities
    from yehu_server.playing.parts import seated
    from yehu_server.playing.practice_files import practice_beside, practices_beside
    from yehu_server.playing.stringing import notes_of
    from yehu_server.scores.reading import percussion_notes

    scores = scores_for(notes_of(quantities))
    room: Values = ()
    ensemble = None
    files: list[Path] = []
    parts: list[Part] = []
    spare = 0
    if arguments.ensemble == BY_MIDI:
        entries = _entries(arguments, scores)
        is_counted = arguments.channel is None and arguments.by == "channel"
        spare = percussion_notes(scores) if is_counted else 0
    else:
        from yehu_server.scores.ensemble_file import read_ensemble

        ensemble = read_ensemble(arguments.ensemble)
        _check_played(ensemble, scores)
        entries, room = list(ensemble.parts), ensemble.room
        if ensemble.room_name is not None:
            with _at(ensemble.room_where):
                room = room_of(ensemble.room_name, playing.presets)
        files.append(ensemble.path)
    per_part = seated([_options_of(entry, playing, room) for entry in entries])
    for entry, usual in zip(entries, per_part, strict=True):
        instrument, own = quantities, usual
        if entry.instrument is not None:
            with _at(entry.where):
                instrument = read_quantities(entry.instrument)
            if arguments.practice is None:
                own = replace(own, bowing=None, practice=None)
                own = own.practised(practice_beside(entry.instrument))
            files += [entry.instrument, *practices_beside(entry.instrument)]
        files += own.files
        with _at(entry.where):
            read = scores_for(notes_of(instrument))
        part = _part(entry, read, instrument, own, phrasing, arguments)
        seed = own.seed if entry.seed is None else entry.seed
        gain_db = _gain_db(own, entry, len(entries), arguments)
        parts.append(replace(part, playing=replace(own, seed=seed), gain_db=gain_db))
    if ensemble is not None:
        _warn_of_unplayed(ensemble, scores)
    return Players(tuple(parts), tuple(files), spare)


def _entries(arguments: argparse.Namespace, scores: Sequence[Score]) -> list[PartEntry]:
    """Name a part for each channel or track with notes."""
    from yehu_server.core.engine.rig import MOST_PARTS
    from yehu_server.core.midi.channels import PERCUSSION
    from yehu_server.scores.ensemble_file import PartEntry
    from yehu_server.scores.reading import channels_with_notes, part_name, tracks_with_notes

    if arguments.by == "track":
        found = [
            PartEntry("", name=part_name(scores, track=track), track=track)
            for track in tracks_with_notes(scores)
        ]
    else:
        chosen = arguments.channel or [each for each in range(16) if each != PERCUSSION]
        found = [
            PartEntry("", name=part_name(scores, channel=channel), channel=channel)
            for channel in channels_with_notes(scores)
            if channel in chosen
        ]
    if len(found) > MOST_PARTS:
        raise ParameterError(
            f"{len(found)} tracks have notes: a stage has room for {MOST_PARTS} parts; "
            "an ensemble file chooses some (docs/ensemble.md)"
        )
    return found or [PartEntry("", name="nobody", channel=0)]


def _check_played(ensemble: EnsembleFile, scores: Sequence[Score]) -> None:
    """Refuse parts that have nothing to play."""
    from yehu_server.scores.reading import has_notes, part_of

    for entry in ensemble.parts:
        if not has_notes([part_of(score, entry.channel, entry.track) for score in scores]):
            channel = "" if entry.channel is None else f"channel {entry.channel + 1}"
            track = "" if entry.track is None else f"track {entry.track}"
            what = " of ".join(filter(None, (channel, track)))
            raise EnsembleError(f"{entry.where}: {what} has no notes in the score")


def _warn_of_unplayed(ensemble: EnsembleFile, scores: Sequence[Score]) -> None:
    """Tell which channels no part plays, where all parts are channels."""
    from yehu_server.core.midi.channels import PERCUSSION
    from yehu_server.scores.reading import channels_with_notes

    if any(entry.track is not None for entry in ensemble.parts):
        return
    played = {entry.channel for entry in ensemble.parts} | {PERCUSSION}
    if left := [each for each in channels_with_notes(scores) if each not in played]:
        channels = ", ".join(str(each + 1) for each in left)
        warn(f"{ensemble.path}: no part plays channel {channels}")


@contextlib.contextmanager
def _at(where: str) -> Iterator[None]:
    """Let errors name the place in the ensemble file."""
    try:
        yield
    except YehuError as error:
        raise EnsembleError(f"{where}: {error}") from error


def _options_of(entry: PartEntry, playing: PlayingOptions, room: Values) -> PlayingOptions:
    """The options of a part: those of all, with its own mapping, preset, settings and place."""
    from yehu_server.playing.mapping import load

    with _at(entry.where):
        if entry.mapping is not None:
            playing = replace(playing, mapping=load(entry.mapping))
        if entry.preset is not None:
            presets = playing.presets
            file, preset = presets.find_file(entry.preset), presets.find(entry.preset)
            kept = (pair for pair in playing.start if is_of_room(pair[0]))  # of --room
            playing = replace(playing, preset=file, start=(*preset.values.items(), *kept))
    own = dict(entry.settings)
    settings = (pair for pair in playing.settings if pair[0] not in own)
    place = {"/room/pan": entry.pan, "/room/distance": entry.distance, SECTION: entry.section}
    start = ((address, float(value)) for address, value in place.items() if value is not None)
    starts = (*playing.start, *room, *start)
    return replace(playing, start=starts, settings=(*settings, *own.items()))


def _part(
    entry: PartEntry,
    scores: Sequence[Score],
    quantities: Quantities,
    playing: PlayingOptions,
    phrasing: float,
    arguments: argparse.Namespace,
) -> Part:
    """The part of an entry, before its player has a seat."""
    from yehu_server.playing.stringing import notes_of
    from yehu_server.rendering.options import Part
    from yehu_server.scores.phrasing import is_fingered, phrased
    from yehu_server.scores.reading import part_of

    own = [part_of(score, entry.channel, entry.track) for score in scores]
    how = {"playing": playing, "within": notes_of(quantities), "rubato": arguments.rubato}
    score = concatenate([phrased(each, phrasing, **how) for each in own])
    channels = frozenset({entry.channel}) if entry.channel is not None else None
    if channels is None and arguments.channel is not None:
        channels = frozenset(arguments.channel)
    return Part(
        score,
        name=entry.name
        or (f"track {entry.track}" if entry.channel is None else f"channel {entry.channel + 1}"),
        channels=channels,
        phrasing=0.0 if is_fingered(score) else phrasing,
        quantities=quantities,
    )


def _gain_db(
    playing: PlayingOptions, entry: PartEntry, parts: int, arguments: argparse.Namespace
) -> float:
    """The gain of a part: as asked for, or so that all are about as loud together as one alone."""
    gain_db: float | None = arguments.gain_db
    if gain_db is None:
        gain_db = dict(playing.start).get("/output/gain", 0.0) - 10.0 * math.log10(parts)
    return gain_db + entry.gain_db
