"""Read ABC, the notation in letters, of version 2.1 (docs/scores.md)."""

import os
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from yehu_server.errors import ScoreError, one_line
from yehu_server.scores.abc import keywords
from yehu_server.scores.abc.fields import metre_of, order_of_parts
from yehu_server.scores.abc.keys import properties_of
from yehu_server.scores.abc.tokens import BLOCK, FIELD
from yehu_server.scores.abc.voice import VoiceReader
from yehu_server.scores.encodings import decoded, encoding_of, guess_line
from yehu_server.scores.score import errors_name, read_score_bytes
from yehu_server.scores.written.assembly import assembled
from yehu_server.scores.written.notated import MAX_PARTS, Written

MAX_BYTES = 4 << 20


def read_abc(path: str | os.PathLike[str], song: int | None = None) -> Written:
    """Read a tune of a file, the first where no other is asked for.

    Raises ScoreError, one line naming the file: where it cannot be read, has no tune, or no such
    one.
    """
    with errors_name(path):
        data = read_score_bytes(path, MAX_BYTES)
        encoding = encoding_of(data)
        head, tunes = _tunes(_shown(decoded(data, encoding)))
        if not tunes:
            raise ScoreError("has no tune of ABC, which begins with X:")
        number = song or 1
        if not 0 < number <= len(tunes):
            raise ScoreError(f"has {len(tunes)} tunes: there is no tune {number}")
        written = _Tune().read([*head, *tunes[number - 1]])
        which = f"tune 1 of {len(tunes)}; --song N takes another"
        lines = [guess_line(encoding), which if len(tunes) > 1 and song is None else ""]
        return replace(written, remarks=(*filter(None, lines), *written.remarks))


def _shown(text: str) -> str:
    """A text whose spaces are of one kind, and without what cannot be shown."""
    strange = {sign for sign in {*text} - {*"\t\r\n"} if not sign.isprintable()}
    return text.translate({ord(sign): " " for sign in strange})


def _tunes(text: str) -> tuple[list[str], list[list[str]]]:
    """The lines of the file's head, and of each tune."""
    head: list[str] = []
    tunes: list[list[str]] = []
    is_open = False
    for line in _without_blocks(text.splitlines()):
        if re.match(r"X:", line):
            tunes.append([])
            is_open = True
        elif not line.strip():
            is_open = False
        if is_open:
            tunes[-1].append(line)
        elif not tunes and line.startswith(("%%", *(f"{name}:" for name in keywords.FIELDS))):
            head.append(line)  # others may be any text
    return head, tunes


def _without_blocks(lines: Sequence[str]) -> Iterator[str]:
    """The lines but for text, PostScript or SVG from `%%begin` to its `%%end` (11.4.5).

    One without an end is left as it is: its directive is told as not understood.
    """
    marks = [BLOCK.match(line) for line in lines]
    last = {found[2]: at for at, found in enumerate(marks) if found and found[1] == "end"}
    inside = ""
    for at, (line, found) in enumerate(zip(lines, marks, strict=True)):
        if inside:
            if found and found[1] == "end" and found[2] == inside:
                inside = ""
        elif found and found[1] == "begin" and last.get(found[2], -1) > at:
            inside = found[2]
        else:
            yield line


