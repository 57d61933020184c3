"""The libraries that the workshop needs beyond the instrument's own."""

from __future__ import annotations

import importlib

from yehu_server.errors import ParameterError


def need(module: str, extra: str) -> None:
    """Check that a library is there.

    Raises
    ------
    ParameterError
        Where it is missing: the extra that brings it.
    """
    try:
        importlib.import_module(module)
    except ImportError:
        library = module.partition(".")[0]
        raise ParameterError(
            f"the body workshop needs {library}: install yehu-server[{extra}]"
        ) from None
