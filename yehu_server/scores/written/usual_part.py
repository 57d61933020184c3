"""Which part of a written score plays where none is asked for."""

from __future__ import annotations

from yehu_server.scores.melodic import melodic_part
from yehu_server.scores.written.in_range import sounding
from yehu_server.scores.written.notated import Written


def usual_parts(written: Written) -> list[int]:
    """The number, from 0, of the part that carries the tune, if any has notes."""
    parts = [[sounding(note) for note in part.notes] for part in written.parts]
    tune = melodic_part(written.names, parts)
    return [] if tune is None else [tune]
