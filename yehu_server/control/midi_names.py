"""MIDI ports by the part of their names that stays the same."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence

# ALSA ends a name in numbers that change with each plugging in; Windows counts ports.
_CHANGING = re.compile(r"\s+\d+(:\d+)?$")
_THROUGH = re.compile(r"\bthrough\b|\bthru\b", re.IGNORECASE)


def stable_names(names: Iterable[str]) -> list[str]:
    """One name for each port, the same whenever it is there.

    Of several alike the second gets ``#2``, and so on.
    """
    seen: Counter[str] = Counter()
    stable = []
    for name in names:
        base = _CHANGING.sub("", name.strip())
        # ALSA: "Client:Client MIDI 1" says the client twice.
        client, colon, port = base.partition(":")
        if colon and port.startswith(client):
            base = port
        seen[base] += 1
        stable.append(base if seen[base] == 1 else f"{base} #{seen[base]}")
    return stable


def is_wanted(name: str, patterns: Sequence[str]) -> bool:
    """Whether a port is to be opened: by words of its name, or any but a through port."""
    if not patterns:
        return not _THROUGH.search(name)
    return any(
        all(word in name.lower() for word in pattern.lower().split()) for pattern in patterns
    )
