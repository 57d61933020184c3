"""How loud a note is beside the others: what the body makes of it, turned up or down."""

from __future__ import annotations

from collections.abc import Callable

from yehu_server.playing.calibration import OPEN_NOTES
from yehu_server.playing.fingering import Fingering
from yehu_server.playing.intonation import Intonation
from yehu_server.playing.ownership import Ownership

# A loud note before a soft one has to die away before it may be turned up.
RISING_MS, FALLING_MS = 90.0, 15.0


class Evenness:
    """Moves ``/output/balance`` from pitch to pitch.

    Parameters
    ----------
    wish : callable
        The present value of a parameter of the player.
    """

    def __init__(
        self, own: Ownership, intonation: Intonation, wish: Callable[[str], float]
    ) -> None:
        self._own = own
        self._intonation = intonation
        self._wish = wish
        self._balance = 0.0  # dB

    def follow(
        self, fingering: Fingering | None, pitch: float, speed: float, frame: int | None
    ) -> None:
        """Let a pitch (fractional MIDI note) be as loud as the others, as far as asked.

        `fingering` is None where no finger was chosen yet, so that the inner string is open;
        `speed` is the bow's (m/s).
        """
        string = 0 if fingering is None else fingering.string
        is_open = fingering is None or fingering.position is None
        heard = float(OPEN_NOTES[string]) if is_open else pitch
        balance = self._intonation.balance_db(string, heard, speed)
        balance *= self._wish("/body/evenness")
        ramp_ms = RISING_MS if balance > self._balance else FALLING_MS
        self._balance = balance
        self._own.move("/output/balance", balance, frame, ramp_ms)
