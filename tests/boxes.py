"""Rectangles on a page."""

from itertools import combinations
from typing import NamedTuple


class Rect(NamedTuple):
    name: str
    x: float
    y: float
    w: float
    h: float

    def overlaps(self, other) -> bool:
        by = 1e-6  # what rounding may do
        return (
            self.x + by < other.x + other.w
            and other.x + by < self.x + self.w
            and self.y + by < other.y + other.h
            and other.y + by < self.y + self.h
        )

    def is_within(self, width: float, height: float) -> bool:
        return (
            self.x >= 0
            and self.y >= 0
            and self.x + self.w <= width + 1e-6
            and self.y + self.h <= height + 1e-6
        )


def overlapping(rects) -> list[tuple[str, str]]:
    return [(a.name, b.name) for a, b in combinations(rects, 2) if a.overlaps(b)]
