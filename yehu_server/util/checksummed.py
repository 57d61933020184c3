"""Read and write what can be computed again, with a checksum: no damaged file is taken."""

import contextlib
import hashlib
from pathlib import Path

from yehu_server.util.files import error_reason, partial_beside, read_bytes

MAX_BYTES = 64 * 2**20
DIGEST_BYTES = 16


class ChecksumError(Exception):
    """A file whose checksum is wrong, or that cannot be read."""


def _digest(path: Path, payload: bytes) -> bytes:
    # The name is included, so that no file is taken for another.
    digest = hashlib.blake2b(path.name.encode() + b"\0", digest_size=DIGEST_BYTES)
    digest.update(payload)
    return digest.digest()


def read_checksummed(path: Path) -> bytes | None:
    """Read a file's payload; None where there is no file. Raises ChecksumError."""
    try:
        data = read_bytes(path, MAX_BYTES)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise ChecksumError(error_reason(error)) from error
    checksum, payload = data[:DIGEST_BYTES], data[DIGEST_BYTES:]
    if checksum != _digest(path, payload):
        raise ChecksumError("it is damaged")
    return payload


def write_checksummed(path: Path, payload: bytes) -> None:
    """Write a file with its checksum atomically; a power cut shows. Raises OSError."""
    partial = partial_beside(path)
    try:
        partial.write_bytes(_digest(path, payload) + payload)
        partial.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)
        raise
