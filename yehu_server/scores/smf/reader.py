"""A tolerant reader of Standard MIDI Files.

Real files are cut short, have wrong lengths and counts, come in wrappers and have velocities above
127. This reader keeps all valid messages, lists the damage in `Score.warnings`, and refuses only
files with nothing to play and those that ask for too much. docs/midi_files.md says what becomes
of each fault.
"""

import os
from bisect import bisect_right
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import groupby
from operator import itemgetter
from pathlib import Path

import mido
import numpy as np

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.errors import ScoreError
from yehu_server.scores.score import (
    COMMON_TIME,
    MAX_DURATION_H,
    KeySignature,
    Metre,
    Score,
    ScoreEvent,
    ScorePart,
    check_duration,
    concatenate,
    distinct,
    errors_name,
    read_score_bytes,
)
from yehu_server.scores.smf.chunks import Part, read_parts, unwrapped
from yehu_server.scores.smf.track import (
    SMPTE,
    Clock,
    DamageReport,
    Placed,
    Track,
    checked_division,
    named,
)
from yehu_server.scores.smf.tunings import retuned

# Controllers: all sound off, all notes off, and changes of mode, which end notes too.
ENDS_ALL = {120, *range(123, 128)}
MAX_BYTES = 64 * 2**20
MAX_REST_S = 30  # between the last message and the end of a track
# Of a state that the last value alone decides: no pedals, selections and modes.
CONTINUOUS = {1, 2, 4, 7, 8, 10, 11, *range(16, 20), *range(70, 80), *range(91, 96)}
MOVES = {"pitchwheel", "aftertouch", "polytouch", "control_change"}
_Song = tuple[list[Track], int, int]  # what sounds together, number of the first, the division

MOD_WHEEL = 1  # controller


def ended(messages: Sequence[Placed], faults: DamageReport) -> list[Placed]:
    """Return messages in order, with a note-off for each note that nothing ends.

    Such a note lasts until another note of its channel begins. Where none does, it lasts as long
    as the score.
    """
    held = _held(messages)
    if not held:
        return list(messages)
    onsets: dict[int, list[int]] = defaultdict(list)  # of each channel, ticks
    for tick, message, _ in messages:
        if message.type == "note_on" and message.velocity > 0:
            onsets[message.channel].append(tick)
    added: list[Placed] = []
    for tick, message, at in held:
        later = onsets[message.channel]
        place = bisect_right(later, tick)
        if place < len(later):
            faults.add("a note without an end stopped at the next one", at)
            off = mido.Message("note_off", channel=message.channel, note=message.note)
            added.append((later[place], off, at))
    return sorted([*added, *messages], key=itemgetter(0))  # stable: before the next note


def settled(messages: Sequence[Placed], starts: Sequence[int]) -> list[Placed]:
    """Return messages without those that another one at the same tick supersedes.

    Of a bend, a pressure or a continuous controller only the last value is heard, where no message
    of another kind lies between. `starts` are the bytes at which the tracks begin.
    """
    kept: list[Placed | None] = []
    last: dict[tuple[str, int, int, int], int] = {}  # by what is moved, a place in `kept`
    before = -1
    for placed in messages:
        tick, message, at = placed
        if tick != before and last:
            last.clear()
        before = tick
        kind = message.type
        number = 0
        if kind == "control_change":
            number = message.control
        elif kind == "polytouch":
            number = message.note
        if kind in MOVES and (kind != "control_change" or number in CONTINUOUS):
            source = kind, message.channel, number, bisect_right(starts, at)
            if source in last:
                kept[last[source]] = None
            last[source] = len(kept)
        elif last:
            last.clear()
        kept.append(placed)
    return [placed for placed in kept if placed is not None]


