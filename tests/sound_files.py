"""Noise for tests of sound files and recordings, which need no instrument for it."""

import numpy as np
import pytest

STEP = {"16": 2.0**-15, "24": 2.0**-23, "float": 2.0**-23}  # of samples of a subtype
MATRIX = [("wav", "16"), ("wav", "24"), ("wav", "float"), ("flac", "16"), ("flac", "24")]
KEPT_FRAMES = 100_000

matrix = pytest.mark.parametrize(("kind", "subtype"), MATRIX)
few_and_many = pytest.mark.parametrize("channels", [1, 2, 6])


def noise(frames: int, channels: int = 1) -> np.ndarray:
    """Samples as libsndfile reads them: of one channel [shape=(frames,)], or (frames, channels)."""
    shape = frames if channels == 1 else (frames, channels)
    return np.random.default_rng(1).uniform(-1.0, 1.0, shape).astype(np.float32)


class NoiseTape:
    """A tape of two channels of noise, which differ; it keeps the last `KEPT_FRAMES`."""

    def __init__(self, rate: float) -> None:
        self.rate = rate
        self.frame = 0
        self._random = np.random.default_rng(1)
        self._played = np.zeros((0, 2), np.float32)

    def play(self, frames: int) -> np.ndarray:
        """The next frames [shape=(frames, 2)], which are on the tape from now on."""
        noise = self._random.uniform(-0.5, 0.5, (frames, 2)).astype(np.float32)
        self._played = np.concatenate([self._played, noise])  # at once: a recorder reads it
        self.frame += frames
        return noise

    def taped(self, start: int) -> tuple[int, np.ndarray]:
        """See `yehu_server.core.engine.ensemble.Ensemble`."""
        played = self._played
        begin = max(start, len(played) - KEPT_FRAMES)
        return begin, played[begin:]
