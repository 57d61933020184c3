"""The errors that users see, each of one line, and text made safe to print.

Everything the package raises on purpose derives from :class:`YehuError`, so that
the command line can print the message and leave with exit code 2.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Collection


class YehuError(Exception):
    """Any foreseen failure: bad input, a missing device, a full disk."""


class ParameterError(YehuError):
    """An unknown parameter, a wrong type, a value out of bounds or not finite."""


class SettingsError(YehuError):
    """A file of settings that cannot be read or is wrong; `more` are its further errors."""

    def __init__(self, message: str, *more: str) -> None:
        super().__init__(message)
        self.more = more


class MappingError(SettingsError):
    """A mapping that is missing, wrong, or cannot be read or written."""


class PresetError(SettingsError):
    """A preset that is missing, wrong, or cannot be read or written."""


class EnsembleError(SettingsError):
    """An ensemble file that cannot be read, is wrong, or does not fit its score."""


class RefusedError(YehuError):
    """A message to a server that cannot be done as it is: raised there, and where it was sent."""


class ScoreError(YehuError):
    """A performance file (MIDI, gesture) that cannot be read."""


class DeviceError(YehuError):
    """An audio or MIDI device that is missing or cannot be opened."""


class OutputError(YehuError):
    """A result that cannot be written."""


class MeasurementError(YehuError):
    """A measurement of a body that cannot be read, or cannot be what it is said to be."""


LONGEST_WORD = 100  # characters compared to find a similar one, which takes time by their square


def did_you_mean(word: object, known: Collection[str], least: float = 0.6) -> str:
    """A hint at the known word that is most like one, if there is one that is as like as that."""
    import difflib  # takes some milliseconds

    found = difflib.get_close_matches(str(word)[:LONGEST_WORD], known, n=1, cutoff=least)
    return f"; did you mean {found[0]}?" if found else ""


FIRST, LAST = 600, 400  # characters kept of a long line; the reason may be at either end


def shortened(text: str) -> str:
    """Text with the middle cut out where it is long."""
    return text if len(text) <= FIRST + LAST else f"{text[:FIRST]} ... {text[-LAST:]}"


def one_line(text: str) -> str:
    """Text for a terminal: shortened, with everything escaped that is not printable.

    That is, control codes, line ends, marks of writing direction, and bytes of a file name that
    are not valid text.
    """
    text = shortened(text)
    return text if text.isprintable() else "".join(map(_escaped, text))


def _escaped(character: str) -> str:
    if character.isprintable() or unicodedata.category(character) == "Zs":
        return character
    return character.encode("unicode_escape").decode("ascii")
