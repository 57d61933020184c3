"""``yehu-server render`` in a shell pipeline: a score comes in, its sound goes out."""

import io
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
import soundfile
from commands import COMMAND, is_one_line
from forks import run, start
from midi_files import midi_file, notes

from yehu_server.cli.render_pipe import BROKEN_PIPE

DRY = ("--dry", "--tail", "0")  # in little time


@pytest.fixture
def tune(tmp_path) -> Path:
    return midi_file(tmp_path / "tune.mid", notes((0.0, 0.2, 67, 90), (0.2, 0.1, 69, 90)))


def piped(*words: object, given: bytes = b"", **options) -> subprocess.CompletedProcess:
    """Run a command in a process of its own; what it writes, as bytes."""
    return run(*words, given=given, text=False, **options)


@pytest.fixture
def alone(tune, command, tmp_path) -> np.ndarray:
    """The same, rendered to a file."""
    assert command("render", tune, "-o", tmp_path / "x.wav", *DRY, "--subtype", "float")[0] == 0
    return soundfile.read(tmp_path / "x.wav", dtype="float32")[0]


def test_raw_samples_are_those_of_the_file_and_nothing_else(tune, alone):
    done = piped("render", tune, "-o", "-", "--format", "raw", *DRY)
    assert done.returncode == 0
    assert np.array_equal(np.frombuffer(done.stdout, "<f4").reshape(-1, 2), alone)
    assert b"standard output: 0.3 s" in done.stderr


def test_a_wav_stream_has_a_length_that_is_not_known_and_can_be_read(tune, alone):
    for subtype in ("16", "24", "float"):
        done = piped("render", "-", "-o", "-", "--subtype", subtype, *DRY, given=tune.read_bytes())
        assert done.returncode == 0, done.stderr
        assert done.stdout[:8] == b"RIFF" + b"\xff" * 4
        assert done.stdout[done.stdout.index(b"data") + 4 :][:4] == b"\xff" * 4
        sound, rate = soundfile.read(io.BytesIO(done.stdout), dtype="float32")
        assert rate == 44100
        assert sound.shape == alone.shape
        assert np.abs(sound - alone).max() < 2.0 ** (-14 if subtype == "16" else -22)


def test_a_reader_that_has_had_enough_ends_it_quietly(tmp_path):
    tune = midi_file(tmp_path / "long.mid", notes((0.0, 600.0, 67, 90)))
    with start("render", tune, "-o", "-", "--format", "raw", text=False) as process:
        assert len(process.stdout.read(1000)) == 1000
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait(timeout=60) == BROKEN_PIPE


def test_a_full_disk_behind_the_output_is_reported(tune, tmp_path):
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096));"
    with (tmp_path / "sound").open("wb") as full:
        done = run("render", tune, "-o", "-", *DRY, code=limit + COMMAND, stdout=full)
    assert done.returncode == 2
    assert is_one_line(done.stderr)
    assert "standard output: cannot write: file too large" in done.stderr


def test_a_wrong_pipe_gets_one_line(tmp_path):
    for words, given, wrong in (
        ("- -o x.wav", b"", "standard input: is empty"),
        ("- -o x.wav", b"hello\n" * 999, "standard input: is not a MIDI file"),
        ("- - -o x.wav", b"", "standard input can be read once only"),
        ("- -o - --format flac", b"", "a flac file cannot be piped"),
        ("- -o x.wav --format raw", b"", "--format raw is for -o -"),
    ):
        done = piped("render", *words.split(), given=given, cwd=tmp_path)
        assert (done.returncode, done.stdout) == (2, b"")
        assert wrong in done.stderr.decode()
        assert is_one_line(done.stderr.decode())
        assert not list(tmp_path.iterdir())


def test_an_input_without_end_is_refused(tmp_path):
    limit = "import yehu_server.scores.smf.reader as smf; smf.MAX_BYTES = 2**20;"
    with Path("/dev/zero").open("rb") as endless:
        words = ("render", "-", "-o", tmp_path / "x.wav")
        done = run(*words, code=limit + COMMAND, stdin=endless)
    assert done.returncode == 2
    assert "standard input: larger than 1 MiB" in done.stderr


def test_sound_does_not_go_to_a_terminal(tune):
    ours, theirs = os.openpty()
    done = run("render", tune, "-o", "-", stdout=theirs)
    os.close(theirs)
    os.close(ours)
    assert done.returncode == 2
    assert "standard output is a terminal" in done.stderr
