"""Finds a MIDI file within what it came in: RIFF, a Macintosh's header, a mail.

What is no MIDI file at all is named, so that its owner knows what to do with it.
"""

from __future__ import annotations

from yehu_server.errors import ScoreError
from yehu_server.scores.smf.faults import DamageReport

JUNK_BYTES = 65_536  # among which a header is searched
HEADER = b"MThd\0\0\0"  # with the length that all headers have, so that prose is none
MAC_BYTES = 128  # of a MacBinary header
MAX_PARTS = 131_070  # of a RIFF file

UNPACK = "unpack it first"
DECODE = "decode it first"
# Where, which bytes, and what they begin. An archive may have a MIDI file within as it is, but
# also several, and names.
ARCHIVES: tuple[tuple[int, bytes, str], ...] = (
    (0, b"\x1f\x8b", f"it is compressed by gzip; {UNPACK}"),
    (0, b"PK\x03\x04", f"it is a zip archive; {UNPACK}"),
    (0, b"BZh", f"it is compressed by bzip2; {UNPACK}"),
    (0, b"\xfd7zXZ", f"it is compressed by xz; {UNPACK}"),
    (0, b"\x28\xb5\x2f\xfd", f"it is compressed by zstd; {UNPACK}"),
    (0, b"7z\xbc\xaf\x27\x1c", f"it is a 7z archive; {UNPACK}"),
    (0, b"Rar!", f"it is a rar archive; {UNPACK}"),
    (0, b"SIT!", f"it is a StuffIt archive; {UNPACK}"),
    (0, b"StuffIt", f"it is a StuffIt archive; {UNPACK}"),
    (2, b"-lh", f"it is an LHA archive; {UNPACK}"),
    (257, b"ustar", f"it is a tar archive; {UNPACK}"),
)
OTHERS: tuple[tuple[int, bytes, str], ...] = (
    (0, b"(This file must be converted with BinHex", f"it is encoded by BinHex; {DECODE}"),
    (0, b"begin 6", f"it is encoded by uuencode; {DECODE}"),
    (0, b"TVRoZA", f"it is encoded in base64; {DECODE}"),
    (0, b"\0\x05\x16\x07", "it is what a Macintosh keeps beside a file; the music is in the other"),
    (0, b"SMF2CLIP", "it is a clip of MIDI 2.0"),
    (0, b"XMF_", "it is an XMF file"),
    (0, b"MMMD", "it is a SMAF ringtone"),
    (0, b"MUS\x1a", "it is a MUS file of a game"),
    (0, b"HMI-MIDISONG", "it is an HMI file of a game"),
    (0, b"HMIMIDIP", "it is an HMP file of a game"),
    (0, b"FORM", "it is an IFF file, as XMI files of games are"),
    (8, b"WAVE", "it is a sound file"),
    (0, b"fLaC", "it is a sound file"),
    (0, b"OggS", "it is a sound file"),
    (0, b"ID3", "it is a sound file"),
    (0, b"%PDF", "it is a PDF"),
    (0, b"<!", "it is a web page or XML"),
    (0, b"<html", "it is a web page"),
    (0, b"<HTML", "it is a web page"),
    (0, b"<?xml", "it is XML"),
)


def unwrapped(data: bytes, faults: DamageReport) -> tuple[int, int]:
    """Return where the MIDI file begins and ends. Raises ScoreError where no header is found."""
    start, end = _of_macintosh(data)
    if data[start : start + 4] == b"RIFF" and data[start + 8 : start + 12] == b"RMID":
        start, end = _of_riff(data, start, end)
    if data[start : start + 4] == b"MThd":
        return start, end
    archive = _kind_of(data, ARCHIVES)
    found = -1 if archive else data.find(HEADER, start, start + JUNK_BYTES + len(HEADER))
    if found < 0:
        kind = archive or _kind_of(data, OTHERS) or _missing(data)
        raise ScoreError(f"is not a MIDI file: {kind}")
    faults.add(f"{found - start} bytes before the header skipped", start)
    return found, end


def _of_macintosh(data: bytes) -> tuple[int, int]:
    """The bytes within a MacBinary header and what follows it, or all."""
    whole = 0, len(data)
    if len(data) < MAC_BYTES or data[0] or not 0 < data[1] < 64 or data[74]:
        return whole
    if data[MAC_BYTES : MAC_BYTES + 4] not in (b"MThd", b"RIFF"):
        return whole
    length = int.from_bytes(data[83:87], "big")
    return MAC_BYTES, min(MAC_BYTES + length, len(data)) if length else len(data)


def _of_riff(data: bytes, start: int, end: int) -> tuple[int, int]:
    """The bytes within the wrapper; its lengths are little-endian, its parts are padded."""
    pos = start + 12
    for _ in range(MAX_PARTS):
        if pos + 8 > end:
            break
        length = int.from_bytes(data[pos + 4 : pos + 8], "little")
        if data[pos : pos + 4] == b"data":
            inside = data[pos + 8 : pos + 12] == b"MThd"
            return (pos + 8, min(pos + 8 + length, end)) if inside else (start, end)
        pos += 8 + length + length % 2
    return start, end


def _kind_of(data: bytes, kinds: tuple[tuple[int, bytes, str], ...]) -> str:
    text = data[:512].lstrip(b"\xef\xbb\xbf \t\r\n")  # a web page may begin with empty lines
    for at, magic, kind in kinds:
        if data[at : at + len(magic)] == magic or (at == 0 and text.startswith(magic)):
            return kind
    return ""


def _missing(data: bytes) -> str:
    if not data.strip(b"\0"):
        return "all of its bytes are zero"
    if b"MTrk" in data[: JUNK_BYTES + 4]:
        return "it has a track and no header (MThd)"
    return f"there is no header (MThd) in the first {JUNK_BYTES // 1024} kB"
