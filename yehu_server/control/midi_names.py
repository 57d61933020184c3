"""Stable names of MIDI ports: without the numbers that change when a port is plugged in again."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Sequence

# ALSA appends numbers that change each time a device is plugged in; Windows counts ports.
_CHANGING = re.compile(r"(?<=\S)\s+\d+(:\d+)?$")
_THROUGH = re.compile(r"\bthrough\b|\bthru\b", re.IGNORECASE)


def _base(name: str) -> str:
    base = _CHANGING.sub("", name.strip())
    # ALSA repeats the client: "Client:Client MIDI 1".
    client, colon, port = base.partition(":")
    return port if colon and port.startswith(client) else base


class StableNames:
    """Gives ports names that they keep, and get again when they come back.

    Of several ports with one name the second is called ``#2``, and so on; it stays so when the
    first one goes.
    """

    def __init__(self) -> None:
        self._names: dict[tuple[str, int], str] = {}

    def of(self, full_names: Iterable[str]) -> list[str]:
        """The names of the ports that are present now, in order."""
        present: dict[tuple[str, int], str] = {}
        for full_name in full_names:
            count = next(n for n in itertools.count() if (full_name, n) not in present)
            present[full_name, count] = ""
        kept = {key: self._names[key] for key in present if key in self._names}
        taken = set(kept.values())
        for key in present:
            if key not in kept:
                base = _base(key[0])
                choices = (base if n == 1 else f"{base} #{n}" for n in itertools.count(1))
                kept[key] = next(name for name in choices if name not in taken)
                taken.add(kept[key])
        self._names = kept
        return [kept[key] for key in present]


def stable_names(names: Iterable[str]) -> list[str]:
    """The names of ports that are all seen for the first time; see `StableNames`."""
    return StableNames().of(names)


def is_wanted(name: str, patterns: Sequence[str]) -> bool:
    """Whether to open a port: by words of its name; without patterns, any but a through port."""
    if not patterns:
        return not _THROUGH.search(name)
    return any(
        all(word in name.lower() for word in pattern.lower().split()) for pattern in patterns
    )
