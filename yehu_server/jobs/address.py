"""The address of a cluster's scheduler, as people write it."""

from __future__ import annotations

import json
import re
from pathlib import Path

from yehu_server.errors import YehuError
from yehu_server.files import read_text, why

PORT = 8786  # Dask's own choice
_ADDRESS = re.compile(r"(?:(tcp|tls|ucx|ws|wss)://)?(\[[0-9a-fA-F:.]+\]|[^\s:/\[\]]+)(?::(\d+))?/?")


def scheduler_address(text: str) -> str:
    """Complete an address: ``HOST``, ``HOST:PORT``, ``tls://HOST:PORT``, or a scheduler's file.

    Raises
    ------
    YehuError
        Where it is none.
    """
    if text.endswith(".json"):
        return _in_file(Path(text))
    found = _ADDRESS.fullmatch(text)
    if found is None or not 0 < int(found[3] or PORT) < 65536:
        raise YehuError(
            f"{text!r} is not the address of a scheduler, such as tcp://10.0.0.1:{PORT}"
        )
    return f"{found[1] or 'tcp'}://{found[2]}:{found[3] or PORT}"


def _in_file(path: Path) -> str:
    """The address in the file that ``dask scheduler --scheduler-file`` writes."""
    try:
        address = json.loads(read_text(path))["address"]
        if not isinstance(address, str):
            raise TypeError  # noqa: TRY301 - as where it is no JSON at all
    except OSError as error:
        raise YehuError(f"{path}: {why(error)}") from error
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise YehuError(f"{path}: is not the file of a Dask scheduler") from error
    return scheduler_address(address.removesuffix(".json"))
