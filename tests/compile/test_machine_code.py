"""Machine code that is kept, or that a release brings, plays without numba."""

import argparse
import json
import os
import re
import struct
import subprocess
import sys
import zlib
from functools import cache
from pathlib import Path

import compile_all
import pytest

from yehu_server.cli.terminal import warn_of_compiling
from yehu_server.compile import cache_folder, levels, machine_code
from yehu_server.compile.cache_folder import source_hash
from yehu_server.compile.jit import Native
from yehu_server.core.engine import warming
from yehu_server.core.engine.warming import all_functions, warm_up
from yehu_server.core.physics.time_loop import advance, advance_with_ledger
from yehu_server.simulation.run import COMPILED
from yehu_server.util.checksummed import read_checksummed, write_checksummed

ROOT = Path(__file__).parents[2]
PLAY = """
import argparse, sys
import numpy as np
from yehu_server.cli.terminal import warn_of_compiling
from yehu_server.compile import jit
from yehu_server.core.engine import warming
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.playing.part_state import Key
from yehu_server.playing.player import Player
jit._values_named_in = None  # to find what a function calls takes as long as all the rest
warn_of_compiling(argparse.Namespace(quiet=False))
warming.warm_up()
instrument = Instrument(InstrumentSpec(44100.0))
Player(instrument).note_on(Key(0, 69))
block = np.zeros(3 * 44100, np.float32)
instrument.process(block)
print("numba" in sys.modules, np.sqrt(np.mean(np.square(block[44100:]))), block[:64].tolist())
"""
"""Plays a note; prints whether numba was there, and how loud it was."""


STUDY = """
import sys
from yehu_server.simulation.run import simulate
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of
from yehu_server.scores.gesture import gesture_from
pluck = {"string": 1, "position": 0.1, "amplitude": 0.001}
for instrument in ({}, {"torsion": "on"}):
    data = {"duration": 0.02, "instrument": instrument, "pluck": pluck}
    simulate(gesture_from(data), energy=True)
    sweep(study_of({"vary": {"force": [0.5]}, "duration": 0.06, "instrument": instrument}))
simulate(gesture_from(data | {"instrument": {"directions": "two"}}), energy=True)
print("numba" in sys.modules)
"""
"""Simulates and sweeps, by all kernels; prints whether numba was there."""


@pytest.fixture(scope="module")
def kept() -> bytes:
    """The file of this level."""
    warm_up()
    payload = read_checksummed(machine_code.file_in(cache_folder.cache_folder()))
    assert payload is not None
    return payload


def changed(payload: bytes, **fields: object) -> bytes:
    head, _, body = payload.partition(b"\n")
    return json.dumps(json.loads(head) | fields).encode() + b"\n" + body


def written(folder: Path, payload: bytes) -> dict[str, int]:
    """What is loaded of a file with a payload in an otherwise empty cache."""
    write_checksummed(machine_code.file_in(folder), payload)
    machine_code.loaded.cache_clear()
    return machine_code.loaded(folder, source_hash())


def undefined_symbols(elf: bytes) -> set[str]:
    """The symbols that an object file of ELF (64 bits) takes from elsewhere."""
    (sections_at,) = struct.unpack_from("<Q", elf, 0x28)
    size, count = struct.unpack_from("<HH", elf, 0x3A)
    sections = [struct.unpack_from("<IIQQQQII", elf, sections_at + i * size) for i in range(count)]
    found = set()
    for _, kind, _, _, at, length, link, _ in sections:
        if kind == SYMBOLS:
            names_at = sections[link][4]
            for symbol in range(at, at + length, 24):
                name, _, _, section = struct.unpack_from("<IBBH", elf, symbol)
                if section == 0 and name:
                    found.add(elf[names_at + name : elf.index(0, names_at + name)].decode())
    return found


SYMBOLS = 2  # a section's kind


