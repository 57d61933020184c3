"""Write captures, every command applied and its frame, a JSON value a line (docs/capture.md)."""

import contextlib
import io
import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.errors import OutputError
from yehu_server.scores.capture_format import as_line
from yehu_server.scores.capture_header import SessionStart, header_of, session_start_of
from yehu_server.system.terminals import quoted
from yehu_server.util.files import create, discard, error_reason, is_removed, write_all
from yehu_server.util.hints import command_name

ROOM_BYTES = 1 << 16  # free space needed to begin a capture


class CaptureWriter:
    """Writes a capture; each line of the file is complete, however writing ends.

    `beginning` is what the session starts from; `overwrite` replaces an older file. Raises
    OutputError where it cannot be written.
    """

    def __init__(self, target: Path, *, beginning: SessionStart, overwrite: bool = False) -> None:
        self.target = target
        self._file = create(target, overwrite=overwrite, room_bytes=ROOM_BYTES)
        self._whole_bytes = 0
        self.events = 0  # commands written
        self._write([header_of(beginning)])

    def commands(self, commands: Any, player: int = 0) -> None:
        """Add commands [shape=(n,), dtype=COMMAND] that a player, counted from 0, applied."""
        self._write(as_line(command, player) for command in commands.tolist())
        self.events += len(commands)

    def note(self, what: str, frame: int, **details: int) -> None:
        """Add a ``rest`` (after a gap `since` a frame), or ``lost`` `events`."""
        self._write([{what: frame, **details}])

    def close(self, frame: int) -> None:
        """End the capture at the frame after the last one played."""
        self._write([{"end": frame}])
        self._file.close()

    def discard(self) -> None:
        """End the capture and remove its file."""
        discard(self._file, self.target)
        self._file.close()

    def _write(self, lines: Iterable[Any]) -> None:
        data = "".join(json.dumps(line) + "\n" for line in lines).encode()
        if is_removed(self._file, self.target):
            self._file.close()
            raise OutputError(f"{self.target}: was removed meanwhile")
        try:
            write_all(self._file, data)
            self._whole_bytes += len(data)
        except OSError as error:
            with contextlib.suppress(OSError):  # remove an incomplete line
                written = self._file.seek(0, io.SEEK_END) - self._whole_bytes
                self._file.truncate(self._whole_bytes + data.rfind(b"\n", 0, written) + 1)
            self._file.close()
            raise OutputError(f"{self.target}: cannot write: {error_reason(error)}") from error


class LiveCapture:
    """Writes the commands that players apply to a file; a full disk ends only the capture.

    The ensemble's instruments must report their commands (``Instrument.report_commands``) from the
    first frame on; `has_room`: whether it plays in a room. `on_message` is called with a line when
    the capture ends. Raises OutputError where the file cannot be written, or is
    there.
    """

    def __init__(
        self,
        ensemble: Ensemble,
        target: Path,
        on_message: Callable[[str], None],
        *,
        has_room: bool,
        overwrite: bool = False,
    ) -> None:
        self._ensemble = ensemble
        self._on_message = on_message
        self._writer: CaptureWriter | None = CaptureWriter(
            target,
            beginning=session_start_of(ensemble.instruments, has_room=has_room),
            overwrite=overwrite,
        )
        self._rests = 0  # number of those written
        self._unreported = 0
        self.is_whole = True

    def keep_up(self, *, is_last: bool = False) -> None:
        """Write the commands that were applied since the last call."""
        if self._writer is None:
            return
        try:
            self._write(self._writer)
            if is_last:
                self._writer.close(self._ensemble.frame)
                self._report_kept(self._writer.target, self._writer.events)
        except OutputError as error:
            kept = "; what was written is kept" if self._writer.target.exists() else ""
            self._writer = None
            self.is_whole = False
            self._on_message(f"capture ended: {error}{kept}")

    def close(self) -> None:
        """Write the last commands, and end the capture after the last frame played."""
        self.keep_up(is_last=True)
        self._writer = None

    def _report_kept(self, target: Path, events: int) -> None:
        what = f"{events} event{'s' * (events != 1)}"
        again = f"{command_name()} replay {quoted(str(target))} -o OUT.wav"
        self._on_message(f"{target}: {what}; `{again}` renders it")

    def discard(self) -> None:
        """End the capture and remove its file."""
        if self._writer is not None:
            self._writer.discard()
        self._writer = None

    def _write(self, writer: CaptureWriter) -> None:
        for since, frame in self._ensemble.gaps[self._rests :]:
            writer.note("rest", frame, since=since)
            self._rests += 1
        unreported = 0
        for player, instrument in enumerate(self._ensemble.instruments):
            writer.commands(instrument.applied_commands(), player)
            unreported += int(instrument.meters()["unreported"])
        if unreported > self._unreported:
            frame = int(self._ensemble.meters()["frame"])
            writer.note("lost", frame, events=unreported - self._unreported)
            self._unreported = unreported
