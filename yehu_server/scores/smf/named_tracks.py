"""Names of the parts of a MIDI file: those of its tracks, else of channels."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from yehu_server.scores.score import ScorePart


def parts_of_tracks(places: set[tuple[int, int]], names: dict[int, str]) -> tuple[ScorePart, ...]:
    """Name the parts of a MIDI file: its tracks with notes, or the channels of a single one.

    Parameters
    ----------
    places : set of (int, int)
        Tracks and channels that have notes.
    names : dict
        Of tracks, as far as they have one.
    """
    if not places:
        return ()
    tracks = sorted({track for track, _ in places})
    if len(tracks) > 1:
        found = [
            ScorePart(names.get(track) or _unnamed(track, places), track=track) for track in tracks
        ]
    else:
        channels = sorted({channel for _, channel in places})
        alone = names.get(tracks[0], "") if len(channels) == 1 else ""
        found = [
            ScorePart(alone or f"channel {channel + 1}", channel=channel) for channel in channels
        ]
    counts = Counter(part.name for part in found)
    return tuple(
        replace(part, name=f"{part.name} ({part.track})") if counts[part.name] > 1 else part
        for part in found
    )


def _unnamed(track: int, places: set[tuple[int, int]]) -> str:
    own = {channel for each, channel in places if each == track}
    others = {channel for each, channel in places if each != track}
    is_alone = len(own) == 1 and own.isdisjoint(others)
    return f"channel {min(own) + 1}" if is_alone else f"track {track}"
