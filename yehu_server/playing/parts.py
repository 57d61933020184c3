"""The players of all parts, each with its instruments and its places on the stage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import MOST_PARTS
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.calibration import Calibration
from yehu_server.errors import ParameterError
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.player import Player
from yehu_server.playing.section_instruments import part_specs, section_size

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


def number_of_instruments(per_part: Sequence[PlayingOptions]) -> int:
    """How many instruments some parts take; raises ParameterError where a stage has fewer."""
    count = sum(map(section_size, per_part))
    if count > MOST_PARTS:
        raise ParameterError(f"{count} players, of all parts and sections: at most {MOST_PARTS}")
    return count


def seated(per_part: Sequence[PlayingOptions]) -> list[PlayingOptions]:
    """Options with a default pan and seed for each part; values that they set themselves win."""
    own, number = [], 0
    for playing, place in zip(per_part, places(len(per_part)), strict=True):
        seed = (playing.seed + number) % SEEDS
        own.append(replace(playing, start=(*place, *playing.start), seed=seed))
        number += section_size(playing)
    return own


def assemble(
    per_part: Sequence[PlayingOptions],
    rate: float,
    tuned: Sequence[Calibration],
    *,
    memory: Any,
    has_room: bool,
) -> tuple[Ensemble, list[Sequence[Instrument]]]:
    """Make the instruments of all parts, on a stage; return them by part, too.

    `per_part`: those of `seated`, one for each part.
    `tuned`: the calibration of each part's instrument.
    `memory`: see `Ensemble`.
    """
    specs: list[InstrumentSpec] = []
    ends = []
    for playing, calibration in zip(per_part, tuned, strict=True):
        specs += part_specs(playing, rate, calibration, number=len(specs))
        ends.append(len(specs))
    ensemble = Ensemble(specs, has_room=has_room, memory=memory, is_live=True)
    begins = [0, *ends]
    return ensemble, [ensemble.instruments[a:b] for a, b in zip(begins, ends, strict=False)]


def player_of(
    part: int, playing: PlayingOptions, instruments: Sequence[Instrument], *, delay_ms: float
) -> Player:
    """The player of a part, counted from 0, on all of its instruments.

    `delay_ms`: from the arrival of a message to its sound.
    """
    instruments[0].delay = instruments[0].frames(delay_ms)
    return playing.mapped(playing.player(instruments, part))
