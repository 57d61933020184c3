"""The onsets of a section, as compiled code plans them (``midi.section_players``)."""

import numpy as np

from yehu_server.core.midi.record import MIDI, prepare_midi
from yehu_server.core.midi.section_players import begin_sequence, plan_onset, plan_release
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.params.table import TABLE


class Together:
    """The onsets of a section of some players, at a rate (Hz), with a seed."""

    def __init__(self, players: int, rate: float, seed: int) -> None:
        self._midi = np.zeros(1, MIDI)
        values = {param.address: param.default for param in TABLE}
        prepare_midi(self._midi, rate, values, players=players)
        self._record = self._midi[0]
        self.begin(seed)

    @property
    def variation(self) -> float:
        """As /playing/variation."""
        return float(self._record["value"][PLAYING.variation])

    @variation.setter
    def variation(self, variation: float) -> None:
        self._record["value"][PLAYING.variation] = variation

    @property
    def playing(self) -> int:
        """How many of them play: the first ones."""
        return int(self._record["playing"])

    @playing.setter
    def playing(self, playing: int) -> None:
        self._record["playing"] = playing

    @property
    def gains(self) -> list[float]:
        """The share of its distance to each other one that a player corrects, of each."""
        shares = self._record["share"][: self.playing].tolist()
        return [share / self.playing for share in shares]

    def begin(self, seed: int) -> None:
        """Begin the sequence of a seed; all are together."""
        begin_sequence(self._record, seed)

    def onset(self, frame: int) -> tuple[int, ...]:
        """How many frames each is late for an onset planned at a frame; plan the next one."""
        plan_onset(self._record, frame)
        return self._late()

    def release(self, frame: int) -> tuple[int, ...]:
        """How many frames each is late for the end of a note."""
        plan_release(self._record, frame)
        return self._late()

    def _late(self) -> tuple[int, ...]:
        return tuple(self._record["late"][: self._record["players"]].tolist())
