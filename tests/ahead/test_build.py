"""Building ahead of time: what is written, and what is refused."""

import hashlib
import shutil
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from llvmlite import binding

from yehu_server.ahead import build as build_module
from yehu_server.ahead import build_hash as hashing
from yehu_server.ahead.build import build, page_linker
from yehu_server.ahead.build_hash import build_hash
from yehu_server.ahead.memory_images import image
from yehu_server.ahead.module import PAGE
from yehu_server.core.engine.mailbox import SERVER
from yehu_server.core.engine.rig import RIG, memory_bytes
from yehu_server.core.midi.events import START
from yehu_server.core.midi.tables import TABLES
from yehu_server.errors import ParameterError, YehuError
from yehu_server.playing.mapping import load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tables import Controls
from yehu_server.playing.tuning import RangePolicy, read_tuning

BEGUN_BY = ("options.py", "tables.py", "calibrations.json", "practices.json")


def test_what_memory_begins_with_counts_in_the_hash(tmp_path, monkeypatch):
    playing = tmp_path / "playing"
    playing.mkdir()
    for name in BEGUN_BY:
        shutil.copy(hashing.PACKAGE / "playing" / name, playing)
    monkeypatch.setattr(hashing, "PACKAGE", tmp_path)
    hashes = {build_hash.__wrapped__()}
    assert hashes == {build_hash()}
    for name in BEGUN_BY:
        with (playing / name).open("a") as file:
            file.write("more = 1\n")
        hashes.add(build_hash.__wrapped__())
    assert len(hashes) == 1 + len(BEGUN_BY)


def test_what_cannot_be_built_is_refused(tmp_path, monkeypatch, refused):
    with pytest.raises(ParameterError, match="'pdp11' is not a level"):
        build("library", tmp_path, level="pdp11")
    with pytest.raises(YehuError, match=r"^sample rate: 5.0 Hz is not within"):
        build("library", tmp_path, rates=[5.0])
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("yehu_server.ahead.build.find_spec", {}.get)  # no zig
    for what in ("wasm", "library"):
        with pytest.raises(YehuError, match=r"there is no (wasm-ld|C compiler) here"):
            build(what, tmp_path)
    words = ("build", "tables", "--mapping", "nothing", "-o", tmp_path / "out")
    assert "no mapping 'nothing'" in refused(*words)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.parametrize("what", ["wasm", "library"])
def test_a_build_is_the_same_to_the_byte_also_from_an_empty_cache(tmp_path, monkeypatch, what):
    if what == "wasm" and page_linker() is None:
        pytest.skip("there is no wasm-ld")
    digests = set()
    for name in ("one", "two", "two"):
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / name))
        files = build(what, tmp_path / "built")
        digests.add(tuple(hashlib.sha256(file.read_bytes()).hexdigest() for file in files))
        shutil.rmtree(tmp_path / "built")
    assert len(digests) == 1


# -- tables ---------------------------------------------------------------------------------------


def test_build_tables_writes_what_a_style_has(tmp_path, command):
    output = tmp_path / "wind.tables"
    options = ["--mapping", "wind", "--tuning", "chaozhou-seven-equal", "--a4", "430"]
    options += ["--keyboard-map", "chaozhou-keys"]
    options += ["--range", "skip", "--preset", "sul-tasto", "--programs"]
    assert command("build", "tables", *options, "-o", output) == (0, f"{output}\n", "")
    playing = PlayingOptions(
        mapping=load("wind"),
        tuning=read_tuning(Path("chaozhou-seven-equal"), Path("chaozhou-keys")),
        a4=430.0,
        policy=RangePolicy.SKIP,
        start=tuple(Presets().load("sul-tasto").values.items()),
        programs=True,
    )
    assert output.read_bytes() == playing.tables(Controls()).tobytes()
    assert len(output.read_bytes()) == TABLES.itemsize


# -- images ---------------------------------------------------------------------------------------


def test_an_image_begins_as_serve_does():
    memory = np.zeros(memory_bytes(1) // 8, np.int64)
    words = image(48000.0)
    while len(words):
        first, count = words[:2]
        memory[first : first + count] = words[2 : 2 + count]
        words = words[2 + count :]
    rig = np.frombuffer(memory, RIG, count=1)[0]
    wanted = PlayingOptions().tables(Controls())[0]
    for name in TABLES.names or ():
        if name != "program_row":  # not read, as there are no programs
            assert np.array_equal(rig["tables"][0][name], wanted[name], equal_nan=True), name
    assert rig["tables"][0]["binds"] > 0
    assert (rig["midi"]["tables"], rig["midi"]["players"]) == (0, 1)
    assert rig["ring"][0]["kind"] == START
    assert rig["mail"]["posted"][SERVER, 0] == 1


def test_zig_links_where_the_system_has_no_linker_and_without_it_both_are_named(monkeypatch):
    monkeypatch.setattr(build_module, "find_spec", lambda _name: None)
    monkeypatch.setattr(build_module.shutil, "which", lambda name: f"/usr/bin/{name}")
    assert build_module.page_linker() == ["/usr/bin/wasm-ld"]
    monkeypatch.setattr(build_module.shutil, "which", lambda _name: None)
    for what, package in (("wasm", "lld"), ("library", "gcc")):
        with pytest.raises(YehuError, match=f"Debian's package {package} has it, and so has zig: "):
            build_module.linker_of(what)
    monkeypatch.setattr(build_module, "find_spec", lambda _name: object())
    assert build_module.linker_of("wasm")[-2:] == ["ziglang", "wasm-ld"]
    assert build_module.linker_of("library")[-2:] == ["ziglang", "cc"]


@pytest.mark.skipif(find_spec("ziglang") is None, reason="there is no zig")
def test_zigs_linker_takes_what_lld_takes(tmp_path):
    module = binding.parse_assembly(
        'target triple = "wasm32-unknown-unknown"\n'
        "define i32 @next(i32 %x) {\n  %y = add i32 %x, 1\n  ret i32 %y\n}\n"
    )
    (tmp_path / "next.o").write_bytes(PAGE.machine().emit_object(module))
    build_module.link_page(
        build_module.zig("wasm-ld"), tmp_path / "next.o", ["next"], tmp_path / "next.wasm"
    )
    linked = (tmp_path / "next.wasm").read_bytes()
    assert linked.startswith(b"\0asm")
    assert b"next" in linked
