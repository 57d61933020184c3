"""The bowings that practising tries for a note, beside the best that it knows so far."""

from collections.abc import Iterable, Iterator
from typing import Any

from yehu_server.core.physics.elementary import log
from yehu_server.core.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    AT_LIGHT,
    BOW_POSITIONS,
    DISTANCE_FACTOR,
    FIRST_NOTE,
    MIN_PRESS,
    TOP_SPEED,
    default_bowing_table,
)
from yehu_server.params.table import find

Array = Any

DEFAULT = BOW_POSITIONS.index(find("/playing/bow_position").default)  # practised first
# Distances of the bow from the bridge, relative to those asked for; on the F string at the default
# place, too.
FARTHERS = ((0.7, 0.85, 1.0, 1.2, 1.45, 1.75), (0.75, 0.87, 1.0, 1.15))
DEFAULT_FARTHERS = ((1.0, 1.15, 1.3, 1.5, 1.7), (0.87, 1.0, 1.15))
SHARES, FIRMEST = (0.75, 1.0, 1.35, 1.8, 2.3), (1.2, 3.5)
TOP_SPEEDS, PRESSES = (0.08, 0.1, 0.13, 0.16, 0.2, 0.25, 0.6), (0.0, 3.0, 4.0)
FIRM_SHARES = (0.7, 0.85, 1.2)
FINE_FARTHERS, FINE_SHARES = (0.95, 1.0, 1.05), (0.88, 1.0, 1.13)
FLAUTANDO_SHARES = (1.0, 1.3, 1.6, 2.0, 2.4)
NEAREST, FARTHEST = 0.055, 0.36  # bow positions
AWAY, CHANGED = 0.05, 0.02  # lost for moving the bow by a factor of e, and its share


def elsewhere(best: Array, string: int, place: int) -> Iterator[Array]:
    """The bow at other places, with other shares of Schelleng's limit."""
    farthers = (DEFAULT_FARTHERS if place == DEFAULT else FARTHERS)[string]
    asked = (BOW_POSITIONS[place] * farther for farther in farthers)
    return _varied(best, string, place, {*asked, *_near(best, place)}, SHARES)


def slower(best: Array, _string: int, _place: int) -> Iterator[Array]:
    """Other highest speeds."""
    return (changed(best, TOP_SPEED, speed) for speed in TOP_SPEEDS)


def pressed(best: Array, _string: int, _place: int) -> Iterator[Array]:
    """Other fingers."""
    return (changed(best, MIN_PRESS, press) for press in PRESSES)


def firmer(best: Array, _string: int, _place: int) -> Iterator[Array]:
    """Other shares for a firm bow alone."""
    return (changed(best, AT_FIRM, best[AT_FIRM] * share) for share in FIRM_SHARES)


def nearby(best: Array, string: int, place: int) -> Iterator[Array]:
    """The bow, and its shares, close to the best."""
    return _varied(best, string, place, _near(best, place), FINE_SHARES)


ROUNDS = (elsewhere, slower, pressed, firmer, nearby)  # tried one after another


def lighter(usual: Array) -> Iterator[tuple[Array, float]]:
    """Other shares for flautando, and what each loses for being another."""
    for share in FLAUTANDO_SHARES:
        yield changed(usual, AT_FLAUTANDO, usual[AT_FLAUTANDO] * share), CHANGED * log(share)


def moved(table: Array, string: int, note: int, place: int) -> Array:
    """The bowing of a note at the default place, with the bow moved to another.

    On the F string it moves as far as ordinarily.
    """
    bowing = table[string, DEFAULT, note - FIRST_NOTE].copy()
    ordinary = default_bowing_table()[string, :, note - FIRST_NOTE, DISTANCE_FACTOR]
    bowing[DISTANCE_FACTOR] *= ordinary[place] / ordinary[DEFAULT]
    farthest = FARTHEST / BOW_POSITIONS[place]
    bowing[DISTANCE_FACTOR] = min(
        max(bowing[DISTANCE_FACTOR], NEAREST / BOW_POSITIONS[place]), farthest
    )
    return bowing


def lost(bowing: Array, usual: Array) -> float:
    """What a bowing loses for its distance from the usual one."""
    away = abs(log(bowing[DISTANCE_FACTOR] / usual[DISTANCE_FACTOR]))
    return AWAY * away + CHANGED * abs(log(bowing[AT_LIGHT] / usual[AT_LIGHT]))


def changed(bowing: Array, column: int, value: float) -> Array:
    """A bowing with another value."""
    other = bowing.copy()
    other[column] = value
    return other


def _near(best: Array, place: int) -> list[float]:
    """Bow positions close to that of a bowing."""
    return [BOW_POSITIONS[place] * best[DISTANCE_FACTOR] * near for near in FINE_FARTHERS]


def _varied(
    best: Array, string: int, place: int, positions: Iterable[float], shares: Iterable[float]
) -> Iterator[Array]:
    """A bowing with the bow elsewhere and other shares of Schelleng's limit."""
    for position in sorted(positions):
        if not NEAREST <= position <= FARTHEST:
            continue
        for share in shares:
            other = changed(best, DISTANCE_FACTOR, position / BOW_POSITIONS[place])
            other[[AT_FLAUTANDO, AT_LIGHT, AT_FIRM]] *= share
            other[AT_FIRM] = min(other[AT_FIRM], FIRMEST[string])
            yield other
