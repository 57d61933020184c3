"""A tolerant reader of Standard MIDI Files.

Real files are cut short, have wrong lengths and counts, come in wrappers and have velocities above
127. This reader keeps all valid messages, lists the damage in `Score.warnings`, and refuses only
files with nothing to play and those that ask for too much. docs/midi_files.md says what becomes
of each fault.
"""

import os
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import accumulate, groupby, pairwise
from operator import itemgetter
from pathlib import Path

import numpy as np

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.errors import ScoreError
from yehu_server.scores.events import NOTE_ON, Events
from yehu_server.scores.score import (
    COMMON_TIME,
    MAX_DURATION_H,
    KeySignature,
    Metre,
    Score,
    ScorePart,
    check_duration,
    concatenate,
    errors_name,
    read_score_bytes,
)
from yehu_server.scores.smf.chunks import Part, read_parts, unwrapped
from yehu_server.scores.smf.messages import (
    Messages,
    ended,
    messages_of,
    settled,
    without_resting_wheels,
)
from yehu_server.scores.smf.track import (
    SMPTE,
    Clock,
    DamageReport,
    Decoded,
    Track,
    checked_division,
    named,
    times_of,
)
from yehu_server.scores.smf.tunings import retuned

MAX_BYTES = 64 * 2**20
MAX_REST_S = 30  # between the last message and the end of a track
_Song = tuple[list[Track], int, int]  # what sounds together, number of the first, the division


def read_score(
    path: str | os.PathLike[str],
    *,
    song: int | None = None,
    strict: bool = False,
    max_duration_h: float = MAX_DURATION_H,
) -> Score:
    """Read a Standard MIDI File, bare or in a wrapper.

    Formats 0 and 1 play all tracks together under the tempo changes of all of them. Format 2 plays
    its tracks one after another, as `concatenate` would, each starting at 120 bpm with tempo
    changes of its own. Files that were joined play in turn too. Sysex other than tuning, escapes,
    metas other than tempo, signatures of time and key, and names of tracks, and what is superseded
    at its own tick (`settled`) are dropped. A channel message with a data byte above 127 is dropped
    as a whole. `song` is the only one to
    play, from 1, of those that play one after another; `strict` refuses a file with any damage.
    Raises DamagedError with `strict`: one line naming the file, its first damage and the byte of
    that; ScoreError, one line naming the file, whatever its bytes: missing, unreadable, too large
    or too long, not a MIDI file, or without one channel message to play.
    """
    faults = DamageReport()
    with errors_name(path):
        score = _parse(read_score_bytes(path, MAX_BYTES), song, max_duration_h, faults)
        if strict:
            faults.refuse()
    return replace(score, name=Path(path).stem, warnings=faults.warnings)


def _parse(data: bytes, song: int | None, max_duration_h: float, faults: DamageReport) -> Score:
    start, end = unwrapped(data, faults)
    decoded = Decoded(data)
    parts = read_parts(decoded, start, end, faults)
    messages = messages_of(decoded, [track for part in parts for track in part.tracks], faults)
    playable = [part for part in parts if any(map(_has_messages, part.tracks))]
    if not playable:
        raise ScoreError("has no playable track")
    for part in playable[1:]:
        faults.add("another file within the file, played after the one before", part.at)
    songs = [each for part in playable for each in _songs(part, faults)]
    if song is not None:
        songs = [_chosen(songs, song)]
    scores = _scores(songs, messages, max_duration_h, faults)
    if len(scores) == 1:
        return scores[0]
    score = concatenate(scores)
    check_duration(score.duration_s, max_duration_h)
    return score


def _has_messages(track: Track) -> bool:
    return track.after > track.begin


