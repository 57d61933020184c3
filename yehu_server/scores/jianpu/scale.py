"""The pitches of figures and characters: key, mode and base octave of a jianpu text."""

import re
from collections.abc import Mapping

from yehu_server.scores.jianpu.characters import DEFAULT_MODE, ERSIPU, is_living, semitones_of
from yehu_server.scores.jianpu.note_words import MAJOR, MAX_OCTAVES, Figure
from yehu_server.scores.jianpu.text import Word, failure
from yehu_server.scores.score import nearest_key, printable
from yehu_server.scores.written.layout import SEMITONES
from yehu_server.scores.written.ornaments import Around, around

MIDDLE_C = 60.0
LOWEST_DO = -5.0  # semitones from middle C, without the sharp or flat of the key
DEFAULT_CHARACTER_KEY = 65.0  # F, in which Chaozhou music is written

_KEY = re.compile(r"([1-7])=(?:([A-Ga-g])([#b]?)|([#b])([A-Ga-g]))")


class Scale:
    """The pitches of figures at a place of the text; keys in semitones above middle C."""

    def __init__(self, characters: Mapping[str, float] | None, key: float | None = None) -> None:
        self.mode = DEFAULT_MODE  # of 二四谱
        self.characters = characters or ERSIPU  # semitones above do, in this notation
        self._key = key
        self.fifths = self._fifths()  # the sharps of the key, below 0 flats; None: none is written
        self.first_key, self.has_own = key, False  # the first that is written, if one is
        self._octave = 0

    def read_key(self, text: str) -> bool:
        """Take a key, such as 1=F or 6=D; False where the word is none."""
        found = _KEY.fullmatch(text)
        if found is None:
            return False
        letter, sign = found[2] or found[5], found[3] or found[4]
        do = SEMITONES[letter.upper()] - MAJOR[int(found[1]) - 1]
        self._key = (do - LOWEST_DO) % 12.0 + LOWEST_DO + {"#": 1, "b": -1}.get(sign or "", 0)
        self.fifths = self._fifths()
        if not self.has_own:
            self.has_own, self.first_key = True, self._key
        return True

    def shift(self, octaves: int, word: Word) -> None:
        """Move the base octave. Raises ScoreError where it is too far from the middle."""
        self._octave += octaves
        if abs(self._octave) > MAX_OCTAVES:
            raise failure(word, "the base octave is too far from the middle")

    def pitch(self, figure: Figure, word: Word, *, shifted: bool = False) -> float:
        """The MIDI note of a figure.

        `shifted`: whether the base octave counts; it does not in chords and grace notes.
        Raises ScoreError beyond MIDI's range, or where the notation has no such character.
        """
        key = MIDDLE_C if figure.sign.isascii() else DEFAULT_CHARACTER_KEY
        if self._key is not None:
            key = MIDDLE_C + self._key
        if not figure.sign.isascii() and figure.sign not in self.characters:
            raise failure(word, f"there is no {figure.sign} in this notation")
        octaves = figure.octave + (self._octave if shifted else 0)
        found = key + self._above_do(figure) + figure.alter + 12.0 * octaves
        if not 0.0 <= found <= 127.0:
            raise failure(word, f"{printable(word.text)} is beyond any instrument")
        return found

    def _above_do(self, figure: Figure) -> float:
        """Semitones of a figure without its accidental and octave."""
        if figure.sign.isascii():
            return MAJOR[int(figure.sign) - 1]
        if self._is_ersipu(figure):
            return semitones_of(figure.sign, figure.weight, self.mode)
        return self.characters[figure.sign]

    def around(self, figure: Figure) -> Around:
        """The intervals from a figure to its neighbours in the scale."""
        signs = "1234567" if figure.sign.isascii() else self.characters
        plain = {sign: self._above_do(Figure(sign)) for sign in signs}
        degrees = sorted({semitones % 12.0 for semitones in plain.values()})
        count, base = len(degrees), plain[figure.sign]
        at = degrees.index(base % 12.0)
        own = degrees[at] + self._above_do(figure) - base + figure.alter
        return around(at, own, lambda to: degrees[to % count] + 12.0 * (to // count))

    def _fifths(self) -> int | None:
        return None if self._key is None else nearest_key(7 * round(self._key))

    def living(self, figure: Figure) -> str:
        """The character of a living note of 二四谱; empty for others."""
        if self._is_ersipu(figure) and is_living(figure.sign, figure.weight, self.mode):
            return figure.sign
        return ""

    def _is_ersipu(self, figure: Figure) -> bool:
        return self.characters is ERSIPU and figure.sign in ERSIPU
