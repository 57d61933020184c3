"""Recordings to follow."""

import numpy as np
from fuzz.target import target, written

from yehu_server.errors import ScoreError
from yehu_server.following.recording import recording_of_file

MAX_BLOCKS = 50


@target(
    "followed-sound",
    ScoreError,
    words=(b"RIFF", b"WAVE", b"fmt ", b"data", b"fLaC", b"OggS", b"FORM", b"AIFF", b"\x44\xac\0\0"),
)
def followed_sound(data: bytes) -> None:
    """A sound file is blocks of samples of bounded size, or a ScoreError."""
    recording = recording_of_file(written(data, "sound.wav"))
    for number, block in enumerate(recording.blocks()):
        assert block.ndim == 2
        assert block.dtype == np.float32
        if number == MAX_BLOCKS:
            break
