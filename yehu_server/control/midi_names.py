"""MIDI ports by the part of their names that stays the same."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Sequence

# ALSA ends a name in numbers that change with each plugging in; Windows counts ports.
_CHANGING = re.compile(r"(?<=\S)\s+\d+(:\d+)?$")
_THROUGH = re.compile(r"\bthrough\b|\bthru\b", re.IGNORECASE)


def _base(name: str) -> str:
    base = _CHANGING.sub("", name.strip())
    # ALSA: "Client:Client MIDI 1" says the client twice.
    client, colon, port = base.partition(":")
    return port if colon and port.startswith(client) else base


class StableNames:
    """Names that ports keep while they are there, and get again when they come back.

    Of several ports alike the second is called ``#2``, and so on; when the first goes, the
    second stays the second.
    """

    def __init__(self) -> None:
        self._names: dict[tuple[str, int], str] = {}

    def of(self, full_names: Iterable[str]) -> list[str]:
        """The names of the ports that are there now, in order."""
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
    """The names of ports that are seen for the first time; see `StableNames`."""
    return StableNames().of(names)


def is_wanted(name: str, patterns: Sequence[str]) -> bool:
    """Whether a port is to be opened: by words of its name, or any but a through port."""
    if not patterns:
        return not _THROUGH.search(name)
    return any(
        all(word in name.lower() for word in pattern.lower().split()) for pattern in patterns
    )
