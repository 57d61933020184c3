"""MusicXML that other programs write, in small: what music21 reads of it is in music21.json."""

from musicxml_text import DIVISIONS, attributes, barline, grace, note, score

TIE, TIED = '<tie type="start"/>', '<tied type="start"/>'
END, ENDED = '<tie type="stop"/>', '<tied type="stop"/>'
BOTH = '<tie type="stop"/><tie type="start"/>'
SCALE = note("F4", 1) + note("G4", 1) + note("A4", 1) + note("Bb4", 1)
DESCENT = note("C5", 1) + note("Bb4", 1) + note("A4", 1) + note("G4", 1)
HIGH = note("F5", 2) + note("E5", 2)
LAST = note("F4", 4)
CLARINET = "<transpose><diatonic>-1</diatonic><chromatic>-2</chromatic></transpose>"
TRIPLET = (
    "<time-modification><actual-notes>3</actual-notes><normal-notes>2</normal-notes>"
    "</time-modification>"
)


def jump(word: str, text: str) -> str:
    sound = f'<sound {word}="{"yes" if word in ("dacapo", "fine") else word}"/>'
    return f"<direction><direction-type><words>{text}</words></direction-type>{sound}</direction>"


def sign(name: str) -> str:
    which = f'<sound {name}="{"segno" if name == "segno" else "coda"}"/>'
    return f"<direction><direction-type><{name}/></direction-type>{which}</direction>"


def back(quarters: float) -> str:
    return f"<backup><duration>{round(DIVISIONS * quarters)}</duration></backup>"


CORPUS: dict[str, str] = {
    "rests and dots": score(
        note("G4", 1.5) + note("r", 0.5) + note("A4", 0.75) + note("B4", 0.25) + note("r", 1),
        note("r", 4),
        note("C5", 3) + note("D5", 0.5) + note("E5", 0.5),
    ),
    "ties": score(
        note("G4", 3) + note("A4", 1, TIED, more=TIE),
        note("A4", 4, ENDED, TIED, more=BOTH),
        note("A4", 2, ENDED, more=END) + note("A4", 1) + note("B4", 1, TIED, more=TIE),
        note("B4", 0.5, ENDED, more=END) + note("C5", 3.5),
    ),
    "upbeat": score(
        attributes(3, 4) + note("C5", 1),
        note("F5", 2) + note("E5", 1),
        note("D5", 1) + note("C5", 1) + note("Bb4", 1),
        note("A4", 2),
    ),
    "metres": score(
        attributes(2, 4) + note("G4", 1) + note("A4", 1),
        attributes(6, 8) + note("B4", 1.5) + note("C5", 0.5) + note("D5", 0.5) + note("E5", 0.5),
        attributes(5, 4) + note("D5", 3) + note("B4", 2),
        attributes(4, 4) + note("G4", 4),
    ),
    "triplets": score(
        "".join(note(name, 1 / 3, more=TRIPLET) for name in ("G4", "A4", "B4", "C5", "B4", "A4"))
        + note("G4", 2),
        "".join(note(name, 2 / 3, more=TRIPLET) for name in ("D5", "C5", "B4")) + note("A4", 2),
    ),
    "repeat": score(SCALE, DESCENT + barline(repeat="backward"), HIGH, LAST),
    "repeat from within": score(
        SCALE,
        barline(location="left", repeat="forward") + DESCENT,
        HIGH + barline(repeat="backward"),
        LAST,
    ),
    "endings": score(
        barline(location="left", repeat="forward") + SCALE,
        barline(location="left", ending="1 start")
        + DESCENT
        + barline(repeat="backward", ending="1 stop"),
        barline(location="left", ending="2 start") + HIGH + barline(ending="2 stop"),
        LAST,
    ),
    "da capo al fine": score(
        SCALE, DESCENT + jump("fine", "Fine"), HIGH, LAST + jump("dacapo", "D.C. al Fine")
    ),
    "dal segno al coda": score(
        SCALE,
        sign("segno") + DESCENT,
        HIGH + jump("tocoda", "To Coda"),
        SCALE + jump("dalsegno", "D.S. al Coda"),
        sign("coda") + LAST,
    ),
    "clarinet": score(attributes(more=CLARINET) + SCALE, HIGH),
    "chords": score(
        note("F4", 2) + note("+A4", 2) + note("+C5", 2) + note("G4", 2) + note("+D5", 2), LAST
    ),
    "two voices": score(
        note("C5", 2) + note("D5", 2) + back(4) + note("F4", 1, voice=2) + note("G4", 3, voice=2),
        note("E5", 4) + back(4) + note("C5", 4, voice=2),
    ),
    "small notes": score(
        grace("G4") + note("A4", 2) + grace("C5") + grace("D5") + note("C5", 2), note("B4", 4)
    ),
    "quarter tones": score(note("F4", 1) + note("F+4", 1) + note("G+4", 2), LAST),
    "other divisions": score(
        SCALE,
        "<attributes><divisions>480</divisions></attributes>"
        "<note><pitch><step>C</step><octave>5</octave></pitch><duration>720</duration></note>"
        "<note><pitch><step>D</step><octave>5</octave></pitch><duration>1200</duration></note>",
    ),
    "short bar": score(SCALE, note("C5", 1) + note("D5", 1), LAST),
}
