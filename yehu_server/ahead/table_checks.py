"""Checks tables that a program gives, before compiled code indexes by them. Compiled.

The tables of ``midi.tables`` hold indices of parameters, and numbers of binds and points. Those
that Python writes are right; others could lead outside the arrays, or to values that are no
numbers.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import native
from yehu_server.compile.memory import WORD, carray
from yehu_server.core.midi.record import CHANNELS_PER_PORT
from yehu_server.core.midi.tables import (
    BEND,
    CONTROL,
    EXPONENTIAL,
    KEY_COUNT,
    MAX_BINDS,
    MAX_POINTS,
    NOTE,
    NRPN,
    PAIR,
    POINTS,
    SKIP,
    TABLES,
    Tables,
)
from yehu_server.core.player.parameter_indices import LOWER_BOUNDS, PARAMETER_COUNT, UPPER_BOUNDS

PAIRS, NRPNS = 32, 1 << 14
MAX = 1e9
TINY = 1e-200  # what a number of the tables divides by is larger
ANY, WHOLE, WHOLE_OR_NONE, ANY_OR_NONE = range(4)  # NaN stands for none
SWITCHES = ("invert", "soft", "by_range", "for_all", "mpe", "is_equal", "has_programs")
# What each field may hold: kind, lowest, highest.
FIELDS = {
    "binds": (WHOLE, 0, MAX_BINDS),
    "source": (WHOLE, 0, MAX),
    "first": (WHOLE, 0, MAX_BINDS - 1),
    "target": (WHOLE, 0, PARAMETER_COUNT - 1),
    "lo": (ANY, -MAX, MAX),
    "hi": (ANY, -MAX, MAX),
    "curve": (WHOLE, 0, POINTS),
    "first_point": (WHOLE, 0, MAX_POINTS),
    "points": (WHOLE, 0, MAX_POINTS),
    "smoothing_ms": (ANY, 0, MAX),
    "channels": (WHOLE, 0, (1 << CHANNELS_PER_PORT) - 1),
    "input_lo": (ANY, -1e307, 1e307),
    "input_hi": (ANY, -1e307, 1e307),
    "same": (ANY, -1e307, 1e307),
    "x": (ANY, 0, 1),
    "y": (ANY, 0, 1),
    "first_switch": (WHOLE_OR_NONE, 0, KEY_COUNT - 1),
    "starts": (WHOLE, 0, PARAMETER_COUNT),
    "start_row": (WHOLE, 0, PARAMETER_COUNT - 1),
    "start_value": (ANY, -MAX, MAX),
    "usual": (ANY, -MAX, MAX),
    "pitch": (ANY_OR_NONE, -MAX, MAX),
    "policy": (WHOLE, 0, SKIP),
    "lowest": (ANY, -MAX, MAX),
    "highest": (ANY, -MAX, MAX),
    "received": (WHOLE, -1, (1 << CHANNELS_PER_PORT) - 1),
    "has_program": (WHOLE, 0, 1),
    "program_row": (WHOLE_OR_NONE, 0, PARAMETER_COUNT - 1),
    "program_value": (ANY, -MAX, MAX),
    **dict.fromkeys(SWITCHES, (WHOLE, 0, 1)),
}


def checking_fields(rules: dict[str, tuple[int, float, float]]) -> Any:
    """Make the function `check_fields`, which closes over what fields may hold."""
    fields: Any = TABLES.fields
    begin = np.array([fields[name][1] // WORD for name in rules])
    end = begin + np.array([fields[name][0].itemsize // WORD for name in rules])
    kind = np.array([rule[0] for rule in rules.values()])
    lowest = np.array([float(rule[1]) for rule in rules.values()])
    highest = np.array([float(rule[2]) for rule in rules.values()])
    words = TABLES.itemsize // WORD

    def check_fields(tables: Any) -> int:
        """Return whether each number of some tables may be where it is."""
        numbers = carray(tables, (words,), np.float64)
        for field in range(len(begin)):
            is_whole = kind[field] in (WHOLE, WHOLE_OR_NONE)
            for place in range(begin[field], end[field]):
                number = numbers[place]
                if math.isnan(number) and kind[field] in (WHOLE_OR_NONE, ANY_OR_NONE):
                    continue
                if not lowest[field] <= number <= highest[field]:  # also refuses NaN
                    return 0
                if is_whole and number != math.floor(number):
                    return 0
        return 1

    return native(check_fields)


@native
def check_values(t: Tables) -> int:
    """Return whether values are within the ranges of their parameters, once each field is right."""
    for n in range(int(t.starts)):
        index = int(t.start_row[n])
        if not LOWER_BOUNDS[index] <= t.start_value[n] <= UPPER_BOUNDS[index]:
            return 0
    for index in range(PARAMETER_COUNT):
        usual = t.usual[index]
        if not LOWER_BOUNDS[index] <= usual <= UPPER_BOUNDS[index] or 0.0 < usual < TINY:
            return 0
    return 1


@native
def check_binds(t: Tables) -> int:
    """Return whether sources and targets of binds are right, once each field is."""
    for n in range(int(t.binds)):
        source, index = int(t.source[n]), int(t.target[n])
        is_change = source < KEY_COUNT or PAIR <= source < PAIR + PAIRS
        is_other = BEND <= source <= NOTE or NRPN <= source < NRPN + NRPNS or source >= CONTROL
        first = 0
        while int(t.source[first]) != source:
            first += 1
        if not (is_change or is_other) or int(t.first[n]) != first:
            return 0
        if (
            not LOWER_BOUNDS[index]
            <= min(t.lo[n], t.hi[n])
            <= max(t.lo[n], t.hi[n])
            <= UPPER_BOUNDS[index]
        ):
            return 0
    return 1


@native
def check_curves(t: Tables) -> int:
    """Return whether the curves of binds are right, once each field is."""
    for n in range(int(t.binds)):
        curve = int(t.curve[n])
        if curve == EXPONENTIAL and (min(t.lo[n], t.hi[n]) < TINY or t.by_range[n] != 0.0):
            return 0
        if curve != POINTS:
            continue
        begin, end = int(t.first_point[n]), int(t.first_point[n] + t.points[n])
        if end > MAX_POINTS or end - begin < 2:
            return 0
        if t.x[begin] != 0.0 or t.x[end - 1] != 1.0:
            return 0
        for point in range(begin + 1, end):
            if t.x[point] <= t.x[point - 1]:
                return 0
    return 1


check_fields = checking_fields(FIELDS)
CHECKS = (check_fields, check_values, check_binds, check_curves)
