"""The instrument: events in, samples out. The same compiled callback live and offline."""

from __future__ import annotations

from ctypes import addressof, c_float
from typing import Any

import numpy as np

from yehu_server.engine import native
from yehu_server.engine.controls import SILENCE, prepare_controls, settle
from yehu_server.engine.mailbox import EVENT, LIVE_BUDGET, RING
from yehu_server.engine.output import prepare_output, rest_output
from yehu_server.engine.telemetry import METERS
from yehu_server.errors import ParameterError
from yehu_server.params.table import SLOT, find
from yehu_server.physics import kernel
from yehu_server.physics.bow import friction_bound
from yehu_server.physics.grid import check_rate
from yehu_server.physics.layout import MAX_FINGERS, new_record
from yehu_server.physics.quantities import Quantities

Array = Any

RIG_BYTES = native.RIG.itemsize
TAPE_FRAMES = native.TAPE


class Instrument:
    """One yehu, ready to play.

    One thread at a time may post events (`write`, `silence`), another play; both
    may be in other processes, where `memory` is shared between them.

    Parameters
    ----------
    rate : float, Hz
        Within the bounds of ``physics.grid``.
    quantities : Quantities
        The physical instrument; the measured one by default.
    channels : int
        How many get the same signal.
    memory : buffer of RIG_BYTES, optional
        Where to live. With it the instrument is live: it bounds what one block may cost.

    Errors: ParameterError where rate or quantities make no stable model.
    """

    def __init__(
        self,
        rate: float,
        quantities: Quantities | None = None,
        *,
        channels: int = 1,
        memory: Any = None,
    ) -> None:
        check_rate(rate)
        self.rate = rate
        self.quantities = quantities or Quantities()
        self._rig = (
            new_record(native.RIG) if memory is None else np.frombuffer(memory, native.RIG, count=1)
        )
        self._address = self._rig.ctypes.data
        self._rig["model"] = kernel.prepare(self.quantities, rate, MAX_FINGERS)
        self._rig["mail"]["budget"] = RING if memory is None else LIVE_BUDGET
        prepare_output(self._rig["output"], rate, channels)
        self.reset()

    def reset(self) -> None:
        """Put model and parameters back to the start; forget scheduled events.

        Nobody may play or post meanwhile.
        """
        rig = self._rig
        rig["state"] = kernel.at_rest(rig["model"])
        rig["controls"] = prepare_controls(self.quantities, self.rate)
        prepare_output(rig["output"], self.rate, self.channels)
        mail = rig["mail"]
        kept = mail["budget"].copy(), mail["reporting"].copy()
        mail[:] = np.zeros(1, mail.dtype)
        mail["budget"], mail["reporting"] = kept
        rig["meters"] = np.zeros(1, METERS)
        rig["meters"]["rate"] = self.rate
        rig["meters"]["loop"]["ns_per_frame"] = 1e9 / self.rate
        rig["published"] = rig["meters"]
        self._meters = rig["meters"].copy()  # as last read whole
        rig["taped"], rig["version"] = 0, 0
        self.rests: list[tuple[int, int]] = []

    @property
    def address(self) -> int:
        """Where the rig lies: the `userdata` of ``engine.native.callback``."""
        return int(self._address)

    @property
    def channels(self) -> int:
        """How many channels get the signal."""
        return int(self._rig["output"]["channels"][0])

    @channels.setter
    def channels(self, channels: int) -> None:
        self._rig["output"]["channels"] = channels

    @property
    def frame(self) -> int:
        """The frame of the next sample."""
        return int(self._rig["controls"]["frame"][0])

    @property
    def friction_bound(self) -> float:
        """See ``physics.bow.friction_bound``."""
        return friction_bound(self._rig["model"][0])

    @property
    def unconverged_solves(self) -> int:
        """Friction solves that did not converge, since the start."""
        return int(self._rig["state"]["unconverged"][0])

    @property
    def lost_states(self) -> int:
        """How often the state was lost and put back to rest, since the start.

        Each sample of output that was not a number counts too.
        """
        return int(self._rig["state"]["lost"][0] + self._rig["output"]["unsound"][0])

    @property
    def dropped_events(self) -> int:
        """Events that found the ring full, since the start."""
        return int(self._rig["mail"]["dropped"][0, 0])

    def frames(self, ms: float) -> int:
        """Milliseconds as a number of frames."""
        return round(ms * 1e-3 * self.rate)

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        """Let a parameter of the engine move to a value; return the value accepted.

        Parameters
        ----------
        frame : int
            When; now by default. Events of one frame apply in the order written.
        ramp_ms : float
            How long the way takes; the parameter's own smoothing by default.

        Errors: ParameterError for an unknown address or a value that is not finite.
        """
        param = find(address)
        accepted = param.accept(value)
        slot = SLOT.get(address)
        if slot is None:
            raise ParameterError(f"{address} is not held by the engine")
        ramp = self.frames(param.smooth_ms if ramp_ms is None else ramp_ms)
        self.post(self.frame if frame is None else frame, slot, accepted, ramp)
        return accepted

    def silence(self, *, frame: int | None = None) -> None:
        """Fade the sound out within 5 ms and put the model to rest."""
        self.post(self.frame if frame is None else frame, SILENCE, 0.0, 0)

    def post(self, frame: int, index: int, target: float, ramp: int) -> bool:
        """Post a bare event (``engine.mailbox``); whether there was room for it."""
        return bool(native.post.call(self._address, frame, index, target, ramp))

    def process(self, out: Array) -> None:
        """Write the next samples, in full scale.

        Parameters
        ----------
        out : ndarray [shape=(frames,) or (frames, channels), float32, contiguous]

        Errors: TypeError where `out` is not contiguous.
        """
        if len(out):
            address = addressof(c_float.from_buffer(out))  # four times as fast as `out.ctypes`
            native.callback.call(None, address, len(out), None, 0, self._address)

    def come_to_rest(self) -> None:
        """Put the model to rest at once, its parameters where they are bound.

        Nobody may play meanwhile.
        """
        rig = self._rig
        kernel.come_to_rest(rig["model"][0], rig["state"][0])
        settle(rig["controls"][0])
        rest_output(rig["output"])

    def recover(self) -> None:
        """Mend what a process left that was killed while it played: rest, and a gap of silence.

        Nobody may play meanwhile. Kept in ``rests``: first frame of the gap, and after it.
        """
        rig = self._rig
        rig["version"][0, 0] += rig["version"][0, 0] % 2
        if rig["meters"]["running"][0]:
            rig["meters"]["running"] = 0
            self.come_to_rest()
            gap = int(rig["taped"][0, 0]), self.frame
            rig["tape"][0, np.arange(*gap) % TAPE_FRAMES] = 0.0
            rig["taped"][0, 0] = self.frame
            self.rests.append(gap)

    def meters(self) -> Any:
        """What the audio side last told of itself: a record of dtype ``telemetry.METERS``."""
        meters = np.zeros(1, METERS)
        for _ in range(native.TRIES):
            if native.read_meters.call(self._address, meters.ctypes.data):
                self._meters = meters
                break
        return self._meters[0]

    def frame_at(self, time_ns: int) -> float:
        """The frame that a moment of ``time.monotonic_ns()`` falls on, as blocks are played."""
        return float(native.frame_at.call(self._address, time_ns))

    def report_events(self) -> None:
        """Keep what is applied for `applied_events`."""
        self._rig["mail"]["reporting"] = 1

    def applied_events(self) -> Array:
        """What was applied since the last call: ndarray [shape=(events,), dtype=EVENT]."""
        events = np.zeros(RING, EVENT)
        count = native.read_reports.call(self._address, events.ctypes.data, RING)
        return events[:count].copy()

    def taped(self, start: int) -> tuple[int, Array]:
        """What was played from a frame on, as far as the tape still holds it.

        Returns the frame it begins at, and the samples [shape=(frames,), float32]. Only the
        last `TAPE_FRAMES` are held; who comes too late gets a later beginning.
        """
        margin = TAPE_FRAMES // 8  # may be overwritten while we copy
        end = native.taped.call(self._address)
        begin = max(start, end - TAPE_FRAMES + margin)
        tape = self._rig["tape"][0]
        samples = tape[np.arange(begin, end) % TAPE_FRAMES]
        return begin, samples
