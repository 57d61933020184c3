"""What OSC calls share: players, clients, and what they need of the server."""

import time
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

from yehu_server.errors import OutputError, RefusedError, YehuError, shortened
from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.call import Request, port_of
from yehu_server.live.osc.clients import Clients
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.peers import Peer
from yehu_server.live.osc.schedule import Schedule
from yehu_server.live.osc.status import Counts
from yehu_server.live.part_addresses import FIRST, OF_PARTS, PART_PARAMS, PLAIN, group_of, part_of
from yehu_server.params.table import PREFIX
from yehu_server.playing.mapping import Mapping as ControllerMapping
from yehu_server.playing.player import Player
from yehu_server.util.token_bucket import TokenBucket

Act = Callable[[Request], None]


@dataclass(eq=False)
class CallContext:
    """What all calls share, and what they need of the server beside its players.

    Addresses come in groups: `FIRST` has those of the first part and of what all share, and each
    part has one.
    """

    players: Sequence[Player]  # those of all parts
    # Returns the status values of a group, by name; any thread may call.
    status: Callable[[str], Mapping[str, float | str]]
    # Record to a file of a plain name, or end that; return the file's name. Raise YehuError.
    start_recording: Callable[[str], str]
    stop_recording: Callable[[], str]
    log: Callable[[str], None]  # prints or logs a line for whoever runs the server
    # Calls a function that may take long, such as one that writes a file, in another thread; those
    # that are given one after another in this order.
    run_in_background: Callable[[Callable[[], None]], object]
    # Calls a function in the thread that handles packets; any thread may call.
    call_soon: Callable[[Callable[[], None]], object]
    # Called with a path where the tree of addresses has changed at it or below.
    on_tree_change: list[Callable[[str], None]] = field(default_factory=list)
    addresses: Collection[str] = ()  # of all calls and parameters, with the prefix
    schedule: Schedule = field(default_factory=Schedule)
    counts: Counts = field(default_factory=Counts)
    writes: set[object] = field(default_factory=set)  # a mark for each file that is being written
    wrong_addresses: set[str] = field(default_factory=set)  # whose errors were logged
    # Who was told, and at which address, that its values are outside the range.
    told: set[tuple[Peer, str]] = field(default_factory=set)
    unlogged: int = 0  # errors since the last that was logged
    counted: int = 0  # of these, as many as a line has told
    last_error_s: float = 0.0  # monotonic
    logged_errors: TokenBucket = field(
        default_factory=lambda: TokenBucket(
            limits.LOGGED_ERRORS_A_SECOND, limits.LOGGED_ERRORS_AT_ONCE
        )
    )
    saves: TokenBucket = field(
        default_factory=lambda: TokenBucket(limits.SAVES_A_SECOND, limits.SAVES_AT_ONCE)
    )

    def __post_init__(self) -> None:
        """Make what is sent to clients."""
        self.groups = (FIRST, *map(group_of, range(len(self.players))))
        self.clients = Clients(self.values, PREFIX, self.status)

    def values(self, group: str) -> dict[str, float]:
        """The values of the parameters of a group, by address; any thread may call."""
        values = self.players[part_of(group)].values()
        own = [param.address for param in PART_PARAMS] if group else values
        return {address: values[address] for address in own}

    def send_error(self, peer: Peer, address: str, reason: str | Callable[[], str]) -> None:
        """Send a peer the reason why its message to an address was refused; count and log it."""
        if isinstance(reason, str) and ": " in reason:  # it may name the parameter once more
            named, _, rest = reason.partition(": ")
            reason = rest if named[:1] == "/" and address.endswith(named) else reason
        self.counts.errors += 1
        self.report_error(peer, address, reason)

    def report_error(self, peer: Peer, address: str, reason: str | Callable[[], str]) -> None:
        """The same for what is counted elsewhere; `address` may be empty, where none was read."""
        self.unlogged += 1
        self.last_error_s = time.monotonic()
        if self._is_new_error(address):
            reason = reason if isinstance(reason, str) else reason()
            hidden = self.unlogged - 1
            more = f" ({_errors(hidden)} before it not shown)" * (hidden > 0)
            what = f"{shortened(address)}: {shortened(reason)}" if address else shortened(reason)
            self.log(f"OSC from {peer.host}: {what}{more}")
            self.unlogged = self.counted = 0
        self.clients.send_error(peer, address, reason)

    def count_errors(self, *, is_end: bool = False) -> None:
        """Log how many errors were not, once none has come for a while, or at the end.

        Who sends wrong messages now and then is told of twice as many each time.
        """
        is_quiet = time.monotonic() - self.last_error_s >= limits.ERRORS_COUNTED_AFTER_S
        is_due = is_end or (is_quiet and self.unlogged >= 2 * self.counted)
        if is_due and self.unlogged > self.counted:
            self.counted = self.unlogged
            self.log(f"OSC: {_errors(self.unlogged)} after the last one not shown")

    def _is_new_error(self, address: str) -> bool:
        """Whether to log an error at an address: once for each, and few of all.

        Who sends from one port, listens at another and names none may see it there.
        """
        if address in self.wrong_addresses or not self.logged_errors.takes(time.monotonic()):
            return False
        if len(self.wrong_addresses) >= limits.WRONG_ADDRESSES:
            self.wrong_addresses.clear()
        self.wrong_addresses.add(address)
        return True

    def tree_changed(self, path: str) -> None:
        """Announce that the tree has changed at a path or below."""
        for listener in self.on_tree_change:
            listener(path)

    def announce(self, path: str) -> None:
        """Announce that the tree has changed at a path below each group that it has."""
        for group in self.groups if len(self.players) > 1 else (FIRST,):
            self.tree_changed(PREFIX + group + path)

    def remap(self, player: Player, mapping: ControllerMapping) -> None:
        """Give a mapping to a player, and to all others that had the same."""
        before = player.mapping
        for one in self.players:
            if one.mapping == before:
                one.remap(mapping, frame=one.frame_of())


