"""What is made of shipped bitcode plays the same samples as what numba compiles, everywhere."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from as_processor import CANNOT, PROCESSORS

from yehu_server.util.sealed import read_sealed

TESTS = Path(__file__).parents[1]
PLAY = """
import hashlib, sys
import numpy as np
from yehu_server.compile.bitcode import shipped
from yehu_server.core.engine import warming
if len(sys.argv) > 1:
    shipped.shipped_file = lambda: shipped.Path(sys.argv[1])
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.playing.wishes import Key, WishPoster
warming.warm_up()
print(all(function.compiled.cache_hits == 1 for function in warming.ALL_FUNCTIONS))
instrument = Instrument(InstrumentSpec(44100.0))
wishes = WishPoster(instrument)
block = np.zeros(441, np.float32)
for pitch in (67, 69, 72, 74, 65, 77, 79, 84):
    wishes.note_on(Key(0, pitch))
    for _ in range(100):
        instrument.process(block)
        sys.stdout.write(hashlib.sha256(block.tobytes()).hexdigest()[:8])
"""
"""Plays a phrase; prints whether all code was in the cache, and the samples of each block."""


def play(processor: str, cache, *file) -> list[str]:
    command = [sys.executable, "-c", PLAY, *map(str, file)]
    if processor:
        command = [sys.executable, str(TESTS / "as_processor.py"), processor, *command]
    child = subprocess.run(
        command,
        env={**os.environ, "NUMBA_CACHE_DIR": str(cache)},
        check=False,
        capture_output=True,
        text=True,
    )
    if child.returncode == CANNOT:
        pytest.skip(child.stderr)
    child.check_returncode()
    return child.stdout.splitlines()


@pytest.fixture(scope="module")
def releases(tmp_path_factory) -> list:
    """Two files that the script wrote one after the other."""
    files = [tmp_path_factory.mktemp("release") / "machine.bitcode" for _ in range(2)]
    for file in files:
        script = TESTS.parent / "scripts" / "bitcode.py"
        subprocess.run([sys.executable, str(script), "-o", str(file)], check=True)
    return files


@pytest.mark.slow
def test_of_the_same_sources_the_same_bytes_are_shipped(releases):
    payloads = [read_sealed(file) for file in releases]
    assert payloads[0] == payloads[1]


@pytest.mark.slow
@pytest.mark.parametrize("processor", ["", *PROCESSORS])
def test_it_plays_the_same_samples_as_what_numba_compiles(releases, tmp_path, processor):
    of_shipped, samples = play(processor, tmp_path / "a", releases[0])
    assert of_shipped == "True"
    assert play(processor, tmp_path / "b", tmp_path / "nothing")[-1] == samples
