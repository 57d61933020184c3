"""The signs of ABC's music (standard 2.1, 4), as a table of patterns in the order of trial."""

import re

LENGTH = r"\d*/*\d*"
NOTE = rf"(\^\^|\^|__|_|=)?([A-Ga-g])([',]*)({LENGTH})(-?)"
TOKEN = re.compile(
    rf"""(?P<field>\[[A-Za-z]:[^\]]{{0,255}}\])
|(?P<bar>\.?(?::*\[?\|[|\]]*:*|::+))(?P<number>(?<!:)[1-9][\d,\-]*)?
|(?P<ending>\[[1-9][\d,\-]*)
|(?P<text>"[^"]*")
|(?P<sign>![^!|\s]+!|\+[^+|\s]+\+)
|(?P<chord>\[[^\[\]|]*\])(?P<chord_length>{LENGTH})(?P<chord_tie>-?)
|(?P<grace>\{{[^{{}}]*\}})
|(?P<note>{NOTE})
|(?P<rest>[zx])(?P<rest_length>{LENGTH})
|(?P<bars>[ZX])(?P<bars_count>\d*)
|\((?P<tuplet>\d)(?P<ratio>(?::\d*){{0,2}})
|(?P<slur>[()])
|(?P<tie>-)
|(?P<broken>>+|<+)
|(?P<short>[.~H-Yh-w])
|(?P<over>&)
|(?P<space>[\s`*$\\]+|y\d*|!)
|(?P<other>.)""",
    re.VERBOSE,
)
# The kind of a token by the last group that is in it, where that is not its own.
KINDS = {
    "number": "bar", "chord_length": "chord", "chord_tie": "chord", "rest_length": "rest",
    "bars_count": "bars", "ratio": "tuplet",
}  # fmt: skip
NOTE_AT = TOKEN.groupindex["note"]  # its own groups follow

# Fields, blocks of text, and what is in K: and V:.
FIELD = re.compile(r"([A-Za-z+]):(?![|:])\s*(.*)")  # C:| is a note at the end of a repeat
BLOCK = re.compile(r"%%\s*(begin|end)([a-z]\w*)")
PROPERTY = re.compile(r'[A-Za-z]+=(?:"[^"]*"|[^\s"]*)|"[^"]*"|[^\s"]+')
KEY = re.compile(r"([A-Ga-g])(#|b(?!lu)|♯|♭|sharp|flat)?([A-Za-z]*)")
ACCIDENTALS = re.compile(r"(?:(?:\^\^?|__?|=)[A-Ga-g])+")
GLUED = re.compile(r"(?<=[A-Za-z#♯♭])(?=[\^_])")
ACCIDENTAL = re.compile(r"(\^\^?|__?|=)([A-Ga-g])")
# The octaves of a clef: those of the standard, and _8 and ^8 as abcm2ps has them.
CLEF = re.compile(r"([A-Za-z]+)\d?(?:([+\-^_])(8|15))?")
