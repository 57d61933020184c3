"""What ABC has: fields, properties of keys and voices, keys, directives and decorations.

A field is `PLAYED`, `SILENT`, which means that it has no sound, or `LEFT_OUT`, of which the reader
tells. What is in no table is not understood. Fields, properties and directives are those of the
[standard 2.1](https://abcnotation.com/wiki/abc:standard:v2.1), sections 3, 4.6, 7 and 11, and what
abcm2ps, abcjs and abc2midi add to them.
"""

import re
from collections.abc import Mapping
from fractions import Fraction

PLAYED, SILENT, LEFT_OUT = "played", "silent", "left out"
FIELDS: Mapping[str, str] = {
    **dict.fromkeys("IKLMPQRTUVX", PLAYED),
    **dict.fromkeys("ABCDEFGHNOSWZrw+", SILENT),
    **dict.fromkeys("ms", LEFT_OUT),
}
# Of V: and K:, those that change where notes sound or how a part is named, and those that do not.
_OF_THE_PRINT = (
    "middle m stafflines subname snm sname stem up down merge staffscale scale cue gstem dyn "
    "lyrics gchord pos color"
)
PROPERTIES: Mapping[str, str] = {
    **dict.fromkeys(("clef", "octave", "transpose", "name", "nm"), PLAYED),
    **dict.fromkeys(_OF_THE_PRINT.split(), SILENT),
}
CLEFS = frozenset({
    "treble", "alto", "tenor", "bass", "perc", "none", "soprano", "mezzo", "mezzosoprano",
    "baritone", "auto", "P", "G", "C", "F",
})  # fmt: skip
MODES = {"maj": 0, "ion": 0, "mix": -1, "dor": -2, "min": -3, "m": -3, "aeo": -3, "phr": -4,
         "loc": -5, "lyd": 1}  # fmt: skip
ALTERS = {"^^": 2.0, "^": 1.0, "=": 0.0, "_": -1.0, "__": -2.0}
# Directives of paper, text and fonts. Names may be followed by numbers.
_OF_THE_PAGE = """
abc abc-charset abc-copyright abc-creator abc-edited-by abc-include abc-version abcm2ps
abc2pscompat alignbars aligncomposer annotationfont autoclef bagpipes barlabelfont barnumbers
barsperstaff bgcolor botmargin breaklimit breakoneoln bstemdown cancelkey center clip combinevoices
composerfont composerspace contbarnb continueall custos dateformat deco decoerr decoration dynalign
dynamic encoding eps exprabove exprbelow flatbeams font footer footerfont format gchord gchordbox
gchordfont glue graceslurs gracespace graceword gutter header headerfont historyfont hyphencont
indent infofont infoline infoname infospace jazzchords keywarn landscape leftmargin linebreak
lineskipfac linethickness linewarn maxshrink maxstaffsep maxsysstaffsep measurebox measurefirst
measurefont measurenb microscale micronewps multicol musicfont musiconly musicspace newpage
notespacingfactor oneperpage ornament pageheight pagescale pagewidth papersize parskipfac partsbox
partsfont partsspace percmap postscript print-leftmargin printparts printtempo ps pslevel rbdbstop
rbmax rbmin repbra repeatfont rightmargin scale score select sep setbarnb setdefl setfont
shifthnote shiftunison slurgraces slurheight splittune squarebreve staff staffbreak staffnonote
staffscale
staffsep stafftopmargin staffwidth staves stemheight straightflags stretchlast stretchstaff
stylesheet subtitlefont subtitlespace svg sysstaffsep tablature tempofont text textfont textoption
textspace timewarn titlecaps titlefont titleformat titleleft titlespace titletrim topmargin
topspace tripletfont tune tuplets vocal vocalabove vocalfont vocalspace voice voicecolor
voicecombine voicefont voicescale volume vskip wordsfont wordsspace writefields
writeout-accidentals
"""
# Those of abc2midi for sounds, chords, drums and loudness, which this instrument has of its own.
_OF_MIDI = """
barlines bassprog bassvol beat beataccents beatmod beatstring bendstring bendvelocity channel
chordattack chordname chordprog chordvol control controlcombo controlstring deltaloudness drone
droneoff droneon drum drumbars drummap drumoff drumon expand fermatafixed fermataproportional
gchord gchordbars gchordoff gchordon grace gracedivider makechordchannels nobeataccents
noportamento portamento program randomchordattack stressmodel trim voice vol volinc
"""
DIRECTIVES: Mapping[str, str] = {
    "propagate-accidentals": PLAYED,
    "midi ratio": PLAYED,
    **dict.fromkeys(_OF_THE_PAGE.split(), SILENT),
    **{f"midi {name}": SILENT for name in _OF_MIDI.split()},
}

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
IGNORED = frozenset({"thumb", "shortphrase", "mediumphrase", "longphrase", "5", "editorial"})

# How music is read.
MUSIC_FIELDS = "KLMQR"
SETTINGS = ("propagate-accidentals", "ratio")  # directives that change how music is read
# What their values may be; those of K:, Q: and R: are told or may be anything.
VALUES = {
    "M": re.compile(r"|none|C\|?|\(?\d+( *\+ *\d+)*\)? */ *\d+"),
    "L": re.compile(r"1|\d+/\d+"),
    "propagate-accidentals": re.compile("pitch|octave|not"),
    "ratio": re.compile(r"[1-9]\d? +[1-9]\d?"),
}
HORNPIPE = "a hornpipe (R:): pairs of even notes are played two to one"
NAMES = {"m": "macros (m:)", "s": "lines of symbols (s:)"}  # of fields that are left out
SPREADS = ("pitch", "octave", "not")  # how far an accidental reaches in its bar (11.3)
SWUNG = {"4/4": Fraction(1, 2), "C": Fraction(1, 2), "2/4": Fraction(1, 4)}  # of hornpipes
TIMES = {2: 3, 3: 2, 4: 3, 6: 2, 8: 3}  # of tuplets; others depend on the metre
