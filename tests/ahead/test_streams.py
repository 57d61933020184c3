"""The same bytes give the same commands: by server, C, WebAssembly and plain Python."""

import json
import random
import shutil
import subprocess

import numpy as np
import pytest
from ahead.programs import compiled, run_in_plain_python
from ahead.streams import (
    BLOCK,
    RATE,
    REPORTING,
    commands_in,
    interpreted,
    messages_of,
    numbers,
    played,
    record_in,
    stream_of,
)

from yehu_server.ahead.interface import control, midi, use_tables
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import RING
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi import events
from yehu_server.core.midi.packing import packed
from yehu_server.core.midi.tables import TABLE_SLOTS, TABLES
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.tables import Controls

SEEDS, PARTS = range(2), 12
SHORT = 2  # parts of a stream in plain Python


@pytest.fixture(scope="module")
def streams():
    return [stream_of(seed, PARTS) for seed in SEEDS]


@pytest.fixture(scope="module")
def here(streams):
    """The records of the server's instrument, which has played the streams."""
    return [played(stream) for stream in streams]


def test_the_instrument_plays_what_each_event_comes_to_alone(streams, here):
    for stream, rig in zip(streams, here, strict=True):
        found = [list(command)[1:] for command in commands_in(rig).tolist()]
        assert found == list(numbers(interpreted(stream)))


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_c_gives_the_same_commands_and_records_to_the_bit(streams, here, library, tmp_path):
    program = compiled(library, tmp_path / "streams", "streams.c")
    for stream, rig in zip(streams, here, strict=True):
        files, blocks = stream.write(tmp_path), str(stream.frames // BLOCK)
        command = [program, *files, blocks, str(REPORTING), tmp_path / "memory"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, "")
        found = record_in(tmp_path / "memory")
        assert commands_in(found).tobytes() == commands_in(rig).tobytes()
        assert found["midi"].tobytes() == rig["midi"].tobytes()


@pytest.mark.skipif(shutil.which("node") is None, reason="there is no node")
def test_web_assembly_gives_the_same_but_for_the_last_bit_of_a_power(
    streams, here, node, tmp_path, everything
):
    for stream, rig in list(zip(streams, here, strict=True))[: None if everything else 1]:
        steps, tables = map(str, stream.write(tmp_path))
        job = {"rate": RATE, "steps": steps, "tables": tables, "count": len(stream.tables)}
        job |= {"blocks": stream.frames // BLOCK, "reporting": REPORTING}
        files = {name: str(tmp_path / name) for name in ("memory", "samples")}
        report = node("streams.mjs", **job, **files)
        assert report == {"finite": True, "lost": 0}
        found = record_in(tmp_path / "memory")
        assert_near(commands_in(found), commands_in(rig))
        assert_near(found["midi"][0], rig["midi"][0])


def assert_near(found, wanted):
    """The same whole numbers, and others that differ by rounding alone."""
    assert found.shape == wanted.shape
    for name in wanted.dtype.names:
        np.testing.assert_allclose(found[name], wanted[name], rtol=1e-12, atol=1e-300)


def test_plain_python_gives_the_same(tmp_path):
    run_in_plain_python("streams.py", tmp_path / "results", SHORT, *SEEDS)
    results = json.loads((tmp_path / "results").read_text())
    for seed in SEEDS:
        wanted = interpreted(stream_of(seed, SHORT))
        assert sum(map(len, wanted)) > 60
        assert results[str(seed)] == [list(map(list, requested)) for requested in wanted]


# -- bytes ----------------------------------------------------------------------------------------


@pytest.fixture
def instrument() -> Instrument:
    return Instrument(InstrumentSpec(RATE), is_live=True)


def posted(instrument: Instrument, since: int = 0) -> list[tuple]:
    return instrument._rig["ring"][0, since : instrument.posted].tolist()


def given(instrument: Instrument, data: bytes, frame: int = 7) -> int:
    return midi.call(
        instrument.address, frame, np.frombuffer(data, np.uint8).ctypes.data, len(data)
    )


def test_bytes_are_posted_as_whole_messages(instrument):
    for data, messages in (
        ([0x90, 69, 100], [[0x90, 69, 100]]),
        ([0x90, 69, 100, 0xC1, 5, 0xE2, 0, 64], [[0x90, 69, 100], [0xC1, 5], [0xE2, 0, 64]]),
        ([0xC0, 5, 0], [[0xC0, 5]]),  # as hosts fill messages up
        ([0x90, 69, 100, 70, 100], [[0x90, 69, 100]]),
        ([0xF0, 0x7E, 1, 2, 0xF7, 0xD0, 3], [[0xD0, 3]]),
        ([0xF0, 0x7E, 1, 0x80, 60, 0], [[0x80, 60, 0]]),  # a system message without its end
        ([0x90, 0xF8, 69, 0xFE, 100], [[0x90, 69, 100]]),
        ([0xB0, 0xFF, 7, 90], [[0xFF], [0xB0, 7, 90]]),
        ([0xF2, 1, 2, 0xF3, 1, 0xF6, 0xF1, 9], []),
        ([60, 0x90, 0xB0, 1], []),
        ([], []),
    ):
        before = instrument.posted
        assert given(instrument, bytes(data)) == len(messages), data
        wanted = [(7, events.MESSAGE, packed(each), 0.0, 0.0) for each in messages]
        assert posted(instrument, before) == wanted, data


def test_all_whole_messages_among_any_bytes_are_posted(instrument):
    chance = random.Random(1)
    for _ in range(2000):
        status = (0x80, 0x90, 0xA0, 0xB0, 0xC0, 0xD0, 0xE0, 0xF0, 0xF7, 0xF2, 0xF8, 0xFF)
        data = bytes(
            chance.choice([chance.choice(status), chance.randrange(128), chance.randrange(256)])
            for _ in range(chance.randint(0, 12))
        )
        before = instrument.posted
        wanted = messages_of(data)
        assert given(instrument, data) == len(wanted), data.hex()
        assert [index for _, _, index, *_ in posted(instrument, before)] == wanted, data.hex()
        if instrument.posted > RING // 2:
            instrument.reset()


def test_a_full_ring_takes_no_more_and_no_control_has_a_number_below_0(instrument):
    assert control.call(instrument.address, 0, -1, 0.5) == 0
    assert control.call(instrument.address, 3, 2, 0.5) == 1
    assert posted(instrument) == [(3, events.CONTROL, 2, 0.5, 0.0)]
    assert given(instrument, bytes([0xD0, 1] * RING)) == RING - 1
    assert given(instrument, bytes([0xD0, 1])) == 0
    assert control.call(instrument.address, 0, 0, 0.5) == 0
    tables = PlayingOptions().tables(Controls())
    assert mapped(instrument, tables) == 0  # until there is room
    for _ in range(RING // 1024):
        instrument.process(np.zeros(BLOCK, np.float32))
    assert mapped(instrument, tables) == 1


# -- tables ---------------------------------------------------------------------------------------


def mapped(instrument: Instrument, tables, frame: int = 0) -> int:
    return use_tables.call(instrument.address, frame, tables.ctypes.data, tables.nbytes)


def test_tables_are_taken_one_after_another_and_those_in_use_are_not_touched(instrument):
    out = np.zeros(BLOCK, np.float32)
    for number in range(1, 6):
        tables = PlayingOptions(a4=440.0 - number).tables(Controls())
        slot = int(instrument.midi["tables"])
        before = instrument.tables[[slot, (slot - 1) % TABLE_SLOTS]].tobytes()
        assert mapped(instrument, tables, instrument.frame + 200) == 1
        assert mapped(instrument, tables) == 0  # the others are not in use yet
        instrument.process(out)
        assert mapped(instrument, tables) == 0
        assert instrument.tables[[slot, (slot - 1) % TABLE_SLOTS]].tobytes() == before
        instrument.process(out)
        assert instrument.midi["tables"] == number % TABLE_SLOTS
        assert instrument.tables[number % TABLE_SLOTS].tobytes() == tables.tobytes()


def test_tables_of_another_size_are_refused(instrument):
    tables = PlayingOptions().tables(Controls())
    for size in (-1, 0, TABLES.itemsize - 8, TABLES.itemsize + 8):
        assert use_tables.call(instrument.address, 0, tables.ctypes.data, size) == -1
    assert instrument.posted == 0
