"""The errors that users see, each of one line, and text made safe to print.

Everything the package raises on purpose derives from :class:`YehuError`, so that
the command line can print the message and leave with exit code 2.
"""

import unicodedata
from collections.abc import Collection, Mapping


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


SHORTEST_BEGINNING = 3  # characters of an address that is compared with the begin of others
LONGEST_WORD = 100  # characters compared to find a similar one, which takes time by their square


# What other programs call options, commands and addresses, by what they are called here.
_OTHER_WORDS = {
    "--audio-device": "device output-device soundcard",
    "--blocksize": "buffer buffer-size buffersize block-size period",
    "--gain-db": "volume gain level",
    "--output": "out outfile wav",
    "--overwrite": "force",
    "--part": "track voice",
    "--rate": "sample-rate samplerate sr",
    "--room": "reverb echo hall ambience",
    "--subtype": "bits bit-depth bitdepth",
    "--tuning": "scale scala temperament scl",
    "--osc": "port",
    "build": "plugin plug-in vst vst3 clap lv2",
    "page": "web browser",
    "score": "convert export",
    "serve": "play live start run server midi osc",
    "/room/level": "reverb wet mix",
    "/panic": "allnotesoff all_notes_off alloff",
    "/pitch": "freq frequency",
    "/preset/load": "program",
}


def _synonyms(word: str) -> list[str]:
    return [here for here, others in _OTHER_WORDS.items() if word.lower() in others.split()]


def did_you_mean(word: object, known: Collection[str], least: float = 0.7) -> str:
    """A hint at the known word that means the same, or is at least as like; empty without one."""
    same = next((each for each in _synonyms(str(word).lstrip("-")) if each in known), None)
    return _hint(same) if same else _most_like(str(word), {each: each for each in known}, least)


def near_address(
    address: str, known: Collection[str], least: float = 0.7, *, prefix: str = ""
) -> str:
    """The same of addresses: one that ends in its name, a group of them, or one that is like it."""
    path = address.rstrip("/")
    name = path.rpartition("/")[2]
    groups = {group: f"{group}/..." for each in known if (group := each.rpartition("/")[0])}
    groups.pop(prefix, None)
    ends = [f"/{path.removeprefix(prefix).lstrip('/')}", *_synonyms(name)]
    found = [each for end in ends for each in known if end[0] == "/" and each.endswith(end)]
    found += [groups[path]] if path in groups else []
    if len(name) >= SHORTEST_BEGINNING:
        found += sorted((each for each in known if each.startswith(path)), key=len)
    shown = groups | {each: each for each in known}
    if found:
        return _hint(found[0])
    names = {each.rpartition("/")[2]: each for each in reversed([*known])} if name == path else {}
    return _most_like(name, names, 0.7) or _most_like(path, shown, least)


def _most_like(word: str, shown: Mapping[str, str], least: float) -> str:
    import difflib  # takes some milliseconds

    bare = {each.lstrip("-"): text for each, text in shown.items()}
    found = difflib.get_close_matches(word[:LONGEST_WORD].lstrip("-"), bare, n=1, cutoff=least)
    return _hint(bare[found[0]]) if found else ""


def _hint(word: str) -> str:
    return f"; did you mean {word}?"


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