@pytest.fixture(autouse=True)
def _nothing_is_shipped(tmp_path, monkeypatch):
    monkeypatch.setattr(machine_code, "SHIPPED", tmp_path / "shipped")
    yield
    machine_code.loaded.cache_clear()


@pytest.mark.usefixtures("kept")
def test_notes_simulations_and_sweeps_from_what_is_kept_need_no_numba_and_read_no_code():
    compile_all.warm_up()
    for code in (PLAY, STUDY):
        ran = subprocess.run(
            [sys.executable, "-c", code], check=True, capture_output=True, text=True
        )
        assert ran.stdout.split()[0] == "False"


def test_what_playing_needs_is_in_one_file_apart_from_what_studies_need_besides(kept, tmp_path):
    compile_all.warm_up()
    found = set(written(tmp_path, kept))
    assert {function.name for function in all_functions()} <= found
    besides = [
        call for some in compile_all.MORE.values() for call in warming.functions_beside(some)
    ]
    assert len(besides) > len(compile_all.MORE)
    assert not {function.name for function in besides} & found
    assert all(function.is_kept for function in besides)
    machine_code.file_in(tmp_path).unlink()
    machine_code.loaded.cache_clear()  # without the first file the others are not loaded
    assert all(machine_code.address_of(call.name, tmp_path) is None for call in besides)


# What compiled code may take from elsewhere: its own parts, the system's clock, memory, and what
# numba's wrappers call where a function raises, which none of ours does.
FROM_ELSEWHERE = re.compile(
    r"yehu_|clock_gettime$|mem(cpy|move|set)$|_?Py|numba_|NRT_|_?_GLOBAL_OFFSET"
)


@pytest.mark.usefixtures("kept")
@pytest.mark.skipif(sys.platform != "linux", reason="object files are not ELF")
def test_no_mathematics_of_a_c_library_is_called():
    """It differs from system to system and by processor; see `core/physics/elementary.py`."""
    compile_all.warm_up()
    strange = {}
    for what in (machine_code.PLAYING, *compile_all.MORE):
        file = machine_code.file_in(cache_folder.cache_folder(), what)
        head, _, body = (read_checksummed(file) or b"").partition(b"\n")
        code, at = zlib.decompress(body), 0
        for name, _, size in json.loads(head)["functions"]:
            symbols = undefined_symbols(code[at : at + size])
            strange[name] = [each for each in symbols if not FROM_ELSEWHERE.match(each)]
            at += size
    assert "yehu_callback" in strange
    assert not any(strange.values()), strange


def test_what_was_made_for_something_else_is_left_alone(kept, tmp_path, caplog):
    system, level, sources = machine_code.made_for(source_hash())
    for other in ([system, level, "0" * 16], ["riscv", level, sources], [system, "z80", sources]):
        assert written(tmp_path, changed(kept, **{"made for": other})) == {}
    assert written(tmp_path, changed(kept, format=0)) == {}
    assert caplog.messages == []


