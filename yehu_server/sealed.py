"""Files that carry their checksum: what is damaged, or was not written whole, is not believed.

They hold what can be made anew at any time, such as compiled code and calibrations.
"""

from __future__ import annotations

import contextlib
import hashlib
import secrets
from pathlib import Path

from yehu_server.files import read_bytes

MOST_BYTES = 64 * 2**20
DIGEST_BYTES = 16


class SealError(Exception):
    """A file that does not hold what was written into it."""


def _digest(path: Path, payload: bytes) -> bytes:
    # With its name, so that no file passes for another.
    digest = hashlib.blake2b(path.name.encode() + b"\0", digest_size=DIGEST_BYTES)
    digest.update(payload)
    return digest.digest()


def read_sealed(path: Path) -> bytes | None:
    """What was written; None where there is no file.

    Errors: SealError for a file that is damaged, or cannot be read.
    """
    try:
        data = read_bytes(path, MOST_BYTES)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise SealError(error.strerror) from error
    seal, payload = data[:DIGEST_BYTES], data[DIGEST_BYTES:]
    if seal != _digest(path, payload):
        raise SealError("it is damaged")
    return payload


def write_sealed(path: Path, payload: bytes) -> None:
    """Write or replace a file at once: whoever reads finds the old one or the new one, whole.

    A power cut may leave less, which its seal shows. Errors: OSError.
    """
    partial = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    try:
        partial.write_bytes(_digest(path, payload) + payload)
        partial.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)
        raise
