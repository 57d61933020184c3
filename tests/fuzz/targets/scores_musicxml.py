"""MusicXML, plain and compressed, and how it is played."""

import io
import math
import zipfile

from fuzz.target import Program, target, written

from yehu_server.errors import ScoreError
from yehu_server.params.table import find
from yehu_server.scores.events import Setting
from yehu_server.scores.jianpu.reader import parse_jianpu
from yehu_server.scores.jianpu.writer import jianpu_of
from yehu_server.scores.musicxml.reader import parse, read_musicxml, written_of
from yehu_server.scores.musicxml.writer import musicxml_of
from yehu_server.scores.score import LONGEST_DURATION_H
from yehu_server.scores.written.notated import MARKS, SIGNS, SPANS, Written
from yehu_server.scores.written.performed import performed
from yehu_server.scores.written.text import lines_of

# What is played of more would take longer than reading it, and is bounded elsewhere.
FEW_NOTES, FEW_BEATS, FEW_TEXTS = 100, 200, 2000
CONTAINER = b'<container><rootfiles><rootfile full-path="s.musicxml"/></rootfiles></container>'
WORDS = (
    b"<measure>", b"</measure>", b"<chord/>", b"<grace/>", b"<rest/>", b"<tie type='start'/>",
    b"<backup><duration>1</duration></backup>", b"<sound tempo='60'/>", b"999999999", b"-1",
    b"<!DOCTYPE x [<!ENTITY a 'b'>]>", b"&a;", b"1e308", b"<ending number='1' type='start'/>",
    b"<slide type='start'/>", b"<tremolo type='stop'/>", b"<wavy-line type='start'/>",
    b"<repeat direction='backward' times='9'/>", b"<sound dalsegno='s'/>", b"<sound tocoda='c'/>",
    b"<wedge type='stop'/>", b"<words>rit.</words>", b"<transpose><chromatic>1</chromatic>",
)  # fmt: skip


def check(score: Written) -> None:
    """What was read is in order and within bounds, and can be played and written again."""
    check_written(score)
    check_played(score)
    check_again(score)


def check_written(score: Written) -> None:
    for part in score.parts:
        beats = [note.beat for note in part.notes]
        assert beats == sorted(beats)
        for note in part.notes:
            assert note.beat >= 0
            assert note.length > 0
            assert 0.0 <= note.pitch <= 127.0
            assert all(mark.name in MARKS for mark in note.marks)
        for one, after in zip(part.notes, part.notes[1:], strict=False):
            assert one.end <= after.beat
        assert all(span.name in SPANS and span.begin <= span.end for span in part.spans)
        assert all(sign.name in SIGNS for sign in part.signs)
    for text in (score.title, *score.unknown, *score.warnings):
        assert text.isprintable()


def check_played(score: Written) -> None:
    notes = sum(len(part.notes) for part in score.parts)
    texts = sum(len(part.spans) + len(part.signs) for part in score.parts)
    if notes > FEW_NOTES or score.end > FEW_BEATS or texts > FEW_TEXTS:
        return
    assert all(line.isprintable() for line in lines_of(score))
    if not notes:
        return
    played = performed(score)
    times = [event.time_s for event in played.events]
    assert times == sorted(times)
    assert 0.0 <= times[0] <= times[-1] <= played.duration_s <= LONGEST_DURATION_H * 3600
    assert math.isfinite(played.duration_s)
    for event in played.events:
        message = event.message
        if isinstance(message, Setting) and message.value is not None:
            param = find(message.address)
            assert param.lo <= message.value <= param.hi


def check_again(score: Written) -> None:
    """What is written of a score is read again, with as many notes."""
    count = sum(len(part.notes) for part in score.parts)
    if not 0 < count <= FEW_NOTES or score.end > FEW_BEATS:
        return
    again = written_of(parse(musicxml_of(score)[0]))
    assert sum(len(part.notes) for part in again.parts) == count
    assert any(part.notes for part in parse_jianpu(jianpu_of(score)[0].encode()).parts)


@target("musicxml", ScoreError, words=WORDS, also=("examples/*.musicxml",))
def musicxml(data: bytes) -> None:
    """A file is a score of notes in order, within bounds, that can be played, or a ScoreError."""
    check(read_musicxml(written(data, "file.musicxml")))


@target("mxl", ScoreError, words=(b"PK\x03\x04", b"PK\x01\x02", b"PK\x05\x06"))
def mxl(data: bytes) -> None:
    """An archive is a score, or a ScoreError, whatever its files are named and hold.

    The first byte says how it is made: as it is, or packed of a container and a score, of which
    the next bytes choose names and damage.
    """
    program = Program(data)
    if program.byte() % 2:
        check_written(read_musicxml(written(data[1:], "file.mxl")))
        return
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        if program.byte() % 2:
            packed.writestr("META-INF/container.xml", CONTAINER)
        names = ("s.musicxml", "../../s.musicxml", "/etc/s.xml", "s.txt")
        packed.writestr(names[program.byte() % 4], data[8:] * (1 + 8 * (program.byte() % 8)))
    whole = bytearray(archive.getvalue())
    for _ in range(program.byte() % 4):
        whole[program.byte() * 257 % len(whole)] ^= program.byte()
    check_written(read_musicxml(written(bytes(whole), "file.mxl")))
