"""The recordings of a server: the one of the command, and those that clients request."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.errors import OutputError
from yehu_server.live.audio.recorder import Recorder
from yehu_server.util.files import inside, why
from yehu_server.util.token_bucket import TokenBucket

ENDINGS = (".wav", ".flac")
# What clients may begin together, and what the folder may have in it.
BEGINS_A_SECOND, BEGINS_AT_ONCE, MOST_TAKES = 1.0, 10.0, 1000


class Recordings:
    """A recording of everything, and beside it one at a time that clients request.

    `folder`: where requested recordings are written; it is made when needed.
    `on_message`: called with a line when a recording begins or ends.
    """

    def __init__(self, tape: Ensemble, folder: Path, on_message: Callable[[str], None]) -> None:
        self._tape = tape
        self._folder = folder
        self._on_message = on_message
        self._everything: Recorder | None = None
        self._requested: Recorder | None = None
        self._begins = TokenBucket(BEGINS_A_SECOND, BEGINS_AT_ONCE)

    def record_everything(
        self, target: Path, *, overwrite: bool = False, waits: bool = False
    ) -> None:
        """Record from the first frame until `close`, or where it `waits` from the first sound.

        Raises OutputError where the file cannot be written.
        """
        self._everything = Recorder(
            self._tape, target, 0, self._on_message, overwrite=overwrite, waits=waits
        )

    def start(self, name: str) -> str:
        """Record to a file of a plain name in the folder; return its name.

        Raises OutputError where a requested recording runs, the name is not plain or already taken,
        too many were begun of late or are there, or the file cannot be written.
        """
        target = inside(self._folder, name, "" if Path(name).suffix in ENDINGS else ".wav")
        if self._requested is not None and self._requested.is_running:
            raise OutputError(f"already recording {self._requested.target.name}")
        if not self._begins.takes(time.monotonic()):
            raise OutputError("recordings are begun too often; try again in a second")
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            if target.exists():
                raise OutputError(f"{target.name} exists")
            if len(os.listdir(self._folder)) >= MOST_TAKES:  # noqa: PTH208 - names are enough
                raise OutputError(f"{self._folder} has {MOST_TAKES} files; remove some first")
        except OSError as error:
            raise OutputError(f"{self._folder}: {why(error)}") from error
        self._requested = Recorder(self._tape, target, self._tape.frame, self._on_message)
        self._on_message(f"recording {target}")
        return target.name

    def stop(self) -> str:
        """End what `start` began; return the file's name.

        Raises OutputError where there is none, or it has ended by itself.
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
        """End all recordings at the last frame played."""
        for recorder in (self._everything, self._requested):
            if recorder is not None:
                recorder.stop()
                self._tell_of(recorder)

    @property
    def is_whole(self) -> bool:
        """Whether no frame is missing in the recording of everything, if there is one."""
        return self._everything is None or self._everything.is_whole

    @property
    def names(self) -> str:
        """Names of the files being recorded, separated by semicolons."""
        recorders = (self._everything, self._requested)
        running = [each for each in recorders if each is not None and each.is_running]
        return "; ".join(each.target.name for each in running)

    def _tell_of(self, recorder: Recorder) -> None:
        if not recorder.failure and recorder.seconds:  # or that was reported
            self._on_message(f"{recorder.target}: {recorder.seconds:.1f} s")
