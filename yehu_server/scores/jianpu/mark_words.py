"""Words of jianpu other than notes: marks, dynamics, texts, and ignored layout commands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, auto
from functools import lru_cache

from yehu_server.scores.written.notated import DYNAMICS, FORCED, Mark
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


# LilyPond's commands, with a backslash before them, and their short forms.
COMMANDS: Mapping[str, Action] = {
    **{name: _sign(name) for name in (*DYNAMICS, *FORCED)},
    "<": Action(Act.HAIRPIN, "crescendo"),
    ">": Action(Act.HAIRPIN, "diminuendo"),
    "!": Action(Act.HAIRPIN_END),
    "cresc": Action(Act.HAIRPIN, "crescendo"),
    "decresc": Action(Act.HAIRPIN, "diminuendo"),
    "dim": Action(Act.HAIRPIN, "diminuendo"),
    "upbow": _mark("up-bow"),
    "downbow": _mark("down-bow"),
    "staccato": _mark("staccato"),
    "staccatissimo": _mark("staccatissimo"),
    "tenuto": _mark("tenuto"),
    "portato": _mark("portato"),
    "accent": _mark("accent"),
    "marcato": _mark("marcato"),
    "espressivo": _mark("soft-accent"),
    "fermata": _mark("fermata"),
    "shortfermata": _mark("fermata"),
    "longfermata": _mark("fermata"),
    "verylongfermata": _mark("fermata"),
    "breathe": _mark("breath"),
    "caesura": _mark("caesura"),
    "trill": _mark("trill"),
    "mordent": _mark("mordent"),
    "prall": _mark("inverted-mordent"),
    "turn": _mark("turn"),
    "reverseturn": _mark("inverted-turn"),
    "flageolet": _mark("harmonic"),
    "open": _mark("open-string"),
    "snappizzicato": _mark("snap-pizzicato"),
    "glissando": Action(Act.GLISSANDO),
    "1": _mark("inner-string"),
    "2": _mark("outer-string"),
}
SHORT: Mapping[str, str] = {
    ".": "staccato",
    "!": "staccatissimo",
    "_": "portato",
    ">": "accent",
    "^": "marcato",
}  # as in -. and ->

# Of the erhu; with or without Fr= before them.
FINGERING: Mapping[str, Action] = {
    "0": _mark("finger", 0),
    "1": _mark("finger", 1),
    "2": _mark("finger", 2),
    "3": _mark("finger", 3),
    "4": _mark("finger", 4),
    "空": _mark("finger", 0),
    "一": _mark("finger", 1),
    "二": _mark("finger", 2),
    "三": _mark("finger", 3),
    "四": _mark("finger", 4),
    "内": _mark("inner-string"),
    "外": _mark("outer-string"),
    "harmonic": _mark("harmonic"),
    "up": _mark("slide-in-up"),
    "down": _mark("slide-in-down"),
    "bend": Action(Act.CONTOUR),
    "tilde": _mark("vibrato"),
    "staccato": _mark("staccato"),
}
NAMED = ("harmonic", "up", "down", "bend", "tilde", "staccato", "souyin")
THERE_AND_BACK = ((0.0, 0.0), (0.4, 0.0), (0.6, -2.0), (0.8, 0.0))  # by ear

# Before the note that they belong to.
AHEAD: Mapping[str, Action] = {
    "slideUp": _mark("slide-in-up"),
    "slideDown": _mark("slide-in-down"),
    "glis": Action(Act.GLISSANDO),
    "gliss": Action(Act.GLISSANDO),
}

# Texts above or below the notes that mean something in jianpu alone.
TEXTS: Mapping[str, Action] = {
    "内": _sign("inner-string"),
    "外": _sign("outer-string"),
    "拨": _sign("pizz"),
    "拉": _sign("arco"),
    "不揉": _sign("vibrato", 0.0),
    "tr": _mark("trill"),
    "颤音": _mark("trill"),
    "泛音": _mark("harmonic"),
}

BRACKETS: Mapping[str, Action] = {
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
    "meter", "tagline", "dedication", "frets",
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
    return BRACKETS.get(word)


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


def mark_of(action: Action) -> Mark:
    """The mark that an action of kind MARK puts on its note."""
    return Mark(action.name, action.value)
