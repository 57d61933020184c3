"""One level of processors gives one sequence of samples, whatever the processor and libraries."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from as_processor import PROCESSORS, V2, environment, missing
from renders import LONG, NAMES, SUMS

from yehu_server.compile import levels

TESTS = Path(__file__).parent
LEVEL = levels.level()
CC = shutil.which("cc")
QUICK = ("a section by MPE", "a simulation", "a capture")  # and of several rates


def sums(*names: str, **settings: str) -> dict[str, str]:
    """The sums of renders, in a process with these variables in its environment."""
    made = subprocess.run(
        [sys.executable, str(TESTS / "renders.py"), *names],
        env={**os.environ, levels.VARIABLE: LEVEL, **settings},
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    )
    return json.loads(made.stdout)


@pytest.fixture(scope="module")
def known() -> dict[str, str]:
    return json.loads(SUMS.read_text())[LEVEL]


@pytest.mark.parametrize(
    "names",
    [[name for name in NAMES if name not in LONG], pytest.param([*LONG], marks=pytest.mark.slow)],
    ids=["short", "long"],
)
def test_commands_give_the_samples_of_this_level(known, names):
    found = sums(*names)
    assert [name for name in names if found[name] != known[name]] == []


@pytest.fixture(scope="module")
def other_libm(tmp_path_factory) -> dict[str, str]:
    """The environment of a C library whose mathematics gives other last bits."""
    if sys.platform != "linux" or not CC:
        return {}
    library = tmp_path_factory.mktemp("libm") / "other_libm.so"
    flags = ["-O1", "-fno-builtin", "-shared", "-fPIC"]
    source = str(TESTS / "other_libm.c")
    subprocess.run([CC, *flags, source, "-o", str(library), "-lm", "-ldl"], check=True)
    look = "import math; print(math.exp(0.3), math.sin(0.3), 1.1**1.1)"
    here, there = (
        subprocess.run(
            [sys.executable, "-c", look], env={**os.environ, **settings},
            check=True, stdout=subprocess.PIPE, text=True,
        ).stdout.split()
        for settings in ({}, {"LD_PRELOAD": str(library)})
    )  # fmt: skip
    assert not set(here) & set(there)
    return {"LD_PRELOAD": str(library)}


# Without --all, the one that differs most from what is new.
@pytest.mark.parametrize(
    "processor",
    [V2, *(pytest.param(each, marks=pytest.mark.slow) for each in PROCESSORS if each != V2)],
)
def test_processor_and_c_library_do_not_matter(known, other_libm, processor):
    if lacking := missing(processor):
        pytest.skip(f"its code does not run here, for lack of {', '.join(lacking)}")
    found = sums(*QUICK, **{**environment(processor), **other_libm, levels.VARIABLE: LEVEL})
    assert found == {name: known[name] for name in QUICK}


@pytest.mark.slow
def test_what_numba_knows_of_processors_does_not_matter(known, tmp_path):
    found = sums(
        QUICK[0], NUMBA_CPU_NAME="nehalem", NUMBA_CPU_FEATURES="", NUMBA_CACHE_DIR=str(tmp_path)
    )
    assert found[QUICK[0]] == known[QUICK[0]]
