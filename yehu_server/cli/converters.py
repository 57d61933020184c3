"""Converters of arguments: text to value, or an error for argparse."""

import argparse
import math
import os
import urllib.parse
from collections.abc import Callable
from pathlib import Path


def target(text: str) -> Path:
    """Convert the path of a file or folder to write."""
    if text == "-":
        raise argparse.ArgumentTypeError(
            "nothing is written to standard output; name a file (./- for one of that name)"
        )
    return Path(text)


def folder(text: str) -> Path:
    """Convert the path of a folder to write to, which may be missing."""
    path = target(text)
    there = next(filter(os.path.exists, (path, *path.parents)))
    if not there.is_dir():
        raise argparse.ArgumentTypeError(f"{there}: is a file; name a folder")
    return path


def web_address(text: str) -> str:
    """The address of a page: ``https://host/path``; without a query or a fragment."""
    parts = urllib.parse.urlsplit(text)
    if parts.scheme not in {"http", "https"} or not parts.hostname or parts.query or parts.fragment:
        raise argparse.ArgumentTypeError(f"{text!r}: expected one such as https://host/yehu/")
    return text


def whole(text: str) -> int:
    """Convert a whole number."""
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None


def whole_within(lo: int, hi: float, wrong: str) -> Callable[[str], int]:
    """Make a converter of a whole number within bounds; `wrong` is the error of others."""

    def convert(text: str) -> int:
        value = whole(text)
        if not lo <= value <= hi:
            raise argparse.ArgumentTypeError(f"{value} {wrong}")
        return value

    return convert


def within(text: str, lo: float, hi: float, unit: str) -> float:
    """Convert a number within bounds."""
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if not lo <= value <= hi:  # also refuses NaN
        what = f"{lo:g} to {hi:g} {unit}".rstrip()
        raise argparse.ArgumentTypeError(f"{text} is not within {what}")
    return value


def number_within(lo: float, hi: float, unit: str) -> Callable[[str], float]:
    """Make a converter of a number within bounds; see `within`."""
    return lambda text: within(text, lo, hi, unit)


port = whole_within(0, 65535, "is not a port, 0 to 65535")
positive = whole_within(1, math.inf, "is not 1 or more")
hours = number_within(0.0, 1000.0, "hours")


def channel(text: str) -> int:
    """Convert a MIDI channel, 1 to 16, to 0 to 15."""
    return whole_within(1, 16, "is not a MIDI channel, 1 to 16")(text) - 1
