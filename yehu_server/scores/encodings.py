"""Find the encoding of names and texts that do not say it.

A mark, NUL bytes as UTF-16 has them, and valid UTF-8 speak for themselves. Other text is Chinese,
Japanese or Korean where its characters are frequent, or at least those that an encoding has for
everyday use: GB 2312 and Big5 have them in tables of their own (level 1), JIS X 0208 too, with
kana, and KS X 1001 has the usual syllables. It is Cyrillic where its words have vowels, and
capitals first. What is left is Latin-1, whose accents come one by one, within words.
"""

import codecs
import re
from functools import lru_cache
from itertools import compress
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
    "koi8_u": "KOI8",
    "cp866": "CP866",
    "utf-16-le": "UTF-16",
    "utf-16-be": "UTF-16",
}
LATIN = "latin-1"
# First bytes of what UTF-16 has most of.
HIGH = bytes([0x00, 0x04, 0x30, *range(0x4E, 0xA0), *range(0xAC, 0xD8), 0xFF])
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
_CONTROL = re.compile(r"[\x01-\x08\x0b\x0c\x0e-\x1f]")


def encoding_of(*texts: bytes) -> str:
    """The encoding of texts of one file, as a codec of Python.

    Those that speak for themselves do not count; where all do, it is UTF-8, or UTF-16 that
    has no mark.
    """
    known = [_evident(text) for text in texts]
    if None not in known:
        is_bare = [len(texts) == 1 or not text.startswith(tuple(MARKS)) for text in texts]
        return next((own for own in compress(known, is_bare) if own and own != "utf-8"), "utf-8")
    unknown = [text for text, own in zip(texts, known, strict=True) if own is None]
    judged = [_judged(text) for text in unknown[:MAX_TEXTS]]
    costs = {name: _cost(judged, name) for name in NAMES}
    best = min(costs, key=lambda name: costs[name])
    return best if costs[best] <= DEAREST else LATIN


def decoded(text: bytes, encoding: str) -> str:
    """Decode a text: as itself says, else by the encoding of its file."""
    own = _evident(text)
    is_even = encoding.startswith("utf-16") and len(text) > 2 and not len(text) % 2
    if own == "utf-8" and is_even and _cost([text[:MAX_BYTES]], encoding) < EVERYDAY:
        own = None  # UTF-16 of Chinese may look so by chance
    return text.decode(own or encoding, "replace").removeprefix("\ufeff")


def guess_line(data: bytes, encoding: str) -> str:
    """A line that names the encoding of a file where it was guessed; else empty."""
    is_guess = encoding in NAMES and not data.startswith((*MARKS,))
    return f"is not UTF-8: read as {NAMES[encoding]}" if is_guess else ""


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
        plain = text.decode("utf-8")
    except UnicodeDecodeError:
        return None
    if len(text) % 2 == 0 and _CONTROL.search(plain[:MAX_BYTES]):  # as Cyrillic of UTF-16 has
        costs = {name: _cost([text[:MAX_BYTES]], name) for name in ("utf-16-le", "utf-16-be")}
        best = min(costs, key=lambda name: costs[name])
        return best if costs[best] < EVERYDAY else "utf-8"
    return "utf-8"


def _judged(text: bytes) -> bytes:
    """Some of a text, from shortly before what is not ASCII."""
    found = _HIGH_BYTE.search(text)
    begin = max(found.start() // 2 * 2 - 16, 0) if found else 0
    return text[begin : begin + MAX_BYTES]


def _cost(texts: list[bytes], encoding: str) -> float:
    """How far characters are from those of every day, 0 for them; STRANGE where it cannot be."""
    is_wide = encoding.startswith("utf-16")
    letters = sum(len(_LETTER.findall(text)) for text in texts)
    size = sum(map(len, texts))
    # Two Latin letters are like a character of UTF-16.
    is_latin = is_wide and b"\0" not in b"".join(texts) and (2 * letters >= size or size == 2)
    best = STRANGE
    for table in (*TABLES, "cyrillic") if is_wide else (encoding,):
        total, count, longest = 0.0, 0, 0
        for data in texts:
            try:
                decoder = codecs.getincrementaldecoder(encoding)()
                text = decoder.decode(data, len(data) < MAX_BYTES)  # else the last one is cut
            except UnicodeDecodeError:
                return STRANGE
            for before, run, after in _FOREIGN.findall(text):
                of_run = _costs_of(run, table)
                # One sign within a word of Latin letters is an accent: Flöte is no 鰐.
                is_accent = (before or after) and (len(run) == 1 or max(of_run) >= RARE)
                total += STRANGE * len(run) if is_accent else sum(of_run)
                count += len(run)
                longest = max(longest, len(run))
        # A single one that is rare may be two accents of a short word: þá.
        is_single = count == 1 and total >= RARE and letters
        cost = STRANGE if is_single or not count else total / count
        if table not in TABLES and (longest < SHORTEST or cost > EVERYDAY):
            cost = STRANGE
        best = min(best, cost)
    return STRANGE if is_latin and (best > FREQUENT or size == 2) else best


def _costs_of(run: str, table: str) -> list[float]:
    """The costs of the characters of a run, in a table of TABLES or in Cyrillic."""
    if table in TABLES:
        return [_cost_of(sign, table) for sign in run]
    costs = []
    for sign in run:
        place = CYRILLIC.find(sign.lower())
        cost = place / len(CYRILLIC) if place >= 0 else EVERYDAY if _SIGNS.match(sign) else STRANGE
        costs.append(cost)
    for word in _CYRILLIC.findall(run):
        usual = word in (word.lower(), word.upper(), word.capitalize())
        if not usual or (len(word) > 1 and not _VOWEL.search(word.lower())):
            costs = [cost + RARE for cost in costs]
        elif word.isupper() and len(word) > 1:  # of two codecs, that in which it is small
            costs = [cost + 0.1 for cost in costs]
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
