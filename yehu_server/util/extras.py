"""Libraries that come with extras of the package only."""

from __future__ import annotations

import importlib

from yehu_server.errors import ParameterError


def need(module: str, what: str, extra: str) -> None:
    """Check that a library is there.

    Raises ParameterError where it is missing: the extra that brings it.

    `what`: what needs it, for the message.
    """
    try:
        importlib.import_module(module)
    except ImportError:
        library = module.partition(".")[0]
        raise ParameterError(f"{what} needs {library}: pip install yehu-server[{extra}]") from None
