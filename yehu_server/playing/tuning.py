"""Scala tunings: the pitch of each key; what happens to notes outside the range.

A scale (``.scl``) lists intervals above its first note, 1/1; a keyboard map (``.kbm``) assigns
them to keys and gives the frequency of a reference key.
"""

from __future__ import annotations

import math
import re
from contextlib import suppress
from dataclasses import dataclass, field, replace
from enum import Enum
from pathlib import Path

from yehu_server.compile.jit import uncompiled
from yehu_server.core.midi import tables
from yehu_server.core.midi.notes import fitted, pitch_of_key
from yehu_server.core.physics.elementary import log2
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import ParameterError, did_you_mean
from yehu_server.util.files import MAX_SETTINGS_BYTES, error_reason, read_text, shipped_folder


class RangePolicy(Enum):
    """What happens to a note outside the range of the instrument."""

    TRANSPOSE = "transpose"
    CLAMP = "clamp"
    SKIP = "skip"

    @property
    def code(self) -> int:
        """What it is called in ``midi.tables``."""
        return int(getattr(tables, self.name))

    def fit(self, note: float, notes: NoteRange = YEHU) -> float | None:
        """Return the note to play for `note` on an instrument with some notes, or None for none."""
        playable = uncompiled(fitted)(self.code, *notes.ends, note)
        return None if math.isnan(playable) else playable


KEYS = range(tables.KEY_COUNT)
MIDDLE_C, A4 = 60, 69
# Hz; the pitches of a tuning that is fixed in Hz are stored relative to this A4.
STANDARD_A4 = 440.0
MAX_NOTES = 1024  # in a scale or a map
MAX_DEGREE = 100_000
MOST_STRETCH = 0.5  # semitones of an octave that is stretched
# Bound on the pitch of a key, so that its frequency is a finite number.
MAX_SEMITONES = 10_000.0
MIN_HZ, MAX_HZ = 1e-6, 1e9

# Text after a pitch is ignored, unless it could be part of the number.
_CENTS = re.compile(r"([+-]?(?:[0-9]+\.[0-9]*|\.[0-9]+))(?![0-9./]|,[0-9]|[eE][+-]?[0-9])")
_RATIO = re.compile(
    r"([+-]?[0-9]{1,1000}+)(?:[ \t]*/[ \t]*([+-]?[0-9]{1,1000}+))?+(?![0-9./]|,[0-9])"
)
_WHOLE = re.compile(r"[+-]?[0-9]{1,18}")
_FREQUENCY = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_LINE_END = re.compile(r"\r\n|\r|\n")
_NO_TEXT = re.compile(r"[\x00-\x08\x0e-\x19\x1b-\x1f]")  # 1a (hex) ends a DOS text


@dataclass(frozen=True)
class Tuning:
    """The pitch of every key."""

    name: str
    # Pitches of keys 0 to 127 (fractional MIDI notes; None for an unmapped key), relative to A4;
    # None where each key sounds its own number.
    keys: tuple[float | None, ...] | None = None
    # Whether pitches are relative to an A4 of 440 Hz, whatever the instrument's A4 is.
    fixed: bool = False
    files: tuple[Path, ...] = field(default=(), compare=False)  # the files that it was read from
    transposed_by: int = 0  # semitones, which `keys` have already

    def transposed(self, semitones: int) -> Tuning:
        """The same tuning with every key so many semitones higher."""
        keys = KEYS if self.keys is None else self.keys
        moved = tuple(None if key is None else key + semitones for key in keys)
        return replace(self, keys=moved, transposed_by=semitones) if semitones else self

    @property
    def has_octaves(self) -> bool:
        """Whether twelve keys are an octave, wherever both have a pitch."""
        return self._off_octave < 0.01

    @property
    def is_in_a_row(self) -> bool:
        """Whether keys play a scale's notes in a row, so that a tune written in 12 is another."""
        return len(self.files) == 1 and self._off_octave > MOST_STRETCH

    @property
    def _off_octave(self) -> float:
        """The largest distance of twelve keys from an octave, in semitones."""
        keys = self.keys or ()
        pairs = zip(keys, keys[12:], strict=False)
        far = (abs(b - a - 12.0) for a, b in pairs if a is not None and b is not None)
        return max(far, default=0.0)

    def pitch(self, note: float, a4: float) -> float | None:
        """Return the pitch of a key as a fractional MIDI note relative to `a4` (Hz).

        A fractional `note` is interpolated between the mapped keys below and above. None for an
        unmapped key, and beyond the outermost mapped keys.
        """
        if self.keys is None:
            return note
        pitches = [math.nan if key is None else key for key in self.keys]
        pitch = uncompiled(pitch_of_key)(pitches, note)
        if math.isnan(pitch):
            return None
        return pitch - 12.0 * log2(a4 / STANDARD_A4) if self.fixed else pitch


