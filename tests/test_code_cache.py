"""Compiled code is cached on disk; a damaged or unusable cache never prevents playing."""

import errno
import io
import os
import pickle
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from types import SimpleNamespace

import numba
import pytest

from yehu_server.compile import cache_folder, jit, levels, machine_code, numba_compiler
from yehu_server.compile import function_cache as cache
from yehu_server.system import files
from yehu_server.util import checksummed
from yehu_server.util.checksummed import ChecksumError, read_checksummed, write_checksummed


def third_of(number: int) -> int:
    return number // 3


third = third_of  # as compiled after one start


def twice(number: int) -> int:
    return third(number) * 2


def thrice(number: int) -> int:
    return third(number) * 3


def made_by(factor):
    def scaled(number: int) -> int:
        return number * factor

    return scaled


class Kept:
    """A small function that is compiled, cached in a folder, and loaded again."""

    def __init__(self, folder, monkeypatch) -> None:
        self.folder = folder
        monkeypatch.setattr(numba_compiler, "cache_folder", lambda: folder)
        monkeypatch.setattr(numba_compiler, "IS_CACHED", True)
        monkeypatch.setattr(cache, "_reported", set())
        monkeypatch.setattr(cache, "_parts", {})

    def start(self, function=third_of) -> tuple[int, bool]:
        """Call the function with 12, as after a start; the result, and whether it was cached."""
        native = jit.Native(function)
        return native.call(12), native.compiled.cache_hits == 1

    @property
    def file(self):
        """The one with the machine code."""
        (file,) = self.folder.glob("*.code")
        return file

    @property
    def source(self):
        """The one with what it was made of."""
        (file,) = self.folder.glob("*.ir")
        return file


@pytest.fixture
def kept(tmp_path, monkeypatch) -> Kept:
    return Kept(tmp_path, monkeypatch)


def test_what_was_compiled_once_is_there_at_the_next_start(kept):
    assert kept.start() == (4, False)
    assert kept.start() == (4, True)


