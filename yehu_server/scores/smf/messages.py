"""The channel messages of a MIDI file in columns, and those of them that are played."""

from collections import defaultdict
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.scores.events import (
    AFTERTOUCH,
    CONTROL,
    NOTE_OFF,
    NOTE_ON,
    PITCHWHEEL,
    POLYTOUCH,
)
from yehu_server.scores.smf.track import DamageReport, Decoded, Track

Array = Any

# Controllers: all sound off, all notes off, and changes of mode, which end notes too.
ENDS_ALL = [120, *range(123, 128)]
# Of a state that the last value alone decides: no pedals, selections and modes.
CONTINUOUS = [1, 2, 4, 7, 8, 10, 11, *range(16, 20), *range(70, 80), *range(91, 96)]
MOD_WHEEL = 1  # controller
RELEASE = 64  # velocity of a note-off


class Messages(NamedTuple):
    """Messages in columns [shape=(messages,)].

    Songs follow one another on one axis of ticks, so that no tick is of two of them.
    """

    tick: Array
    at: Array  # byte in the file
    code: Array  # as of `scores.events`
    song: Array  # counted from 0
    track: Array  # its number in its song

    @property
    def kind(self) -> Array:
        """The kinds of messages, as of `scores.events`."""
        return self.code >> 20

    @property
    def first(self) -> Array:
        """The first data bytes."""
        return self.code >> 8 & 127

    @property
    def source(self) -> Array:
        """The channels of messages, other ones in each song."""
        return self.song << 4 | self.code >> 16 & 15

    def where(self, chosen: Array) -> "Messages":
        """Those of a mask, or in the order of some places."""
        return Messages(*(column[chosen] for column in self))


def messages_of(decoded: Decoded, tracks: Sequence[Track], faults: DamageReport) -> Messages:
    """The messages of tracks without damaged ones; the tracks are told where theirs are then."""
    tick, at, body, status = map(np.array, decoded.columns)
    data = np.frombuffer(decoded.data, np.uint8)
    has_two = status & 0xE0 != 0xC0
    first = data[body].astype(np.int64)
    second = data[body + has_two].astype(np.int64) * has_two  # else the first again
    # Dropped at its full length: mostly this is a velocity above 127, and the next message is
    # intact.
    is_whole = (first | second) < 0x80
    if not is_whole.all():
        count = len(is_whole) - int(is_whole.sum())
        faults.add("a damaged message dropped", int(at[is_whole.argmin()]), count)
    places = np.append(0, np.cumsum(is_whole))
    for track, begin, after in zip(
        tracks,
        places[[track.begin for track in tracks]].tolist(),
        places[[track.after for track in tracks]].tolist(),
        strict=True,
    ):
        track.begin, track.after = begin, after
    code = status << 16 | first << 8 | second
    none = np.zeros_like(tick)
    return Messages(tick, at, code, none, none).where(is_whole)


def without_resting_wheels(messages: Messages) -> Messages:
    """The messages without CC 1 of channels where it is 0 throughout: a wheel that nobody moves."""
    is_wheel = messages.code & 0xF07F00 == CONTROL << 20 | MOD_WHEEL << 8
    if not is_wheel.any():
        return messages
    source = messages.source
    moved = source[is_wheel & (messages.code & 127 > 0)]
    return messages.where(~is_wheel | np.isin(source, moved))


def settled(messages: Messages) -> Messages:
    """Return messages without those that another one at the same tick supersedes.

    Of a bend, a pressure or a continuous controller only the last value is heard, where no message
    of another kind lies between.
    """
    kind, first = messages.kind, messages.first
    is_control = kind == CONTROL
    is_move = (kind == POLYTOUCH) | (kind == AFTERTOUCH) | (kind == PITCHWHEEL)
    is_move |= is_control & np.isin(first, CONTINUOUS)
    begins = ~is_move
    begins[1:] |= messages.tick[1:] != messages.tick[:-1]
    moves = np.flatnonzero(is_move)
    number = first * (is_control | (kind == POLYTOUCH))
    # By what is moved, and in which run of moves.
    moved = np.cumsum(begins) << 32 | messages.track << 15 | number << 8 | messages.code >> 16
    moved = moved[moves]
    order = np.argsort(moved, kind="stable")
    superseded = moves[order[:-1][moved[order[1:]] == moved[order[:-1]]]]
    if not len(superseded):
        return messages
    kept = np.ones(len(kind), bool)
    kept[superseded] = False
    return messages.where(kept)


def ended(messages: Messages, faults: DamageReport) -> Messages:
    """Return messages in order, with a note-off for each note that nothing ends.

    Such a note lasts until another note of its channel begins. Where none does, it lasts as long
    as the score. Percussion's notes end by themselves.
    """
    kind, source = messages.kind, messages.source
    is_on = (kind == NOTE_ON) & (messages.code & 127 > 0)
    ends_all = (kind == CONTROL) & np.isin(messages.first, ENDS_ALL)
    found = np.flatnonzero((kind == NOTE_ON) | (kind == NOTE_OFF) | ends_all)
    columns = found, source[found], messages.first[found], is_on[found], ends_all[found]
    held: dict[int, dict[int, int]] = defaultdict(dict)  # by channel and key, the note's place
    for place, channel, key, begins, ends in zip(*(c.tolist() for c in columns), strict=True):
        keys = held[channel]
        if begins:
            keys[key] = place
        elif ends:
            keys.clear()
        elif key in keys:
            del keys[key]
    own = (keys for channel, keys in held.items() if channel & 15 != PERCUSSION_CHANNEL)
    places = np.array([place for keys in own for place in keys.values()], np.int64)
    # The next onset of each one's channel; songs have other ticks.
    since = (source & 15) << 52 | messages.tick
    onsets = np.flatnonzero(is_on)
    onsets = onsets[np.argsort(since[onsets], kind="stable")]
    later = np.searchsorted(since[onsets], since[places], side="right")
    later = np.append(onsets, -1)[later]
    has_end = (later >= 0) & (source[later] == source[places])
    places, later = places[has_end], later[has_end]
    if not len(places):
        return messages
    added = messages.where(places)
    faults.add("a note without an end stopped at the next one", int(added.at.min()), len(places))
    off = added.code & 0x0FFF00 | NOTE_OFF << 20 | RELEASE
    added = added._replace(tick=messages.tick[later], code=off)
    both = Messages(*map(np.concatenate, zip(added, messages, strict=True)))
    return both.where(np.argsort(both.tick, kind="stable"))  # before the next note
