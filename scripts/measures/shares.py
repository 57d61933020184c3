"""How many of the cases of a measure are right: counted, printed, and as JSON values."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Share:
    """The cases that are right, of one part of a measure.

    `counts`: whether the part counts for the whole measure; others are there to compare with.
    """

    what: str
    right: int
    of: int
    counts: bool = True

    @property
    def percent(self) -> float:
        return 100.0 * self.right / self.of if self.of else 100.0

    def __str__(self) -> str:
        return f"{self.what}: {self.right} of {self.of} ({self.percent:.1f} %)"

    def as_data(self) -> dict[str, Any]:
        """Return what is written to a JSON file."""
        return {
            "what": self.what,
            "right": self.right,
            "of": self.of,
            "percent": round(self.percent, 2),
        }


def share(what: str, right: Iterable[Any]) -> Share:
    """Count the cases that are right."""
    cases = [bool(is_right) for is_right in right]
    return Share(what, sum(cases), len(cases))


def share_line(
    what: str, right: Iterable[Any], words: Iterable[str] = (), *, counts: bool = True
) -> Share:
    """Count the cases that are right; print the share, and the words for those that are not."""
    cases = [bool(is_right) for is_right in right]
    found = Share(what, sum(cases), len(cases), counts)
    wrong = [text for text, is_right in zip(words, cases, strict=False) if not is_right]
    print(f"{found}{': ' if wrong else ''}{', '.join(wrong)}", flush=True)
    return found


def whole(measure: str, parts: Iterable[Share]) -> Share:
    """Return the share of a measure, from those of its parts."""
    counted = [part for part in parts if part.counts]
    return Share(measure, sum(part.right for part in counted), sum(part.of for part in counted))
