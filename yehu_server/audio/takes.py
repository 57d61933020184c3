"""Recordings of an instrument while it plays: the command's, and those made on request."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from yehu_server.audio.recorder import Recorder
from yehu_server.engine.instrument import Instrument
from yehu_server.errors import OutputError
from yehu_server.files import inside

ENDINGS = (".wav", ".flac")


class Takes:
    """One recording of everything, and beside it one at a time on request.

    Parameters
    ----------
    folder : Path
        Where recordings on request are written; it is made when one begins.
    said : callable
        Told in a line when a recording begins or ends.
    """

    def __init__(self, instrument: Instrument, folder: Path, said: Callable[[str], None]) -> None:
        self._instrument = instrument
        self._folder = folder
        self._said = said
        self._everything: Recorder | None = None
        self._requested: Recorder | None = None

    def record_everything(self, target: Path, *, overwrite: bool = False) -> None:
        """Record from the first frame until `close`.

        Raises
        ------
        OutputError
            Where the file cannot be written.
        """
        self._everything = Recorder(self._instrument, target, 0, self._said, overwrite=overwrite)

    def start(self, name: str) -> str:
        """Record under a plain name, into the folder; return the file's name.

        Raises
        ------
        OutputError
            Where a recording runs, the name is no plain one or taken, or the file cannot be
            written.
        """
        target = inside(self._folder, name, "" if Path(name).suffix in ENDINGS else ".wav")
        if self._requested is not None and self._requested.is_running:
            raise OutputError(f"already recording {self._requested.target.name}")
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            if target.exists():
                raise OutputError(f"{target.name} exists")
        except OSError as error:
            raise OutputError(f"{self._folder}: {error.strerror}") from error
        self._requested = Recorder(self._instrument, target, self._instrument.frame, self._said)
        self._said(f"recording {target}")
        return target.name

    def stop(self) -> str:
        """End what `start` began; return the file's name.

        Raises
        ------
        OutputError
            Where none runs, or it has ended by itself.
        """
        recorder, self._requested = self._requested, None
        if recorder is None:
            more = "; --record ends with the server" if self._everything is not None else ""
            raise OutputError(f"nothing is being recorded{more}")
        recorder.stop()
        if recorder.failure:
            raise OutputError(f"the recording has ended: {recorder.failure}")
        self._tell_of(recorder)
        return recorder.target.name

    def close(self) -> None:
        """End all recordings with what is played so far."""
        for recorder in (self._everything, self._requested):
            if recorder is not None:
                recorder.stop()
                self._tell_of(recorder)

    @property
    def is_whole(self) -> bool:
        """Whether the recording of everything, if there is one, lacks nothing."""
        return self._everything is None or self._everything.is_whole

    @property
    def names(self) -> str:
        """Names of the files that are being recorded, or nothing."""
        recorders = (self._everything, self._requested)
        running = [each for each in recorders if each is not None and each.is_running]
        return "; ".join(each.target.name for each in running)

    def _tell_of(self, recorder: Recorder) -> None:
        if not recorder.failure:  # or it has been told
            self._said(f"{recorder.target}: {recorder.seconds:.1f} s")
