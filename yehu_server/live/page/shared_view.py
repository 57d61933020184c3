"""The instruments of the server, from the pages' process: it reads them, and posts commands."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from yehu_server.core.engine import native
from yehu_server.core.engine.mailbox import KIND_BITS, PAGE_QUEUE, PAGE_QUEUES, PAGES, RESERVE
from yehu_server.core.engine.rig import RIG, RIG_BYTES
from yehu_server.core.engine.snapshot import SNAPSHOT, snapshot
from yehu_server.core.engine.telemetry import METERS
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.core.stage.record import STAGE, TAPE
from yehu_server.params.table import TABLE
from yehu_server.system.memory import Handle, open_shared

Array = Any

_NOTHING: Mapping[int, float] = MappingProxyType({})

MARGIN = TAPE // 8  # frames of the tape that may be overwritten during a copy
SHARED_INDICES = [INDEX[param.address] for param in TABLE if param.is_shared]


class SharedView:
    """Instruments in shared memory, by its `handle`, that another process plays."""

    def __init__(self, handle: Handle) -> None:
        self._memory = open_shared(handle)
        count = int(np.frombuffer(self._memory, RIG, count=1)["parts"][0, 0])
        self._rigs = np.frombuffer(self._memory, RIG, count=count)
        self._stage = np.frombuffer(self._memory, STAGE, offset=count * RIG_BYTES, count=1)[0]
        self._address = self._rigs.ctypes.data
        self._record = np.zeros(1, SNAPSHOT)
        self._meters = np.zeros(1, METERS)

    @property
    def rate(self) -> float:
        """Sample rate (Hz)."""
        return float(self._rigs["model"]["rate"][0])

    def frame_of(self, arrived_ns: int) -> int:
        """The frame at which a message sounds that arrived at this `clocks.monotonic_ns`."""
        delay = int(self._rigs["mail"]["delay"][0, 0])
        return int(native.frame_at.call(self._address, arrived_ns)) + delay

    def post(
        self,
        rig: int,
        page: int,
        frame: int,
        kind: int,
        index: int = 0,
        value: float = 0.0,
        other: float = 0.0,
    ) -> int:
        """Post a page's event to a part, by its first instrument; return its number."""
        address = self._address + rig * RIG_BYTES
        kind += page << KIND_BITS
        native.post_from.call(address, PAGES, frame, kind, index, value, other)
        return int(self._rigs["mail"]["posted"][rig, PAGES, 0])

    def taken(self, rig: int) -> int:
        """Number of events of pages that the audio callback has moved to their queues."""
        return int(self._rigs["mail"]["drained"][rig, PAGES, 0])

    def room(self, rig: int, page: int) -> int:
        """Number of events that the queue of a page has room for."""
        pending = self._rigs["mail"]["pending"][rig, PAGES + page % PAGE_QUEUES]
        return PAGE_QUEUE - RESERVE - int(pending)

    def held(self, rig: int) -> Array:
        """Indices of the parameters of a part that the owner holds."""
        return np.flatnonzero(self._rigs["midi"]["is_held"][rig])

    def snapshot(self, rig: int = 0, own: Mapping[int, float] = _NOTHING) -> bytes:
        """A snapshot of an instrument (``engine.snapshot``) and, twice, the values of parameters.

        First come those that they have, then those that were set, from which controllers move them.
        Its level is that of the mix, and what all share is as the first instrument has it.

        `own`: values, by index, in place of those that it has.
        """
        midi = self._rigs["midi"][rig]
        is_moved = (midi["is_target"] != 0) & (midi["is_held"] == 0)
        record, values = self._record[0], self._rigs["player"]["value"][rig].copy()
        snapshot.call(self._address + rig * RIG_BYTES, self._record.ctypes.data)
        if rig:
            record["peak"], record["rms"] = self._stage["peak"], self._stage["rms"]
            values[SHARED_INDICES] = self._rigs["player"]["value"][0, SHARED_INDICES]
        for index, value in own.items():
            values[index] = value
        was_set = np.where(is_moved, midi["set_to"], values)
        return self._record.tobytes() + bytes(values.tobytes()) + bytes(was_set.tobytes())

    def load(self) -> tuple[float, int]:
        """The share of the time that computing takes, and the number of drop-outs so far."""
        for _ in range(native.TRIES):
            if native.read_meters.call(self._address, self._meters.ctypes.data):
                break
        meters = self._meters[0]
        return float(meters["load"]), int(meters["underruns"] + meters["missed"])

    def taped(self) -> int:
        """Number of frames that were taped: the next frame to be played."""
        return int(native.taped.call(self._address))

    def sound(self, begin: int, end: int) -> tuple[int, bytes]:
        """Frames of the mix, left and right in turn, float32, as far as the tape has them."""
        begin = max(begin, end - TAPE + MARGIN)
        frames = self._stage["tape"][np.arange(begin, end) % TAPE]
        return begin, frames.tobytes()