def _songs(part: Part, faults: DamageReport) -> list[_Song]:
    """The songs of a file, which play one after another: the tracks of format 2, or one."""
    tracks, form = part.tracks, part.file_format
    if len(tracks) != part.announced:
        announced = "1 track" if part.announced == 1 else f"{part.announced} tracks"
        faults.add(f"{announced} announced, {len(tracks)} found", part.at + 10)
    if form > 2:
        faults.add(f"unknown format {form}, read as format 1", part.at + 8)
    elif form == 0 and len(tracks) > 1:
        faults.add(f"format 0 with {len(tracks)} tracks, read as format 1", part.at + 8)
    division = checked_division(part.division, part.at + 12, faults)
    if form == 2:
        return [([track], number, division) for number, track in enumerate(tracks, start=1)]
    return [(tracks, 1, division)]


def _chosen(songs: Sequence[_Song], song: int) -> _Song:
    if not 0 < song <= len(songs):
        count = "one song" if len(songs) == 1 else f"{len(songs)} songs"
        raise ScoreError(f"has {count}: there is no song {song}")
    if not any(map(_has_messages, songs[song - 1][0])):
        raise ScoreError(f"song {song} has nothing to play")
    return songs[song - 1]


def _scores(
    songs: Sequence[_Song], messages: Messages, max_duration_h: float, faults: DamageReport
) -> list[Score]:
    """The score of each song; the messages of all are chosen and timed at once."""
    lasts = [max(tracks, key=lambda track: track.end) for tracks, *_ in songs]
    begins = [0, *accumulate(last.end + 1 for last in lasts)]  # where songs begin, in ticks of all
    messages = _placed(songs, messages, begins)
    places = _places(messages)
    messages = ended(settled(without_resting_wheels(messages)), faults)
    bounds = np.searchsorted(messages.song, np.arange(len(songs) + 1))
    latest = np.append(messages.tick, 0)[bounds[1:] - 1].tolist()
    clocks, ends_s = [], []
    for number, (tracks, _, division) in enumerate(songs):
        # Sorting is stable: at one tick, the order of the tracks stays.
        tempos = sorted((tempo for track in tracks for tempo in track.tempos), key=itemgetter(0))
        clock, last = Clock(division, tempos), lasts[number]
        has_messages = bounds[number] < bounds[number + 1]
        latest_s = clock.seconds(latest[number] - begins[number]) if has_messages else 0.0
        end_s = clock.seconds(last.end)
        if end_s > latest_s + MAX_REST_S:
            faults.add(f"silence at the end cut to {MAX_REST_S} s", last.end_at)
            end_s = latest_s + MAX_REST_S
        try:
            check_duration(end_s, max_duration_h)
        except ScoreError as error:
            raise ScoreError(f"{error}{_longest_rest(tracks, clock, end_s)}") from None
        clocks.append(clock)
        ends_s.append(end_s)
    times = times_of(clocks, begins, messages.tick)
    events = Events(*times, messages.track, messages.code)
    return [
        _score(song, clock, events.where(slice(begin, after)), end_s, own)
        for song, clock, begin, after, end_s, own in zip(
            songs, clocks, bounds.tolist(), bounds[1:].tolist(), ends_s, places, strict=False
        )
    ]


def _placed(songs: Sequence[_Song], messages: Messages, begins: Sequence[int]) -> Messages:
    """The messages of songs in order, on an axis of ticks where these begin at some."""
    tracks = [
        (song, number, begins[song], track.after - track.begin)
        for song, (tracks, first, _) in enumerate(songs)
        for number, track in enumerate(tracks, start=first)
    ]
    song, number, begin, counts = np.array(tracks).T
    own = messages.where(slice(songs[0][0][0].begin, songs[-1][0][-1].after))
    song, number, begin = (np.repeat(each, counts) for each in (song, number, begin))
    own = own._replace(tick=own.tick + begin, song=song, track=number)
    return own.where(np.argsort(own.tick, kind="stable"))


