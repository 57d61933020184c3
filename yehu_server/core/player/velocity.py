"""What velocity does to a note: its loudness, evened out, by bow and by gain; its attack. Compiled.

At NEUTRAL_VELOCITY all is as the other parameters say. A harder note is bowed faster and gets its
force sooner than its speed; a softer one begins gently. Force is not set here: mappings bind
velocity to /playing/pressure (mappings/keyboard.toml). With that, the level rises by some 18 dB
from 1 to 127 (scripts/playability.py velocity).
"""

from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.player.brilliance import set_brilliance
from yehu_server.core.player.ear import HOP_S
from yehu_server.core.player.fingering import OPEN
from yehu_server.core.player.intonation import balance_db
from yehu_server.core.player.ownership import move_parameter
from yehu_server.core.player.parameter_indices import BODY, OUTPUT, PLAYING
from yehu_server.params.table import find

# A gain that rises slowly does not amplify the end of a loud note before; with the bow off the
# string there is none.
RISING_MS, FALLING_MS = 90.0, 15.0


@compiled_exactly
def set_loudness_balance(p: Any, c: Any, pitch: float, speed: float, effort: float) -> None:
    """Set colour and ``/output/balance`` for a pitch (fractional MIDI note).

    `speed` (m/s) is the bow's; `effort` (m/s) is it times its share of Schelleng's limit.
    """
    string = max(p.string, 0)  # before the first note the inner string is open
    sounding_pitch = pitch
    if p.position == OPEN:
        sounding_pitch = p.open_note[string]
    set_brilliance(p, c, string, sounding_pitch, effort)
    balance = balance_db(p, string, sounding_pitch, speed) - p.louder_by
    balance *= p.value[BODY.evenness]
    balance += 0.0 if p.is_direct != 0 else struck_db(p) + p.gesture.gain_db
    is_off = c.value[SLOTS.bow_side] == 0.0 and p.is_direct == 0
    ramp_ms = RISING_MS if balance > p.balance and not is_off else FALLING_MS
    if p.gesture.gain_db != p.gesture.gain_to and has_risen(p, c):  # it goes on in small steps
        ramp_ms = 1e3 * HOP_S
    p.balance = balance
    move_parameter(p, c, OUTPUT.balance, balance, ramp_ms)


@compiled_exactly
def has_risen(p: Any, c: Any) -> bool:
    """Whether a gain that rose as the note began has come to its end."""
    return bool(c.frame - p.note_began >= 1e-3 * RISING_MS * p.rate)


NEUTRAL_VELOCITY = find("/playing/velocity").default
# At velocities of 0 and 1, by ear: gain (dB); factors on bow speed, time of attack and, above
# NEUTRAL_VELOCITY, pressure during the attack.
SOFT_DB, HARD_DB = -10.5, 3.7
SOFT_SPEED, HARD_SPEED = 0.6, 1.2
SOFT_ATTACK, HARD_ATTACK = 1.75, 0.6
HARD_ATTACK_PRESSURE, ATTACK_PRESSURE_MS = 1.3, 60.0


@compiled_exactly
def between(p: Any, softest: float, neutral: float, hardest: float) -> float:
    """A value at the velocity of the note, from those at 0, NEUTRAL_VELOCITY and 1."""
    velocity = p.value[PLAYING.velocity]
    if velocity < NEUTRAL_VELOCITY:
        return float(
            neutral + (softest - neutral) * (NEUTRAL_VELOCITY - velocity) / NEUTRAL_VELOCITY
        )
    return float(
        neutral + (hardest - neutral) * (velocity - NEUTRAL_VELOCITY) / (1.0 - NEUTRAL_VELOCITY)
    )


@compiled_exactly
def struck_db(p: Any) -> float:
    """Gain (dB) of the note."""
    return between(p, SOFT_DB, 0.0, HARD_DB)


@compiled_exactly
def struck_speed(p: Any) -> float:
    """Factor on the bow's speed."""
    return between(p, SOFT_SPEED, 1.0, HARD_SPEED)


@compiled_exactly
def struck_attack(p: Any) -> float:
    """Factor on the time of the attack."""
    return between(p, SOFT_ATTACK, 1.0, HARD_ATTACK)


@compiled_exactly
def attack_pressure_factor(p: Any) -> float:
    """Factor on the bow's pressure as a stroke begins."""
    return between(p, 1.0, 1.0, HARD_ATTACK_PRESSURE)
