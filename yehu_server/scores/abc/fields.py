"""Read fields of ABC: metre, unit length, tempo, order of parts."""

import re
from fractions import Fraction

from yehu_server.scores.written.notated import HIGHEST_TEMPO, LOWEST_TEMPO

MAX_ORDER = 200  # parts as they are played

_FRACTION = re.compile(r"(\d+)/(\d+)")


def metre_of(text: str) -> Fraction | None:
    """The quarters in a bar; None where it is free or not understood."""
    word = text.strip()
    if word in ("C", "C|"):
        return Fraction(4)
    found = re.fullmatch(r"\(?(\d+(?:\+\d+)*)\)?/(\d+)", word.replace(" ", ""))
    if not found or not 0 < int(found[2][:4]) <= 64:
        return None
    count = sum(int(each[:3]) for each in found[1].split("+"))
    return Fraction(4 * count, int(found[2])) if 0 < count <= 256 else None


def length_of(text: str) -> Fraction | None:
    """A length such as 1/8, in quarters."""
    found = _FRACTION.match(text.strip())
    if found and 0 < int(found[1][:4]) <= 16 and 0 < int(found[2][:4]) <= 512:
        return Fraction(4 * int(found[1]), int(found[2]))
    return Fraction(4) if text.strip() == "1" else None


def tempo_of(text: str, unit: Fraction) -> float | None:
    """Quarters a minute; None where no figure is written."""
    bare = re.sub(r'"[^"]*"', "", text).strip()
    left, equals, right = bare.rpartition("=")
    number = re.match(r"\s*(\d+(?:\.\d+)?)", right)
    if number is None:
        return None
    lengths = [Fraction(int(a), int(b)) for a, b in _FRACTION.findall(left) if 0 < int(b) < 10_000]
    beat = sum(lengths, Fraction(0)) * 4 if equals and lengths else unit
    tempo = float(beat) * float(number[1][:6])
    return tempo if LOWEST_TEMPO <= tempo <= HIGHEST_TEMPO else None


def order_of_parts(text: str) -> list[str]:
    """The parts in the order of a header such as (AB)2C."""
    stack: list[list[str]] = [[]]
    last: list[str] = []
    for sign in re.findall(r"[A-Za-z]|\d+|[()]", text):
        if sign == "(":
            stack.append([])
        elif sign == ")" and len(stack) > 1:
            last = stack.pop()
            stack[-1] += last
        elif sign.isdecimal():
            stack[-1] += last * (min(int(sign[:3]), 20) - 1)
        elif sign.isalpha():
            last = [sign]
            stack[-1] += last
        if sum(map(len, stack)) > MAX_ORDER:
            break
    return [each for level in stack for each in level][:MAX_ORDER]