EQUAL = Tuning("12-tone equal temperament")


def read_tuning(scale: Path, keyboard: Path | None = None) -> Tuning:
    """Read a Scala scale and, if given, a Scala keyboard map; a bare name means a shipped file.

    Without a map the scale's 1/1 is key 60 at its pitch in equal temperament, and each key plays
    the next note of the scale. With a map the pitches are fixed in Hz. Raises ParameterError,
    naming the file, and the line where that is known.
    """
    scale = _found(scale, ".scl")
    keyboard = None if keyboard is None else _found(keyboard, ".kbm")
    lines = _Lines(scale)
    name = lines.title() or scale.stem
    count = lines.whole("the number of notes", 0, MAX_NOTES)
    notes = tuple(_note(lines, f"note {n} of {count}") for n in range(1, count + 1))
    layout = _Keyboard() if keyboard is None else _read_keyboard(keyboard)
    reference = layout.interval(layout.reference, notes)
    if reference is None:
        where = f"{keyboard}: line {layout.reference_line}"
        raise ParameterError(f"{where}: the reference key {layout.reference} is not mapped")
    above = layout.reference_pitch - reference
    keys: list[float | None] = [None] * len(KEYS)
    for key in range(layout.first, layout.last + 1):
        interval = layout.interval(key, notes)
        if interval is not None:
            pitch = above + interval
            if abs(pitch) > MAX_SEMITONES:
                raise ParameterError(f"{scale}: key {key} would be {pitch:.0f} semitones away")
            keys[key] = pitch
    if all(key is None for key in keys):
        raise ParameterError(f"{keyboard}: maps no key")
    files = (scale,) if keyboard is None else (scale, keyboard)
    return Tuning(name, tuple(keys), fixed=keyboard is not None, files=files)


def shipped_tunings() -> dict[str, Tuning]:
    """Equal temperament, and the shipped scales: each by itself and on each map that takes it."""
    folder = shipped_folder("tunings")
    found = {"equal": EQUAL}
    for scale in sorted(folder.glob("*.scl")):
        found[scale.stem] = read_tuning(scale)
        for keyboard in sorted(folder.glob("*.kbm")):
            with suppress(ParameterError):  # the scale is not one for this map
                found[f"{scale.stem}, {keyboard.stem}"] = read_tuning(scale, keyboard)
    return found


def _found(path: Path, ending: str) -> Path:
    """The file of a path, or of the name of a shipped file."""
    if path.suffix or path.name != str(path) or path.exists():
        return path
    folder = shipped_folder("tunings")
    shipped = folder / f"{path}{ending}"
    if not shipped.exists():
        names = sorted(file.stem for file in folder.glob(f"*{ending}"))
        there = f"(shipped: {', '.join(names)}; or name a file){did_you_mean(path, names)}"
        what = "scale" if ending == ".scl" else "keyboard map"
        raise ParameterError(f"no {what} {str(path)!r} {there}")
    return shipped


@dataclass(frozen=True)
class _Keyboard:
    """A keyboard map; its defaults are the map of a scale without one.

    `degrees` are those of the scale from the `middle` key up, None for no note; they repeat
    `octave` degrees higher (0: one scale higher). Without degrees, keys follow the scale.
    """

    first: int = KEYS[0]
    last: int = KEYS[-1]
    middle: int = MIDDLE_C
    reference: int = MIDDLE_C
    reference_line: int = 0
    reference_pitch: float = float(MIDDLE_C)
    octave: int = 0
    degrees: tuple[int | None, ...] = ()

    def interval(self, key: int, notes: tuple[float, ...]) -> float | None:
        """Semitones from the scale's 1/1 on the middle key to any key; None if unmapped."""
        steps = key - self.middle
        if not self.degrees:
            return _interval(steps, notes)
        octaves, index = divmod(steps, len(self.degrees))
        degree = self.degrees[index]
        octave = _interval(self.octave or len(notes), notes)
        own = None if degree is None else _interval(degree, notes)
        return None if own is None or octave is None else own + octaves * octave


def _interval(degree: int, notes: tuple[float, ...]) -> float | None:
    """Semitones from 1/1 to a degree; the last note of a scale is 1/1 of the next octave."""
    if not notes:
        return 0.0 if degree == 0 else None
    octaves, index = divmod(degree, len(notes))
    return octaves * notes[-1] + (notes[index - 1] if index else 0.0)


