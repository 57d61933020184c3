"""Write captures of sessions: every wish that the player fulfilled, with its frame.

docs/capture.md describes the format: one JSON value a line, so that a capture that was cut short
by a crash can be read.
"""

from __future__ import annotations

import contextlib
import io
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from yehu_server.errors import OutputError
from yehu_server.files import create, discard, why, write_all
from yehu_server.score.capture_beginning import Beginning, header_of
from yehu_server.score.capture_format import as_line

ROOM_BYTES = 1 << 16  # free space needed to begin a capture


class CaptureWriter:
    """Writes a capture; each line of the file is complete, however writing ends.

    Parameters
    ----------
    beginning : Beginning
        What the session starts from.
    overwrite : bool
        Whether to replace an older file.

    Raises
    ------
    OutputError
        Where it cannot be written.
    """

    def __init__(
        self,
        target: Path,
        *,
        beginning: Beginning,
        overwrite: bool = False,
    ) -> None:
        self._target = target
        self._file = create(target, overwrite=overwrite, room_bytes=ROOM_BYTES)
        self._whole_bytes = 0
        self._write([header_of(beginning)])

    def wishes(self, wishes: Any, player: int = 0) -> None:
        """Add wishes [shape=(wishes,), dtype=WISH] that a player, counted from 0, fulfilled."""
        self._write(as_line(wish, player) for wish in wishes)

    def note(self, what: str, frame: int, **details: int) -> None:
        """Add a ``rest`` (after a gap `since` a frame), or ``lost`` `events`."""
        self._write([{what: frame, **details}])

    def close(self, frame: int) -> None:
        """End the capture at the frame after the last one played."""
        self._write([{"end": frame}])
        self._file.close()

    def discard(self) -> None:
        """End the capture and remove its file."""
        discard(self._file, self._target)
        self._file.close()

    def _write(self, lines: Iterable[Any]) -> None:
        data = "".join(json.dumps(line) + "\n" for line in lines).encode()
        try:
            write_all(self._file, data)
            self._whole_bytes += len(data)
        except OSError as error:
            with contextlib.suppress(OSError):  # remove an incomplete line
                written = self._file.seek(0, io.SEEK_END) - self._whole_bytes
                self._file.truncate(self._whole_bytes + data.rfind(b"\n", 0, written) + 1)
            self._file.close()
            raise OutputError(f"{self._target}: cannot write: {why(error)}") from error
