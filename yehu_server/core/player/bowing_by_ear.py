"""Corrects the bow's pressure so that the string keeps speaking, and remembers it. Compiled.

A string that slips more than once in a period has too light a bow, one without a period too heavy
a one. The hand leans more or less, in steps, until the string speaks: never where the player
scratches or plays tremolo, and only a little where the bow is to be light. From a string that
slips twice in each period it goes nearer to the bridge for a moment.
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player.bowing import FIRM, FLAUTANDO, SCRATCHY
from yehu_server.core.player.ear import PITCH_CERTAINTY, learning_bin
from yehu_server.core.player.gestures import tremolo_of
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.core.player.right_hand import set_bow_pressure

FEW_SLIPS, MANY_SLIPS = 0.6, 1.5  # slips in a period: between them the string speaks
MIN_CERTAINTY = 0.8  # below it the sound has no period
FAULT_HOPS = 12  # hearings of the same fault before the hand acts
JUDGE_AFTER_HOPS = 8  # hearings until it judges what it did
EASE_AFTER_HOPS = 16  # hops in Helmholtz motion before the correction is halved
# Slips in a period of a string that sounds an octave up. No force ends that: of notes that began so
# far from the bridge (E5, A5) none of 6 stayed so after the bow had gone nearer by this factor, two
# after a slower stroke, four under 1.8 times the force. For how many hearings it lasts before.
TWICE, NEARER, TWICE_HOPS = (1.7, 2.3), 0.82, 4
HEAVIER_STEP, LIGHTER_STEP = 1.25, 0.8  # steps of the factor on the bow's pressure
MIN_PRESSURE_FACTOR, MAX_PRESSURE_FACTOR, MAX_FLAUTANDO_FACTOR = 0.5, 1.8, 1.3
NEUTRAL_WITHIN = 0.05  # nearer to 1 than this the factor is 1
SPEAKS, TOO_LIGHT, TOO_HEAVY = 0, 1, 2


@compiled_exactly
def begin_pressure_correction(p: Any, pitch: float) -> None:
    """Begin a note with the pressure that it was learnt to need."""
    p.pressure_factor, p.fault, p.faults = 1.0, SPEAKS, 0
    p.spoken, p.eased_from, p.nearer = 0, 0.0, 1.0
    if may_correct_pressure(p):
        row, position_bin, speed_bin = learning_bin(p, p.string, pitch)
        known = p.learnt_pressure_factor[p.string, row, position_bin, speed_bin]
        p.pressure_factor = min(known, heaviest(p)) if known > 0.0 else 1.0
        p.eased_from = p.pressure_factor if known > 0.0 else 0.0


@compiled_exactly
def may_correct_pressure(p: Any) -> bool:
    """Whether the hand may help: not where it is to scratch or to tremble."""
    listens = p.value[PLAYING.listening] > 0.0 and p.corrects_pressure != 0
    return bool(listens and p.value[PLAYING.pressure] < SCRATCHY and tremolo_of(p) == 0.0)


@compiled_exactly
def heaviest(p: Any) -> float:
    """The largest factor on the bow's pressure."""
    return MAX_FLAUTANDO_FACTOR if p.value[PLAYING.pressure] <= FLAUTANDO else MAX_PRESSURE_FACTOR


@compiled_exactly
def fault_of(p: Any) -> int:
    """Which fault the string has, as it is heard.

    Without a period and with many slips the bow may be either; then the command decides.
    """
    if p.ear.certainty < MIN_CERTAINTY and (
        p.ear.slips < MANY_SLIPS or p.value[PLAYING.pressure] > FIRM
    ):
        return TOO_HEAVY
    return TOO_LIGHT if p.ear.slips >= MANY_SLIPS else SPEAKS


@compiled_exactly
def slips_twice(p: Any) -> bool:
    """Whether the string slips twice in each period, and is heard an octave up."""
    return bool(TWICE[0] < p.ear.slips < TWICE[1] and p.ear.certainty > PITCH_CERTAINTY)


@compiled_exactly
def correct_pressure(p: Any, c: Any, pitch: float) -> None:
    """Change the pressure factor where the string has not spoken for FAULT_HOPS hops."""
    if not may_correct_pressure(p):
        return
    fault = fault_of(p)
    if fault == SPEAKS:
        p.faults = min(p.faults, 0)
        if p.nearer != 1.0 and p.ear.certainty > PITCH_CERTAINTY:
            p.nearer = 1.0
            set_bow_pressure(p, c, pitch, True)
        if (
            p.pressure_factor != 1.0
            and p.ear.certainty > PITCH_CERTAINTY
            and p.ear.slips > FEW_SLIPS
        ):
            p.spoken += 1
            if p.spoken == EASE_AFTER_HOPS:
                ease_or_learn(p, c, pitch)
        return
    p.spoken = 0
    p.faults = p.faults + 1 if fault == p.fault or p.faults < 0 else 1
    p.fault = fault
    if p.faults >= TWICE_HOPS and p.nearer == 1.0 and slips_twice(p):
        p.nearer = NEARER
        set_bow_pressure(p, c, pitch, True)
    if p.faults < FAULT_HOPS:
        return
    p.faults = FAULT_HOPS - JUDGE_AFTER_HOPS
    was_eased = p.eased_from > 0.0
    if was_eased and p.pressure_factor != p.eased_from:
        p.pressure_factor = p.eased_from  # it needs all of the help
    elif fault == TOO_LIGHT:
        p.pressure_factor = min(p.pressure_factor * HEAVIER_STEP, heaviest(p))
    else:
        p.pressure_factor = max(p.pressure_factor * LIGHTER_STEP, MIN_PRESSURE_FACTOR)
    p.eased_from = p.pressure_factor if was_eased else 0.0
    set_bow_pressure(p, c, pitch, True)


@compiled_exactly
def ease_or_learn(p: Any, c: Any, pitch: float) -> None:
    """Once, reduce the correction to its square root: the attack alone may have needed it.

    If the string then fails again, it is restored; if not, it is learnt.

    What the string still speaks with, or could not do without, is remembered.
    """
    if p.eased_from == 0.0:
        p.eased_from = p.pressure_factor
        p.pressure_factor = math.sqrt(p.pressure_factor)
        p.pressure_factor = (
            1.0 if abs(p.pressure_factor - 1.0) < NEUTRAL_WITHIN else p.pressure_factor
        )
        p.spoken = 0
        set_bow_pressure(p, c, pitch, True)
        return
    row, position_bin, speed_bin = learning_bin(p, p.string, pitch)
    p.learnt_pressure_factor[p.string, row, position_bin, speed_bin] = p.pressure_factor
