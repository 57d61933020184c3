"""One level of processors gives one sequence of samples, whatever the processor and libraries."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from as_processor import PROCESSORS, V2, environment, missing
from renders import NAMES, SUMS

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


@pytest.mark.parametrize("half", [0, 1])
def test_commands_give_the_samples_of_this_level(known, half):
    names = NAMES[half::2]
    found = sums(*names)
    assert [name for name in names if found[name] != known[name]] == []


# Without --all, the one that differs most from what is new.
@pytest.mark.parametrize(
    "processor",
    [V2, *(pytest.param(each, marks=pytest.mark.slow) for each in PROCESSORS if each != V2)],
)
def test_the_processor_that_libraries_see_does_not_matter(known, processor):
    if lacking := missing(processor):
        pytest.skip(f"its code does not run here, for lack of {', '.join(lacking)}")
    found = sums(*QUICK, **{**environment(processor), levels.VARIABLE: LEVEL})
    assert found == {name: known[name] for name in QUICK}


@pytest.mark.skipif(sys.platform != "linux" or not CC, reason="needs a C compiler")
def test_the_c_library_does_not_matter(known, tmp_path):
    """Another one's mathematics differs in the last bit: here each result does."""
    library = tmp_path / "other_libm.so"
    source = TESTS / "other_libm.c"
    flags = ["-O1", "-fno-builtin", "-shared", "-fPIC"]
    subprocess.run([CC, *flags, str(source), "-o", str(library), "-lm", "-ldl"], check=True)
    look = "import math; print(math.exp(0.3), math.sin(0.3), 1.1**1.1)"
    here, there = (
        subprocess.run(
            [sys.executable, "-c", look], env={**os.environ, **settings},
            check=True, stdout=subprocess.PIPE, text=True,
        ).stdout.split()
        for settings in ({}, {"LD_PRELOAD": str(library)})
    )  # fmt: skip
    assert not set(here) & set(there)
    found = sums(*QUICK, LD_PRELOAD=str(library))
    assert found == {name: known[name] for name in QUICK}


@pytest.mark.slow
def test_what_numba_knows_of_processors_does_not_matter(known, tmp_path):
    found = sums(
        QUICK[0], NUMBA_CPU_NAME="nehalem", NUMBA_CPU_FEATURES="", NUMBA_CACHE_DIR=str(tmp_path)
    )
    assert found[QUICK[0]] == known[QUICK[0]]
