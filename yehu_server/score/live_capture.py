"""Capture a session while it is played."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from yehu_server.engine.ensemble import Ensemble
from yehu_server.errors import OutputError
from yehu_server.score.capture_beginning import beginning_of
from yehu_server.score.capture_writer import CaptureWriter


class LiveCapture:
    """Writes the wishes that players fulfil to a file; a full disk ends only the capture.

    Parameters
    ----------
    ensemble : Ensemble
        Its instruments must report their wishes (``Instrument.report_wishes``) from the first
        frame on.
    has_room : bool
        Whether it plays in a room.
    said : callable
        Called with a line when the capture ends by itself.
    overwrite : bool
        Whether to replace an older file.

    Raises
    ------
    OutputError
        Where the file cannot be written, or is there.
    """

    def __init__(
        self,
        ensemble: Ensemble,
        target: Path,
        said: Callable[[str], None],
        *,
        has_room: bool,
        overwrite: bool = False,
    ) -> None:
        self._ensemble = ensemble
        self._said = said
        self._writer: CaptureWriter | None = CaptureWriter(
            target,
            beginning=beginning_of(ensemble.instruments, has_room=has_room),
            overwrite=overwrite,
        )
        self._rests = 0  # number of those written
        self._unreported = 0
        self.is_whole = True

    def keep_up(self) -> None:
        """Write the wishes that were fulfilled since the last call."""
        if self._writer is not None:
            try:
                self._write(self._writer)
            except OutputError as error:
                self._end(error)

    def close(self) -> None:
        """Write the last wishes, and end the capture after the last frame played."""
        self.keep_up()
        writer, self._writer = self._writer, None
        if writer is not None:
            try:
                writer.close(self._ensemble.frame)
            except OutputError as error:
                self._end(error)

    def discard(self) -> None:
        """End the capture and remove its file."""
        if self._writer is not None:
            self._writer.discard()
        self._writer = None

    def _write(self, writer: CaptureWriter) -> None:
        for since, frame in self._ensemble.rests[self._rests :]:
            writer.note("rest", frame, since=since)
            self._rests += 1
        unreported = 0
        for player, instrument in enumerate(self._ensemble.instruments):
            writer.wishes(instrument.applied_wishes(), player)
            unreported += int(instrument.meters()["unreported"])
        if unreported > self._unreported:
            frame = int(self._ensemble.meters()["frame"])
            writer.note("lost", frame, events=unreported - self._unreported)
            self._unreported = unreported

    def _end(self, error: OutputError) -> None:
        self._writer = None
        self.is_whole = False
        self._said(f"capture ended: {error}; what was written is kept")
