"""A first start makes machine code of what is shipped; without it, numba compiles as ever."""

from __future__ import annotations

import argparse
import logging
import os
import stat
import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from powers import cube

from yehu_server.cli.terminal import warn_of_compiling
from yehu_server.compile import cache, jit
from yehu_server.compile.bitcode import shipped, start
from yehu_server.compile.bitcode.capture import CaptureError, capturing
from yehu_server.compile.bitcode.shipped import Shipped, read_shipped, write_shipped
from yehu_server.compile.jit import Native, source_hash
from yehu_server.util.sealed import read_sealed, write_sealed

TESTS = Path(__file__).parents[1]
CAPTURE = """
import sys
from pathlib import Path
from powers import cube
from yehu_server.compile.bitcode.capture import capturing
from yehu_server.compile.bitcode.shipped import write_shipped
from yehu_server.compile.jit import source_hash
with capturing() as capture:
    cube().capture(capture)
write_shipped(Path(sys.argv[1]), capture.shipped(), source_hash())
"""


@pytest.fixture(scope="module")
def captured(tmp_path_factory) -> Shipped:
    """What a process of its own captured, with an empty cache."""
    folder = tmp_path_factory.mktemp("captured")
    file = folder / "machine.bitcode"
    environment = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(folder),
        "PYTHONPATH": os.pathsep.join((str(TESTS), os.environ.get("PYTHONPATH", ""))),
    }
    subprocess.run([sys.executable, "-c", CAPTURE, str(file)], env=environment, check=True)
    return read_shipped(file, source_hash())


class Release:
    """A copy with bitcode, and a cache that is empty."""

    def __init__(self, captured, folder, monkeypatch) -> None:
        self.file = folder / "machine.bitcode"
        self.cache = folder / "cache"
        self.cache.mkdir()
        self._patch = monkeypatch
        monkeypatch.setattr(shipped, "shipped_file", lambda: self.file)
        monkeypatch.setattr(jit, "cache_folder", lambda: self.cache)
        monkeypatch.setattr(jit, "IS_CACHED", True)
        monkeypatch.setattr(cache, "_reported", set())
        self.content = captured
        self.write()

    def write(self, **changes) -> None:
        write_shipped(self.file, replace(self.content, **changes), source_hash())

    def forget(self) -> None:
        for file in self.cache.iterdir():
            file.unlink()

    def start(self) -> bool:
        """Call the function, as after a start; whether its code was in the cache by then."""
        self._patch.setattr(jit, "_asked_for", set())
        function = cube()
        assert function.call(3.0) == 27.0
        return function.compiled.cache_hits == 1


@pytest.fixture
def release(captured, tmp_path, monkeypatch) -> Release:
    return Release(captured, tmp_path, monkeypatch)


def compiled_anew(release: Release, caplog) -> str:
    """The one line that tells why what is shipped was of no use."""
    assert not release.start()
    (line,) = caplog.messages
    assert line.endswith("; compiling instead, which takes half a minute")
    assert line.isprintable()
    return line


def test_what_is_shipped_is_not_compiled(release, caplog):
    assert release.start()
    (file,) = release.cache.iterdir()  # and so was nothing that it calls
    assert file.name.startswith("powers.cubed")
    assert caplog.messages == []


def test_what_it_became_is_kept_for_later_starts(release, monkeypatch):
    assert release.start()
    release.file.unlink()
    monkeypatch.setattr(start, "make", None)
    assert release.start()


def test_it_becomes_the_code_that_numba_makes(release):
    assert release.start()
    (file,) = release.cache.iterdir()
    replayed = instructions(file)
    release.forget()
    release.file.unlink()
    assert not release.start()
    (file,) = release.cache.glob("*cubed*")
    assert instructions(file) == replayed


def instructions(file) -> bytes:
    """The section of a cached object file that holds the instructions."""
    from llvmlite.binding import ObjectFileRef

    _, _, (code, _) = cache.pickle.loads(read_sealed(file))
    sections = ObjectFileRef.from_data(code).sections()
    return b"".join(section.data() for section in sections if section.is_text())


def test_without_a_file_it_is_compiled_and_nobody_is_warned(release, caplog):
    release.file.unlink()
    caplog.set_level(logging.DEBUG, "yehu_server")
    assert "without code made in advance" in compiled_anew(release, caplog)
    assert caplog.records[0].levelno == logging.DEBUG


