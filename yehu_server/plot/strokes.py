"""The strokes of a written part, as the player bows it: found by letting it play.

What a score says of its strokes is not all: a bow has a length, so that the player draws it the
other way where a note needs more hair than is left, and turns it within a long one; and phrasing
joins short plain notes.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import RIG
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import part_specs
from yehu_server.playing.stringing import notes_of as range_of
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import PartPlayer
from yehu_server.scores.phrasing import PHRASING
from yehu_server.scores.score import Score
from yehu_server.scores.written.mark_settings import actives_of, is_plucked
from yehu_server.scores.written.notated import Written
from yehu_server.scores.written.part_bowing import Played, bowed
from yehu_server.scores.written.performed import performed
from yehu_server.scores.written.tempo import WrittenClock

BLOCK = 64  # frames between two readings of the bow
MAX_TURNS = 2  # of a note that are counted: more are a tremolo
SOONER_S = 1e-6


@dataclass(frozen=True)
class Stroke:
    """Notes on one bow, by their numbers, both included, and its direction; 0: plucked.

    `turns` are the directions in which it goes on where it comes to the bow's end.
    """

    first: int
    last: int
    direction: float
    turns: tuple[float, ...] = ()


def strokes_of(
    written: Written, number: int, quantities: Quantities | None = None, phrasing: float = PHRASING
) -> list[Stroke]:
    """Return the strokes of a part, counted from 0, that is in range, as `render` has them."""
    quantities = quantities or Quantities()
    part = written.parts[number]
    actives = actives_of(part)
    played = bowed(part, actives, WrittenClock(written))
    playing = PlayingOptions(quantities=quantities, phrasing=phrasing)
    whole = Part.shaped([performed(written, [number], range_of(quantities))], playing)
    directions = list(_directions(whole, Options.rate, played))
    slurred = _slurred(whole.score, played)
    found: list[Stroke] = []
    for at, each in enumerate(played):
        first, *turns = directions[at]
        before = played[at - 1].direction if at else 0.0
        goes_on = slurred[at] or (each.direction and each.direction == before)
        if is_plucked(each.note, actives[at]):
            found.append(Stroke(at, at, 0.0))
        elif goes_on and found and first == (found[-1].turns or (found[-1].direction,))[-1]:
            found[-1] = replace(found[-1], last=at, turns=(*found[-1].turns, *turns))
        else:
            found.append(Stroke(at, at, first, tuple(turns)))
    return found


def _slurred(score: Score, played: Sequence[Played]) -> list[bool]:
    """Whether each note begins while the one before it sounds."""
    notes = sorted(score.notes, key=lambda note: note.start_s)
    found, place, end_s = [], 0, 0.0
    for each in played:
        while place < len(notes) and notes[place].start_s < each.begin_s - SOONER_S:
            end_s = max(end_s, notes[place].end_s)
            place += 1
        found.append(end_s > each.begin_s + SOONER_S)
    return found


def _directions(part: Part, rate: int, played: Sequence[Played]) -> Iterator[list[float]]:
    """Play a part, and yield in which directions the bow goes at each note, in turn."""
    calibration = part.playing.calibration(float(rate))
    specs = part_specs(part.playing, float(rate), calibration, number=0)
    instruments = [Instrument(spec) for spec in specs]
    player, first = PartPlayer(part, instruments), instruments[0]
    rig = np.frombuffer(first.memory, RIG, count=1)[0]
    bows: list[float] = []  # after each block
    samples = np.zeros(BLOCK, np.float32)
    for at, each in enumerate(played):
        end_s = min([each.end_s, *(after.begin_s for after in played[at + 1 : at + 2])])
        begin = first.frames(1e3 * each.begin_s) // BLOCK
        end = max(first.frames(1e3 * end_s) // BLOCK, begin + 1)
        while len(bows) < end:
            player.play_before((len(bows) + 1) * BLOCK)
            first.process(samples)
            bows.append(float(rig["player"]["direction"]))
        own = [direction for direction, _ in groupby(bows[begin:end])]
        yield own if len(own) <= 1 + MAX_TURNS else own[:1]
