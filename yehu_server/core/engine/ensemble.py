"""Instruments on one stage, one or more, live or offline: to left and right, in a room."""

from collections.abc import Sequence
from ctypes import addressof, c_float
from typing import Any

import numpy as np

from yehu_server.core.engine import native
from yehu_server.core.engine.instrument import Instrument, new_memory
from yehu_server.core.engine.rig import MAX_PARTS, RIG_BYTES, memory_bytes
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.stage.record import STAGE, TAPE, clear_stage, prepare_stage
from yehu_server.errors import ParameterError

Array = Any

TAPE_FRAMES = TAPE


class Ensemble:
    """Instruments on one stage.

    Parameters
    ----------
    specs : sequence of InstrumentSpec
        What each of the instruments is.
    channels : int
        Number of channels: left and right in turn; a single one has the mean of both.
    has_room : bool
        Whether they play in a room, and their bodies sound differently to both sides; else dry.
    memory : buffer, optional
        Of ``rig.memory_bytes`` of their number, all zeros: holds all state.
    is_live : bool
        See `Instrument`.

    Raises
    ------
    ParameterError
        Where they are too many, or have different sample rates.
    """

    def __init__(
        self,
        specs: Sequence[InstrumentSpec],
        *,
        channels: int = 2,
        has_room: bool = True,
        memory: Any = None,
        is_live: bool = False,
    ) -> None:
        check_parts(len(specs))
        if len({spec.rate for spec in specs}) > 1:
            raise ParameterError("instruments of one stage have one sample rate")
        memory = new_memory(len(specs)) if memory is None else memory
        whole = np.frombuffer(memory, np.uint8, count=memory_bytes(len(specs)))
        rigs = whole[: len(specs) * RIG_BYTES].reshape(-1, RIG_BYTES)
        self.instruments = tuple(
            Instrument(spec, memory=rig, is_live=is_live)
            for spec, rig in zip(specs, rigs, strict=True)
        )
        self.rate = specs[0].rate
        self._stage = np.frombuffer(whole, STAGE, offset=len(specs) * RIG_BYTES, count=1)[0]
        self._address = whole.ctypes.data
        whole[:8].view(np.int64)[0] = len(specs)
        prepare_stage(self._stage, self.rate, channels, has_room=has_room)
        for instrument in self.instruments:
            instrument.follow_clock(self.address)
        self._memory = memory

    @property
    def first(self) -> Instrument:
        """The first instrument: its parameters are those that all share."""
        return self.instruments[0]

    @property
    def address(self) -> int:
        """The `userdata` of ``engine.native.callback``."""
        return int(self._address)

    @property
    def memory(self) -> Any:
        """The buffer that holds all state."""
        return self._memory

    @property
    def gaps(self) -> list[tuple[int, int]]:
        """Frames that were lost with a process: the first of them and the one after them."""
        return self.first.gaps

    @property
    def channels(self) -> int:
        """Number of channels."""
        return int(self._stage["channels"])

    @channels.setter
    def channels(self, channels: int) -> None:
        self._stage["channels"] = channels

    @property
    def frame(self) -> int:
        """Frame number of the next sample."""
        return self.first.frame

    @property
    def level(self) -> tuple[float, float]:
        """Peak and rms of the mix, in the last sixtieth of a second."""
        return float(self._stage["peak"]), float(self._stage["rms"])

    @property
    def lost_states(self) -> int:
        """Number of states that were lost, of all instruments and of the mix."""
        lost = sum(instrument.lost_states for instrument in self.instruments)
        return lost + int(self._stage["invalid_samples"])

    def frame_at(self, time_ns: int) -> float:
        """The frame that is played at a time of `clocks.monotonic_ns`."""
        return self.first.frame_at(time_ns)

    def frames(self, ms: float) -> int:
        """Convert milliseconds to frames."""
        return self.first.frames(ms)

    def meters(self) -> Any:
        """The last published meters of the callback: those of the first instrument."""
        return self.first.meters()

    def process(self, out: Array) -> None:
        """Compute the next frames (full scale is 1).

        Parameters
        ----------
        out : ndarray [shape=(frames, channels) or (frames,), float32, contiguous]

        Raises
        ------
        TypeError
            Where `out` is not contiguous.
        """
        if len(out):
            address = addressof(c_float.from_buffer(out))
            native.callback.call(None, address, len(out), None, 0, self._address)

    def reset(self) -> None:
        """Put all back to their start; drop all commands. Nothing may compute meanwhile."""
        for instrument in self.instruments:
            instrument.reset()
        clear_stage(self._stage)

    def end_all(self) -> None:
        """End all notes and all sound at once. Nothing may compute meanwhile."""
        for instrument in self.instruments:
            instrument.end_all()
        clear_stage(self._stage)

    def come_to_rest(self) -> None:
        """Put models to rest, parameters to their targets; nothing may compute meanwhile."""
        for instrument in self.instruments:
            instrument.come_to_rest()
        clear_stage(self._stage)

    def recover(self) -> None:
        """Repair the state after a process was killed while it computed a block.

        All notes end, the models are put to rest, and the frames of that block become silence;
        ``gaps`` has their first frame and the one after them. Nothing may compute meanwhile.
        """
        is_broken = self.first.is_broken()
        for instrument in self.instruments:
            instrument.repair()
        if not is_broken:
            return
        frame = max(instrument.frame for instrument in self.instruments)
        for instrument in self.instruments:
            instrument.skip_to(frame)
        self.end_all()
        gap = self.first.tape_up_to(frame), frame
        self._stage["tape"][np.arange(*gap) % TAPE_FRAMES] = 0.0
        for instrument in self.instruments:
            instrument.gaps.append(gap)

    def taped(self, start: int) -> tuple[int, Array]:
        """The frames [shape=(frames, 2), float32] that were played from one on; and the first.

        It is a later one where the tape, of the last `TAPE_FRAMES`, has overwritten `start`.
        """
        margin = TAPE_FRAMES // 8  # may be overwritten during the copy
        end = native.taped.call(self._address)
        begin = max(start, end - TAPE_FRAMES + margin)
        return begin, self._stage["tape"][np.arange(begin, end) % TAPE_FRAMES]


def check_parts(parts: int) -> None:
    """Raise ParameterError for a number of instruments that no stage has room for."""
    if not 1 <= parts <= MAX_PARTS:
        raise ParameterError(f"{parts} parts: a stage has 1 to {MAX_PARTS}")
