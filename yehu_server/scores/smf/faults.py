"""The damage found in a MIDI file: each kind once, with the byte where it is first."""

from __future__ import annotations

from yehu_server.errors import ScoreError

MOST_KINDS = 30  # listed separately; a hostile file could have one for each of its bytes
OTHERS = "further faults of other kinds"


class DamagedError(ScoreError):
    """A file that could be played, with damage, where none is accepted."""


class DamageReport:
    """The damage found in one file, by kind; each entry says how the reader went on."""

    def __init__(self) -> None:
        self._found: dict[str, tuple[int, int]] = {}  # how often, and the first byte

    def add(self, what: str, at: int) -> None:
        """Note a fault at a byte of the file, counted from 0."""
        if what not in self._found and len(self._found) >= MOST_KINDS:
            what = OTHERS
        times, first = self._found.get(what, (0, at))
        self._found[what] = (times + 1, min(first, at))

    @property
    def warnings(self) -> tuple[str, ...]:
        """A line for each kind, by place in the file."""
        by_place = sorted(self._found.items(), key=lambda fault: fault[1][1])
        return tuple(_describe(what, times, at) for what, (times, at) in by_place)

    def refuse(self) -> None:
        """Raise DamagedError for the first fault in the file, if there is one."""
        if self._found:
            what, (_, at) = min(self._found.items(), key=lambda fault: fault[1][1])
            raise DamagedError(f"{_describe(what, 1, at)}: refused by --strict")


def _describe(what: str, times: int, at: int) -> str:
    return f"{what}, at byte {at}" if times == 1 else f"{what}, {times} times, first at byte {at}"
