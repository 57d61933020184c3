"""Split a jianpu text into words and headers with their places, without comments and lyrics."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from yehu_server.errors import ScoreError
from yehu_server.scores.encodings import LATIN, encoding_of, guess_line

# Plain signs for those of Chinese keyboards and word processors; one for one, so that columns stay.
_PLAIN = {
    **{code: code - 0xFEE0 for code in range(0xFF01, 0xFF5F)},
    **dict.fromkeys((0x2018, 0x2019, 0x2032), ord("'")),
    **dict.fromkeys((0x2013, 0x2014, 0x2015, 0x2212, 0x2500), ord("-")),
    0x201A: ord(","),
    0x3000: ord(" "),
    0xFEFF: ord(" "),
    0xFF61: ord("."),
    0x266D: ord("b"),
    0x266F: ord("#"),
}

_HEADER = re.compile(r"\s*([^\W\d_]+)\s*=")
_WORD_SIGNS = {"Fr", "slide"}  # begin with a name and = as headers do, but are words
_WORD = re.compile(r'[_^-]?"[^"]*"|\S+')
_TO_BLANK = re.compile(r"\s*(?:[LH]:|chords\s*=)\s*")  # with nothing more: up to an empty line
_NEXT = re.compile(r"(?<!\S)Next(?:Part|Score)(?!\S)")
_LYRICS = ("L:", "H:")
_TEMPO_COMMENT = re.compile(r"%%\s*tempo:\s*(\S+)\s*")


class Word(NamedTuple):
    """A word and its place, counted from 1."""

    text: str
    line: int
    column: int


class Header(NamedTuple):
    """A line such as ``title=...``; the name in lower case."""

    name: str
    value: str
    line: int


def failure(word: Word, reason: str) -> ScoreError:
    """An error at a word."""
    return ScoreError(f"line {word.line}, column {word.column}: {reason}")


def decoded(data: bytes) -> tuple[str, str]:
    """Return the text of a file, and a warning where its encoding was guessed.

    Raises ScoreError where it is no text in UTF-8 or an encoding that `encodings` knows.
    """
    encoding = encoding_of(data)
    if encoding == LATIN:  # of which jianpu has no use
        encoding = "gb18030"
    try:
        text = data.decode(encoding).removeprefix("\ufeff")
    except UnicodeDecodeError:
        raise ScoreError("is not text in UTF-8 or GB 18030") from None
    if "\0" in text:
        raise ScoreError("is not text")
    return text, guess_line(encoding)


def words_of(text: str) -> Iterator[Word | Header]:
    """The words and headers of a text without comments and lyrics; LilyPond code is ``LP:``."""
    in_code = in_lyrics = False
    for number, written in _divided(text):
        line = written.translate(_PLAIN)
        bare = line.strip()
        if in_code:
            in_code = not bare.startswith(":LP")
        elif in_lyrics:
            in_lyrics = bool(bare)
        elif bare.startswith(("LP:", "LPH:")):
            in_code = True
            yield Word("LP:", number, line.index("LP") + 1)
        elif _TO_BLANK.fullmatch(line):
            in_lyrics = True
            if bare.startswith("chords"):
                yield Header("chords", "", number)
        elif not bare.startswith(_LYRICS):
            yield from _words_in(line, written, number)


def _divided(text: str) -> Iterator[tuple[int, str]]:
    """Lines and their numbers; NextPart and NextScore begin one, and end it, as in jianpu-ly.

    What follows on the same line stays at its column.
    """
    for number, line in enumerate(text.splitlines(), start=1):
        begin = 0
        for found in _NEXT.finditer(line):
            if "%" not in line[: found.start()]:
                yield number, " " * begin + line[begin : found.start()]
                yield number, " " * found.start() + found[0]
                begin = found.end()
        yield number, " " * begin + line[begin:]


def _words_in(line: str, written: str, number: int) -> Iterator[Word | Header]:
    header = _HEADER.match(line)
    if header and header[1] not in _WORD_SIGNS:
        yield Header(header[1].lower(), written[header.end() :].strip(), number)
        return
    tempo = _TEMPO_COMMENT.fullmatch(line.strip())
    if tempo:
        yield Word(tempo[1], number, line.index(tempo[1]) + 1)
        return
    for found in _WORD.finditer(line):
        if found[0].startswith("%"):
            return
        yield Word(found[0], number, found.start() + 1)
