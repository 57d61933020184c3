"""Any file that is given for one of ours gets one line of error, soon."""

import contextlib
import os
import struct

import pytest

from yehu_lab.body import read as measure
from yehu_lab.body.tap import Channel, read_recording
from yehu_lab.sweeps.result import Result
from yehu_server.cli import _parser
from yehu_server.cli.config import read_config
from yehu_server.core.physics.default_quantities import read_body, read_quantities
from yehu_server.errors import YehuError
from yehu_server.following.recording import downmix_of, recording_of_file
from yehu_server.playing.mapping import load
from yehu_server.playing.preset_folders import read_preset
from yehu_server.playing.tuning import read_tuning
from yehu_server.scores.capture import read_capture
from yehu_server.scores.gesture import read_gesture
from yehu_server.scores.musicxml.reader import read_musicxml
from yehu_server.scores.smf.reader import read_score
from yehu_server.simulation.run import Simulation
from yehu_server.util.parsing import MAX_DEPTH, parse_json, parse_toml
from yehu_server.util.sound_file import is_rendered

SERVE = _parser().parse_args(["serve"]).command
READERS = {
    "c.toml": lambda path: read_config(path, SERVE, None),
    "i.toml": read_quantities,
    "i.json": read_quantities,
    "b.json": read_body,
    "g.json": read_gesture,
    "m.toml": lambda path: load(str(path)),
    "p.toml": read_preset,
    "s.scl": lambda path: read_tuning(path, None),
    "c.jsonl": read_capture,
    "s.mid": read_score,
    "s.musicxml": read_musicxml,
    "v.wav": recording_of_file,
    "t.wav": lambda path: measure([path]),
    "t.flac": lambda path: measure([path]),
    "t.csv": lambda path: measure([path]),
    "t.uff": lambda path: measure([path]),
    "r.npz": Result.load,
    "n.npz": Simulation.load,
}
CONTENTS = {
    "nothing": b"\0",
    "no text": b"\xff\xfe\x00",
    "many digits": b"a = " + b"9" * 5000,
    "many digits of JSON": b'{"duration": ' + b"9" * 5000 + b"}",
    "many hexadecimal digits": b"about = 0x" + b"f" * 5000 + b"\nprogram = 0x" + b"f" * 5000,
    "many hexadecimal digits in a list": b"about = [0x" + b"f" * 5000 + b"]",
    "a huge fraction": b"a = 1e999",
    "deep lists": b"a = " + b"[" * 20_000,
    "deep lists of JSON": b"[" * 900 + b"]" * 900,
    "deep names": b"about." + b"a." * 5000 + b"a = 1",
    "deep tables": b"[about." + b"a." * 5000 + b"a]",
    "deep names of JSON": b'{"controls": ' + b'{"a":' * 900 + b"1" + b"}" * 901,
    "a long line": b"about = [" + b'"' + b"a" * 10**6 + b'"]',
    "a long name": b"a" * 10**6 + b" = 1",
}


@pytest.mark.parametrize("name", READERS)
def test_a_hostile_text_is_refused(tmp_path, name):
    path = tmp_path / name
    wrong = {}
    for content, text in CONTENTS.items():
        path.write_bytes(text)
        try:
            wrong[content] = READERS[name](path)
        except YehuError as error:
            if not str(error).startswith(str(path)):
                wrong[content] = error
    assert not wrong


@pytest.mark.parametrize("name", READERS)
def test_what_never_ends_or_never_begins_is_refused_at_once(tmp_path, name):
    os.mkfifo(tmp_path / f"fifo-{name}")
    (tmp_path / f"folder-{name}").mkdir()
    (tmp_path / f"zero-{name}").symlink_to("/dev/zero")
    with (tmp_path / f"large-{name}").open("wb") as large:
        large.truncate(2**40)
    for path in tmp_path.iterdir():
        with pytest.raises(YehuError) as error:
            READERS[name](path)
        assert str(path) in str(error.value)
        assert len(str(error.value)) < 200 + len(str(path))


def sound(of: str) -> bytes:
    """A RIFF or RF64 file with sizes of up to 2^63 and a little sound."""
    form = struct.pack("<IHHIIHH", 16, 1, 1, 44100, 88200, 2, 16)
    if of == "RIFF":
        sizes = b"RIFF" + struct.pack("<I", 2**32 - 1) + b"WAVE"
    else:
        large = struct.pack("<IQQQI", 28, 2**63 - 1, 2**63 - 1, 2**62, 0)
        sizes = b"RF64" + struct.pack("<I", 2**32 - 1) + b"WAVEds64" + large
    return sizes + b"fmt " + form + b"data" + struct.pack("<I", 2**32 - 1) + bytes(1000)


@pytest.mark.parametrize("of", ["RIFF", "RF64"])
def test_sizes_that_no_file_has_print_no_traceback(tmp_path, capfd, of):
    path = tmp_path / "v.wav"
    path.write_bytes(sound(of))
    readers = (
        recording_of_file,
        lambda path: downmix_of(recording_of_file(path)),
        lambda path: read_recording(path, [Channel("force")]),
        is_rendered,
    )
    for read in readers:
        with contextlib.suppress(YehuError):
            read(path)
    assert capfd.readouterr().err == ""


def test_samples_without_a_header_are_no_sound(tmp_path):
    path = tmp_path / "v.raw"  # of which soundfile would ask what it holds
    path.write_bytes(bytes(1000))
    for read in (recording_of_file, lambda path: read_recording(path, [])):
        with pytest.raises(YehuError):
            read(path)
    assert not is_rendered(path)


def nested(depth: int) -> str:
    return "[" * depth + "]" * depth


def test_as_deep_as_anybody_nests_is_read():
    assert parse_json(nested(MAX_DEPTH - 1))[0]
    assert parse_toml(f"a = {nested(MAX_DEPTH - 2)}")["a"]
    for deep in (nested(MAX_DEPTH + 1), nested(100_000)):
        with pytest.raises(ValueError, match="nested too deeply"):
            parse_json(deep)
        with pytest.raises(ValueError, match="nested too deeply"):
            parse_toml(f"a = {deep}")


def test_a_mapping_of_far_too_many_binds_is_refused_before_it_is_parsed(tmp_path, monkeypatch):
    bind = '{source = "cc 20", target = "/playing/vibrato"}, '
    path = tmp_path / "m.toml"
    path.write_text(f"bind = [{bind * 257}]")
    with pytest.raises(YehuError, match=r"expected 0 to 256 of .* got 257"):
        load(str(path))
    path.write_text(f"bind = [{bind * 14_000}]")
    monkeypatch.setattr("tomllib.loads", None)
    with pytest.raises(YehuError, match="larger than 128 KiB"):
        load(str(path))
