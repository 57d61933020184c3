"""The instrument for Python: post events, compute samples, read meters; live and offline alike."""

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
    """A yehu that computes sound.

    One thread at a time may post events (`write`, `silence`), and another may compute samples
    (`process`), also in another process that shares `memory`.

    Parameters
    ----------
    rate : float, Hz
        Sample rate, within the bounds of ``physics.grid``.
    quantities : Quantities
        The physical instrument; by default the measured one.
    channels : int
        Number of channels, which all get the same signal.
    memory : buffer of RIG_BYTES, optional
        Holds all state. With it the instrument is live: events of one block are limited.

    Raises
    ------
    ParameterError
        Where rate and quantities make no stable model.
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
        """Put model and parameters back to their start; drop all events.

        Nothing may post or compute meanwhile.
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
        self._meters = rig["meters"].copy()  # the last consistent copy
        rig["taped"], rig["version"] = 0, 0
        self.rests: list[tuple[int, int]] = []

    @property
    def address(self) -> int:
        """Address of the rig: the `userdata` of ``engine.native.callback``."""
        return int(self._address)

    @property
    def channels(self) -> int:
        """Number of channels that get the signal."""
        return int(self._rig["output"]["channels"][0])

    @channels.setter
    def channels(self, channels: int) -> None:
        self._rig["output"]["channels"] = channels

    @property
    def frame(self) -> int:
        """Frame number of the next sample."""
        return int(self._rig["controls"]["frame"][0])

    @property
    def friction_bound(self) -> float:
        """See ``physics.bow.friction_bound``."""
        return friction_bound(self._rig["model"][0])

    @property
    def unconverged_solves(self) -> int:
        """Number of friction solves that did not converge, since the start."""
        return int(self._rig["state"]["unconverged"][0])

    @property
    def lost_states(self) -> int:
        """Number of times that the model's state was lost and put back to rest, since the start.

        Samples of output that were not numbers are counted too.
        """
        return int(self._rig["state"]["lost"][0] + self._rig["output"]["unsound"][0])

    @property
    def dropped_events(self) -> int:
        """Number of events dropped because the ring was full, since the start."""
        return int(self._rig["mail"]["dropped"][0, 0])

    def frames(self, ms: float) -> int:
        """Convert milliseconds to frames."""
        return round(ms * 1e-3 * self.rate)

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        """Move a parameter of the engine to a value, clamped to its range; return that value.

        Parameters
        ----------
        frame : int
            When to begin; by default now. Events of one frame apply in the order written.
        ramp_ms : float
            Length of the ramp; by default the parameter's own smoothing.

        Raises
        ------
        ParameterError
            Where the address is none of the engine's, or the value is not finite.
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
        """Fade the sound out within 5 ms, then put the model to rest."""
        self.post(self.frame if frame is None else frame, SILENCE, 0.0, 0)

    def post(self, frame: int, index: int, target: float, ramp: int) -> bool:
        """Post an event (``engine.mailbox``); return whether there was room for it."""
        return bool(native.post.call(self._address, frame, index, target, ramp))

    def process(self, out: Array) -> None:
        """Compute the next samples (full scale is 1).

        Parameters
        ----------
        out : ndarray [shape=(frames,) or (frames, channels), float32, contiguous]

        Raises
        ------
        TypeError
            Where `out` is not contiguous.
        """
        if len(out):
            address = addressof(c_float.from_buffer(out))  # four times as fast as `out.ctypes`
            native.callback.call(None, address, len(out), None, 0, self._address)

    def come_to_rest(self) -> None:
        """Put the model to rest at once, and move all parameters to their targets.

        Nothing may compute meanwhile.
        """
        rig = self._rig
        kernel.come_to_rest(rig["model"][0], rig["state"][0])
        settle(rig["controls"][0])
        rest_output(rig["output"])

    def recover(self) -> None:
        """Repair the state after a process was killed while it computed a block.

        The model is put to rest, and the frames of that block become silence; ``rests`` has their
        first frame and the one after them. Nothing may compute meanwhile.
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
        """The last published meters: a record of dtype ``telemetry.METERS``."""
        meters = np.zeros(1, METERS)
        for _ in range(native.TRIES):
            if native.read_meters.call(self._address, meters.ctypes.data):
                self._meters = meters
                break
        return self._meters[0]

    def frame_at(self, time_ns: int) -> float:
        """The frame that is played at a time of ``time.monotonic_ns()``."""
        return float(native.frame_at.call(self._address, time_ns))

    def report_events(self) -> None:
        """Report applied events from now on, for `applied_events`."""
        self._rig["mail"]["reporting"] = 1

    def applied_events(self) -> Array:
        """The events applied since the last call: ndarray [shape=(events,), dtype=EVENT]."""
        events = np.zeros(RING, EVENT)
        count = native.read_reports.call(self._address, events.ctypes.data, RING)
        return events[:count].copy()

    def taped(self, start: int) -> tuple[int, Array]:
        """The samples that were played from a frame on.

        Returns
        -------
        frame : int
            The first frame returned: a later one where the tape, which holds the last
            `TAPE_FRAMES`, has overwritten `start`.
        samples : ndarray [shape=(frames,), float32]
        """
        margin = TAPE_FRAMES // 8  # may be overwritten during the copy
        end = native.taped.call(self._address)
        begin = max(start, end - TAPE_FRAMES + margin)
        tape = self._rig["tape"][0]
        samples = tape[np.arange(begin, end) % TAPE_FRAMES]
        return begin, samples
