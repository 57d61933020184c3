"""Words of jianpu other than notes: marks, dynamics, texts, and ignored layout commands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, auto
from functools import lru_cache

from yehu_server.scores.written.notated import DYNAMICS, FORCED
from yehu_server.scores.written.words import meaning_of


class Act(Enum):
    """What a word does at the note, rest or dash before it."""

    MARK = auto()  # value: a Mark of that note
    SIGN = auto()  # a sign of notated.SIGNS from there on
    SLUR = auto()  # begins
    SLUR_END = auto()
    TIE = auto()
    HAIRPIN = auto()
    HAIRPIN_END = auto()
    GLISSANDO = auto()  # to the next note
    CONTOUR = auto()  # there and back
    TEMPO = auto()  # value: quarter notes a minute
    TEMPO_CHANGE = auto()  # ritardando or accelerando, by its name
    TEMPO_AGAIN = auto()


@dataclass(frozen=True, slots=True)
class Action:
    """One thing that a word does; `name` and `value` as its kind has them."""

    act: Act
    name: str = ""
    value: float | None = None


def _mark(name: str, value: float | None = None) -> Action:
    return Action(Act.MARK, name, value)


def _sign(name: str, value: float | None = None) -> Action:
    return Action(Act.SIGN, name, value)


def _marks(names: Mapping[str, str]) -> dict[str, Action]:
    return {word: _mark(name) for word, name in names.items()}


# LilyPond's commands, with a backslash before them, and their short forms.
COMMANDS: Mapping[str, Action] = {
    **{name: _sign(name) for name in (*DYNAMICS, *FORCED)},
    **dict.fromkeys(("<", "cresc"), Action(Act.HAIRPIN, "crescendo")),
    **dict.fromkeys((">", "decresc", "dim"), Action(Act.HAIRPIN, "diminuendo")),
    "!": Action(Act.HAIRPIN_END),
    "glissando": Action(Act.GLISSANDO),
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
# As in -. and ->
SHORT = {".": "staccato", "!": "staccatissimo", "_": "portato", ">": "accent", "^": "marcato"}

# Of the erhu; with or without Fr= before them.
FINGERING: Mapping[str, Action] = {
    **{sign: _mark("finger", number) for number, sign in enumerate("01234")},
    **{sign: _mark("finger", number) for number, sign in enumerate("空一二三四")},
    **_marks({
        "内": "inner-string", "外": "outer-string", "harmonic": "harmonic", "up": "slide-in-up",
        "down": "slide-in-down", "tilde": "vibrato", "staccato": "staccato",
    }),
    "bend": Action(Act.CONTOUR),
}  # fmt: skip
NAMED = ("harmonic", "up", "down", "bend", "tilde", "staccato", "souyin")
THERE_AND_BACK = ((0.0, 0.0), (0.4, 0.0), (0.6, -2.0), (0.8, 0.0))  # by ear

# Before the note that they belong to.
AHEAD: Mapping[str, Action] = {
    **_marks({"slideUp": "slide-in-up", "slideDown": "slide-in-down"}),
    **dict.fromkeys(("glis", "gliss"), Action(Act.GLISSANDO)),
}

# Texts above or below the notes that mean something in jianpu alone.
TEXTS: Mapping[str, Action] = {
    "内": _sign("inner-string"),
    "外": _sign("outer-string"),
    "拨": _sign("pizz"),
    "拉": _sign("arco"),
    "不揉": _sign("vibrato", 0.0),
    **_marks(
        {
            "tr": "trill",
            "颤音": "trill",
            "泛音": "harmonic",
            "上滑音": "slide-in-up",
            "下滑音": "slide-in-down",
            "揉": "vibrato",
        }
    ),
}

SLURS_AND_TIES: Mapping[str, Action] = {
    "(": Action(Act.SLUR),
    ")": Action(Act.SLUR_END),
    "~": Action(Act.TIE),
}

# Understood, and nothing to hear.
SILENT = frozenset({
    "OnePage", "NoBarNums", "NoIndent", "RaggedLast", "SeparateTimesig", "angka", "Indonesian",
    "WithStaff", "PartMidi", "ChordsRoman", "RepeatAccidentals", "NormalAccidentals",
    "KeepOctave", "[(", ")]", "\\(", "\\)", "\\break", "\\noBreak", "\\pageBreak",
})  # fmt: skip
SILENT_HEADERS = frozenset({
    "subtitle", "subsubtitle", "composer", "poet", "arranger", "copyright", "opus", "piece",
    "meter", "tagline", "dedication", "frets", "chords",
})  # fmt: skip


@lru_cache(maxsize=1024)
def action_of(word: str) -> Action | None:
    """What a word does at the note before it; None where it is not understood."""
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


def _text(text: str) -> Action | None:
    known = TEXTS.get(text.strip().rstrip("."))
    meaning = meaning_of(text)
    if known is not None or meaning is None:
        return known
    acts = {"hairpin": Act.HAIRPIN, "change": Act.TEMPO_CHANGE, "tempo": Act.TEMPO}
    acts |= {"sign": Act.SIGN, "back": Act.TEMPO_AGAIN}
    if meaning.kind not in acts:  # a da capo as a text
        return None
    return Action(acts[meaning.kind], meaning.name, meaning.value)