def test_a_damaged_file_is_reported_and_left_alone(kept, tmp_path, caplog):
    file = machine_code.file_in(tmp_path)
    sizes = json.loads(kept.partition(b"\n")[0])["functions"]
    renamed = changed(kept, functions=[[name, "another", size] for name, _, size in sizes])
    cut, nothing = kept[: len(kept) // 2], changed(kept, functions=None)
    for damaged in (b"", cut, b"not ours", nothing, renamed):
        caplog.clear()
        assert written(tmp_path, damaged) == {}
        assert caplog.messages[0].startswith(f"{file}: ")
    caplog.clear()
    file.write_bytes(b"0" * 100)
    machine_code.loaded.cache_clear()
    assert machine_code.loaded(tmp_path, source_hash()) == {}
    assert "damaged" in caplog.messages[0]


@pytest.fixture
def shipped(kept, tmp_path, monkeypatch) -> Path:
    """The folder of what a release brings, with the file of this level."""
    folder = tmp_path / "shipped"
    folder.mkdir()
    made_for = machine_code.made_for(source_hash(is_shipped=True))
    write_checksummed(machine_code.file_in(folder), changed(kept, **{"made for": made_for}))
    monkeypatch.setattr(machine_code, "SHIPPED", folder)
    machine_code.loaded.cache_clear()
    yield folder
    machine_code.loaded.cache_clear()


def test_what_is_shipped_for_this_level_is_taken_where_nothing_is_kept(
    shipped, tmp_path, monkeypatch
):
    assert shipped.is_dir()
    assert machine_code.loaded(tmp_path / "empty", source_hash())
    machine_code.loaded.cache_clear()
    monkeypatch.setattr(levels, "level", lambda: "another")
    assert machine_code.loaded(tmp_path / "empty", source_hash()) == {}


def test_what_is_shipped_fits_any_version_of_numba_and_what_is_kept_its_own(
    shipped, kept, tmp_path, monkeypatch
):
    assert shipped.is_dir()
    write_checksummed(machine_code.file_in(tmp_path), kept)
    before = source_hash()
    monkeypatch.setattr(cache_folder, "version", lambda _name: "99.0")
    source_hash.cache_clear()
    try:
        assert source_hash() != before
        assert machine_code.loaded(tmp_path / "empty", source_hash())
        machine_code.file_in(shipped).unlink()
        machine_code.loaded.cache_clear()
        assert machine_code.loaded(tmp_path, source_hash()) == {}
    finally:
        source_hash.cache_clear()


def test_functions_of_one_object_file_are_all_found_in_it(kept, tmp_path):
    """As in what a release brings for ARM: the size of all but the first is 0."""
    sizes = json.loads(kept.partition(b"\n")[0])["functions"]
    (name, entry, size), *_ = sizes
    twice = changed(kept, functions=[[name, entry, size], ["again", entry, 0]])
    found = written(tmp_path, twice)
    assert found[name] == found["again"] != 0


def test_commands_tell_that_something_is_compiled(monkeypatch, capsys):
    """Whether it is for playing, or for what else a command calls."""

    def warned(more) -> str:
        warn_of_compiling(argparse.Namespace(quiet=False), more)
        return capsys.readouterr().err

    warm_up()
    for more, missing, line in (
        ({}, advance, "compiling the instrument for this machine (about a minute), once ..."),
        (COMPILED, advance_with_ledger, "compiling what else is needed (some seconds), once ..."),
    ):
        assert warned(more) == ""
        with monkeypatch.context() as patched:
            patched.setattr(machine_code, "loaded", cache(lambda *_: {}))
            assert warned(more) == ""  # it is in the cache, function by function
            patched.setattr(
                Native, "is_cached", property(lambda self, missing=missing: self is not missing)
            )
            assert warned(more) == f"yehu-server: {line}\n"


@pytest.mark.slow
def test_code_for_a_level_of_processors_plays_without_numba(tmp_path):
    subprocess.run(
        [sys.executable, "-m", "releases.machine_code", tmp_path],
        env={**os.environ, "PYTHONPATH": str(ROOT / "scripts")},
        check=True, stdout=subprocess.DEVNULL,
    )  # fmt: skip
    of_arm = levels.level() == levels.lowest() and levels.triple().startswith("x86_64")
    assert len(list(tmp_path.iterdir())) == (1 + len(compile_all.MORE)) * (2 if of_arm else 1)
    of_level = f"""
from yehu_server.compile import machine_code
machine_code.SHIPPED = machine_code.Path({str(tmp_path)!r})
{PLAY}"""
    found = []
    for script, settings in ((of_level, {"NUMBA_CACHE_DIR": str(tmp_path / "empty")}), (PLAY, {})):
        ran = subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, **settings}, check=True, capture_output=True, text=True,
        )  # fmt: skip
        found.append(ran.stdout)
    assert found[0].startswith("False")
    assert found[0] == found[1]
