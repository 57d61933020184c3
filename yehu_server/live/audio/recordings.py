"""Recordings of live sound, in stereo: the one of the command, and those that clients request."""

import os
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.errors import OutputError
from yehu_server.live import traffic_limits as limits
from yehu_server.util.files import create, discard, error_reason, is_removed, path_inside
from yehu_server.util.sound_file import SoundWriter, format_of
from yehu_server.util.subtypes import DEFAULT_SUBTYPES, SUBTYPES
from yehu_server.util.token_bucket import TokenBucket

EVERY_S = 0.05
CHANNELS = 2  # left and right
HEARD = 1e-5  # -100 dB of full scale
BEFORE_S = 0.02  # of silence before the first sound
ROOM_S = 1.0  # a recording begins only if so much fits on the disk


class Recorder:
    """A recording in a thread of its own, to a file that is valid at every moment.

    Raises OutputError where the file cannot be written, or is there and not to `overwrite`. It
    begins with frame `start` or, if it `waits`, a moment before the first sound. `on_message`:
    called with a line when it ends by itself, as on a full disk, or when frames are missing.
    """

    def __init__(
        self,
        tape: Ensemble,
        target: Path,
        start: int,
        on_message: Callable[[str], None],
        *,
        overwrite: bool = False,
        waits: bool = False,
    ) -> None:
        format_name, rate = format_of(target), round(tape.rate)
        subtype = DEFAULT_SUBTYPES[format_name]
        room_bytes = round(ROOM_S * rate) * CHANNELS * SUBTYPES[subtype].size
        self.target = target
        self.missed_frames = 0
        self.failure = ""  # why it ended by itself
        self._tape = tape
        self._position = start
        self._waits = waits
        self._before = np.zeros((0, CHANNELS), np.float32)  # silence that may come before a sound
        self._on_message = on_message
        self._file = create(target, overwrite=overwrite, room_bytes=room_bytes)
        form = (rate, format_name, subtype)
        self._writer = SoundWriter(self._file, target, *form, channels=CHANNELS)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)
        self._thread.start()

    @property
    def is_running(self) -> bool:
        """Whether it still records."""
        return self._thread.is_alive()

    @property
    def is_whole(self) -> bool:
        """Whether no frame is missing so far."""
        return not self.failure and self.missed_frames == 0

    @property
    def seconds(self) -> float:
        """Length of the recording (s)."""
        return self._writer.written_frames / self._tape.rate

    def stop(self) -> None:
        """End the recording at the last frame played."""
        self._ending.set()
        self._thread.join()

    def _run(self) -> None:
        try:
            ending = False
            while not ending:
                ending = self._ending.wait(EVERY_S)
                self._check_kept()
                begin, samples = self._tape.taped(self._position)
                if self._waits:
                    self._position = begin + len(samples)
                    self._writer.write(self._from_first_sound(samples))
                    continue
                if begin > self._position:  # the thread was late by more than the tape
                    self._miss(begin)
                self._writer.write(samples)
                self._position = begin + len(samples)
        except OutputError as error:
            self.failure = str(error)
        self._close()
        if self.failure:
            is_kept = self.seconds and self.target.exists()
            kept = f"; {self.seconds:.1f} s are kept" if is_kept else ""
            self._on_message(f"recording ended: {self.failure}{kept}")

    def _check_kept(self) -> None:
        if is_removed(self._file, self.target):
            raise OutputError(f"{self.target}: was removed meanwhile")

    def _from_first_sound(self, samples: Any) -> Any:
        """The samples from a moment before the first sound on; none before."""
        samples = np.concatenate((self._before, samples))
        sounds = np.flatnonzero(np.abs(samples).max(axis=1, initial=0.0) > HEARD)
        moment = round(BEFORE_S * self._tape.rate)
        self._waits = len(sounds) == 0
        if self._waits:
            self._before = samples[-moment:]
            return samples[:0]
        return samples[max(sounds[0] - moment, 0) :]

    def _miss(self, begin: int) -> None:
        """Write silence for missing frames, so that later ones keep their time."""
        rate = self._tape.rate
        lost, at = begin - self._position, self._writer.frames
        self.missed_frames += lost
        self._on_message(
            f"{self.target}: {lost / rate:.1f} s are missing from {at / rate:.1f} s on, as "
            "silence: the disk was too slow"
        )
        while self._position < begin:
            frames = min(begin - self._position, round(rate))
            self._writer.write(np.zeros((frames, CHANNELS), np.float32))
            self._position += frames

    def _close(self) -> None:
        try:
            self._writer.close()
        except OutputError as error:
            self.failure = self.failure or str(error)
        if self._writer.written_frames == 0:
            if self._waits and not self.failure:
                self._on_message(f"{self.target}: nothing was played, so nothing is recorded")
            else:
                self.failure = self.failure or f"{self.target}: there is nothing to write"
            discard(self._file, self.target)
        self._file.close()


ENDINGS = (".wav", ".flac")
OTHER_FORMATS = (".mp3", ".ogg", ".opus", ".m4a", ".aac", ".aif", ".aiff", ".caf", ".w64")


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
        self._begins = TokenBucket(limits.RECORDINGS_A_SECOND, limits.RECORDINGS_AT_ONCE)

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
        """Record to a file of a plain name in the folder; return its path.

        Raises OutputError where a requested recording runs, the name is not plain, already taken or
        of another format, too many were begun of late or are there, or the file cannot be written.
        """
        ending = Path(name).suffix
        if ending.lower() in OTHER_FORMATS:
            raise OutputError(f"{name}: recordings are {' or '.join(ENDINGS)}")
        target = path_inside(self._folder, name, "" if ending in ENDINGS else ".wav")
        if self._requested is not None and self._requested.is_running:
            raise OutputError(f"already recording {self._requested.target.name}")
        if not self._begins.takes(time.monotonic()):
            raise OutputError("recordings are begun too often; try again in a second")
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            if target.exists():
                raise OutputError(f"{target.name} exists")
            if len(os.listdir(self._folder)) >= limits.RECORDINGS:  # noqa: PTH208
                raise OutputError(
                    f"{self._folder} has {limits.RECORDINGS} files; remove some first"
                )
        except OSError as error:
            raise OutputError(f"{self._folder}: {error_reason(error)}") from error
        self._requested = Recorder(self._tape, target, self._tape.frame, self._on_message)
        self._on_message(f"recording {target}")
        return str(target)

    def stop(self) -> str:
        """End what `start` began; return the file's path. OutputError: it runs no more."""
        recorder, self._requested = self._requested, None
        if recorder is None:
            more = "; --record ends with the server" if self._everything is not None else ""
            raise OutputError(f"nothing is being recorded{more}")
        recorder.stop()
        if recorder.failure:
            raise OutputError(f"the recording has ended: {recorder.failure}")
        self._report(recorder)
        return str(recorder.target)

    def close(self) -> None:
        """End all recordings at the last frame played."""
        for recorder in (self._everything, self._requested):
            if recorder is not None:
                recorder.stop()
                self._report(recorder)

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

    def _report(self, recorder: Recorder) -> None:
        if not recorder.failure and recorder.seconds:  # or that was reported
            self._on_message(f"{recorder.target}: {recorder.seconds:.1f} s")
