"""The errors that users see; each message is one line.

Everything the package raises on purpose derives from :class:`YehuError`, so that
the command line can print the message and leave with exit code 2.
"""

from __future__ import annotations


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
