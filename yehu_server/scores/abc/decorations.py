"""Decorations of ABC, in the names of `notated`."""

from __future__ import annotations

from collections.abc import Mapping

DECORATIONS: Mapping[str, tuple[str, float | None]] = {
    "trill": ("trill", None), "lowermordent": ("mordent", None), "mordent": ("mordent", None),
    "uppermordent": ("inverted-mordent", None), "pralltriller": ("inverted-mordent", None),
    "roll": ("turn", None), "turn": ("turn", None), "turnx": ("turn", None),
    "invertedturn": ("inverted-turn", None), "invertedturnx": ("inverted-turn", None),
    "staccato": ("staccato", None), "wedge": ("staccatissimo", None), "tenuto": ("tenuto", None),
    ">": ("accent", None), "accent": ("accent", None), "emphasis": ("accent", None),
    "^": ("marcato", None), "marcato": ("marcato", None), "fermata": ("fermata", None),
    "invertedfermata": ("fermata", None), "upbow": ("up-bow", None), "downbow": ("down-bow", None),
    "open": ("open-string", None), "snap": ("snap-pizzicato", None), "slide": ("slide-in-up", None),
    "breath": ("breath", None), "arpeggio": ("arpeggio", None), "plus": ("pizzicato", None),
    "spiccato": ("spiccato", None), "tremolo": ("tremolo", None), "harmonic": ("harmonic", None),
    "vibrato": ("vibrato", None), "slideup": ("slide-in-up", None),
    "slidedown": ("slide-in-down", None), "fall": ("slide-out-down", None),
    "doit": ("slide-out-up", None), "espressivo": ("soft-accent", None),
    "staccatissimo": ("staccatissimo", None), "portato": ("portato", None),
    **{str(finger): ("finger", float(finger)) for finger in range(5)},
    **{"/" * strokes: ("tremolo", float(strokes)) for strokes in range(1, 5)},
}  # fmt: skip
SHORTCUTS: Mapping[str, str] = {
    ".": "staccato", "~": "roll", "H": "fermata", "L": "accent", "M": "lowermordent", "O": "coda",
    "P": "uppermordent", "S": "segno", "T": "trill", "u": "upbow", "v": "downbow",
}  # fmt: skip
WEDGES: Mapping[str, str] = {
    "<(": "crescendo", "crescendo(": "crescendo", ">(": "diminuendo", "diminuendo(": "diminuendo",
    "<)": "stop", "crescendo)": "stop", ">)": "stop", "diminuendo)": "stop",
}  # fmt: skip
JUMPS: Mapping[str, str] = {
    "segno": "segno", "coda": "coda", "fine": "fine", "d.c.": "dacapo", "dacapo": "dacapo",
    "d.s.": "dalsegno", "dalsegno": "dalsegno", "dacoda": "tocoda", "tocoda": "tocoda",
    "d.c.alfine": "dacapo", "d.c.alcoda": "dacapo", "d.s.alfine": "dalsegno",
    "d.s.alcoda": "dalsegno",
}  # fmt: skip
SILENT = frozenset({"thumb", "shortphrase", "mediumphrase", "longphrase", "5", "editorial"})
