"""Read the keys of a MIDI file that a mapping takes as key switches: they play no notes."""

from collections.abc import Collection
from dataclasses import replace

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.scores.score import Score, ScoreEvent, Setting, notes_of
from yehu_server.scores.slides import ARTICULATION


def with_key_switches(score: Score, first: int | None, channels: Collection[int]) -> Score:
    """Return a score whose keys from `first` (MIDI note) on choose articulations.

    They become settings, so that nothing takes them for notes; parts of them alone are none. None:
    there are no such keys. Other channels than `channels` stay as they are.
    """
    if first is None:
        return score
    events, is_any = [], False
    for event in score.events:
        message = event.message
        is_key = message.type in ("note_on", "note_off") and message.channel in channels
        if not (is_key and 0 <= message.note - first < len(ARTICULATIONS)):
            events.append(event)
            continue
        is_any = True
        if message.type == "note_on" and message.velocity > 0:
            chosen = Setting(ARTICULATION, float(message.note - first), message.channel)
            events.append(ScoreEvent(event.time_s, chosen, event.beat, event.track))
    if not is_any:
        return score
    read = replace(score, events=tuple(events))
    sounding = {(note.channel, read.events[note.begins].track) for note in notes_of(read)}
    parts = [
        part
        for part in score.parts
        if any(part.channel in (c, None) and part.track in (t, None) for c, t in sounding)
    ]
    return replace(read, parts=tuple(parts))
