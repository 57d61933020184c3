"""Which queue of the callback each sender's events wait in, so that none makes another late.

There are SENDER_QUEUES (``core.engine.mailbox``). Each sender has one of them to itself as long as
there are enough. All others share the last but one; those of them who crowd it have the last.
"""

from collections import Counter, OrderedDict
from collections.abc import Sequence

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import SENDER_QUEUE, SENDER_QUEUES
from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.peers import Peer

QUIET_S = 5.0  # after which another may have a sender's queue, once nothing waits in it
OF_OTHERS, OF_CROWDERS = SENDER_QUEUES - 1, SENDER_QUEUES
CROWDED = SENDER_QUEUE // 16  # events in the queue of others, where a share of them is too much


class SenderQueues:
    """The queues of senders, from 1, by the first instruments of parts; of one thread."""

    def __init__(self, instruments: Sequence[Instrument]) -> None:
        self._instruments = instruments
        self._quiet = QUIET_S * instruments[0].rate
        self._free = list(range(OF_OTHERS - 1, 0, -1))
        # Queue and latest frame of each sender; who was not active for longest comes first.
        self._own: OrderedDict[Peer, tuple[int, int]] = OrderedDict()
        # What each of the others has sent since their queue was empty; and who crowds it, until
        # nothing waits in the queue of crowders.
        self._sent: Counter[Peer] = Counter()
        self._crowders: set[Peer] = set()

    def queue_of(self, peer: Peer, frame: int) -> int:
        """The queue for what a sender plays at a frame."""
        if peer in self._own:
            queue, _ = self._own[peer]
            self._own.move_to_end(peer)
        elif self._free:
            queue = self._free.pop()
        else:
            oldest, (queue, latest) = next(iter(self._own.items()))
            if frame - latest <= self._quiet or self._waiting(queue):
                return self._queue_of_others(peer)
            del self._own[oldest]
        self._own[peer] = queue, frame
        return queue

    def _waiting(self, queue: int) -> int:
        """The most events that wait in a queue of a part."""
        return max(instrument.waiting(queue) for instrument in self._instruments)

    def _queue_of_others(self, peer: Peer) -> int:
        """The queue of others; that of crowders for a share of it or more where it is crowded."""
        waiting, sent = self._waiting(OF_OTHERS), self._sent
        if not waiting or len(sent) > limits.PEERS:
            sent.clear()
        if self._crowders and not self._waiting(OF_CROWDERS):
            self._crowders.clear()
        if peer not in self._crowders:
            sent[peer] += 1
            if waiting <= CROWDED or sent[peer] * len(sent) < sent.total():
                return OF_OTHERS
            self._crowders.add(peer)
        return OF_CROWDERS
