"""Which MIDI input ports are opened, and names that they keep when they are plugged in again."""

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
        named = {key: self._names[key] for key in present if key in self._names}
        taken = set(named.values())
        for key in present:
            if key not in named:
                base = _base(key[0])
                choices = (base if n == 1 else f"{base} #{n}" for n in itertools.count(1))
                named[key] = next(name for name in choices if name not in taken)
                taken.add(named[key])
        self._names = named
        return [named[key] for key in present]


def matches(name: str, words: str) -> bool:
    """Whether the name of a port has all of some words, in any order and case."""
    return all(word in name.lower() for word in words.lower().split())


def is_opened(name: str, patterns: Sequence[str], *, others: bool) -> bool:
    """Whether to open a port: one that a pattern matches, and with `others` any but through ports.

    A pattern is words of its name.
    """
    is_other = others and not _THROUGH.search(name)
    return is_other or any(matches(name, words) for words in patterns)
