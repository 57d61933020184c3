"""Interpret words over the staff, such as pizz., sul pont., rit. and Allegro."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.scores.written.notated import Span

# Words and their beginnings, as signs of `notated`. The first that fits counts.
SIGNS: tuple[tuple[str, tuple[str, float | None]], ...] = (
    (r"snap pizz|bart[oó]k pizz", ("pizz", None)),
    (r"pizz|pluck|拨弦|撥弦|拨奏|撥奏", ("pizz", None)),
    (r"arco|(?:col )?bow(?:ed)?$|拉弦|弓$|拉奏", ("arco", None)),
    (r"(?:sul|on)? ?(?:the )?(?:pont|bridge)|am steg|近[码馬]", ("sul-ponticello", None)),
    (r"flautand", ("flautando", None)),
    (r"(?:sul |sur la )?(?:tast|touche)|am griffbrett", ("sul-tasto", None)),
    (r"(?:modo )?ord|nat(?:\.|ural)|normal|pos\. ?ord|普通", ("ordinary", None)),
    (r"non[- ]legato|d[eé]tach|分弓", ("non-legato", None)),
    (r"(?:sempre |molto )?legato|连弓|連弓", ("legato", None)),
    (r"(?:sempre )?stacc|顿弓|頓弓", ("staccato", None)),
    (r"trem(?:\.|olo|$)|颤弓|抖弓", ("tremolo", None)),
    (r"(?:senza|non|no|sans) vib", ("vibrato", 0.0)),
    (r"(?:molto|wide) vib", ("vibrato", 50.0)),
    (r"(?:con |with )?vib|espr|揉弦", ("vibrato", None)),
    (r"sul (?:f|iv|iii|ii|2)\b|inner string|内弦|內弦|里弦", ("inner-string", None)),
    (r"sul (?:c|i|1)\b|outer string|外弦", ("outer-string", None)),
)  # fmt: skip
# Names of articulations, English and Chinese, where no word above is meant: those of the fingers
# are for one note, others hold.
ARTICULATED: Mapping[str, tuple[str, float]] = {
    name: ("gesture" if row.fingers or row.vibrato else "articulation", float(number))
    for number, row in enumerate(ARTICULATIONS)
    for name in (row.name, row.name.replace("-", " "), row.chinese)
}
HAIRPINS = (
    (r"(?:poco a poco |poco |più |piu |molto |sempre )?cresc|[渐漸]强|漸強", "crescendo"),
    (r"(?:poco a poco |poco |più |piu |molto |sempre )?(?:dim|decresc)|[渐漸]弱", "diminuendo"),
)
CHANGES = (
    (r"(?:poco |molto )?(?:rit|rall|allarg|slentando|calando|morendo)|[渐漸]慢", "ritardando"),
    (r"(?:poco |molto )?(?:accel|string(?:endo)?\b|affrett|stretto)|[渐漸]快", "accelerando"),
)  # fmt: skip
BACK = re.compile(r"a tempo|tempo (?:i|1|primo)\b|原速|回原速", re.IGNORECASE)
# Quarter notes a minute, by ear, where no figure stands beside the word.
TEMPI: Mapping[str, float] = {
    "grave": 42.0, "largo": 50.0, "larghetto": 60.0, "lento": 54.0, "adagio": 66.0,
    "andante": 84.0, "andantino": 92.0, "moderato": 108.0, "allegretto": 116.0, "allegro": 132.0,
    "vivace": 152.0, "vivo": 152.0, "presto": 176.0, "prestissimo": 200.0,
    "慢板": 56.0, "中板": 92.0, "快板": 132.0, "行板": 80.0, "小快板": 112.0, "急板": 176.0,
}  # fmt: skip
DYNAMICS = re.compile(r"(?:(?:sempre|subito|poco|più|piu|meno) )?(p{1,4}|f{1,4}|mp|mf)\.?")
JUMP_WORDS = (
    (r"d\.? ?c\.?\b|da capo", "dacapo"),
    (r"d\.? ?s\.?\b|dal segno", "dalsegno"),
    (r"(?:al |to |a )(?:the )?coda|to coda", "tocoda"),
    (r"fine$", "fine"),
    (r"coda$", "coda"),
)

# How signs are written in words, of those that are; each is read as itself.
WRITTEN_SIGNS: Mapping[tuple[str, float | None], str] = {
    ("pizz", None): "pizz.", ("arco", None): "arco", ("sul-ponticello", None): "sul pont.",
    ("flautando", None): "flautando", ("sul-tasto", None): "sul tasto", ("ordinary", None): "ord.",
    ("non-legato", None): "non legato", ("legato", None): "legato", ("staccato", None): "stacc.",
    ("tremolo", None): "trem.", ("vibrato", 0.0): "senza vib.", ("vibrato", 50.0): "molto vib.",
    ("vibrato", None): "vib.", ("inner-string", None): "sul F", ("outer-string", None): "sul C",
}  # fmt: skip
WRITTEN_CHANGES: Mapping[str, str] = {"ritardando": "rit.", "accelerando": "accel."}


@dataclass(frozen=True)
class Meaning:
    """The meaning of a word: kind, name and value."""

    kind: str  # sign, hairpin, change, back, tempo, jump
    name: str = ""
    value: float | None = None


@lru_cache(maxsize=1024)
def meaning_of(text: str) -> Meaning | None:
    """Return the meaning of words; None where it is not known."""
    words = " ".join(text.split()).strip(" ()[]\"'").lower()
    found = DYNAMICS.fullmatch(words)
    if found or BACK.search(words):
        return Meaning("sign", found[1]) if found else Meaning("back")
    for pattern, (name, value) in SIGNS:
        if re.match(pattern, words):
            return Meaning("sign", name, value)
    if words in ARTICULATED:
        return Meaning("sign", *ARTICULATED[words])
    for kind, table in (("hairpin", HAIRPINS), ("change", CHANGES), ("jump", JUMP_WORDS)):
        for pattern, name in table:
            if re.match(pattern, words):
                return Meaning(kind, name)
    tempo = TEMPI.get(re.split(r"[ ,.;]", words, maxsplit=1)[0])
    return None if tempo is None else Meaning("tempo", value=tempo)


def words_of_sign(name: str, value: float | None) -> str | None:
    """The words that are read as a sign; None where there are none."""
    if (name, value) in WRITTEN_SIGNS:
        return WRITTEN_SIGNS[name, value]
    own = (text for text, sign in ARTICULATED.items() if sign == (name, value))
    return next((text for text in own if meaning_of(text) == Meaning("sign", name, value)), None)


class OpenSpan:
    """A span that words begin, put into `spans` when something, or `longest` quarters, ends it."""

    def __init__(self, spans: list[Span], longest: Fraction | None = None) -> None:
        self._spans, self._longest = spans, longest
        self._open: tuple[str, Fraction] | None = None

    def begin(self, name: str, beat: Fraction) -> None:
        """Begin a span, and end the one before."""
        self.end(beat)
        self._open = name, beat

    def end(self, beat: Fraction) -> None:
        """End the span, if one is open."""
        if self._open is not None and self._open[1] < beat:
            name, begin = self._open
            end = beat if self._longest is None else min(beat, begin + self._longest)
            self._spans.append(Span(name, begin, end))
        self._open = None
