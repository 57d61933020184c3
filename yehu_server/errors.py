"""The errors that users see, each of one line, and text made safe to print.

Everything the package raises on purpose derives from :class:`YehuError`, so that
the command line can print the message and leave with exit code 2.
"""

import unicodedata
from collections.abc import Collection, Sequence


class YehuError(Exception):
    """Any foreseen failure: bad input, a missing device, a full disk; notes are further ones."""

    @property
    def lines(self) -> tuple[str, ...]:
        """What is wrong, and what else is, a line each."""
        return (str(self), *getattr(self, "__notes__", ()))


class ParameterError(YehuError):
    """An unknown parameter, a wrong type, a value out of bounds or not finite."""


class SettingsError(YehuError):
    """A file of settings that cannot be read or is wrong."""


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
    "--transpose": "key keys pitch semitones shift",
    "--tuning": "scale scala temperament scl",
    "--osc": "port",
    "build": "plugin plug-in vst vst3 clap lv2",
    "page": "web browser",
    "render": "play",
    "score": "convert export",
    "serve": "play live start run server midi osc",
    "/room/level": "reverb wet mix",
    "/note": "play noteon note_on noteoff note_off key",
    "/panic": "allnotesoff all_notes_off alloff stop",
    "/pitch": "freq frequency slide glide",
    "/playing/bend": "pitchbend pitch_bend bender",
    "/playing/press": "aftertouch",
    "/playing/speed": "bow_speed bowspeed",
    "/playing/vibrato": "vibrato_depth",
    "/preset/load": "program",
}


def _synonyms(word: str) -> list[str]:
    return [here for here, others in _OTHER_WORDS.items() if word.lower() in others.split()]


def did_you_mean(word: object, known: Collection[str], least: float = 0.7) -> str:
    """A hint at the known word that means the same, or is at least as like; empty without one."""
    bare = {each.lstrip("-"): each for each in known}
    own = str(word).lstrip("-")
    begun = [each for each in bare if len(own) >= SHORTEST_BEGINNING and each.startswith(own)]
    same = [each for each in _synonyms(own) if each in known][:2]
    return _hint(same or [bare[each] for each in _near(own, bare, least) or begun[:1]])


def near_address(address: str, known: Collection[str], *, prefix: str = "") -> str:
    """The same of addresses: those that end in it or begin with it, else one like it."""
    path = address.rstrip("/")
    own = f"/{path.removeprefix(prefix).lstrip('/')}"
    name = own.rpartition("/")[2]
    ends = [*(_synonyms(name) if own == f"/{name}" else ()), own]
    found = [each for end in ends for each in known if end[:1] == "/" and each.endswith(end)]
    groups = {each.rpartition("/")[0] for each in known} - {"", prefix}
    if len(name) >= SHORTEST_BEGINNING:
        begun = [each for each in {*known, *groups} if each.startswith(path)]
        begun = [each for each in begun if "/" not in each[len(path) :]]
        found += sorted(begun, key=lambda each: (len(each), each))[:1]
    found = found or [each for each in [_like_part_by_part(path, known)] if each]
    if not found and own == f"/{name}":
        names = {each.rpartition("/")[2]: each for each in reversed([*known])}
        found = [names[each] for each in _near(name, names, 0.8)]
    return _hint([each if each in known else f"{each}/..." for each in dict.fromkeys(found)])


def _like_part_by_part(path: str, known: Collection[str]) -> str:
    """The address, or the group, each part of which is like that of a path; else empty.

    Of a path that goes on beyond an address it is that address.
    """
    at = ""
    for part in path.split("/")[1:]:
        below = [each[len(at) + 1 :] for each in known if each.startswith(f"{at}/")]
        near = _near(part, {each.partition("/")[0] for each in below})
        if not near:
            return at if at in known else ""
        at += f"/{near[0]}"
    return at


def _near(word: str, words: Collection[str], least: float = 0.75) -> list[str]:
    """The one of some words that is most like another, at least so much; empty without one."""
    import difflib  # takes some milliseconds

    folded = {each.casefold(): each for each in words}
    word = word[:LONGEST_WORD].casefold()
    return [folded[each] for each in difflib.get_close_matches(word, folded, n=1, cutoff=least)]


def _hint(words: Sequence[str]) -> str:
    return f"; did you mean {' or '.join(words[:2])}?" if words else ""


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
