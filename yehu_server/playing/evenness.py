"""Evens out the loudness of notes, which the body radiates differently."""

from __future__ import annotations

from collections.abc import Callable

from yehu_server.playing.calibration import OPEN_NOTES
from yehu_server.playing.fingering import Fingering
from yehu_server.playing.intonation import Intonation
from yehu_server.playing.ownership import Ownership

# A gain that rises slowly does not amplify the end of a loud note before.
RISING_MS, FALLING_MS = 90.0, 15.0


class Evenness:
    """Sets ``/output/balance`` for each pitch.

    Parameters
    ----------
    wish : callable
        Returns the present value of a parameter of the player.
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
        """Set the gain for a pitch (fractional MIDI note), scaled by ``/body/evenness``.

        Parameters
        ----------
        fingering : Fingering, optional
            None before the first note, where the inner string is open.
        speed : float
            Bow speed (m/s).
        """
        string = 0 if fingering is None else fingering.string
        is_open = fingering is None or fingering.position is None
        heard = float(OPEN_NOTES[string]) if is_open else pitch
        balance = self._intonation.balance_db(string, heard, speed)
        balance *= self._wish("/body/evenness")
        ramp_ms = RISING_MS if balance > self._balance else FALLING_MS
        self._balance = balance
        self._own.move("/output/balance", balance, frame, ramp_ms)
