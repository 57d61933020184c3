"""Guests of the page: what those on other machines may do, and the PIN that lets them in."""

from __future__ import annotations

import hmac
import secrets
import time
from dataclasses import dataclass, field

from yehu_server.live import limits
from yehu_server.live.network import is_here, plain
from yehu_server.util.token_bucket import TokenBucket

LISTEN, PLAY, OWN = ROLES = ("listen", "play", "own")
DIGITS = 6


def new_pin() -> str:
    """A PIN that nobody can guess."""
    return f"{secrets.randbelow(10**DIGITS):0{DIGITS}}"


@dataclass(frozen=True)
class Guests:
    """What guests may do: listen, play, or own the server as this machine does; and their PIN."""

    role: str = PLAY
    pin: str = field(default_factory=new_pin)


class Admission:
    """Gives each who connects a role.

    `guests`: without them, all own the server.
    """

    def __init__(self, guests: Guests | None) -> None:
        self._guests = guests
        self._tries: dict[str, TokenBucket] = {}

    def role_of(self, host: str, pin: str) -> str | None:
        """The role of a host (an IP address) that sends a PIN or none; None where it is refused."""
        if self._guests is None or is_here(host):
            return OWN
        if not pin:
            return None
        if len(self._tries) > limits.PEERS:
            self._tries.clear()
        tries = self._tries.setdefault(
            plain(host), TokenBucket(1.0 / limits.PIN_AGAIN_S, limits.PINS_AT_ONCE)
        )
        now = time.monotonic()
        if tries.left(now) < 1.0:
            return None
        if hmac.compare_digest(pin.encode(errors="replace"), self._guests.pin.encode()):
            return self._guests.role
        tries.spend(1.0)
        return None
