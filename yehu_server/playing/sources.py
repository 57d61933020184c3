"""Sources by their canonical names: MIDI controllers, properties of a note, OSC addresses."""

import re

from yehu_server.errors import ParameterError
from yehu_server.params.table import PREFIX

BEND, PRESSURE, POLY_PRESSURE = "bend", "pressure", "poly-pressure"
VELOCITY, NOTE = "velocity", "note"
WORDS = (BEND, PRESSURE, POLY_PRESSURE, VELOCITY, NOTE)
OF_ONE_NOTE = (POLY_PRESSURE, VELOCITY, NOTE)
# Data entry, RPN and NRPN, channel mode messages: see core/midi/control_changes.py.
# Sustain (64) holds notes unless a mapping binds it.
RESERVED = {6, 38, *range(96, 102), *range(120, 128)}
COARSE = range(32)  # controllers with a fine half, FINE_ABOVE higher
FINE_ABOVE = 32
STEPS, FINEST = 127, 16383  # largest values of 7 and of 14 bits
NO_NRPN = FINEST  # 127/127 means that none is selected
MPE_FROM = 3  # channels with notes that seem to be MPE's, where no zone says so
CHANNELS = 16  # in each port

_CC = re.compile(r"(?:cc|CC) ?(0|[1-9][0-9]{0,2})(?:/(0|[1-9][0-9]{0,2}))?")
_NRPN = re.compile(r"(?:nrpn|NRPN) ?(0|[1-9][0-9]{0,4})(?:/(0|[1-9][0-9]{0,2}))?")
# An OSC address has no spaces, and none of the characters of patterns.
_ADDRESS = re.compile(r"(?:/[!-.0-~]+)+")
_NOT_IN_ADDRESSES = frozenset("#*,?[]{}")
LONGEST_ADDRESS = 255


def control(number: int) -> str:
    """The source of a 7-bit control change."""
    return f"cc {number}"


def pair(coarse: int) -> str:
    """The source of two control changes that make 14 bits, by the number of the coarse one."""
    return f"cc {coarse}/{coarse + FINE_ABOVE}"


def nrpn(number: int) -> str:
    """The source of a non-registered parameter, 0 to 16382."""
    return f"nrpn {number}"


def is_address(source: str) -> bool:
    """Whether a source is an OSC address."""
    return source.startswith("/")


def is_own(address: str) -> bool:
    """Whether a text is a possible OSC address of the user's own."""
    try:
        return is_address(address) and canonical(address) == address
    except ParameterError:
        return False


def controller(source: str) -> str:
    """The controller of a source: the same for a control change in 7 bits and in 14."""
    return source.partition("/")[0] if source.startswith("cc ") else source


def canonical(text: str) -> str:
    """The canonical name of a source; raises ParameterError where there is no such source."""
    if text in WORDS:
        return text
    if is_address(text):
        return _checked_address(text)
    if found := _CC.fullmatch(text):
        coarse, fine = int(found[1]), found[2] and int(found[2])
        if max(coarse, fine or 0) <= STEPS:
            return _checked_control(text, coarse, fine)
    if found := _NRPN.fullmatch(text):
        number = int(found[1])
        if found[2] is not None and number <= STEPS and int(found[2]) <= STEPS:
            number = number << 7 | int(found[2])
        elif found[2] is not None:
            number = NO_NRPN
        if number < NO_NRPN:
            return nrpn(number)
    raise ParameterError(
        f"unknown source {text!r} (cc 0-119, cc 0/32 to 31/63, nrpn 0-16382, "
        f"{', '.join(WORDS)}, or an OSC address)"
    )


def _checked_control(text: str, coarse: int, fine: int | str | None) -> str:
    if coarse in RESERVED or fine in RESERVED:
        raise ParameterError(f"{text} has a meaning of its own in MIDI")
    if fine is None:
        return control(coarse)
    if coarse not in COARSE:
        raise ParameterError(f"{text}: only cc 0 to 31 have a fine half")
    if fine != coarse + FINE_ABOVE:
        raise ParameterError(f"{text}: the fine half of cc {coarse} is {coarse + FINE_ABOVE}")
    return pair(coarse)


def _checked_address(text: str) -> str:
    if not _ADDRESS.fullmatch(text) or _NOT_IN_ADDRESSES & set(text):
        raise ParameterError(f"{text!r} is not an OSC address")
    if len(text) > LONGEST_ADDRESS:
        raise ParameterError("the OSC address is too long")
    if text == PREFIX or text.startswith(f"{PREFIX}/"):
        raise ParameterError(f"{text}: addresses under {PREFIX} have meanings of their own")
    return text