class _Tune:
    def __init__(self) -> None:
        self._unknown: Counter[str] = Counter()
        self._warnings: Counter[str] = Counter()
        self._voices: dict[str, VoiceReader] = {}
        self._names: dict[str, str] = {}
        self._defaults: list[tuple[str, str]] = []  # fields of the head
        # What fields of voices say of where notes sound, in the order in which they are named.
        self._properties: dict[str, dict[str, int]] = {}
        self._order = ""
        self._labels: list[tuple[str, int]] = []
        self._title = ""
        self._in_music = False
        self._now: VoiceReader | None = None
        self._shortcuts = dict(keywords.SHORTCUTS)

    def read(self, lines: Sequence[str]) -> Written:
        for written in lines:
            if written.startswith("%%"):
                self._directive(written[2:])
            line = re.sub(r"(?<!\\)%.*", "", written).rstrip()
            if found := FIELD.match(line):
                self._field(found[1], found[2].strip())
            elif self._in_music and line.strip():
                self._reader().line(line, self._inline)
        for voice in self._voices.values():
            voice.end()
        parts = [
            (self._names.get(name, ""), self._voices[name].bars)
            for name in self._properties
            if name in self._voices and self._voices[name].bars
        ]
        if not parts:
            raise ScoreError("has no notes of ABC")
        sections = self._sections(max(len(bars) for _, bars in parts))
        read = assembled(parts, self._title, self._unknown, self._warnings, sections)
        swings = any(voice.is_hornpipe for voice in self._voices.values())
        return replace(read, remarks=(keywords.HORNPIPE,)) if swings else read

    def _reader(self) -> VoiceReader:
        return self._now or self._voice("1")

    def _voice(self, name: str) -> VoiceReader:
        if name not in self._voices:
            if len(self._voices) >= MAX_PARTS:
                raise ScoreError(f"has more than {MAX_PARTS} voices")
            voice = VoiceReader(self._unknown, self._warnings, self._shortcuts)
            metre = next((metre_of(text) for key, text in self._defaults[::-1] if key == "M"), None)
            if metre is not None and metre < 3:
                voice.unit = Fraction(1, 4)
            for key in [*"LMKQR", *keywords.SETTINGS]:
                for letter, text in self._defaults:
                    if letter == key and (key != "Q" or not self._voices):
                        voice.field(letter, text)
            voice.set_properties(self._properties.setdefault(name, {}))
            self._voices[name] = voice
        self._now = self._voices[name]
        return self._now

    def _check(self, name: str, value: str) -> None:
        """Tell of a value that a field or a directive cannot have."""
        if name in keywords.VALUES and not keywords.VALUES[name].fullmatch(value.strip()):
            self._unknown[one_line(f"{name}:{value}"[:40])] += 1

    def _field(self, letter: str, text: str) -> None:
        self._check(letter, text)
        if letter == "T":
            self._title = self._title or "".join(filter(str.isprintable, text))[:200]
        elif letter == "P" and not self._in_music:
            self._order = text
        elif letter == "U":
            sign, _, name = text.partition("=")
            self._shortcuts[sign.strip()[:1]] = name.strip().strip("!+")
        elif letter == "I":
            self._directive(text)
        elif letter == "V":
            self._take_voice(text)
        elif letter == "P":
            self._labels.append((text.strip()[:1], self._reader().label()))
        elif self._in_music and letter in keywords.MUSIC_FIELDS:
            self._reader().field(letter, text)
        elif letter in keywords.MUSIC_FIELDS:
            self._defaults.append((letter, text))
            self._in_music = letter == "K" or self._in_music
        elif keywords.FIELDS.get(letter, keywords.LEFT_OUT) == keywords.LEFT_OUT:
            self._unknown[keywords.NAMES.get(letter, f"{letter}:")] += 1

    def _directive(self, text: str) -> None:
        """Take a directive (11), of a line of its own or of an I: field."""
        name, value = [*text.strip().split(maxsplit=1), "", ""][:2]
        setting = name
        if name.lower() == "midi":
            name = f"MIDI {value.partition(' ')[0]}"
            setting, value = [*value.split(maxsplit=1), "", ""][:2]
        if setting in keywords.SETTINGS:
            self._check(setting, value)
            if self._in_music:
                self._reader().field(setting, value)
            else:
                self._defaults.append((setting, value))
        elif name[:1].isalpha() and re.sub(r"-?\d+$", "", name.lower()) not in keywords.DIRECTIVES:
            self._unknown[one_line(f"%%{name}"[:40])] += 1

    def _take_voice(self, text: str) -> None:
        name, rest = [*(text or "1").split(maxsplit=1), ""][:2]
        found, called, others = properties_of(rest, self._unknown)
        if called:
            self._names[name] = called
        for word in others:
            self._unknown[one_line(f"{word} in V:"[:40])] += 1
        if self._in_music:
            self._voice(name).set_properties(found)
        else:
            self._properties.setdefault(name, {}).update(found)

    def _inline(self, letter: str, text: str) -> VoiceReader:
        self._field(letter, text.strip())
        return self._reader()

    def _sections(self, count: int) -> list[range]:
        """The bars of each part, in the order that the head asks for."""
        begins = [*self._labels, ("", count)]
        ranges: dict[str, range] = {}
        for (name, begin), (_, end) in pairwise(begins):
            ranges.setdefault(name, range(begin, end))
        order = [ranges[name] for name in order_of_parts(self._order) if name in ranges]
        return [range(begins[0][1]), *order] if order and begins[0][1] else order
