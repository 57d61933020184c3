"""The players of all parts, each with its instruments and its places on the stage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import MOST_PARTS
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.calibration import Calibration
from yehu_server.errors import ParameterError
from yehu_server.playing.live_player import LivePlayer
from yehu_server.playing.section_instruments import part_specs, section_size
from yehu_server.playing.style import Style

WIDEST = 0.7  # pan of the outermost players; by ear: the room stays around them


def places(parts: int) -> list[tuple[tuple[str, float], ...]]:
    """The start values of parameters, by address, that place each of some players.

    They sit side by side from left to right, in the order of the parts; one alone in the middle.
    """
    if parts == 1:
        return [()]
    step = 2.0 * WIDEST / (parts - 1)
    return [(("/room/pan", part * step - WIDEST),) for part in range(parts)]


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
    """Styles with a default pan and seed for each part; values that a style sets itself win."""
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
