"""Words of jianpu other than notes: marks, dynamics, texts, and ignored layout commands."""

from collections.abc import Mapping
from functools import lru_cache

from yehu_server.scores.written.notated import DYNAMICS, FORCED
from yehu_server.scores.written.words import Meaning, meaning_of

# What words do at the note, rest or dash before them has the kinds of `words`, but for jumps, and
# these: a mark; a slur, a tie or a hairpin that begins or ends; a slide to the next note
# (glissando), or there and back (contour).

# As in -. and ->
SHORT = {".": "staccato", "!": "staccatissimo", "_": "portato", ">": "accent", "^": "marcato"}
NAMED = ("harmonic", "up", "down", "bend", "tilde", "staccato", "souyin")
THERE_AND_BACK = ((0.0, 0.0), (0.4, 0.0), (0.6, -2.0), (0.8, 0.0))  # by ear
SLURS_AND_TIES = {"(": Meaning("slur"), ")": Meaning("slur end"), "~": Meaning("tie")}
# Understood, and without effect on the sound.
IGNORED = frozenset({
    "OnePage", "NoBarNums", "NoIndent", "RaggedLast", "SeparateTimesig", "angka", "Indonesian",
    "WithStaff", "PartMidi", "ChordsRoman", "RepeatAccidentals", "NormalAccidentals",
    "KeepOctave", "[(", ")]", "\\(", "\\)", "\\break", "\\noBreak", "\\pageBreak",
})  # fmt: skip
IGNORED_HEADERS = frozenset({
    "subtitle", "subsubtitle", "composer", "poet", "arranger", "copyright", "opus", "piece",
    "meter", "tagline", "dedication", "frets", "chords",
})  # fmt: skip


def _marks(names: Mapping[str, str]) -> dict[str, Meaning]:
    return {word: Meaning("mark", name) for word, name in names.items()}


# LilyPond's commands, with a backslash before them, and their short forms.
COMMANDS: Mapping[str, Meaning] = {
    **{name: Meaning("sign", name) for name in (*DYNAMICS, *FORCED)},
    **dict.fromkeys(("<", "cresc"), Meaning("hairpin", "crescendo")),
    **dict.fromkeys((">", "decresc", "dim"), Meaning("hairpin", "diminuendo")),
    "!": Meaning("hairpin end"),
    "glissando": Meaning("glissando"),
    **_marks({
        "upbow": "up-bow", "downbow": "down-bow", "staccato": "staccato",
        "staccatissimo": "staccatissimo", "tenuto": "tenuto", "portato": "portato",
        "accent": "accent", "marcato": "marcato", "espressivo": "soft-accent",
        "fermata": "fermata", "shortfermata": "fermata", "longfermata": "fermata",
        "verylongfermata": "fermata", "breathe": "breath", "caesura": "caesura",
        "trill": "trill", "mordent": "mordent", "prall": "inverted-mordent", "turn": "turn",
        "reverseturn": "inverted-turn", "flageolet": "harmonic", "open": "open-string",
        "snappizzicato": "snap-pizzicato", "spiccato": "spiccato",
        "1": "inner-string", "2": "outer-string",
    }),
}  # fmt: skip

# Of the erhu; with or without Fr= before them.
FINGERING: Mapping[str, Meaning] = {
    **{sign: Meaning("mark", "finger", number) for number, sign in enumerate("01234")},
    **{sign: Meaning("mark", "finger", number) for number, sign in enumerate("空一二三四")},
    **_marks({
        "内": "inner-string", "外": "outer-string", "harmonic": "harmonic", "up": "slide-in-up",
        "down": "slide-in-down", "tilde": "vibrato", "staccato": "staccato",
    }),
    "bend": Meaning("contour"),
}  # fmt: skip

# Before the note that they belong to.
AHEAD: Mapping[str, Meaning] = {
    **_marks({"slideUp": "slide-in-up", "slideDown": "slide-in-down"}),
    **dict.fromkeys(("glis", "gliss"), Meaning("glissando")),
}

# Texts above or below the notes that mean something in jianpu alone.
TEXTS: Mapping[str, Meaning] = {
    "内": Meaning("sign", "inner-string"), "外": Meaning("sign", "outer-string"),
    "拨": Meaning("sign", "pizz"), "拉": Meaning("sign", "arco"),
    "不揉": Meaning("sign", "vibrato", 0.0),
    **_marks({
        "tr": "trill", "颤音": "trill", "泛音": "harmonic", "上滑音": "slide-in-up",
        "下滑音": "slide-in-down", "揉": "vibrato",
    }),
}  # fmt: skip


@lru_cache(maxsize=1024)
def action_of(word: str) -> Meaning | None:
    """The meaning of a word for the note before it; None where it is not understood."""
    bare = word.lstrip("_^") if word[:2] in ("_\\", "^\\") else word
    if bare.startswith("\\"):
        return COMMANDS.get(bare[1:])
    if word.endswith('"') and '"' in word[:-1]:
        return _text(word.lstrip("_^-").strip('"'))
    if word.startswith("Fr=") or word in NAMED:
        return FINGERING.get(word.removeprefix("Fr="))
    if len(word) == 2 and word[0] in "-_^" and word[1] in SHORT:
        return COMMANDS[SHORT[word[1]]]
    return SLURS_AND_TIES.get(word)


def _text(text: str) -> Meaning | None:
    meaning = TEXTS.get(text.strip().rstrip(".")) or meaning_of(text)
    return meaning if meaning is not None and meaning.kind != "jump" else None
