"""What each player of a section has a value of its own of: a seed, a gain, a seat. Compiled."""

from __future__ import annotations

import math

import numpy as np

from yehu_server.jit import compiled_exactly
from yehu_server.player.rows import HIGHEST, LOWEST, ROW

SEED, GAIN, PAN, DISTANCE = "/engine/seed", "/output/gain", "/room/pan", "/room/distance"
OWN = (SEED, GAIN, PAN, DISTANCE)
SEED_ROW, GAIN_ROW, PAN_ROW, DISTANCE_ROW = (ROW[address] for address in OWN)
SEEDS = 1 << 16
APART = 7919  # seeds of two players; a prime, so that they meet no other section's soon

# Seats: in two rows, so far before and behind the part's own distance, alike on both sides; from
# left to right, neighbours so far apart, all of them no more than to either side of the part's
# own place.
FRONT, BACK = 0.87, 1.15
NEIGHBOUR, TO_EITHER_SIDE = 0.12, 0.35


@compiled_exactly
def own_value(row: int, value: float, number: int, people: int) -> float:
    """The value that a player has of a parameter, of what their part has.

    All of them together are as loud as one alone.

    Parameters
    ----------
    row : int
        Of the parameter; -1 for none.
    number : int
        The player, counted from 0.
    people : int
        How many of them play.
    """
    if row == SEED_ROW:
        return float((int(np.rint(value)) + APART * number) % SEEDS)
    if people == 1:
        return value
    if row == GAIN_ROW:
        own = value - 10.0 * math.log10(people)
        return float(min(max(own, LOWEST[GAIN_ROW]), HIGHEST[GAIN_ROW]))
    if row == DISTANCE_ROW:
        from_outside = min(number, people - 1 - number)
        factor = BACK if from_outside % 2 != 0 else FRONT
        own = value * (factor if people > 2 else 1.0)
        return float(min(max(own, LOWEST[DISTANCE_ROW]), HIGHEST[DISTANCE_ROW]))
    if row == PAN_ROW:
        side = min(0.5 * NEIGHBOUR * (people - 1), TO_EITHER_SIDE)
        middle = min(max(value, side - 1.0), 1.0 - side)
        return float(middle + side * (2.0 * min(number, people - 1) / (people - 1) - 1.0))
    return value
