"""Find the keys of a MIDI file that are key switches, of a mapping or of another library."""

from collections import defaultdict
from collections.abc import Collection
from dataclasses import replace
from itertools import pairwise

from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import ScoreError
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.scores.score import Score, ScoreEvent, ScoreNote, Setting, without_notes
from yehu_server.scores.slides import ARTICULATION

FAR = 12  # semitones


def with_key_switches(score: Score, first: int | None, channels: Collection[int]) -> Score:
    """Return a score whose keys from `first` (MIDI note) on choose articulations.

    They become settings, so that nothing takes them for notes, and a remark counts them; parts of
    them alone are none. None: there are no such keys. Other channels than `channels` stay as they
    are. Raises ScoreError where no other note is left.
    """
    if first is None:
        return score
    events: list[ScoreEvent] = []
    taken: list[float] = []
    for event in score.events:
        message = event.message
        is_key = message.type in ("note_on", "note_off") and message.channel in channels
        if not (is_key and 0 <= message.note - first < len(ARTICULATIONS)):
            events.append(event)
            continue
        if message.type == "note_on" and message.velocity > 0:
            taken.append(float(message.note - first))
            chosen = Setting(ARTICULATION, taken[-1], message.channel)
            events.append(ScoreEvent(event.time_s, chosen, event.beat, event.track))
    if not taken:
        return score
    remark = f"notes taken as key switches: {len(taken)} (articulations: {len({*taken})})"
    read = replace(score, events=tuple(events), remarks=(*score.remarks, remark))
    if not read.notes:
        raise ScoreError(f"has no other note: {remark}")
    sounding = {(note.channel, note.track) for note in read.notes}
    parts = [
        part
        for part in score.parts
        if any(part.channel in (c, None) and part.track in (t, None) for c, t in sounding)
    ]
    return replace(read, parts=tuple(parts))


def low_keys(score: Score, channels: Collection[int], within: NoteRange = YEHU) -> list[ScoreNote]:
    """The notes that seem to be key switches of another library.

    They are below the range, and an octave or more below all others of their channel and track.
    """
    places: dict[tuple[int, int], list[ScoreNote]] = defaultdict(list)
    for note in score.notes:
        if note.channel in channels:
            places[note.channel, note.track].append(note)
    found: list[ScoreNote] = []
    for notes in places.values():
        ends = pairwise(sorted({note.key for note in notes}))
        gaps = [low for low, high in ends if high - low >= FAR and low < within.lowest]
        low = [note for note in notes if gaps and note.key <= gaps[-1]]
        found += low if 2 * len(low) <= len(notes) else []
    return found


def without_low_keys(score: Score, channels: Collection[int], within: NoteRange) -> Score:
    """A score without its `low_keys`, and a remark that counts them."""
    low = low_keys(score, channels, within)
    if not low:
        return score
    remark = f"notes far below the tune left out, as key switches: {len(low)}"
    return replace(without_notes(score, low), remarks=(*score.remarks, remark))
