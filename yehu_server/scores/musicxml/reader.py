"""Read MusicXML: `.musicxml`, `.xml` and `.mxl`.

docs/scores.md lists what is understood. Each voice becomes a part of its own, with one note at a
time: the highest of a chord. Entities are refused: none of them belongs into a score, and they can
make a small file endless. Nothing but the file itself is opened: neither its document type nor what
an archive names.
"""

import codecs
import io
import os
import re
import sys
import zipfile
import zlib
from collections import Counter
from typing import Any
from xml.etree import ElementTree as ET
from xml.etree.ElementTree import Element, SubElement
from xml.parsers import expat

from yehu_server.errors import ScoreError
from yehu_server.scores.musicxml.bars import BarReader
from yehu_server.scores.musicxml.elements import tell_strange
from yehu_server.scores.score import errors_name, printable, read_score_bytes
from yehu_server.scores.written.assembly import assembled
from yehu_server.scores.written.notated import MAX_BYTES, MAX_PARTS, Written

MAX_XML_BYTES = 32 << 20
MAX_ELEMENTS = 1_000_000
DEEPEST = 100
MAX_ENTRIES = 1000  # of an archive
MAX_CONTAINER_BYTES = 1 << 16
ZIP = b"PK\x03\x04"
CONTAINER = "META-INF/container.xml"
_SAYS = re.compile(rb"(?:\xef\xbb\xbf)?\s*<\?xml[^>]*encoding\s*=\s*[\"']([\w.:-]+)")
# Codecs of Python, and the widest of each kind, which writers mean by the same name.
WIDEST = {
    "gb2312": "gb18030", "gbk": "gb18030", "big5": "big5hkscs", "cp950": "big5hkscs",
    "shift_jis": "cp932", "euc_kr": "cp949",
}  # fmt: skip
NAMED_OTHERWISE = {"cp31j": "cp932", "gb_2312-80": "gb2312"}
COMPRESSIONS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
ENTRY = b"PK\x01\x02"  # before each entry of an archive's directory
# What zipfile raises for archives that are damaged or made to harm.
DAMAGED = (
    zipfile.BadZipFile, zlib.error, EOFError, KeyError, NotImplementedError, OSError, OverflowError,
    RuntimeError, ValueError,
)  # fmt: skip


def read_musicxml(path: str | os.PathLike[str]) -> Written:
    """Read a MusicXML file, plain or compressed.

    Raises ScoreError, one line naming the file, whatever its bytes: where it cannot be read, is no
    MusicXML or is beyond all bounds.
    """
    with errors_name(path):
        data = read_score_bytes(path, MAX_XML_BYTES)
        return written_of(parse(unpacked(data) if data.startswith(ZIP) else data))


def written_of(root: Element) -> Written:
    """Return the score of a root element. Raises ScoreError where it is none, or beyond bounds."""
    if root.tag == "score-timewise":
        root = _partwise(root)
    if root.tag != "score-partwise":
        raise ScoreError(f"is not a MusicXML score: its root is <{printable(root.tag)}>")
    unknown: Counter[str] = Counter()
    tell_strange(root, unknown)
    warnings: Counter[str] = Counter()
    elements = root.findall("part")
    if len(elements) > MAX_PARTS:
        raise ScoreError(f"has more than {MAX_PARTS} parts")
    names = {
        part.get("id", ""): printable(part.findtext("part-name") or "")
        for part in root.iterfind("part-list/score-part")
    }
    titles = (root.findtext(path) or "" for path in ("work/work-title", "movement-title"))
    title = next(filter(None, map(printable, titles)), "")
    parts = []
    for element in elements:
        reader = BarReader(element, unknown, warnings)
        bars = [reader.read(measure) for measure in element.iterfind("measure")]
        parts.append((names.get(element.get("id", ""), ""), bars))
    return assembled(parts, title, unknown, warnings)


def _partwise(root: Element) -> Element:
    """Change a score of bars with parts to one of parts with bars."""
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


def unpacked(data: bytes) -> bytes:
    """The score in a compressed file; raises ScoreError where it is damaged, too large or none."""
    if len(data) > MAX_BYTES:
        raise ScoreError(f"is an archive larger than {MAX_BYTES >> 20} MiB")
    if data.count(ENTRY) > MAX_ENTRIES:
        raise ScoreError(f"is an archive of more than {MAX_ENTRIES} files")
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            name = _score_name(archive)
            return _member(archive, name, MAX_XML_BYTES)
    except DAMAGED as error:
        raise ScoreError(f"is a damaged archive ({type(error).__name__})") from None