class _Lines:
    """The lines of a file, without its comments."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.number = 0  # of the line read last
        try:
            text = read_text(path, MAX_SETTINGS_BYTES)
        except UnicodeDecodeError as error:
            text = error.object.decode("latin-1")
        except (OSError, ValueError) as error:  # a name may have a NUL
            raise ParameterError(f"{path}: {error_reason(error)}") from error
        if _NO_TEXT.search(text):
            raise ParameterError(f"{path}: not a text file")
        self._lines = _LINE_END.split(text.removeprefix("\ufeff").partition("\x1a")[0])

    def error(self, message: str) -> ParameterError:
        """Make an error about the line read last."""
        return ParameterError(f"{self.path}: line {max(self.number, 1)}: {message}")

    def title(self) -> str:
        """Read the first line, which may be empty."""
        while self.number < len(self._lines):
            line = self._lines[self.number]
            self.number += 1
            if not line.startswith("!"):
                return line.strip()
        raise self.error("the file ends before the description")

    def next(self) -> str | None:
        """Read the next line that is not empty; None at the end."""
        while self.number < len(self._lines):
            line = self._lines[self.number].partition("!")[0].strip()
            self.number += 1
            if line:
                return line
        return None

    def take(self, what: str) -> str:
        """Read the next line; raises where the file ends."""
        line = self.next()
        if line is None:
            raise self.error(f"the file ends before {what}")
        return line

    def whole(self, what: str, lo: int, hi: int) -> int:
        """Read the next line as an integer within bounds."""
        return self.check(self.take(what), what, lo, hi)

    def check(self, line: str, what: str, lo: int, hi: int) -> int:
        """Convert a line just read to an integer within bounds."""
        if not _WHOLE.fullmatch(line):
            raise self.error(f"expected {what}, got {_quote(line)}")
        if not lo <= int(line) <= hi:
            raise self.error(f"{what}: {int(line)} is not within {lo} to {hi}")
        return int(line)


def _octaves(number: int) -> float:
    """The logarithm to base 2 of a number of any size above zero."""
    beyond = max(number.bit_length() - 1000, 0)
    return log2(float(number >> beyond)) + beyond


def _note(lines: _Lines, what: str) -> float:
    line = lines.take(what)
    if cents := _CENTS.match(line):
        semitones = float(cents[1]) / 100.0
    elif ratio := _RATIO.match(line):
        over, under = int(ratio[1]), int(ratio[2] or 1)
        if over <= 0 or under <= 0:
            raise lines.error(f"{what}: a ratio must be above zero, not {_quote(line)}")
        semitones = 12.0 * (_octaves(over) - _octaves(under))
    else:
        raise lines.error(f"{what}: expected cents or a ratio, got {_quote(line)}")
    if abs(semitones) > MAX_SEMITONES:
        raise lines.error(f"{what}: {_quote(line)} is too far away")
    return semitones


def _read_keyboard(path: Path) -> _Keyboard:
    lines = _Lines(path)
    lowest, highest = KEYS[0], KEYS[-1]
    size = lines.whole("the size of the map", 0, MAX_NOTES)
    first = lines.whole("the first key", lowest, highest)
    last = lines.whole("the last key", first, highest)
    middle = lines.whole("the middle key", lowest, highest)
    reference = lines.whole("the reference key", lowest, highest)
    reference_line = lines.number
    line = lines.take("the reference frequency")
    if not _FREQUENCY.fullmatch(line):
        raise lines.error(f"expected the reference frequency, got {_quote(line)}")
    if not MIN_HZ <= float(line) <= MAX_HZ:
        bounds = f"{MIN_HZ:g} to {MAX_HZ:g} Hz"
        raise lines.error(f"the reference frequency: {_quote(line)} is not within {bounds}")
    pitch = A4 + 12.0 * log2(float(line) / STANDARD_A4)
    octave = lines.whole("the degree of the octave", 0, MAX_DEGREE)
    degrees: list[int | None] = [None] * size  # unmapped keys at the end may be left out
    for index in range(size):
        entry = lines.next()
        if entry is None:
            break
        if entry not in {"x", "X"}:
            degrees[index] = lines.check(entry, "a degree of the scale, or x", 0, MAX_DEGREE)
    return _Keyboard(first, last, middle, reference, reference_line, pitch, octave, tuple(degrees))


def _quote(line: str) -> str:
    return repr(line if len(line) <= 40 else f"{line[:40]}...")
