"""The players of all parts, each with the instruments it plays: one, or those of a section."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from yehu_server.engine.ensemble import Ensemble
from yehu_server.engine.instrument import Instrument
from yehu_server.engine.rig import MOST_PARTS
from yehu_server.engine.spec import InstrumentSpec
from yehu_server.errors import ParameterError
from yehu_server.player.calibration import Calibration
from yehu_server.playing.live import LivePlayer
from yehu_server.playing.places import places
from yehu_server.playing.section_people import part_specs, section_size
from yehu_server.playing.style import Style

SEEDS = 1 << 16


@dataclass(frozen=True)
class Part:
    """A part: its player, and the instruments that it plays."""

    player: LivePlayer
    instruments: Sequence[Instrument]


def number_of_instruments(styles: Sequence[Style]) -> int:
    """How many instruments the parts of some styles take.

    Raises
    ------
    ParameterError
        Where they are more than a stage has.
    """
    count = sum(map(section_size, styles))
    if count > MOST_PARTS:
        raise ParameterError(f"{count} players, of all parts and sections: at most {MOST_PARTS}")
    return count


def seated(styles: Sequence[Style]) -> list[Style]:
    """The same styles, with a place and a seed for each part; what they say themselves counts."""
    own, number = [], 0
    for style, place in zip(styles, places(len(styles)), strict=True):
        seed = (style.seed + number) % SEEDS
        own.append(replace(style, start=(*place, *style.start), seed=seed))
        number += section_size(style)
    return own


def assemble(
    styles: Sequence[Style],
    rate: float,
    calibration: Calibration,
    *,
    memory: Any,
    has_room: bool,
) -> tuple[Ensemble, list[Sequence[Instrument]]]:
    """Make the instruments of all parts, on a stage; return them by part, too.

    Parameters
    ----------
    styles : sequence of Style
        Those of `seated`, one for each part.
    memory : buffer
        See `Ensemble`.
    """
    specs: list[InstrumentSpec] = []
    ends = []
    for style in styles:
        specs += part_specs(style, rate, calibration, number=len(specs))
        ends.append(len(specs))
    ensemble = Ensemble(specs, has_room=has_room, memory=memory, is_live=True)
    begins = [0, *ends]
    return ensemble, [ensemble.instruments[a:b] for a, b in zip(begins, ends, strict=False)]


def player_of(
    part: int, style: Style, instruments: Sequence[Instrument], *, delay_ms: float
) -> LivePlayer:
    """The player of a part, counted from 0: its wishes go to all of its instruments."""
    wishes = style.wishes(instruments)
    return LivePlayer(instruments[0], style, delay_ms=delay_ms, part=part, wishes=wishes)
