"""Ends the notes of a MIDI file that nothing ends: the instrument would return to them for good."""

from __future__ import annotations

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Sequence
from operator import itemgetter

import mido

from yehu_server.score.smf.faults import Faults
from yehu_server.score.smf.track import Placed

PERCUSSION = 9  # whose notes end by themselves
ALL_SOUND_OFF, ALL_NOTES_OFF = 120, 123  # and from there on, changes of mode end notes too


def ended(messages: Sequence[Placed], faults: Faults) -> list[Placed]:
    """Return messages in order, with a note-off for each note that nothing ends.

    Such a note lasts until another note of its channel begins. Where none does, it lasts as long
    as the score.
    """
    held = _held(messages)
    if not held:
        return list(messages)
    onsets: dict[int, list[int]] = defaultdict(list)  # of each channel, ticks
    for tick, message, _ in messages:
        if _begins(message):
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


def _begins(message: mido.Message) -> bool:
    return bool(message.type == "note_on" and message.velocity > 0)


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
        elif kind == "control_change" and _ends_all(message.control):
            held[message.channel].clear()
    held.pop(PERCUSSION, None)
    return [placed for notes in held.values() for placed in notes.values()]


def _ends_all(control: int) -> bool:
    return control == ALL_SOUND_OFF or control >= ALL_NOTES_OFF
