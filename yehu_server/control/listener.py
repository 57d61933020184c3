"""One peer that is told values by OSC: what it has asked for, and what waits to be sent to it."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

from yehu_server.control.allowance import Allowance
from yehu_server.control.parts import divided
from yehu_server.control.peers import Peer
from yehu_server.control.status import PLACE

ERRORS_A_SECOND, ERRORS_AT_ONCE = 10.0, 20.0


@dataclass
class Listener:
    """A peer and what it is to be told. Addresses come in groups: see ``parts``."""

    peer: Peer
    # By group of addresses: the end of its subscription (monotonic s), and the form of the
    # addresses it is told: plain, or ending in UNIT.
    subscribed: dict[str, tuple[float, str]] = field(default_factory=dict)
    asked_status: dict[str, float] = field(default_factory=dict)  # the same, of the status
    # Addresses of which it is told all changes, by group; parameters and status apart.
    listens: dict[str, set[str]] = field(default_factory=dict)
    watches: dict[str, set[str]] = field(default_factory=dict)
    hushed_until: float = 0.0  # until then it is not answered (monotonic s)
    # Addresses to send, and their groups: in the next round of telling, and in the present one.
    to_tell: dict[str, str] = field(default_factory=dict)
    telling: dict[str, str] = field(default_factory=dict)
    errors: Allowance = field(default_factory=lambda: Allowance(ERRORS_A_SECOND, ERRORS_AT_ONCE))
    complained: float = field(default_factory=time.monotonic)

    @property
    def until(self) -> float:
        """When its last subscription ends (monotonic s)."""
        ends = [end for end, _ in self.subscribed.values()]
        return max([*ends, *self.asked_status.values()], default=0.0)

    def subscribes(self, now: float) -> bool:
        """Whether it has a subscription."""
        return self.until > now

    @property
    def is_idle(self) -> bool:
        """Whether nothing waits to be sent to it, and it listens to no address."""
        return not (self.to_tell or self.telling or self.listens or self.watches)

    def among(self, address: str) -> tuple[str, dict[str, set[str]]]:
        """The group of an address, and among which of its addresses it stands."""
        addressed, own = divided(address)
        return addressed, self.watches if own.startswith(PLACE) else self.listens

    def ignore(self, address: str) -> None:
        """Tell it no more of an address that it listens to."""
        addressed, among = self.among(address)
        addresses = among.get(addressed, set())
        addresses.discard(address)
        if not addresses:
            among.pop(addressed, None)
        self.to_tell.pop(address, None)
        self.telling.pop(address, None)

    def form(self, addressed: str, now: float) -> str | None:
        """The form of addresses in which it subscribed to a group's values; None if it has not."""
        end, form = self.subscribed.get(addressed, (0.0, ""))
        return form if end > now else None

    def forms(self, now: float) -> list[str]:
        """The groups whose values it has subscribed to."""
        return [addressed for addressed, (end, _) in self.subscribed.items() if end > now]

    def states(self, now: float) -> set[str]:
        """The groups whose status it has subscribed to."""
        return {addressed for addressed, end in self.asked_status.items() if end > now}
