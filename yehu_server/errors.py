"""The errors a user can meet; each message is one clear line.

Everything the package raises on purpose derives from :class:`YehuError`, so that
the command line can print the message and leave with exit code 2.
"""

from __future__ import annotations


class YehuError(Exception):
    """Any foreseen failure: bad input, a missing device, a full disk."""


class ParameterError(YehuError):
    """An unknown parameter, a wrong type, a value out of bounds or not finite."""


class SettingsError(YehuError):
    """A file of the user's that cannot be read or does not make sense.

    `more` has a line for everything else that is wrong with it.
    """

    def __init__(self, message: str, *more: str) -> None:
        super().__init__(message)
        self.more = more


class MappingError(SettingsError):
    """A mapping that is not there, cannot be read or written, or does not make sense."""


class PresetError(SettingsError):
    """A preset that is not there, cannot be read or written, or does not make sense."""


class RefusedError(YehuError):
    """A message to a server that cannot be done as it is: raised there, and where it was sent."""


class ScoreError(YehuError):
    """A performance file (MIDI, gesture) that cannot be read."""


class DeviceError(YehuError):
    """An audio or MIDI device that is missing or refuses."""


class OutputError(YehuError):
    """A result that cannot be written where it should go."""
