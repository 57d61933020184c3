"""What applied commands move: the parameters of the engine, each at its frame."""

from typing import Any, NamedTuple

import numpy as np

from yehu_server.core.controls.slots import FINGER_POSITION, SLOTS
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.player.commands import apply
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.params.table import SLOT

BY_EAR = [*FINGER_POSITION, SLOTS.bow_pressure]
ADDRESSES = {slot: address for address, slot in SLOT.items()}


class Move(NamedTuple):
    """One move of a parameter, or a fade to silence, and its length (frames)."""

    frame: int
    address: str
    target: float
    ramp: int


class Moves:
    """Tells what the player of an instrument moves, by doing the same with copies of its records.

    Make it before the instrument computes its first frame: it begins with what the player is then.
    """

    def __init__(self, instrument: Instrument) -> None:
        rig = instrument._rig
        self._instrument = instrument
        self._player, self._controls = rig["player"].copy(), rig["controls"].copy()
        self.targets = self._controls["target"][0].copy()
        instrument.report_commands()

    def seen(self) -> list[Move]:
        """The moves since the last call; one to the same target too."""
        return [
            move for command in self._instrument.applied_commands() for move in self._of(command)
        ]

    def _of(self, command: Any) -> list[Move]:
        controls, frame = self._controls[0], int(command["frame"])
        controls["target"], controls["silence_in"] = np.nan, 0  # so that every move is seen
        controls["frame"] = frame
        records = self._player.ctypes.data, self._controls.ctypes.data
        apply.call(*records, *command.item())
        is_moved = ~np.isnan(controls["target"])
        self.targets = np.where(is_moved, controls["target"], self.targets)
        moves = [
            Move(
                frame,
                ADDRESSES[slot],
                float(controls["target"][slot]),
                int(controls["remaining"][slot]),
            )
            for slot in np.flatnonzero(is_moved).tolist()
        ]
        if controls["silence_in"] != 0:
            moves.append(Move(frame, "silence", 0.0, int(controls["silence_in"])))
        return moves

    def are_those_of_the_audio_side(self) -> bool:
        """Whether the instrument's parameters move to where these do, after `seen`.

        What the player moves by ear is left out while it listens: a copy hears nothing. So is the
        direction of the bow: a copy draws none, so it does not know how much hair is left.
        """
        targets = self._instrument._rig["controls"]["target"][0]
        is_alike = targets == self.targets
        is_alike[SLOTS.pluck_force] |= (
            targets[SLOTS.pluck_force] == 0.0
        )  # the string slips off the fingertip by itself
        is_alike[SLOTS.bow_speed] |= abs(targets[SLOTS.bow_speed]) == abs(
            self.targets[SLOTS.bow_speed]
        )
        if self._instrument._rig["player"]["value"][0, PLAYING.listening] > 0.0:
            is_alike[BY_EAR] = True
        return bool(is_alike.all())
