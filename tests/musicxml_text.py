"""MusicXML in few words: what tests write their scores with."""

import re

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
DOCTYPE = (
    '<!DOCTYPE score-partwise PUBLIC "-//Recordare//DTD MusicXML 4.0 Partwise//EN" '
    '"http://www.musicxml.org/dtds/partwise.dtd">\n'
)
DIVISIONS = 12  # of a quarter note
ALTER = {"#": 1, "b": -1, "": 0, "+": 0.5}


def pitch(name: str) -> str:
    """The element of a pitch such as F#4; `F+4` is a quarter tone higher than F4."""
    letter, sign, octave = re.fullmatch(r"([A-G])([#b+]?)(\d)", name).groups()
    alter = f"<alter>{ALTER[sign]}</alter>" if sign else ""
    return f"<pitch><step>{letter}</step>{alter}<octave>{octave}</octave></pitch>"


def note(name: str, quarters: float, *notations: str, more: str = "", voice: int = 1) -> str:
    """A note; name "r" is a rest, "+C5" a note of the chord before."""
    chord = "<chord/>" if name.startswith("+") else ""
    what = "<rest/>" if name == "r" else pitch(name.removeprefix("+") if chord else name)
    ties = "".join(re.findall(r'<tie type="\w+"/>', more))
    marks = f"<notations>{''.join(notations)}</notations>" if notations else ""
    length = round(DIVISIONS * quarters)
    return (
        f"<note>{chord}{what}<duration>{length}</duration>{ties}<voice>{voice}</voice>"
        f"{more.replace(ties, '') if ties else more}{marks}</note>"
    )


def grace(name: str, more: str = "", slash: str = "yes") -> str:
    """A grace note."""
    return (
        f'<note><grace slash="{slash}"{more}/>{pitch(name)}<voice>1</voice><type>16th</type></note>'
    )


def articulation(name: str) -> str:
    return f"<articulations><{name}/></articulations>"


def ornament(name: str) -> str:
    return f"<ornaments><{name}/></ornaments>"


def technical(name: str, text: str = "") -> str:
    return f"<technical><{name}>{text}</{name}></technical>"


def slur(kind: str) -> str:
    return f'<slur type="{kind}" number="1"/>'


def words(text: str) -> str:
    return f"<direction><direction-type><words>{text}</words></direction-type></direction>"


def dynamics(name: str) -> str:
    return f"<direction><direction-type><dynamics><{name}/></dynamics></direction-type></direction>"


def wedge(kind: str) -> str:
    return f'<direction><direction-type><wedge type="{kind}"/></direction-type></direction>'


def tempo(quarters: float) -> str:
    return f'<direction><direction-type/><sound tempo="{quarters}"/></direction>'


def attributes(beats: int = 4, unit: int = 4, fifths: int = 0, more: str = "") -> str:
    return (
        f"<attributes><divisions>{DIVISIONS}</divisions><key><fifths>{fifths}</fifths></key>"
        f"<time><beats>{beats}</beats><beat-type>{unit}</beat-type></time>{more}</attributes>"
    )


def barline(*, location: str = "right", repeat: str = "", ending: str = "") -> str:
    """A bar line; `ending` is such as "1 start"."""
    inner = ""
    if ending:
        number, kind = ending.split()
        inner += f'<ending number="{number}" type="{kind}"/>'
    if repeat:
        inner += f'<repeat direction="{repeat}"/>'
    return f'<barline location="{location}">{inner}</barline>'


def score(*bars: str, title: str = "", before: str = HEAD + DOCTYPE, **others: str) -> str:
    """A score of one part; the first bar gets attributes where it has none.

    `others` are further parts, one bar each, by their names.
    """
    first = "" if "<attributes>" in bars[0] else attributes()
    parts = {"P1": [first + bars[0], *bars[1:]]} | {
        name: [attributes() + bar] for name, bar in others.items()
    }
    names = "".join(
        f'<score-part id="{name}"><part-name>{name}</part-name></score-part>' for name in parts
    )
    work = f"<work><work-title>{title}</work-title></work>" if title else ""
    body = "".join(
        f'<part id="{name}">'
        + "".join(
            f'<measure number="{number}">{bar}</measure>' for number, bar in enumerate(each, 1)
        )
        + "</part>"
        for name, each in parts.items()
    )
    return (
        f'{before}<score-partwise version="4.0">{work}<part-list>{names}</part-list>{body}'
        "</score-partwise>"
    )
