"""Records what is played, live, off the instrument's tape."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np

from yehu_server.audio.file import WAV_LIMIT, format_of, sound_file
from yehu_server.engine.instrument import Instrument
from yehu_server.errors import OutputError
from yehu_server.files import check_target

log = logging.getLogger(__name__)

EVERY_S = 0.05
SUBTYPES = {"wav": "float", "flac": "24"}
FRAMES_LIMIT = WAV_LIMIT // 4 - (1 << 20)


class Recorder:
    """One recording, in a thread of its own; the file appears when it is complete.

    Parameters
    ----------
    start : int
        The frame to begin at.
    failed : callable
        Told in a line when the recording ends by itself, such as on a full disk.

    Errors: OutputError where the file could not be written.
    """

    def __init__(
        self, instrument: Instrument, target: Path, start: int, failed: Callable[[str], None]
    ) -> None:
        self._format = format_of(target)
        check_target(target)
        self.target = target
        self.missed_frames = 0
        self._instrument = instrument
        self._position = start
        self._start = start
        self._failed = failed
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)
        self._thread.start()

    @property
    def is_running(self) -> bool:
        """Whether it still records."""
        return self._thread.is_alive()

    @property
    def seconds(self) -> float:
        """How long the recording is."""
        return (self._position - self._start) / self._instrument.rate

    def stop(self) -> None:
        """End the recording with what is played so far."""
        self._ending.set()
        self._thread.join()

    def _run(self) -> None:
        rate, subtype = round(self._instrument.rate), SUBTYPES[self._format]
        try:
            with sound_file(self.target, rate, self._format, subtype) as file:
                ending = False
                while not ending and file.frames < FRAMES_LIMIT:
                    ending = self._ending.wait(EVERY_S)
                    begin, samples = self._instrument.taped(self._position)
                    if begin > self._position:  # we were held up for longer than the tape
                        self.missed_frames += begin - self._position
                        file.write(np.zeros(begin - self._position, np.float32))
                    file.write(samples)
                    self._position = begin + len(samples)
        except OutputError as error:
            self._failed(f"recording ended: {error}")
            return
        if not ending:
            self._failed(f"recording ended: {self.target} is as long as a file can be")
        if self.missed_frames:
            log.warning("%s: %d frames are missing, as zeros", self.target, self.missed_frames)