DAMAGE = {
    "cut short": lambda data: data[: len(data) // 2],
    "emptied": lambda _data: b"",
    "zeros": lambda data: bytes(len(data)),
    "more": lambda data: data + b"\0",
    "one bit": lambda data: data[:-9] + bytes([data[-9] ^ 4]) + data[-8:],
}


@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_damaged_code_is_compiled_anew_and_reported_in_one_line(kept, caplog, damage):
    kept.start()
    for file in (kept.source, kept.file):
        file.write_bytes(damage(file.read_bytes()))
    assert kept.start() == (4, False)
    (line,) = caplog.messages
    assert "damaged; compiling anew" in line
    assert "\n" not in line
    assert kept.start() == (4, True)  # healed
    assert len(caplog.messages) == 1


def test_one_functions_code_does_not_pass_for_anothers(kept):
    kept.start()
    file = kept.file
    other = file.with_name("native.other-cpython-311-0123456789abcdef.code")
    other.write_bytes(file.read_bytes())
    with pytest.raises(ChecksumError):
        read_checksummed(other)


@contextmanager
def another_level(name="another"):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(levels, "level", lambda: name)
        patch.setattr(cache, "_parts", {})
        yield


def compiled_functions(monkeypatch) -> list[str]:
    """The names of the functions that are compiled from now on, not just loaded or optimised."""
    names = []
    compiler = numba.core.compiler.CompilerBase
    extract = compiler._compile_bytecode

    def compile_bytecode(self):
        names.append(self.state.func_id.func_name)
        return extract(self)

    monkeypatch.setattr(compiler, "_compile_bytecode", compile_bytecode)
    return names


def test_what_was_compiled_on_one_processor_is_only_optimised_on_another(kept, monkeypatch):
    monkeypatch.setitem(globals(), "third", jit.compiled(third_of))
    names = compiled_functions(monkeypatch)
    assert kept.start(twice) == (8, False)
    assert names == ["twice", "third_of"]
    with another_level():
        assert kept.start(twice) == (8, True)
        assert len(list(kept.folder.glob("*.code"))) == 2
        assert kept.start(twice) == (8, True)
        assert kept.start(thrice) == (12, False)
    with another_level("a third"):
        assert kept.start(twice) == (8, True)
    assert names == ["twice", "third_of", "thrice"]


@pytest.mark.parametrize("lost", ["its file", "its name"])
def test_without_a_part_that_it_was_made_of_it_is_compiled_anew(kept, caplog, monkeypatch, lost):
    monkeypatch.setitem(globals(), "third", jit.compiled(third_of))
    kept.start(twice)
    (caller,), (part,) = kept.folder.glob("*twice*.ir"), kept.folder.glob("*third*.ir")
    for code in kept.folder.glob("*.code"):
        code.unlink()
    if lost == "its file":
        monkeypatch.setattr(cache, "_parts", {})
        part.unlink()
    else:  # LLVM would end the process, were it to look for it
        read = io.BytesIO(read_checksummed(caller))
        name, kind, (modules, _links) = pickle.load(read)  # noqa: S301 - our own
        write_checksummed(caller, cache.payload_of((name, kind, (modules, [])), read.read()))
    assert kept.start(twice) == (8, False)
    (line,) = caplog.messages
    assert "compiling anew" in line
    assert kept.start(twice) == (8, True)


def test_functions_of_one_name_have_code_of_their_own(kept):
    assert kept.start(made_by(2)) == (24, False)
    assert kept.start(made_by(3)) == (36, False)
    assert kept.start(made_by(2)) == (24, True)


NAME = """
import numba
import numpy as np
from yehu_server.compile import jit, numba_compiler
row = numba.from_dtype(np.dtype([("number", float)]))
print(row._code)  # which counts types
def number_of(row):
    return row.number
how = {"no_alias": True, "one_version": False, "no_cpython_wrapper": True}
made = numba_compiler.dispatcher(number_of, fastmath=jit.FASTMATH, **how)
made.compile((row,))
print(made.overloads[row,].fndesc.mangled_name)
"""


@pytest.mark.slow
def test_parts_have_the_same_names_in_all_processes(tmp_path):
    """Else what one process made of them would not find another's."""
    names = set()
    for seed in "12":
        environment = {**os.environ, "PYTHONHASHSEED": seed, "NUMBA_CACHE_DIR": str(tmp_path)}
        command = [sys.executable, "-c", NAME]
        told = subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE)
        number, name = told.stdout.decode().split()
        assert number not in name
        names.add(name)
        shutil.rmtree(tmp_path)
    assert len(names) == 1


def in_order(falling: bool) -> type:
    """Options in an order, as a process happens to have them."""

    class Ordered(set):
        def __iter__(self):
            return iter(sorted(super().__iter__(), reverse=falling))

    return Ordered


@pytest.mark.usefixtures("kept")
def test_code_is_found_whatever_order_a_process_has_its_options_in():
    """Python orders a set of words anew at each start."""
    options = [in_order(falling)(jit.FASTMATH) for falling in (False, True)]
    assert [*options[0]] != [*options[1]]
    how = {"no_alias": True, "one_version": False}
    files = {
        numba_compiler.dispatcher(third_of, fastmath=each, **how)._cache.path(())
        for each in options
    }
    assert len(files) == 1


