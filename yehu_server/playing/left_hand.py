"""The left hand: four fingers that stop the strings, step, slide, press and play vibrato.

A step puts the next finger down while the one before still holds, and then lifts that, so that
the string is never open in between. A slide moves the finger that is down.
"""

from __future__ import annotations

from collections.abc import Callable

from yehu_server.params.table import FINGERS
from yehu_server.playing.bowing import manner
from yehu_server.playing.fingering import Fingering
from yehu_server.playing.ownership import Ownership

# Ramps of finger force. Chosen by trying landings of 1 to 5 ms and lifts of 3 to 25 ms on 24 steps
# up and down both strings; half of these are within 10 cents of their pitch after 21 ms
# (scripts/playability.py legato tries more).
LANDING_MS, LIFTING_MS = 3.0, 5.0
# A position nearer than this is reached by a slide, as no second finger fits beside the first.
NEAREST_STEP = 2e-3  # m
SETTLING_MS = 8.0


class LeftHand:
    """Moves the fingers, and keeps the present fingering.

    Parameters
    ----------
    wish : callable
        Returns the present value of a parameter under ``/playing``.
    """

    def __init__(self, own: Ownership, wish: Callable[[str], float]) -> None:
        self._own = own
        self._wish = wish
        self._finger = len(FINGERS) - 1  # so that the first finger comes first
        self._pressing = 0.0
        self.fingering: Fingering | None = None

    @property
    def side(self) -> float:
        """The value of ``/bow/side`` that bows the string of the fingering; 0 without one."""
        return self.fingering.side if self.fingering else 0.0

    def stop(
        self,
        fingering: Fingering,
        frame: int | None,
        *,
        pitch: float | None = None,
        slide_ms: float | None = None,
    ) -> None:
        """Stop a string, or leave it open.

        Parameters
        ----------
        pitch : float
            The sounding pitch (fractional MIDI note), which may need a larger finger force.
        slide_ms : float
            Time in which the finger that is down slides there; None for a step.
        """
        before = None if self.fingering is None else self.fingering.position
        self.fingering = fingering
        position = fingering.position
        if position is None or before is None:
            if position is not None:
                self._land(position, frame)
            self.press(frame, pitch)
            return
        if slide_ms is None and abs(position - before) < NEAREST_STEP:
            slide_ms = SETTLING_MS
        if slide_ms is not None:
            self._own.move(self._address("position"), position, frame, slide_ms)
            self.press(frame, pitch)
            return
        lifted = self._address("press")
        self._land(position, frame)
        self.press(frame, pitch)
        self._own.move(lifted, 0.0, frame, LIFTING_MS)

    def press(self, frame: int | None, pitch: float | None = None) -> None:
        """Set the wished finger force, or lift the finger where the string is open."""
        is_down = self.fingering is not None and self.fingering.position is not None
        press = self._wish("/playing/press") if is_down else 0.0
        if is_down and pitch is not None:
            press = max(press, manner(pitch).press)
        if press != self._pressing or press > 0.0:
            self._own.move(
                self._address("press"), press, frame, LANDING_MS if press else LIFTING_MS
            )
        self._pressing = press

    def leave(self, frame: int | None) -> None:
        """Lift all fingers, also those that a direct write put down."""
        self.fingering, self._pressing = None, 0.0
        for number in FINGERS:
            self._own.take_back(f"/finger/{number}/press")
            self._own.move(f"/finger/{number}/press", 0.0, frame, LIFTING_MS)

    def rock(self, frame: int | None) -> None:
        """Set depth and rate of the vibrato as wished."""
        self._own.move("/vibrato/depth", self._wish("/playing/vibrato"), frame)
        self._own.move("/vibrato/press", self._wish("/playing/vibrato_press"), frame)
        self._own.move("/vibrato/rate", self._wish("/playing/vibrato_rate"), frame)

    def begin_rocking(self, frame: int | None) -> None:
        """Fade in the vibrato of a new note, in ``/playing/vibrato_delay``."""
        delay_ms = self._wish("/playing/vibrato_delay")
        self._own.move("/vibrato/onset", 0.0 if delay_ms > 0.0 else 1.0, frame, 0.0)
        if delay_ms > 0.0:
            self._own.move("/vibrato/onset", 1.0, frame, delay_ms)

    def _land(self, position: float, frame: int | None) -> None:
        """Put the next finger over a position (m)."""
        self._finger = (self._finger + 1) % len(FINGERS)
        self._pressing = 0.0
        self._own.move(self._address("position"), position, frame, 0.0)

    def _address(self, what: str) -> str:
        return f"/finger/{FINGERS[self._finger]}/{what}"
