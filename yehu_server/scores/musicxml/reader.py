"""Read MusicXML: `.musicxml`, `.xml` and `.mxl`; and what MuseScore exports of its own files.

docs/scores.md tells what is understood. Each voice becomes a part of its own, with one note at a
time: the highest of a chord.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections import Counter
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

from yehu_server.errors import ScoreError
from yehu_server.scores.musicxml.bars import BarReader
from yehu_server.scores.musicxml.file import read_root
from yehu_server.scores.musicxml.marks import printable
from yehu_server.scores.score import naming, read_score_bytes
from yehu_server.scores.written.assembly import assembled
from yehu_server.scores.written.notated import MOST_BYTES, MOST_PARTS, Written

PROGRAMS = (
    "mscore", "musescore", "mscore4portable", "mscore3", "musescore3", "MuseScore4", "MuseScore3",
)  # fmt: skip
LONGEST_S = 120.0


def read_musicxml(path: str | os.PathLike[str]) -> Written:
    """Read a MusicXML file, plain or compressed.

    Raises ScoreError, one line naming the file, whatever its bytes: where it cannot be read, is no
    MusicXML or is beyond all bounds.
    """
    with naming(path):
        return written_of(read_root(path))


def written_of(root: Element) -> Written:
    """Return the score of a root element. Raises ScoreError where it is none, or beyond bounds."""
    if root.tag == "score-timewise":
        root = _partwise(root)
    if root.tag != "score-partwise":
        raise ScoreError(f"is no MusicXML score: its root is <{printable(root.tag)}>")
    unknown: Counter[str] = Counter()
    warnings: Counter[str] = Counter()
    elements = root.findall("part")
    if len(elements) > MOST_PARTS:
        raise ScoreError(f"has more than {MOST_PARTS} parts")
    names = _names(root)
    parts = []
    for element in elements:
        reader = BarReader(element, unknown, warnings)
        bars = [reader.read(measure) for measure in element.iterfind("measure")]
        parts.append((names.get(element.get("id", ""), ""), bars))
    return assembled(parts, _title(root), unknown, warnings)


def _partwise(root: Element) -> Element:
    """The same score with its bars in parts, and not its parts in bars."""
    changed = Element("score-partwise")
    changed.extend(child for child in root if child.tag != "measure")
    parts: dict[str, Element] = {}
    for measure in root.iterfind("measure"):
        for part in measure.iterfind("part"):
            name = part.get("id", "")
            if name not in parts:
                parts[name] = SubElement(changed, "part", {"id": name})
            SubElement(parts[name], "measure", dict(measure.attrib)).extend(part)
    return changed


def _names(root: Element) -> dict[str, str]:
    return {
        part.get("id", ""): printable(part.findtext("part-name") or "")
        for part in root.iterfind("part-list/score-part")
    }


def _title(root: Element) -> str:
    for path in ("work/work-title", "movement-title"):
        title = (root.findtext(path) or "").strip()
        if title:
            return printable(title)
    return ""


def read_musescore(path: Path) -> Written:
    """Read a file of MuseScore as its program exports it.

    Raises ScoreError, one line naming the file: where it cannot be read, or there is no such
    program, how to export it.
    """
    with naming(path):
        read_score_bytes(path, MOST_BYTES)
        program = next(filter(None, map(shutil.which, PROGRAMS)), None)
        if program is None:
            raise ScoreError(
                "is a file of MuseScore, which is read where MuseScore is installed; or export it "
                "there: File, Export, MusicXML"
            )
        with tempfile.TemporaryDirectory(prefix="yehu-server-") as folder:
            target = Path(folder) / "score.musicxml"
            words = [program, "-o", str(target), str(path.resolve())]
            try:
                subprocess.run(words, check=True, capture_output=True, timeout=LONGEST_S)  # noqa: S603 - no shell
                return read_musicxml(target)
            except (subprocess.SubprocessError, OSError) as error:
                why = type(error).__name__
                raise ScoreError(f"{program} cannot export it ({why}); export it there") from None
            except ScoreError as error:
                raise ScoreError(str(error).removeprefix(f"{target}: ")) from None
