"""What commands print: results and warnings, a safe line at a time, and the log of serve."""

from __future__ import annotations

import argparse
import contextlib
import json
import logging
import sys
from typing import Any

from yehu_server.errors import one_line


def print_result(text: str, *, flush: bool = False) -> None:
    """Print a result."""
    for line in text.split("\n"):
        print(one_line(line), flush=flush)


def warn(text: str) -> None:
    """Print a warning or an error on one line."""
    print(f"yehu-server: {one_line(text)}", file=sys.stderr)


LEVELS = ("debug", "info", "warning", "error")


def set_up_log(arguments: argparse.Namespace) -> None:
    """Set up logging by --log-level and --json-log, and set `quiet` for warnings only or JSON."""
    handler = _Handler()
    handler.setFormatter(_JsonFormatter() if arguments.json_log else _PlainFormatter())
    logging.basicConfig(handlers=[handler], level=logging.WARNING, force=True)
    logging.getLogger("yehu_server").setLevel(arguments.log_level.upper())
    arguments.quiet = arguments.json_log or arguments.log_level in ("warning", "error")


class _Handler(logging.Handler):
    """Writes to the present sys.stderr, which a status line may have replaced."""

    def emit(self, record: logging.LogRecord) -> None:
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.write(self.format(record) + "\n")
            sys.stderr.flush()


class _PlainFormatter(logging.Formatter):
    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802 - logging's name
        return f"yehu-server: {one_line(record.message)}"

    def formatException(self, ei: Any) -> str:  # noqa: N802 - logging's name
        return "\n".join(map(one_line, super().formatException(ei).split("\n")))


class _JsonFormatter(logging.Formatter):
    def format(self, record: logging.LogRecord) -> str:
        fields = {
            "time": self.formatTime(record, "%Y-%m-%dT%H:%M:%S%z"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": one_line(record.getMessage()),
        }
        if record.exc_info:
            fields["exception"] = self.formatException(record.exc_info)
        return json.dumps(fields)
