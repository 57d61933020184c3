"""The hash of all that a build is made from, and the section of WebAssembly that has it."""

import hashlib
from functools import cache

from yehu_server.compile.cache_folder import source_hash
from yehu_server.util import PACKAGE
from yehu_server.util.source_key import key_of


@cache
def build_hash() -> str:
    """Hash of the sources, calibrations and bowing tables that builds are made of (16 digits)."""
    learnt = [
        (PACKAGE / "playing" / name).read_text(encoding="utf-8")
        for name in ("calibrations.json", "practices.json")
    ]
    begun = [PACKAGE / "playing" / name for name in ("options.py", "tables.py")]  # memory's start
    return key_of(begun, source_hash(is_shipped=True), *learnt)


NAME = b"yehu"
PREAMBLE = b"\0asm\1\0\0\0"
CUSTOM = 0


def with_section(module: bytes, text: str) -> bytes:
    """A module with a custom section at its end that holds a text, and a checksum of the rest."""
    body = bytes((len(NAME),)) + NAME + f"{text} {_checksum(module, text)}".encode()
    return module + bytes((CUSTOM,)) + _leb128(len(body)) + body


def section_of(module: bytes) -> str:
    """The text of a module's last section; empty where that is not ours, or a byte is wrong."""
    at = len(PREAMBLE)
    if not module.startswith(PREAMBLE):
        return ""
    text, checksum, begin = "", "", at
    while at < len(module):
        text, checksum, begin = "", "", at
        kind = module[at]
        size, at = _read_leb128(module, at + 1)
        body = module[at : at + size]
        if kind == CUSTOM and body[1 : 1 + len(NAME)] == NAME and body[:1] == bytes((len(NAME),)):
            text, _, checksum = body[1 + len(NAME) :].decode("utf-8", "replace").rpartition(" ")
        at += size
    is_whole = at == len(module) and checksum == _checksum(module[:begin], text)
    return text if is_whole else ""


def _checksum(module: bytes, text: str) -> str:
    return hashlib.blake2b(module + text.encode(), digest_size=16).hexdigest()


def _leb128(number: int) -> bytes:
    digits = bytearray()
    while number >= 0x80:
        digits.append(number & 0x7F | 0x80)
        number >>= 7
    return bytes((*digits, number))


def _read_leb128(data: bytes, at: int) -> tuple[int, int]:
    number = shift = 0
    while at < len(data):
        number |= (data[at] & 0x7F) << shift
        shift += 7
        at += 1
        if data[at - 1] < 0x80:
            break
    return number, at
