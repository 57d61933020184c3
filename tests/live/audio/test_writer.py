"""Sound files while they are written: valid and whole in their frames at every moment."""

import io
import math

import numpy as np
import pytest
import soundfile
from sound_files import STEP, few_and_many, matrix, noise

from yehu_server.errors import OutputError
from yehu_server.util.sound_file import SoundWriter
from yehu_server.util.subtypes import SUBTYPES


@matrix
def test_samples_of_another_number_of_channels_are_never_mistaken(tmp_path, kind, subtype):
    for channels, wrong in ((1, (1000, 2)), (2, (1000,)), (2, (1000, 1)), (2, (1000, 2, 1))):
        target = tmp_path / f"{channels}{len(wrong)}{wrong[-1]}"
        with io.FileIO(target, "w") as file:
            writer = SoundWriter(file, target, 44100, kind, subtype, channels=channels)
            writer.write(noise(5000, channels))
            with pytest.raises(ValueError, match="of shape"):
                writer.write(np.zeros(wrong, np.float32))
            writer.close()
        read, _ = soundfile.read(target)
        np.testing.assert_allclose(read, noise(5000, channels), rtol=0, atol=STEP[subtype])


@few_and_many
@matrix
def test_a_file_can_be_opened_after_each_write_and_holds_all_but_a_block_or_two(
    tmp_path, kind, subtype, channels
):
    target = tmp_path / "sound"
    samples = noise(40_000, channels)
    held_back = {"wav": 0, "flac": 2 * 4096}[kind]
    with io.FileIO(target, "w") as file:
        writer = SoundWriter(file, target, 44100, kind, subtype, channels=channels)
        for end in range(5000, 40_001, 5000):
            writer.write(samples[end - 5000 : end])
            if end > held_back:
                read, _ = soundfile.read(target)
                assert len(read) == writer.written_frames
                assert end - held_back <= len(read) <= end
                np.testing.assert_allclose(read, samples[: len(read)], rtol=0, atol=STEP[subtype])
        writer.close()
    assert soundfile.info(target).frames == writer.written_frames == 40_000


@few_and_many
@pytest.mark.parametrize("subtype", ["16", "24", "float"])
def test_a_wav_file_cut_anywhere_keeps_its_channels_apart(tmp_path, subtype, channels):
    target, cut = tmp_path / "sound.wav", tmp_path / "cut.wav"
    samples = noise(1000, channels)
    with io.FileIO(target, "w") as file:
        writer = SoundWriter(file, target, 44100, "wav", subtype, channels=channels)
        header = target.stat().st_size
        writer.write(samples[:500])
        older = target.read_bytes()[:header]
        writer.write(samples[500:])
        data = target.read_bytes()
    each = channels * SUBTYPES[subtype].size
    for missing in range(2 * each):
        cut.write_bytes(data[: len(data) - missing])
        read, _ = soundfile.read(cut)
        assert len(read) == 1000 - math.ceil(missing / each)
        np.testing.assert_allclose(read, samples[: len(read)], rtol=0, atol=STEP[subtype])
    cut.write_bytes(older + data[header:-1])  # ended before the header had the last samples
    read, _ = soundfile.read(cut)
    np.testing.assert_allclose(read, samples[:500], rtol=0, atol=STEP[subtype])


@few_and_many
@matrix
def test_a_disk_that_fills_amid_a_frame_leaves_whole_frames(
    tmp_path, kind, subtype, channels, limited
):
    target = tmp_path / "sound"
    samples = noise(20_000, channels)
    each = channels * SUBTYPES[subtype].size
    with io.FileIO(target, "w") as file:
        writer = SoundWriter(file, target, 44100, kind, subtype, channels=channels)
        header = target.stat().st_size
        most_bytes = header + 12_000 * each + each - 1
        limited(most_bytes)
        with pytest.raises(OutputError, match="cannot write: file too large"):  # noqa: PT012
            for part in np.array_split(samples, 7):
                writer.write(part)
            writer.close()
    read, _ = soundfile.read(target)
    assert len(read) == writer.written_frames == (12_000 if kind == "wav" else 2 * 4096)
    np.testing.assert_allclose(read, samples[: len(read)], rtol=0, atol=STEP[subtype])
    size = target.stat().st_size
    assert size == header + 12_000 * each if kind == "wav" else size < most_bytes
