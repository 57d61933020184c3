"""Hash source code without its comments and docstrings, so that the hash changes with the code."""

import hashlib
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path

_COMMENTS = re.compile(
    r'(?P<docstring>^[ \t]*"""(?:[^\\]|\\.)*?"""[ \t]*$)'
    r'|(?P<text>"""(?:[^\\]|\\.)*?"""|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\')'
    r"|#[^\n]*",
    re.MULTILINE | re.DOTALL,
)


def without_comments(source: str) -> str:
    """Python source without comments, docstrings and empty lines."""
    code = _COMMENTS.sub(lambda match: match["text"] or "", source)
    return "\n".join(line for line in map(str.rstrip, code.splitlines()) if line)


def key_of(sources: Iterable[Path], *more: str) -> str:
    """Hash of the code in some Python files, and of other texts (16 hex digits)."""
    digest = hashlib.sha256()
    for text in more:
        digest.update(text.encode() + b"\0")
    for path in sources:
        status = path.stat()
        code = _code(path, status.st_mtime_ns, status.st_size)
        digest.update(path.name.encode() + b"\0" + code + b"\0")
    return digest.hexdigest()[:16]


@cache
def _code(path: Path, _mtime_ns: int, _size: int) -> bytes:
    """A file without comments; read once, as long as it does not change."""
    return without_comments(path.read_text(encoding="utf-8")).encode()
