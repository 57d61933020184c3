"""The WebAssembly module plays what the server plays."""

import shutil

import numpy as np
import pytest
from ahead.likeness import apart, are_near, begins_alike
from ahead.phrases import BLOCK, FRAMES, PHRASES, RATE, STOPPED, played

from yehu_server.ahead.build_hash import build_hash, section_of
from yehu_server.core.engine.snapshot import SNAPSHOT, snapshot
from yehu_server.core.midi.events import EVENTS
from yehu_server.core.player.commands import KINDS
from yehu_server.params.table import SLOT, TABLE

pytestmark = pytest.mark.skipif(shutil.which("node") is None, reason="there is no node")


@pytest.fixture
def by_node(node, tmp_path):
    def play(commands, frames=FRAMES, rate=RATE, block=BLOCK):
        job = {"rate": rate, "frames": frames, "block": block, "commands": commands}
        report = node("play.mjs", **job, parameters=len(TABLE), samples=str(tmp_path / "samples"))
        return np.fromfile(tmp_path / "samples", np.float32).reshape(-1, 2), report

    return play


def test_a_phrase_begins_as_here_and_stays_near(by_node, here):
    found = []
    for name, commands in PHRASES.items():
        sound, report = by_node(commands)
        assert (report["finite"], report["lost"]) == (True, 0)
        assert np.abs(sound).max() > 0.01
        assert begins_alike(sound, here[name]), name
        found.append(apart(sound, here[name]))
    assert are_near(np.concatenate(found)), dict(zip(PHRASES, found, strict=True))


def test_blocks_of_any_size_give_the_same_samples(by_node):
    whole = by_node(STOPPED, frames=4800)[0]
    for block in (1, 37):
        assert np.array_equal(by_node(STOPPED, frames=4800, block=block)[0], whole)


def test_it_reports_values_and_snapshots_as_here(by_node):
    frames = 4 * BLOCK  # so early that rounding has not grown
    report = by_node(STOPPED, frames=frames)[1]
    _, ensemble = played(STOPPED, frames=frames)
    seen = np.zeros(1, SNAPSHOT)
    snapshot.call(ensemble.address, seen.ctypes.data)
    expected = np.frombuffer(seen.tobytes(), np.float64)
    found = np.array([np.nan if number is None else number for number in report["snapshot"]])
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)
    values = [
        ensemble.first.target(param.address) if param.address in SLOT else param.default
        for param in TABLE
    ]
    assert report["values"] == pytest.approx(values)


def test_it_names_the_sources_that_it_was_built_from(by_node, wasm):
    assert section_of(wasm.read_bytes()).split()[-1] == build_hash()
    assert by_node([], frames=BLOCK)[1]["sources"] == build_hash()


def test_a_rate_that_it_was_not_built_for_is_refused(node, tmp_path):
    with pytest.raises(AssertionError, match="not built for 32000 Hz"):
        node("play.mjs", rate=32000, frames=1, block=1, commands=[], samples=str(tmp_path / "s"))


def test_no_random_events_make_a_trap_or_a_number_that_is_not_finite(node, everything):
    kinds, count = len(KINDS) + len(EVENTS), 1_000_000 if everything else 60_000
    report = node("fuzz.mjs", rate=RATE, seed=1, count=count, parameters=len(TABLE), kinds=kinds)
    assert report["posted"] == count
    assert report["finite"]
    assert report["loudest"] > 0.01
