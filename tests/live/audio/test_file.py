"""Sound files: they hold what was written, or do not exist."""

import numpy as np
import pytest
import soundfile
from sound_files import MATRIX, STEP, few_and_many, matrix, noise

from yehu_server.errors import OutputError
from yehu_server.util import wav_stream
from yehu_server.util.sound_file import check_format, is_rendered, sound_file


def write(target, samples, kind="wav", subtype="24", rate=44100):
    channels = 1 if samples.ndim == 1 else samples.shape[1]
    with sound_file(target, rate, kind, subtype, channels=channels) as file:
        for part in np.array_split(samples, 7):
            file.write(part)
    return file


@few_and_many
@matrix
def test_a_file_holds_what_was_written_and_tells_its_peak_and_rms(
    tmp_path, kind, subtype, channels
):
    target = tmp_path / "sound"
    loud_at_the_end = np.linspace(0.1, 0.5, channels, dtype=np.float32)
    samples = loud_at_the_end * noise(10_000, channels)
    file = write(target, samples, kind, subtype, rate=48000)
    info = soundfile.info(target)
    assert info.format == ("WAVEX" if (kind, channels) == ("wav", 6) else kind.upper())
    assert info.subtype == {"16": "PCM_16", "24": "PCM_24", "float": "FLOAT"}[subtype]
    assert (info.channels, info.samplerate, info.frames) == (channels, 48000, 10_000)
    read, _ = soundfile.read(target)
    np.testing.assert_allclose(read, samples, rtol=0, atol=STEP[subtype])
    assert file.peak == pytest.approx(np.abs(read).max(), abs=STEP[subtype])
    assert file.rms == pytest.approx(np.sqrt(np.mean(read**2)), abs=STEP[subtype])
    assert list(tmp_path.iterdir()) == [target]


def test_a_format_that_cannot_hold_a_subtype_says_so(tmp_path):
    with pytest.raises(OutputError, match=r"flac.*float.*16 or 24"):
        check_format("flac", "float")
    with (
        pytest.raises(OutputError, match="flac"),
        sound_file(tmp_path / "x", 44100, "flac", "float"),
    ):
        pass
    assert not list(tmp_path.iterdir())


def test_the_target_appears_only_when_it_is_whole_and_is_as_before_if_it_never_is(tmp_path):
    target = tmp_path / "sound.wav"
    target.write_bytes(b"older")

    def interrupted(error: type[BaseException]) -> None:
        with sound_file(target, 44100, "wav", "24") as file:
            file.write(noise(10_000))
            (partial,) = (path for path in tmp_path.iterdir() if path != target)
            assert partial.name.startswith(".")
            raise error

    for error in (KeyboardInterrupt, ValueError, OSError, SystemExit):
        with pytest.raises((error, OutputError)):
            interrupted(error)
        assert target.read_bytes() == b"older"
        assert list(tmp_path.iterdir()) == [target]


@few_and_many
@pytest.mark.parametrize(("subtype", "bytes_each"), [("16", 2), ("24", 3), ("float", 4)])
def test_a_wav_file_longer_than_its_sizes_can_say_is_refused(
    tmp_path, monkeypatch, subtype, bytes_each, channels
):
    assert wav_stream.WAV_LIMIT <= 2**32
    monkeypatch.setattr(wav_stream, "WAV_LIMIT", 1000 * channels * bytes_each)
    write(tmp_path / "just.wav", noise(1000, channels), subtype=subtype)
    with pytest.raises(OutputError, match=r"long\.wav.*FLAC"):
        write(tmp_path / "long.wav", noise(1001, channels), subtype=subtype)
    write(tmp_path / "long.flac", noise(1001, channels), "flac")
    assert {path.name for path in tmp_path.iterdir()} == {"just.wav", "long.flac"}
    with pytest.raises(OutputError, match=r"for a WAV file \(4 GiB\)$"):  # nor would FLAC hold it
        write(tmp_path / "long.wav", noise(1001 * channels, 9), subtype=subtype)


@pytest.mark.parametrize(("kind", "most"), [("wav", 64), ("flac", 8)])
def test_as_many_channels_as_a_format_holds_are_written_and_others_refused(tmp_path, kind, most):
    target = tmp_path / "sound"
    samples = noise(1000, most)
    write(target, samples, kind)
    read, _ = soundfile.read(target)
    np.testing.assert_allclose(read, samples, rtol=0, atol=STEP["24"])
    target.unlink()
    for channels in (0, most + 1):
        wrong = f"a {kind} file holds 1 to {most} channels, not {channels}"
        with pytest.raises(OutputError, match=wrong):
            check_format(kind, "24", channels)
        with (
            pytest.raises(OutputError, match=wrong),
            sound_file(target, 44100, kind, "24", channels=channels),
        ):
            pass
    assert list(tmp_path.iterdir()) == []


@few_and_many
@matrix
def test_a_disk_that_is_full_only_for_the_last_samples_is_reported(
    tmp_path, kind, subtype, channels, limited
):
    target = tmp_path / "sound"
    samples = noise(9999, channels)
    write(target, samples, kind, subtype)
    short = target.stat().st_size - 10
    target.write_bytes(b"older")
    limited(short)
    with pytest.raises(OutputError, match="cannot write: file too large"):
        write(target, samples, kind, subtype)
    assert target.read_bytes() == b"older"
    assert list(tmp_path.iterdir()) == [target]


def test_where_a_file_cannot_go_is_said(tmp_path):
    (tmp_path / "file").write_text("")
    link = tmp_path / "null.wav"
    link.symlink_to("/dev/null")
    for target, wrong in (
        (tmp_path / "none" / "x.wav", "does not exist"),
        (tmp_path / "file" / "x.wav", "not a folder"),
        (tmp_path, "is a folder"),
        (link, "regular"),
    ):
        with pytest.raises(OutputError, match=wrong), sound_file(target, 44100, "wav", "24"):
            pass
    assert link.is_symlink()


def test_only_what_was_rendered_is_known_to_be_a_rendering(tmp_path):
    for kind, subtype in MATRIX:
        for channels in (1, 2, 6):
            target = tmp_path / f"{subtype}.{channels}.{kind}"
            write(target, noise(1000, channels), kind, subtype)
            assert is_rendered(target)
    for kind in ("wav", "flac"):
        soundfile.write(tmp_path / f"other.{kind}", noise(1000), 44100)
        assert not is_rendered(tmp_path / f"other.{kind}")
    (tmp_path / "text").write_text("a score")
    assert not is_rendered(tmp_path / "text")
    (tmp_path / "empty").touch()  # as mktemp makes it
    assert is_rendered(tmp_path / "empty")
