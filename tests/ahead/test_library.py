"""The C library plays what the server plays, from a program without Python."""

import ctypes
import platform
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from ahead.phrases import BLOCK, FRAMES, PHRASES, RATE, STOPPED
from ahead.programs import compiled

from yehu_server.ahead.build_hash import build_hash
from yehu_server.core.midi.events import EVENTS
from yehu_server.core.player.commands import KINDS
from yehu_server.params.table import TABLE, find
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.tables import Controls

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")


@pytest.fixture(scope="module")
def program(library, tmp_path_factory) -> Path:
    """A C program that plays commands."""
    return compiled(library, tmp_path_factory.mktemp("program") / "play", "play.c")


@pytest.fixture
def by_c(program, tmp_path):
    def play(commands, frames=FRAMES, rate=RATE, block=BLOCK, channels=2):
        lines, samples = tmp_path / "commands", tmp_path / "samples"
        lines.write_text("".join(" ".join(map(repr, command)) + "\n" for command in commands))
        numbers = map(str, (channels, frames, block))
        command = [program, repr(rate), *numbers, lines, samples]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return np.fromfile(samples, np.float32).reshape(-1, channels), done

    return play


def test_it_plays_the_very_samples_of_numbas_code_for_its_level(by_c, here):
    for name, commands in PHRASES.items():
        sound, done = by_c(commands)
        assert done.returncode == 0
        assert np.array_equal(sound, here[name]), name


def test_one_channel_has_the_mean_of_left_and_right(by_c):
    both, one = (by_c(STOPPED, frames=4800, channels=channels)[0] for channels in (2, 1))
    assert np.abs(both[:, 0] - both[:, 1]).max() > 0.01 * np.abs(both).max()
    np.testing.assert_allclose(one[:, 0], both.mean(axis=1), atol=1e-7)


def test_it_tells_sources_frame_losses_rate_and_values(by_c):
    printed = by_c(STOPPED, frames=1000)[1].stdout.split()
    default = find("/playing/bow_position").default
    assert printed == [build_hash().lstrip("0"), "1000", "0", "48000", f"{default:.17g}"]


def test_a_rate_that_it_was_not_built_for_is_refused(by_c):
    done = by_c([], rate=32000.0)[1]
    assert (done.returncode, done.stderr) == (4, "no instrument at 32000 Hz\n")


def test_it_needs_the_c_library_alone(library):
    command = [shutil.which("objdump"), "-p", library / "libyehu.so"]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    needed = {line.split()[1] for line in listed.splitlines() if "NEEDED" in line}
    assert needed <= {"libm.so.6", "libc.so.6"}


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="the counter is for glibc")
def test_it_allocates_nothing_neither_as_it_is_prepared_nor_as_it_plays(library, tmp_path):
    program = compiled(library, tmp_path / "allocate", "allocate.c", "counted.c")
    (tmp_path / "tables").write_bytes(PlayingOptions().tables(Controls()).tobytes())
    kinds = len(KINDS) + len(EVENTS) - 1  # but for TABLES_TO, which `yehu_use_tables` posts
    command = [program, str(200_000), str(kinds), tmp_path / "tables"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    own, preparing, playing, frames, taken = map(int, printed)
    assert own == 1  # of the program: it counts
    assert (preparing, playing) == (0, 0)
    assert frames >= 200_000
    assert taken > 200


def test_after_a_reset_it_plays_as_at_first_and_keeps_what_was_set(library):
    yehu = ctypes.CDLL(str(library / "libyehu.so"))
    number, rig = ctypes.c_int64, ctypes.c_void_p
    yehu.yehu_size.restype = yehu.yehu_frame.restype = number
    yehu.yehu_value.restype = ctypes.c_double
    yehu.yehu_prepare.argtypes = [rig, ctypes.c_double, number]
    yehu.yehu_midi.argtypes = [rig, number, ctypes.c_char_p, number]
    yehu.yehu_process.argtypes = [rig, rig, number]
    memory = np.full(yehu.yehu_size() + 64, 255, np.uint8)  # preparing relies on nothing
    at = rig((memory.ctypes.data + 63) // 64 * 64)
    volume = TABLE.index(find("/playing/volume"))

    def sounds(*messages):
        for message in messages:
            yehu.yehu_midi(at, yehu.yehu_frame(at), bytes(message), 3)
        samples = np.zeros((FRAMES // 2, 2), np.float32)
        yehu.yehu_process(at, samples.ctypes.data, len(samples))
        return samples

    for channels in (0, -1, 3, 1 << 40):  # with which it would write elsewhere than into a block
        assert not yehu.yehu_prepare(at, RATE, channels)
    assert not yehu.yehu_prepare(at, RATE + 1.0, 2)
    assert (memory == 255).all()
    assert yehu.yehu_prepare(at, RATE, 2)
    first = sounds((0xB0, 7, 100), (0x90, 69, 100))
    held = sounds((0x90, 74, 30))  # held as it is reset, as is the one before
    yehu.yehu_reset(at)
    assert yehu.yehu_frame(at) == 0
    assert np.array_equal(sounds((0x90, 69, 100)), first)
    assert yehu.yehu_value(at, volume) < 0.8
    assert not np.array_equal(first, held)
    yehu.yehu_reset(at)
    assert not sounds().any()