def _places(messages: Messages) -> Iterator[list[tuple[int, int]]]:
    """The tracks and channels with notes, of each song in order; percussion does not count."""
    is_note = (messages.kind == NOTE_ON) & (messages.code >> 16 & 15 != PERCUSSION_CHANNEL)
    notes = messages.where(is_note)
    found = np.unique(notes.song << 32 | notes.track << 4 | notes.code >> 16 & 15)
    bounds = np.searchsorted(found >> 32, range(messages.song[-1] + 2)).tolist()
    places = [*zip((found >> 4 & 0xFFFF).tolist(), (found & 15).tolist(), strict=True)]
    return (places[begin:after] for begin, after in pairwise(bounds))


def _score(
    song: _Song, clock: Clock, events: Events, end_s: float, places: Sequence[tuple[int, int]]
) -> Score:
    """The score of a song with notes at some tracks and channels."""
    tracks, first, division = song
    signatures = sorted((each for track in tracks for each in track.metres), key=itemgetter(0))
    metres = [Metre(clock.beat(tick), quarters) for tick, quarters in signatures]
    tunings = sorted((each for track in tracks for each in track.tunings), key=itemgetter(0))
    tuned, remarks = retuned(events, [(clock.seconds(tick), body) for tick, body in tunings])
    names, encoding = named(tracks)
    parts = _parts(places, dict(enumerate(names, start=first)))
    if encoding:
        remarks = (*remarks, f"names of tracks are not UTF-8: read as {encoding}")
    return Score(
        tuned,
        end_s,
        metres=(COMMON_TIME, *metres),
        parts=parts,
        remarks=remarks,
        keys=_keys(tracks, division),
    )


def _keys(tracks: Sequence[Track], division: int) -> tuple[KeySignature, ...]:
    """The key signatures that change something; of several at a tick the first that is not C.

    Sequencers write C unasked. A file that counts frames has no beats to place them at.
    """
    if division >= SMPTE:
        return ()
    by_tick: dict[int, int] = {}
    for tick, fifths in sorted((key for track in tracks for key in track.keys), key=itemgetter(0)):
        by_tick[tick] = by_tick.get(tick) or fifths
    changes = (next(same) for _, same in groupby(by_tick.items(), key=itemgetter(1)))
    return tuple(KeySignature(Fraction(tick, division), fifths) for tick, fifths in changes)


def _longest_rest(tracks: Sequence[Track], clock: Clock, duration_s: float) -> str:
    """The place of a rest that is most of the duration, as text; empty where there is none."""
    rests = (track.longest for track in tracks)
    longest = ((clock.seconds(tick) - clock.seconds(tick - delta), at) for delta, tick, at in rests)
    seconds, at = max(longest)
    return f" (most of it is the rest before byte {at})" if 2.0 * seconds > duration_s else ""


def _parts(places: Sequence[tuple[int, int]], names: dict[int, str]) -> tuple[ScorePart, ...]:
    """The tracks that have notes, of the tracks and channels that do; of one track its channels."""
    tracks = sorted({track for track, _ in places})
    channels = sorted({channel for _, channel in places})
    if len(tracks) > 1:
        by_track, by_channel = defaultdict(set), defaultdict(set)
        for track, channel in places:
            by_track[track].add(channel)
            by_channel[channel].add(track)

        def unnamed(track: int) -> str:
            own = min(by_track[track])
            is_alone = len(by_track[track]) == len(by_channel[own]) == 1
            return f"channel {own + 1}" if is_alone else f"track {track}"

        named = [(names.get(track) or unnamed(track), track) for track in tracks]
        found = [ScorePart(name, track=track) for name, track in named]
    else:
        alone = names.get(tracks[0], "") if len(channels) == 1 else ""
        found = [ScorePart(alone or f"channel {each + 1}", channel=each) for each in channels]
    counts = Counter(part.name for part in found)
    return tuple(
        replace(part, name=f"{part.name} ({part.track})") if counts[part.name] > 1 else part
        for part in found
    )
