"""Find the encoding of names and texts that do not say it.

A mark and valid UTF-8 speak for themselves. Other text is Chinese, Japanese or Korean where its
characters are frequent, or at least those that an encoding has for everyday use: GB 2312 and Big5
have them in tables of their own (level 1), JIS X 0208 too, with kana, and KS X 1001 has the usual
syllables. It is Cyrillic where its words have vowels, and capitals first. What is left is Latin-1,
whose accents come one by one, within words.
"""

import codecs
import re
from functools import lru_cache
from string import ascii_letters

from yehu_server.scores.frequent_characters import CYRILLIC, HAN, HANGUL

MARKS = {
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}
# Two bytes of the first and last character for everyday use, and of those that are rare: GB 2312,
# Big5, JIS X 0208 (levels 1 and 2) and KS X 1001. In the order in which they are believed where
# several fit.
TABLES = {
    "gb18030": ((0xB0A1, 0xD7F9), (0xD8A1, 0xF7FE)),
    "big5": ((0xA440, 0xC67E), (0xC940, 0xF9D5)),
    "cp932": ((0x889F, 0x9872), (0x989F, 0xEAA4)),
    "cp949": ((0xB0A1, 0xC8FE), (0xCAA1, 0xFDFE)),
}
STRICT = {"gb18030": "gb2312", "cp949": "euc_kr"}  # codecs without what was added later
NAMES = {
    "gb18030": "GB 18030",
    "big5": "Big5",
    "cp932": "Shift-JIS",
    "cp949": "EUC-KR",
    "cp1251": "Windows-1251",
}
LATIN = "latin-1"
MAX_BYTES = 1 << 12  # of a text that are judged
MAX_TEXTS = 64
SHORTEST = 3  # letters of Cyrillic together, in the longest word: Þá is two
FREQUENT, EVERYDAY, RARE, STRANGE = 0.0, 0.5, 1.0, 3.0  # costs of characters
DEAREST = 1.0  # mean cost of what is believed
_HIGH_BYTE = re.compile(rb"[\x80-\xff]")
_LETTER = re.compile(rb"[A-Za-z ]")
_FOREIGN = re.compile(r"([A-Za-z]?)([^\0-\x7f]+)([A-Za-z]?)")
# Fullwidth forms and punctuation, which are everywhere; and kana.
_SIGNS = re.compile(
    r"[\u00ab\u00b7\u00bb\u2116\u2014\u2018-\u201d\u2026\u3000-\u3011\uff01-\uff5e]"
)
_KANA = re.compile(r"[\u3041-\u30fe]")
_CYRILLIC = re.compile(r"[\u0401-\u045f\u0490\u0491]+")
_VOWEL = re.compile("^(?![ъыь]).*[аеёиоуыэюяіїє](?!.*ъ$)")  # and signs where they may stand


def encoding_of(*texts: bytes) -> str:
    """The encoding of texts of one file, as a codec of Python.

    Those that speak for themselves do not count, but for one alone; where all do, it is UTF-8.
    """
    known = [_evident(text) for text in texts]
    unknown = [_judged(text) for text, own in zip(texts, known, strict=True) if own is None]
    if not unknown:
        return (len(known) == 1 and known[0]) or "utf-8"
    costs = {name: _cost(unknown[:MAX_TEXTS], name) for name in NAMES}
    best = min(costs, key=lambda name: costs[name])
    return best if costs[best] <= DEAREST else LATIN


def decoded(text: bytes, encoding: str) -> str:
    """Decode a text: as itself says, else by the encoding of its file."""
    return text.decode(_evident(text) or encoding, "replace").removeprefix("\ufeff")


def guess_line(encoding: str) -> str:
    """A line that names the encoding of a file where it was guessed; else empty."""
    return f"is not UTF-8: read as {NAMES[encoding]}" if encoding in NAMES else ""


def _evident(text: bytes) -> str | None:
    """The encoding of a text that has a mark or is UTF-8."""
    for mark, name in MARKS.items():
        if text.startswith(mark):
            return name
    try:
        text.decode()
    except UnicodeDecodeError:
        return None
    return "utf-8"


def _judged(text: bytes) -> bytes:
    """Some of a text, from shortly before what is not ASCII."""
    found = _HIGH_BYTE.search(text)
    begin = max(found.start() - 16, 0) if found else 0
    return text[begin : begin + MAX_BYTES]


def _cost(texts: list[bytes], encoding: str) -> float:
    """How far characters are from those of every day, 0 for them; STRANGE where it cannot be."""
    total, count, longest = 0.0, 0, 0
    for data in texts:
        try:
            decoder = codecs.getincrementaldecoder(encoding)()
            text = decoder.decode(data, len(data) < MAX_BYTES)  # else the last one is cut
        except UnicodeDecodeError:
            return STRANGE
        for before, run, after in _FOREIGN.findall(text):
            of_run = _costs_of(run, encoding)
            # One sign within a word of Latin letters is an accent: Flöte is no 鰐.
            is_accent = (before or after) and (len(run) == 1 or max(of_run) >= RARE)
            total += STRANGE * len(run) if is_accent else sum(of_run)
            count += len(run)
            longest = max(longest, len(run))
    # A single one that is rare may be two accents of a short word: þá.
    if not count or (count == 1 and total >= RARE and any(map(_LETTER.search, texts))):
        return STRANGE
    cost = total / count
    is_word = encoding in TABLES or (longest >= SHORTEST and cost <= EVERYDAY)
    return cost if is_word else STRANGE


def _costs_of(run: str, encoding: str) -> list[float]:
    """The costs of the characters of a run, in a table of TABLES or in Cyrillic."""
    if encoding in TABLES:
        return [_cost_of(sign, encoding) for sign in run]
    places = [CYRILLIC.find(sign.lower()) for sign in run]
    costs = [
        place / len(CYRILLIC) if place >= 0 else EVERYDAY if _SIGNS.match(sign) else STRANGE
        for sign, place in zip(run, places, strict=True)
    ]
    for word in _CYRILLIC.findall(run):
        usual = word in (word.lower(), word.upper(), word.capitalize())
        if not usual or (len(word) > 1 and not _VOWEL.search(word.lower())):
            costs = [cost + RARE for cost in costs]
    return costs


@lru_cache(maxsize=1 << 14)
def _cost_of(sign: str, table: str) -> float:
    """The cost of a character, by its place in the table of an encoding."""
    if _SIGNS.match(sign) or (table == "cp932" and _KANA.match(sign)):
        return FREQUENT
    try:
        code = int.from_bytes(sign.encode(STRICT.get(table, table)), "big")
    except UnicodeEncodeError:
        return STRANGE
    if sign in (HANGUL if table == "cp949" else HAN):
        return FREQUENT
    if code >= 0xC000 and chr(code & 0xFF) in ascii_letters:  # also an accent and a letter
        return STRANGE
    for cost, (first, last) in zip((EVERYDAY, RARE), TABLES[table], strict=True):
        if first <= code <= last:
            return cost
    return STRANGE  # half a katakana, symbols, and what a maker may define
