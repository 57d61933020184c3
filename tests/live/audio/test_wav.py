"""WAV files as we write them, against libsndfile and the format's specification."""

import io
import struct

import numpy as np
import pytest
import soundfile

from yehu_server.util.subtypes import SUBTYPES
from yehu_server.util.wav_stream import WavStream, encoded

EDGES = [1.0, -1.0, 0.0, -0.0, 1.5, -1.5, 2**-24, -(2**-24), 2**-31, -(2**-31), 3 * 2**-32]


def samples(channels: int = 1) -> np.ndarray:
    """Samples [shape=(frames,) of one channel, else (frames, channels)]."""
    random = np.random.default_rng(1)
    small = random.uniform(-1.0, 1.0, 5000) * 10.0 ** random.uniform(-12.0, 0.0, 5000)
    mono = np.concatenate([random.uniform(-1.2, 1.2, 5000), small, EDGES]).astype(np.float32)
    if channels == 1:
        return mono
    return np.stack([random.permutation(mono) for _ in range(channels)], axis=1)


def chunks(data: bytes) -> dict[bytes, bytes]:
    """The chunks of a RIFF file, in their order."""
    assert (data[:4], data[8:12]) == (b"RIFF", b"WAVE")
    assert struct.unpack("<I", data[4:8])[0] == len(data) - 8
    found, at = {}, 12
    while at < len(data):
        name, (size,) = data[at : at + 4], struct.unpack("<I", data[at + 4 : at + 8])
        found[name] = data[at + 8 : at + 8 + size]
        at += 8 + size + size % 2
    assert at == len(data)
    return found


def written(path, subtype: str, software: str = "", channels: int = 1) -> bytes:
    with io.FileIO(path, "w") as file:
        stream = WavStream(file, 48000, subtype, software, channels=channels)
        for part in np.array_split(samples(channels), 3):
            stream.write(part)
        stream.close()
    return path.read_bytes()


@pytest.mark.parametrize("channels", [1, 2, 6])
@pytest.mark.parametrize("subtype", ["16", "24", "float"])
def test_samples_are_the_bytes_that_libsndfile_makes_of_them(tmp_path, subtype, channels):
    reference = tmp_path / "reference.wav"
    form = "WAV" if channels <= 2 else "WAVEX"
    sound = samples(channels)
    soundfile.write(reference, sound, 48000, subtype=SUBTYPES[subtype].name, format=form)
    theirs = chunks(reference.read_bytes())
    assert encoded(sound, subtype) == theirs[b"data"]
    ours = chunks(written(tmp_path / "ours.wav", subtype, channels=channels))
    assert ours[b"data"] == theirs[b"data"]
    fmt, speakers = ours[b"fmt "], slice(20, 24)
    assert not any(fmt[speakers])  # theirs are those of a cinema
    expected = theirs[b"fmt "]
    assert fmt[: speakers.start][: len(expected)] == expected[: speakers.start]
    assert fmt[speakers.stop :] == expected[speakers.stop :]


@pytest.mark.parametrize("channels", [1, 2])
def test_floats_have_the_header_that_the_format_asks_for(tmp_path, channels):
    ours = chunks(written(tmp_path / "ours.wav", "float", channels=channels))
    assert list(ours) == [b"fmt ", b"fact", b"data"]
    sizes = (192000 * channels, 4 * channels)
    assert ours[b"fmt "] == struct.pack("<HHIIHHH", 3, channels, 48000, *sizes, 32, 0)
    assert ours[b"fact"] == struct.pack("<I", len(samples()))  # frames
