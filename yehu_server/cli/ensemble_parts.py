"""Who plays what in ``render --ensemble``: channels, tracks, or the parts of an ensemble file."""

from __future__ import annotations

import argparse
import contextlib
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from yehu_server.cli.sound_options import BY_MIDI, Values, room_of
from yehu_server.cli.terminal import warn
from yehu_server.errors import EnsembleError, ParameterError, YehuError
from yehu_server.scores.score import Score, concatenate

if TYPE_CHECKING:
    from yehu_server.core.physics.default_quantities import Quantities
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
    scores_for: Callable[[Quantities | None, int | None], list[Score]],
    playing: PlayingOptions,
) -> Players:
    """Give each part of some scores, which are played one after another, a player.

    Raises YehuError where there are too many parts, or what a file names is not there. `scores_for`
    reads the scores, in the range of an instrument or with None as they are written, with the key
    switches of a mapping; `playing` is where an ensemble file says nothing else.
    """
    from yehu_server.playing.parts import seated
    from yehu_server.playing.stringing import notes_of
    from yehu_server.rendering.options import Part
    from yehu_server.scores.reading import part_name, part_of, percussion_notes

    scores = scores_for(playing.quantities, playing.mapping.key_switches)
    room: Values = ()
    ensemble = None
    files: list[Path] = []
    parts: list[Part] = []
    if arguments.ensemble == BY_MIDI:
        Part(concatenate(scores), playing).check_is_heard()
        entries = _entries(arguments, scores)
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
        own = replace(
            usual,
            channels=usual.channels if entry.channel is None else frozenset({entry.channel}),
            seed=usual.seed if entry.seed is None else entry.seed,
            gain_db=_gain_db(usual, entry, len(entries)),
        )
        with _at(entry.where):
            if entry.instrument is not None:
                own = own.on_instrument(entry.instrument, arguments.practice)
            read = scores_for(own.quantities, own.mapping.key_switches)
        files += own.files
        what = f"track {entry.track}" if entry.channel is None else f"channel {entry.channel + 1}"
        played = [part_of(score, entry.channel, entry.track) for score in read]
        if any(each.instrument is not None or each.mapping is not None for each in entries):
            as_written = scores_for(None, own.mapping.key_switches)
            written = [part_of(score, entry.channel, entry.track) for score in as_written]
            name = entry.name or part_name(read, entry.channel, entry.track)
            within = notes_of(own.quantities)
            played = [
                _with_own_moves(score, whole, name, within)
                for score, whole in zip(played, written, strict=True)
            ]
        parts.append(Part.shaped(played, own, entry.name or what))
    if ensemble is not None:
        _warn_of_unplayed(ensemble, scores)
    is_counted = ensemble is None and arguments.channel is None
    spare = percussion_notes(scores) - percussion_notes(part.score for part in parts)
    return Players(tuple(parts), tuple(files), spare if is_counted else 0)


def _with_own_moves(score: Score, written: Score, name: str, within: NoteRange) -> Score:
    """A part whose remark on moves is of itself alone, where others have other instruments."""
    from yehu_server.scores.chords import is_single, tops_of
    from yehu_server.scores.octaves import octaves_of
    from yehu_server.scores.score import REST_S
    from yehu_server.scores.written.in_range import MOVED, line_of

    remarks = [line for line in score.remarks if not line.startswith(MOVED)]
    if len(remarks) < len(score.remarks):
        notes = written.note_columns
        single = notes.where(is_single(tops_of(notes)))
        octaves = octaves_of(single.spans(), REST_S, within)
        if octaves.summary:
            remarks.append(line_of([(name, octaves)], within))
    return replace(score, remarks=tuple(remarks))


def _entries(arguments: argparse.Namespace, scores: Sequence[Score]) -> list[PartEntry]:
    """Name a part for each channel or track with notes."""
    from yehu_server.core.engine.rig import MAX_PARTS
    from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
    from yehu_server.scores.ensemble_file import PartEntry
    from yehu_server.scores.reading import (
        channels_with_notes,
        part_name,
        shares_channels,
        tracks_with_notes,
    )

    chosen = arguments.channel or [each for each in range(16) if each != PERCUSSION_CHANNEL]
    if arguments.by == "track" or (
        arguments.by is None and arguments.channel is None and shares_channels(scores)
    ):
        found = [
            PartEntry("", name=part_name(scores, track=track), track=track)
            for track in tracks_with_notes(scores, chosen)
        ]
    else:
        found = [
            PartEntry("", name=part_name(scores, channel=channel), channel=channel)
            for channel in channels_with_notes(scores)
            if channel in chosen
        ]
    if len(found) > MAX_PARTS:
        raise ParameterError(
            f"{len(found)} tracks have notes: a stage has room for {MAX_PARTS} parts; "
            "an ensemble file chooses some (docs/ensemble.md)"
        )
    return found or [PartEntry("", name="nobody", channel=0)]


def _check_played(ensemble: EnsembleFile, scores: Sequence[Score]) -> None:
    """Refuse parts that have nothing to play."""
    from yehu_server.scores.reading import part_of

    for entry in ensemble.parts:
        if not any(part_of(score, entry.channel, entry.track).notes for score in scores):
            channel = "" if entry.channel is None else f"channel {entry.channel + 1}"
            track = "" if entry.track is None else f"track {entry.track}"
            what = " of ".join(filter(None, (channel, track)))
            raise EnsembleError(f"{entry.where}: {what} has no notes in the score")


def _warn_of_unplayed(ensemble: EnsembleFile, scores: Sequence[Score]) -> None:
    """Warn of channels that no part plays, where all parts are channels."""
    from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
    from yehu_server.scores.reading import channels_with_notes

    if any(entry.track is not None for entry in ensemble.parts):
        return
    played = {entry.channel for entry in ensemble.parts} | {PERCUSSION_CHANNEL}
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
    from yehu_server.params.preset_file import is_of_room
    from yehu_server.playing.mapping import load

    with _at(entry.where):
        if entry.mapping is not None:
            playing = replace(playing, mapping=load(entry.mapping))
        if entry.preset is not None:
            kept = (pair for pair in playing.start if is_of_room(pair[0]))  # of --room
            playing = playing.with_preset(entry.preset)
            playing = replace(playing, start=(*playing.start, *kept))
    own = dict(entry.settings)
    settings = (pair for pair in playing.settings if pair[0] not in own)
    place = {"/room/pan": entry.pan, "/room/distance": entry.distance, SECTION: entry.section}
    start = ((address, float(value)) for address, value in place.items() if value is not None)
    starts = (*playing.start, *room, *start)
    return replace(playing, start=starts, settings=(*settings, *own.items()))


def _gain_db(playing: PlayingOptions, entry: PartEntry, parts: int) -> float:
    """The gain of a part: as asked for, or so that all are about as loud together as one alone."""
    gain_db = playing.gain_db
    if gain_db is None:
        gain_db = dict(playing.start).get("/output/gain", 0.0) - 10.0 * math.log10(parts)
    return gain_db + entry.gain_db
