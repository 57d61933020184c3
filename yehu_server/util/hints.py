"""What hints name: the command as it was called, and how to get a library of an extra."""

import contextlib
import importlib
import os
import sys
from pathlib import Path

from yehu_server.errors import ParameterError
from yehu_server.system.terminals import quoted


def command_name() -> str:
    """The command as one types it again: ``scripts/yehu`` says its own name in YEHU_COMMAND."""
    return quoted(os.environ.get("YEHU_COMMAND", "yehu-server"))


def shown_path(path: Path) -> str:
    """A path as one types it: from the current folder, or from home, where it lies in one."""
    for folder, name in ((Path.cwd, Path()), (Path.home, Path("~"))):
        with contextlib.suppress(ValueError, OSError, RuntimeError):  # it is elsewhere, or gone
            return str(name / path.relative_to(folder()))
    return str(path)


def install_command(extra: str) -> str:
    """The command that installs an extra for the Python that runs this, also in a checkout."""
    return f"{quoted(sys.executable)} -m pip install 'yehu-server[{extra}]'"


def require_package(module: str, what: str, extra: str) -> None:
    """Raise a ParameterError that names the extra where a library is missing that `what` needs."""
    try:
        importlib.import_module(module)
    except ImportError:
        library = module.partition(".")[0]
        raise ParameterError(f"{what} needs {library}: {install_command(extra)}") from None