def _errors(count: int) -> str:
    return f"{count} error{'s' * (count > 1)}"


class GroupCalls:
    """Calls at a group of addresses; each takes a `Request`, and raises YehuError to refuse it."""

    def __init__(self, group: str, context: CallContext) -> None:
        self._player = context.players[part_of(group)]
        self._group = group
        self._prefix = PREFIX + group
        self._context = context
        self._clients = context.clients

    def _echo(self, peer: Peer, addresses: Iterable[str]) -> None:
        """Send a peer the values that it has set, of those that the group has."""
        known = OF_PARTS if self._group else PLAIN
        self._clients.echo(peer, [self._group + one for one in addresses if one in known])

    def _check_rate(self) -> None:
        """Refuse what writes a file where that is done too often."""
        if not self._context.saves.takes(time.monotonic()):
            raise OutputError("files are written too often; try again in a second")

    def _write(self, peer: Peer, address: str, write: Callable[[], Callable[[], None]]) -> None:
        """Write a file aside, as a disk may be slow; then call what `write` returns."""
        mark = object()

        def aside() -> None:
            try:
                then = write()
            except YehuError as error:
                then = partial(self._send_error, peer, address, str(error))
            self._context.call_soon(partial(end, then))

        def end(then: Callable[[], None]) -> None:
            self._context.writes.discard(mark)
            try:
                then()
            except YehuError as error:
                self._send_error(peer, address, str(error))

        self._context.writes.add(mark)
        self._context.run_in_background(aside)

    def after_writes(self, address: str, act: Act, call: Request) -> None:
        """Carry out what reads files: after those that are being written, where there are any."""
        if self._context.writes:
            self._write(call.peer, address, lambda: partial(act, call))
        else:
            act(call)

    def _send(self, peer: Peer, address: str, *arguments: float | str) -> None:
        """Send a peer an answer of the group."""
        self._clients.send(peer, pack(self._prefix + address, *arguments))

    def _end_subscriptions(self, peer: Peer, ports: Sequence[float]) -> None:
        """End a peer's subscriptions, or those at a port that it names; tell it, and who had them.

        Raises RefusedError where there are none.
        """
        at = peer.at(port_of(ports[0])) if ports else None
        told = self._clients.answered(peer)
        ended = self._clients.unsubscribe(peer, at)
        if not ended:
            where = (
                f"at port {ports[0]:g}" if ports else "from this port; /unsubscribe PORT names one"
            )
            raise RefusedError(f"nothing is subscribed {where}")
        for one in dict.fromkeys((*told, *ended)):
            one.send(pack(f"{self._prefix}/unsubscribed"))

    def _send_error(self, peer: Peer, address: str, reason: str) -> None:
        """Send a peer the reason why a call of the group was refused."""
        self._context.send_error(peer, self._prefix + address, reason)