def test_of_other_sources_it_is_compiled_and_nobody_is_warned(release, caplog):
    write_shipped(release.file, release.content, "0123456789abcdef")
    caplog.set_level(logging.DEBUG, "yehu_server")
    assert "of other sources" in compiled_anew(release, caplog)
    assert caplog.records[0].levelno == logging.DEBUG


@pytest.mark.parametrize(
    ("what", "name"),
    [
        ("numba", "numba.__version__"),
        ("llvmlite", "llvmlite.__version__"),
        ("machine", "binding.get_process_triple"),
    ],
)
def test_for_another_version_or_machine_it_is_compiled(release, caplog, monkeypatch, what, name):
    other = "another" if what != "machine" else lambda: "another"
    with monkeypatch.context() as patch:
        patch.setattr(f"yehu_server.compile.bitcode.shipped.{name}", other)
        release.write()
    caplog.set_level(logging.DEBUG, "yehu_server")
    assert f"for {what} another" in compiled_anew(release, caplog)


def test_a_damaged_file_is_compiled_and_told(release, caplog):
    whole = bytearray(release.file.read_bytes())
    whole[-20] ^= 1
    release.file.write_bytes(whole)
    assert "machine.bitcode: it is damaged" in compiled_anew(release, caplog)


def test_a_sound_file_of_something_else_is_compiled_and_told(release, caplog):
    write_sealed(release.file, b'{"made for": 3}\n')
    assert "none of ours" in compiled_anew(release, caplog)


def test_bitcode_that_llvm_refuses_is_compiled_and_told(release, caplog):
    release.write(
        libraries=tuple(replace(one, bitcode=b"BC\xc0\xde") for one in release.content.libraries)
    )
    assert "bitcode" in compiled_anew(release, caplog)


def test_where_llvm_ends_its_process_it_is_compiled_and_told(release, caplog, monkeypatch):
    ended = release.file.with_name("python")
    ended.write_text("#!/bin/sh\nkill -ABRT $$\n")
    ended.chmod(ended.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setattr(start, "sys", SimpleNamespace(executable=str(ended)))
    assert "LLVM ended with -6" in compiled_anew(release, caplog)


def test_where_no_process_can_be_started_it_is_compiled_and_told(release, caplog, monkeypatch):
    monkeypatch.setattr(start, "sys", SimpleNamespace(executable="/nowhere/python"))
    assert "No such file" in compiled_anew(release, caplog)


def test_what_was_of_no_use_is_not_tried_again(release, caplog):
    release.file.write_bytes(b"")
    function = cube()
    jit.make_of_shipped([function])
    jit.make_of_shipped([function])
    assert len(caplog.messages) == 1


def told(capsys, **options) -> str:
    warn_of_compiling(argparse.Namespace(quiet=False), **options)
    return capsys.readouterr().err


def test_commands_tell_how_long_a_first_start_takes(release, capsys):
    assert "preparing for this processor, once" in told(capsys)
    assert "compiling for this machine, once ..." in told(capsys, plays=False)
    release.file.unlink()
    assert "for half a minute: this copy came without" in told(capsys)
    (release.cache / "of_before.code").touch()
    assert told(capsys) == ""


@pytest.mark.usefixtures("release")
def test_what_is_not_shipped_starts_no_process(monkeypatch):
    monkeypatch.setattr(start, "sys", None)

    def halved(number: float) -> float:
        return number / 2.0

    assert Native("float64(float64)", halved).call(3.0) == 1.5


def test_processes_share_the_work(captured):
    (export,) = captured.exports.values()
    small = replace(export, library=0)
    content = replace(captured, exports={"a": small, "b": export, "c": small})
    assert start._shares(content, ["a", "b", "c"], 2) == [["b"], ["a", "c"]]
    assert start._shares(content, ["a", "b"], 1) == [["b", "a"]]
    assert start._shares(content, ["b"], 2) == [["b"]]


def test_what_was_compiled_before_cannot_be_captured():
    function = cube()
    function.keep()  # and so is what it calls
    with capturing() as capture:
        cube().capture(capture)
        with pytest.raises(CaptureError, match="raised"):
            capture.shipped()


def test_a_release_takes_the_file_along():
    project = tomllib.loads((TESTS.parent / "pyproject.toml").read_text(encoding="utf-8"))
    (pattern,) = project["tool"]["hatch"]["build"]["artifacts"]
    assert shipped.shipped_file().relative_to(TESTS.parent).match(pattern)
