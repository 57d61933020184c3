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


CUSTOM = 0
MARK = b"\x04yehu"  # the name of our section, after its length
LONGEST = 127  # a length up to this is one byte


def with_section(module: bytes, text: str) -> bytes:
    """A module with a custom section at its end that holds a text, and a checksum of the rest."""
    checksum = hashlib.blake2b(module + text.encode(), digest_size=16).hexdigest()
    body = MARK + f"{text} {checksum}".encode()
    return module + bytes((CUSTOM, len(body))) + body


def section_of(module: bytes) -> str:
    """The text of a module's last section; empty where that is not ours, or a byte is wrong."""
    rest, _, body = module.rpartition(MARK)
    text, _, _ = body[:LONGEST].decode("utf-8", "ignore").rpartition(" ")
    return text if module == with_section(rest[:-2], text) else ""
