"""Converters of arguments: text to value, or an error for argparse."""

from __future__ import annotations

import argparse
from pathlib import Path

LOWEST_A4, HIGHEST_A4 = 390.0, 480.0  # Hz


def target(text: str) -> Path:
    """Convert the path of a file or folder to write."""
    if text == "-":
        raise argparse.ArgumentTypeError(
            "nothing is written to standard output; name a file (./- for one of that name)"
        )
    return Path(text)


def a4(text: str) -> float:
    """Convert the frequency of A4 in Hz."""
    return within(text, LOWEST_A4, HIGHEST_A4, "Hz")


def whole(text: str) -> int:
    """Convert a whole number."""
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None


def port(text: str) -> int:
    """Convert the number of a port, 0 to 65535."""
    value = whole(text)
    if not 0 <= value <= 65535:
        raise argparse.ArgumentTypeError(f"{value} is not a port, 0 to 65535")
    return value


def seed(text: str) -> int:
    """Convert a seed, 0 to 65535."""
    value = whole(text)
    if not 0 <= value <= 65535:
        raise argparse.ArgumentTypeError(f"{value} is not a seed, 0 to 65535")
    return value


def positive(text: str) -> int:
    """Convert a whole number from 1."""
    value = whole(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{value} is not 1 or more")
    return value


def channel(text: str) -> int:
    """Convert a MIDI channel, 1 to 16, to 0 to 15."""
    value = whole(text)
    if not 1 <= value <= 16:
        raise argparse.ArgumentTypeError(f"{value} is not a MIDI channel, 1 to 16")
    return value - 1


def within(text: str, lo: float, hi: float, unit: str) -> float:
    """Convert a number within bounds."""
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if not lo <= value <= hi:  # also refuses NaN
        raise argparse.ArgumentTypeError(f"{text} is not within {lo:g} to {hi:g} {unit}")
    return value


def seconds(text: str) -> float:
    """Convert seconds, 0 to 600."""
    return within(text, 0.0, 600.0, "s")


def hours(text: str) -> float:
    """Convert hours, up to 1000."""
    return within(text, 0.0, 1000.0, "hours")


def share(text: str) -> float:
    """Convert a share, 0 to 1."""
    return within(text, 0.0, 1.0, "")


def decibels(text: str) -> float:
    """Convert decibels, -60 to 24."""
    return within(text, -60.0, 24.0, "dB")
