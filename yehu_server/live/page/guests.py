"""Guests of the page: what those on other machines may do, and the PIN that lets them in."""

import hmac
import secrets
import time
from collections import OrderedDict
from dataclasses import dataclass, field
from typing import Any

from yehu_server.live import traffic_limits as limits
from yehu_server.live.network import is_here, plain
from yehu_server.params.spec import Param
from yehu_server.util.token_bucket import TokenBucket

LISTEN, PLAY, OWN = ROLES = ("listen", "play", "own")
DIGITS = 6


def is_owner_only(param: Param) -> bool:
    """Whether a parameter is of the instrument, the room or the output, and so no player's."""
    prefixes = ("/body/", "/string/", "/engine/", "/output/")
    return param.is_shared or param.address.startswith(prefixes)


def new_pin() -> str:
    """A PIN that nobody can guess."""
    return f"{secrets.randbelow(10**DIGITS):0{DIGITS}}"


@dataclass(frozen=True)
class Guests:
    """What guests may do: listen, play, or own the server as this machine does; and their PIN."""

    role: str = PLAY
    pin: str = field(default_factory=new_pin)


class Admission:
    """Gives each who connects a role; without `guests`, all own the server."""

    def __init__(self, guests: Guests | None) -> None:
        self._guests = guests
        self._tries: OrderedDict[str, TokenBucket] = OrderedDict()  # the latest host last
        self._all_tries = TokenBucket(limits.PINS_OF_ALL_A_SECOND, limits.PINS_OF_ALL_AT_ONCE)
        self._admitted: OrderedDict[str, None] = OrderedDict()

    def role_of(self, host: str, pin: str) -> str | None:
        """The role of a host (an IP address) that sends a PIN or none; None where it is refused."""
        if self._guests is None or is_here(host):
            return OWN
        if not pin:
            return None
        host, now = plain(host), time.monotonic()
        tries = self._tries.setdefault(
            host, TokenBucket(1.0 / limits.PIN_AGAIN_S, limits.PINS_AT_ONCE)
        )
        remember_latest(self._tries, host)
        # A host that had the PIN before is not kept out by what others guess.
        buckets = [tries] if host in self._admitted else [tries, self._all_tries]
        if any(bucket.left(now) < 1.0 for bucket in buckets):
            return None
        if hmac.compare_digest(pin.encode(errors="replace"), self._guests.pin.encode()):
            self._admitted[host] = None
            remember_latest(self._admitted, host)
            return self._guests.role
        for bucket in buckets:
            bucket.spend(1.0)
        return None


def remember_latest(hosts: OrderedDict[str, Any], latest: str) -> None:
    """Make a host the latest one, and forget the oldest where they are too many."""
    hosts.move_to_end(latest)
    while len(hosts) > limits.PEERS:
        hosts.popitem(last=False)
