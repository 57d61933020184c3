"""Draws an address in a terminal, so that a phone opens it by its camera instead of by typing.

Half a character is one module of the code, black on white whatever the terminal's colours: most
cameras do not read the inverse.
"""

from __future__ import annotations

import contextlib
from itertools import zip_longest
from typing import TextIO

import segno

QUIET = 4  # modules of white around it (ISO/IEC 18004)
# Black and white of the 256 colours, which themes leave alone; and back.
BLACK_ON_WHITE, PLAIN = "\x1b[38;5;16;48;5;231m", "\x1b[0m"
HALVES = {(0, 0): " ", (1, 0): "▀", (0, 1): "▄", (1, 1): "█"}  # by the upper and the lower module


def show(text: str, stream: TextIO) -> None:
    """Draw a text as a QR code, where a terminal shows it."""
    encoding = stream.encoding or ""
    if stream.isatty() and encoding.lower().startswith("utf"):
        with contextlib.suppress(OSError):  # the terminal was closed
            stream.write("".join(f"{line}\n" for line in drawn(text)))
            stream.flush()


def drawn(text: str) -> list[str]:
    """The lines of a QR code of a text, with their colours."""
    rows = [bytes(row) for row in segno.make_qr(text).matrix_iter(border=QUIET)]
    white = bytes(len(rows[0]))
    pairs = zip_longest(rows[::2], rows[1::2], fillvalue=white)
    halves = ("".join(map(HALVES.__getitem__, zip(*pair, strict=True))) for pair in pairs)
    return [f"{BLACK_ON_WHITE}{line}{PLAIN}" for line in halves]