def _held(messages: Sequence[Placed]) -> list[Placed]:
    """The note-ons that still hold at the end, in the order of the channels."""
    held: dict[int, dict[int, Placed]] = defaultdict(dict)  # by channel and key
    for placed in messages:
        message = placed[1]
        kind = message.type
        if kind == "note_on" and message.velocity > 0:
            held[message.channel][message.note] = placed
        elif kind in ("note_on", "note_off"):
            held[message.channel].pop(message.note, None)
        elif kind == "control_change" and message.control in ENDS_ALL:
            held[message.channel].clear()
    held.pop(PERCUSSION_CHANNEL, None)  # whose notes end by themselves
    return [placed for notes in held.values() for placed in notes.values()]


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
    parts = read_parts(data, start, end, faults)
    playable = [part for part in parts if any(track.messages for track in part.tracks)]
    if not playable:
        raise ScoreError("has no playable track")
    for part in playable[1:]:
        faults.add("another file within the file, played after the one before", part.at)
    songs = [each for part in playable for each in _songs(part, faults)]
    if song is not None:
        songs = [_chosen(songs, song)]
    scores = [_play_together(*each, max_duration_h, faults) for each in songs]
    if len(scores) == 1:
        return scores[0]
    score = concatenate(scores)
    check_duration(score.duration_s, max_duration_h)
    return score


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
    if not any(track.messages for track in songs[song - 1][0]):
        raise ScoreError(f"song {song} has nothing to play")
    return songs[song - 1]


def _play_together(
    tracks: Sequence[Track], first: int, division: int, max_duration_h: float, faults: DamageReport
) -> Score:
    # Sorting is stable: at one tick, the order of the tracks and within them stays.
    tempos = sorted((tempo for track in tracks for tempo in track.tempos), key=itemgetter(0))
    messages = sorted((placed for track in tracks for placed in track.messages), key=itemgetter(0))
    starts = [track.start_at for track in tracks]  # a message's byte is within its track
    found = [distinct(map(itemgetter(1), track.messages)) for track in tracks]
    kinds = {message.type for own in found for message in own}
    if "control_change" in kinds:
        messages = without_resting_wheels(messages)
    if not kinds.isdisjoint(MOVES):
        messages = settled(messages, starts)
    messages = ended(messages, faults)
    clock = Clock(division, tempos)
    last = max(tracks, key=lambda track: track.end)
    end_s = clock.seconds(last.end)
    latest_s = (clock.seconds(messages[-1][0]) if messages else 0.0) + MAX_REST_S
    if end_s > latest_s:
        faults.add(f"silence at the end cut to {MAX_REST_S} s", last.end_at)
        end_s = latest_s
    try:
        check_duration(end_s, max_duration_h)
    except ScoreError as error:
        raise ScoreError(f"{error}{_longest_rest(tracks, clock, end_s)}") from None
    events = _events(messages, clock, starts, first)
    signatures = sorted((each for track in tracks for each in track.metres), key=itemgetter(0))
    metres = [Metre(clock.beat(tick), quarters) for tick, quarters in signatures]
    tunings = sorted((each for track in tracks for each in track.tunings), key=itemgetter(0))
    tuned, remarks = retuned(events, [(clock.seconds(tick), body) for tick, body in tunings])
    places = {
        (number, message.channel)
        for number, own in enumerate(found, start=first)
        for message in own
        if message.type == "note_on" and message.channel != PERCUSSION_CHANNEL
    }
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


def without_resting_wheels(messages: Sequence[Placed]) -> list[Placed]:
    """The messages without CC 1 of channels where it is 0 throughout: a wheel that nobody moves."""
    found: dict[int, list[int]] = {}  # by channel: places of its moves
    moved: set[int] = set()
    for place, (_, message, _) in enumerate(messages):
        if message.type == "control_change" and message.control == MOD_WHEEL:
            found.setdefault(message.channel, []).append(place)
            if message.value > 0:
                moved.add(message.channel)
    resting = {at for channel, places in found.items() if channel not in moved for at in places}
    if not resting:
        return list(messages)
    return [placed for place, placed in enumerate(messages) if place not in resting]


def _events(
    messages: Sequence[Placed], clock: Clock, starts: Sequence[int], first: int
) -> tuple[ScoreEvent, ...]:
    """Messages at their times; each is of the track within whose bytes it lies."""
    places = np.fromiter(map(itemgetter(2), messages), np.int64, len(messages))
    tracks = first + np.maximum(np.searchsorted(starts, places, side="right") - 1, 0)
    times = clock.times(map(itemgetter(0), messages))
    columns = zip(messages, times, tracks.tolist(), strict=True)
    rows = [(seconds, message, beat, track) for (_, message, _), (seconds, beat), track in columns]
    return tuple(map(partial(tuple.__new__, ScoreEvent), rows))


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


def _parts(places: set[tuple[int, int]], names: dict[int, str]) -> tuple[ScorePart, ...]:
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