def _score_name(archive: zipfile.ZipFile) -> str:
    # What a Macintosh keeps beside files is named ._ and the file's name.
    names = [name for name in archive.namelist() if not name.rpartition("/")[2].startswith("._")]
    if CONTAINER in names:
        for file in _rootfiles(_member(archive, CONTAINER, MAX_CONTAINER_BYTES)):
            kind = file.get("media-type", "application/vnd.recordare.musicxml+xml")
            if "musicxml" in kind and file.get("full-path") in names:
                return str(file.get("full-path"))
    for name in names:  # a container that is missing or wrong
        if name.lower().endswith((".musicxml", ".xml")) and not name.startswith("META-INF/"):
            return name
    raise ScoreError("is an archive without a score")


def _rootfiles(container: bytes) -> list[Element]:
    try:
        return list(parse(container).iter("rootfile"))
    except ScoreError:  # the score may be read nevertheless
        return []


def _member(archive: zipfile.ZipFile, name: str, most_bytes: int) -> bytes:
    info = archive.getinfo(name)
    if info.compress_type not in COMPRESSIONS:
        raise ScoreError("is an archive compressed in a way that MusicXML does not have")
    with archive.open(info) as file:
        data = file.read(most_bytes + 1)
    if len(data) > most_bytes:  # whatever its directory says
        raise ScoreError(f"is an archive with a file larger than {most_bytes >> 10} KiB")
    return data


def parse(data: bytes) -> ET.Element:
    """Parse XML of bounded size and depth, without namespaces. Raises ScoreError with the line."""
    builder = _Builder()
    data, encoding = _in_utf8(data)
    parser = expat.ParserCreate(encoding)
    parser.buffer_text = True
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    parser.EntityDeclHandler = builder.refuse_entity
    # The document type stays outside: it is not fetched, and no score needs its entities.
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code) if error.code else "not well-formed"
        raise ScoreError(f"line {error.lineno}: is not XML ({reason})") from None
    except (ValueError, LookupError):  # an encoding that is unknown, or has many bytes
        said = _SAYS.match(data)
        name = printable(said[1].decode("ascii")) if said else "unknown"
        raise ScoreError(f"its encoding is not read ({name}); save it as UTF-8") from None
    return builder.root()


def _in_utf8(data: bytes) -> tuple[bytes, str | None]:
    """Bytes that expat reads, and their encoding where it is another than they say."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data, "utf-16"
    found = _SAYS.match(data)
    said = found[1].decode("ascii").lower() if found else "utf-8"
    name = said.removeprefix("x-").replace("windows-", "cp")
    try:
        codec = codecs.lookup(NAMED_OTHERWISE.get(name, name)).name
        if codec.startswith("utf-"):  # UTF-16 in bytes that are none
            return data, "utf-8" if found else None
        return data.decode(WIDEST.get(codec, codec)).encode(), "utf-8"
    except LookupError:  # the parser refuses it
        return data, None
    except UnicodeError:
        raise ScoreError(f"says that it is {said}, which it is not; save it as UTF-8") from None


class _Builder:
    def __init__(self) -> None:
        self._tree = ET.TreeBuilder()
        self._depth = 0
        self._elements = 0
        self._is_text = False

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        self._elements += 1
        if self._depth > DEEPEST:
            raise ScoreError(f"has elements deeper than {DEEPEST}")
        if self._elements > MAX_ELEMENTS:
            raise ScoreError(f"has more than {MAX_ELEMENTS} elements")
        self._is_text = True
        # Of a million elements each string counts.
        self._tree.start(sys.intern(tag.rpartition(":")[2]), attributes)

    def end(self, tag: str) -> None:
        self._depth -= 1
        self._is_text = False
        self._tree.end(tag.rpartition(":")[2])

    def data(self, text: str) -> None:
        if self._is_text and not text.isspace():  # the rest is indentation
            self._tree.data(text)

    def refuse_entity(self, *_: Any) -> None:
        raise ScoreError("defines XML entities, which no score needs")

    def root(self) -> ET.Element:
        return self._tree.close()
