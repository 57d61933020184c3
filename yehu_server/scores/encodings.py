"""Find the encoding of names and texts that do not say it.

A mark, NUL bytes as UTF-16 has them, and valid UTF-8 speak for themselves. Other text is Chinese or
Japanese where its characters are those that an encoding has for everyday use: GB 2312 and Big5
have them in tables of their own (level 1), JIS X 0208 too, with kana. What is left is Latin-1,
whose accents come one by one, within words.
"""

from __future__ import annotations

import codecs
import re
from functools import lru_cache
from string import ascii_letters

MARKS = {
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}
# Two bytes of the first and last character for everyday use, and of those that are rare: GB 2312,
# Big5 and JIS X 0208, levels 1 and 2. In the order in which they are believed where several fit.
TABLES = {
    "gb18030": ((0xB0A1, 0xD7F9), (0xD8A1, 0xF7FE)),
    "big5": ((0xA440, 0xC67E), (0xC940, 0xF9D5)),
    "cp932": ((0x889F, 0x9872), (0x989F, 0xEAA4)),
}
NAMES = {
    "gb18030": "GB 18030",
    "big5": "Big5",
    "cp932": "Shift-JIS",
    "utf-16-le": "UTF-16",
    "utf-16-be": "UTF-16",
}
LATIN = "latin-1"
HIGH = bytes([0x00, 0x30, *range(0x4E, 0xA0), 0xFF])  # first bytes of what UTF-16 has most of
MAX_BYTES = 1 << 12  # of a text that are judged
MAX_TEXTS = 64
EVERYDAY, RARE, STRANGE = 0.0, 1.0, 3.0  # costs of characters
DEAREST = 1.0  # mean cost of what is believed
_HIGH_BYTE = re.compile(rb"[\x80-\xff]")
_LETTER = re.compile(rb"[A-Za-z ]")
_FOREIGN = re.compile(r"([A-Za-z]?)([^\0-\x7f]+)([A-Za-z]?)")
# Fullwidth forms and punctuation, which are everywhere; and kana.
_SIGNS = re.compile(r"[\u00b7\u2014\u2018-\u201d\u2026\u3000-\u3011\uff01-\uff5e]")
_KANA = re.compile(r"[\u3041-\u30fe]")


def encoding_of(*texts: bytes) -> str:
    """The encoding of texts of one file, as a codec of Python.

    Those that speak for themselves do not count; where all do, it is UTF-8, or that of one alone.
    """
    known = [_evident(text) for text in texts]
    if None not in known:
        return known[0] or "utf-8" if len(known) == 1 else "utf-8"
    unknown = [text for text, own in zip(texts, known, strict=True) if own is None]
    judged = [_judged(text) for text in unknown[:MAX_TEXTS]]
    costs = {name: _cost(judged, name) for name in NAMES}
    best = min(costs, key=lambda name: costs[name])
    return best if costs[best] <= DEAREST else LATIN


def decoded(text: bytes, encoding: str) -> str:
    """Decode a text: as itself says, else by the encoding of its file."""
    own = _evident(text)
    if own == "utf-8" and encoding.startswith("utf-16") and not len(text) % 2:
        own = None  # which UTF-16 of Chinese may be by chance
    return text.decode(own or encoding, "replace").removeprefix("\ufeff")


def _evident(text: bytes) -> str | None:
    """The encoding of a text that has a mark, zeros, or is UTF-8."""
    for mark, name in MARKS.items():
        if text.startswith(mark):
            return name
    if b"\0" in text[:MAX_BYTES].rstrip(b"\0"):
        sides = {"utf-16-le": text[1:MAX_BYTES:2], "utf-16-be": text[:MAX_BYTES:2]}
        strange = {name: len(side.translate(None, HIGH)) for name, side in sides.items()}
        return min(sides, key=lambda name: (strange[name], -sides[name].count(0)))
    try:
        text.decode("utf-8")
    except UnicodeDecodeError:
        return None
    return "utf-8"


def _judged(text: bytes) -> bytes:
    """Some of a text, from shortly before what is not ASCII."""
    found = _HIGH_BYTE.search(text)
    begin = max(found.start() // 2 * 2 - 16, 0) if found else 0
    return text[begin : begin + MAX_BYTES]


def _cost(texts: list[bytes], encoding: str) -> float:
    """How far characters are from those of every day, 0 for them; STRANGE where it cannot be."""
    is_table = encoding in TABLES
    letters = sum(len(_LETTER.findall(text)) for text in texts)
    size = sum(map(len, texts))
    if not is_table and b"\0" not in b"".join(texts) and (2 * letters >= size or size == 2):
        return STRANGE  # two Latin letters are like a character of UTF-16
    best = STRANGE
    for table in (encoding,) if is_table else TABLES:
        total, count = 0.0, 0
        for data in texts:
            try:
                decoder = codecs.getincrementaldecoder(encoding)()
                text = decoder.decode(data, len(data) < MAX_BYTES)  # else the last one is cut
            except UnicodeDecodeError:
                return STRANGE
            for before, run, after in _FOREIGN.findall(text):
                costs = [_cost_of(sign, table) for sign in run]
                # One sign within a word of Latin letters is an accent: Flöte is no 鰐.
                is_accent = (before or after) and (len(run) == 1 or any(costs))
                total += STRANGE * len(run) if is_accent else sum(costs)
                count += len(run)
        # A single one that is rare may be two accents of a short word: þá.
        is_single = count == 1 and total and letters
        best = min(best, STRANGE if is_single or not count else total / count)
    return best


@lru_cache(maxsize=1 << 14)
def _cost_of(sign: str, table: str) -> float:
    """The cost of a character, by its place in the table of an encoding."""
    if _SIGNS.match(sign) or (table == "cp932" and _KANA.match(sign)):
        return EVERYDAY
    try:
        codec = "gb2312" if table == "gb18030" else table
        code = int.from_bytes(sign.encode(codec), "big")
    except UnicodeEncodeError:
        return STRANGE
    if code >= 0xC000 and chr(code & 0xFF) in ascii_letters:  # also an accent and a letter
        return STRANGE
    for cost, (first, last) in zip((EVERYDAY, RARE), TABLES[table], strict=True):
        if first <= code <= last:
            return cost
    return STRANGE  # half a katakana, symbols, and what a maker may define