def test_a_full_disk_is_reported_once_and_it_plays(kept, caplog, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(checksummed.Path, "write_bytes", full)
    assert kept.start() == (4, False)
    assert kept.start() == (4, False)
    (line,) = caplog.messages
    assert "No space left on device" in line
    assert not list(kept.folder.iterdir())


def test_a_numba_unlike_ours_compiles_at_each_start_and_it_plays(kept, caplog, monkeypatch):
    with monkeypatch.context() as patch:
        patch.delattr(cache.CompileResult, "_reduce")
        assert kept.start() == (4, False)
    assert not list(kept.folder.iterdir())
    assert kept.start(third_of) == (4, False)
    assert len(caplog.messages) == 1


def test_who_writes_at_once_leaves_a_file_that_is_whole(tmp_path):
    file = tmp_path / "x.code"
    payloads = [bytes([which]) * 100_000 for which in range(4)]
    with ThreadPoolExecutor() as workers:
        for _ in range(10):
            writing = [workers.submit(write_checksummed, file, payload) for payload in payloads]
            while not all(job.done() for job in writing):
                assert read_checksummed(file) in (None, *payloads)
    assert list(tmp_path.iterdir()) == [file]


def test_a_part_of_other_functions_is_kept_without_machine_code(kept, monkeypatch):
    for function, result, hits in ((twice, 8, 0), (thrice, 12, 1)):
        monkeypatch.setitem(globals(), "third", jit.compiled(third_of))
        assert kept.start(function) == (result, False)
        assert sum(third.value.stats.cache_hits.values()) == hits
    assert not list(kept.folder.glob("*third_of*.code"))


# ---------------------------------------------------------------- the folder


@pytest.fixture
def own_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert cache_folder._open_cache() == ""
    return cache_folder.cache_folder()


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no users")
def test_nothing_is_read_from_a_folder_of_another_user_or_that_all_may_write_to(
    own_folder, monkeypatch, caplog
):
    own_folder.chmod(0o777)
    assert cache_folder._open_cache() == cache_folder.OTHERS
    own_folder.chmod(0o755)
    if (user := os.getuid()) == 0:
        os.chown(own_folder, 1234, -1)
    else:
        monkeypatch.setattr(os, "getuid", lambda: user + 1)
    assert cache_folder._open_cache() == cache_folder.OTHERS
    machine_code.file_in(own_folder).write_bytes(b"not ours")
    monkeypatch.setattr(machine_code, "SHIPPED", own_folder / "none")
    for is_trusted in (False, True):
        monkeypatch.setattr(cache_folder, "IS_TRUSTED", is_trusted)
        assert machine_code.loaded.__wrapped__(own_folder, "") == {}
        assert ("it is damaged" in caplog.text) == is_trusted


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no users")
@pytest.mark.parametrize(
    ("mode", "is_shared"),
    [(0o700, False), (0o755, False), (0o775, True), (0o777, True), (0o1777, None)],
)
def test_nor_where_a_group_may_write_or_put_another_folder_in_its_place(
    own_folder, tmp_path, monkeypatch, mode, is_shared
):
    monkeypatch.setattr(files, "_is_private", lambda _group: False)
    link = tmp_path / "link"
    link.symlink_to(own_folder.parent / "elsewhere" / "code")
    (around := link.readlink().parent).mkdir()
    link.readlink().mkdir(0o700)
    own_folder.chmod(mode)
    assert files.may_others_write(own_folder) == (is_shared is not False)
    own_folder.chmod(0o700)
    around.chmod(mode)
    assert files.may_others_write(link) == bool(is_shared)  # in a sticky one nobody replaces it


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no users")
@pytest.mark.parametrize(
    ("name", "members", "is_private"),
    [("me", [], True), ("me", ["me"], True), ("me", ["me", "you"], False), ("users", [], False)],
)
def test_a_group_of_its_own_is_a_users_who_is_alone_in_it(monkeypatch, name, members, is_private):
    import grp
    import pwd

    monkeypatch.setattr(pwd, "getpwuid", lambda _user: SimpleNamespace(pw_name="me"))
    group = SimpleNamespace(gr_name=name, gr_mem=members)
    monkeypatch.setattr(grp, "getgrgid", lambda _group: group)
    assert files._is_private(1000) is is_private


def test_folders_of_older_sources_are_removed_and_no_others(own_folder):
    old, other = (own_folder.with_name(f"compiled-{name}") for name in ("0" * 16, "photos"))
    for folder in (old, other):
        folder.mkdir()
        os.utime(folder, (0.0, 0.0))
    cache_folder._open_cache()
    assert sorted(own_folder.parent.iterdir()) == sorted([own_folder, other])


def test_without_a_folder_to_keep_code_in_it_is_compiled_all_the_same(tmp_path):
    (tmp_path / "file").touch()
    code = "from yehu_server.core.engine.native import publish; assert publish.address"
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "file")}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True)
