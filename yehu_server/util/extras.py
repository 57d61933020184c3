"""Check for libraries that only extras of the package bring."""

from __future__ import annotations

import importlib

from yehu_server.errors import ParameterError


def require_package(module: str, what: str, extra: str) -> None:
    """Check that a library is there.

    Raises ParameterError where it is missing, which names the extra that brings it.

    `what`: what needs it, for the message.
    """
    try:
        importlib.import_module(module)
    except ImportError:
        library = module.partition(".")[0]
        raise ParameterError(f"{what} needs {library}: pip install yehu-server[{extra}]") from None
