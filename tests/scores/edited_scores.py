"""Random edits of scores: a field or an element more, an encoding changed, a voice moved."""

import re
from collections.abc import Callable
from random import Random
from xml.etree import ElementTree as ET

NAME = "Flöte 二胡"
# Lines within a tune, and what stands before a note.
LINES = (
    "N:a bad egg", "%%staffsep 40", "% abc", "w: la la", "K:D", "K:Gdor", "K:Bb clef=bass",
    "L:1/16", "M:3/4", "K:C transpose=2", "%%MIDI program 41", "K:A ^d", "I:linebreak $", "H:abc",
)  # fmt: skip
BEFORE = (
    "[K:F]", "[L:1/16]", '"Am"', "!f!", "!upbow!", "^", "_", "=", ".", "(", "[N:egg]", "[M:3/4]",
    "[r:abc]", "[K:E clef=treble]", '"^text"', "y", "`", "v", "!invented!",
)  # fmt: skip
AFTER = ("2", "/", "3/2", ">", "<", ")", "'", ",", "|", ":|", "|]", "||", "-", " z ", " x2 ", "|:")
_NOTE = re.compile(r"(?<![A-Za-z^_=!\"\[{])[A-Ga-g](?![A-Za-z:!\"])")


def edited_abc(text: str, random: Random) -> tuple[str, str, bytes]:
    """What was done, the tune of ABC edited, and the bytes of the file."""
    lines = text.splitlines()
    key = next(at for at, line in enumerate(lines) if line.startswith("K:"))
    codec = "utf-8"
    music = [
        at for at in range(key + 1, len(lines))
        if not re.match(r"[A-Za-z]:|%", lines[at]) and _NOTE.search(lines[at])
    ]  # fmt: skip
    kind = random.choice(("line", "before", "after", "head", "codec", "voices"))
    what = kind
    if kind == "line":
        what = random.choice(LINES)
        lines.insert(random.choice(music), what)
    elif kind in ("before", "after"):
        at = random.choice(music)
        note = random.choice([*_NOTE.finditer(lines[at])])
        what = random.choice(BEFORE if kind == "before" else AFTER)
        place = note.start() if kind == "before" else note.end()
        lines[at] = lines[at][:place] + what + lines[at][place:]
    elif kind == "head":
        what = random.choice(("Z:me", "S:egg", "%%abc-charset utf-8", "O:x", "U:q=!upbow!", "Q:60"))
        lines.insert(key, what)
    elif kind == "codec":
        codec = random.choice(("utf-16", "latin-1", "gbk", "utf-8-sig"))
        what = codec
        lines.insert(1, "T:Flöte" if codec == "latin-1" else "T:二胡旋律")
    else:
        body, named = lines[key + 1 :], ["V:1", "V:2 name=B octave=-1"]
        random.shuffle(named)
        lines[key + 1 :] = [named[0], *body, named[1], *body]
    return what, (said := "\n".join(lines) + "\n"), said.encode(codec, "replace")


def _voices(root: ET.Element, random: Random) -> str:
    names = {voice.text for voice in root.iter("voice")}
    moved = dict(
        zip(sorted(filter(None, names)), random.sample(range(1, 20), len(names)), strict=False)
    )
    for voice in root.iter("voice"):
        voice.text = str(moved.get(voice.text or "", 1))
    return "voices numbered otherwise"


def _parts(root: ET.Element, _: Random) -> str:
    names, parts = root.find("part-list"), root.findall("part")
    if names is not None and len(parts) > 1:
        score_parts = names.findall("score-part")
        for parent, first in ((names, score_parts[0]), (root, parts[0])):
            parent.remove(first)
            parent.append(first)
    return "the first part moved to the end"


def _elements(root: ET.Element, random: Random) -> str:
    of_notes = (
        "<lyric><text>la</text></lyric>", "<notehead>x</notehead>",
        "<notations><technical><up-bow/></technical></notations>",
        "<notations><articulations><tenuto/></articulations></notations>",
    )  # fmt: skip
    of_bars = (
        "<direction><direction-type><words>egg</words></direction-type></direction>",
        '<print new-system="yes"/>', "<bookmark id='a'/>", "<link/>",
        "<attributes><clef><sign>C</sign><line>3</line></clef></attributes>",
        "<direction><direction-type><dynamics><f/></dynamics></direction-type></direction>",
        "<harmony><root><root-step>A</root-step></root><kind>minor</kind></harmony>",
    )  # fmt: skip
    where = random.choice(("note", "measure"))
    found = random.choice([*root.iter(where)])
    what = random.choice(of_notes if where == "note" else of_bars)
    made = ET.fromstring(what)  # noqa: S314 - from above
    if where == "note":
        found.append(made)
    else:
        found.insert(0, made)
    return what


def _pitch(root: ET.Element, random: Random) -> str:
    octaves = [octave for octave in root.iter("octave") if octave.text]
    octave = random.choice(octaves)
    octave.text = str(int(octave.text or 4) + random.choice((-1, 1)))
    return "an octave"


def _repeat(root: ET.Element, random: Random) -> str:
    at = random.randrange(len(root.findall("part")[0].findall("measure")))
    sign = "<barline location='right'><repeat direction='backward'/></barline>"
    for part in root.findall("part"):
        bars = part.findall("measure")
        if at < len(bars):
            bars[at].append(ET.fromstring(sign))  # noqa: S314 - from above
    return "a repeat"


def _transposed(root: ET.Element, random: Random) -> str:
    chromatic = random.choice(("-2", "-9", "3"))
    text = f"<attributes><transpose><chromatic>{chromatic}</chromatic></transpose></attributes>"
    random.choice(root.findall("part")).findall("measure")[0].insert(1, ET.fromstring(text))  # noqa: S314
    return "a transposing part"


EDITS: tuple[Callable[[ET.Element, Random], str], ...] = (
    _voices, _parts, _elements, _pitch, _repeat, _transposed,
)  # fmt: skip


def edited_xml(data: bytes, random: Random) -> tuple[str, bytes, bytes]:
    """What was done, MusicXML edited, and the same in another encoding, perhaps."""
    root = ET.fromstring(data)  # noqa: S314 - files that one chose
    what = random.choice(EDITS)(root, random)
    text = ET.tostring(root, encoding="unicode")
    codec = random.choice(("UTF-8", "UTF-16", "GB18030", "US-ASCII", "windows-1251", "EUC-KR"))
    said = f'<?xml version="1.0" encoding="{codec}"?>\n{text}'
    return f"{what}, {codec}", text.encode(), said.encode(codec, "xmlcharrefreplace")
