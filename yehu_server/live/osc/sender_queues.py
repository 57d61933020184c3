"""Which queue of the callback each sender's events wait in, so that none makes another late.

There are SENDER_QUEUES (``core.engine.mailbox``). Each sender has one of them to itself as long as
there are enough; the last is of all others together.
"""

from collections import OrderedDict
from collections.abc import Sequence

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import SENDER_QUEUES
from yehu_server.live.osc.peers import Peer

QUIET_S = 5.0  # after which another may have a sender's queue, once nothing waits in it
OF_OTHERS = SENDER_QUEUES


class SenderQueues:
    """The queues of senders, from 1, by the first instruments of parts; of one thread."""

    def __init__(self, instruments: Sequence[Instrument]) -> None:
        self._instruments = instruments
        self._quiet = QUIET_S * instruments[0].rate
        self._free = list(range(OF_OTHERS - 1, 0, -1))
        # Queue and latest frame of each sender; who was not active for longest comes first.
        self._own: OrderedDict[Peer, tuple[int, int]] = OrderedDict()

    def queue_of(self, peer: Peer, frame: int) -> int:
        """The queue for what a sender plays at a frame."""
        if peer in self._own:
            queue, _ = self._own[peer]
            self._own.move_to_end(peer)
        elif self._free:
            queue = self._free.pop()
        else:
            oldest, (queue, latest) = next(iter(self._own.items()))
            is_idle = frame - latest > self._quiet and not any(
                instrument.has_waiting(queue) for instrument in self._instruments
            )
            if not is_idle:
                return OF_OTHERS
            del self._own[oldest]
        self._own[peer] = queue, frame
        return queue
