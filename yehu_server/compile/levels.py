"""The level of processors that code is compiled for, never this very processor.

All processors of a level run the same instructions, so one set of sources gives the same samples on
each of them. A bowed string is chaotic: one rounding that differs is heard seconds later.
"""

import os
from collections.abc import Mapping
from functools import cache

from yehu_server.errors import ParameterError, YehuError

VARIABLE = "YEHU_LEVEL"  # of the environment: the level, in the place of the highest one
_V2 = frozenset({"cx16", "popcnt", "sse3", "sse4.1", "sse4.2", "ssse3"})
_V3 = _V2 | {"avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"}
_ARM: Mapping[str, frozenset[str]] = {"aarch64": frozenset()}
# The levels of each kind of machine, the highest first, with the features that they need, by LLVM's
# names. There is none with AVX-512: it gives the same samples as AVX2, and no sooner.
LEVELS: Mapping[str, Mapping[str, frozenset[str]]] = {
    "x86_64": {"x86-64-v3": _V3, "x86-64-v2": _V2},
    "aarch64": _ARM,
    "arm64": _ARM,
}


@cache
def triple() -> str:
    """Return the name of this system, by LLVM's name, such as ``x86_64-unknown-linux-gnu``."""
    from llvmlite import binding

    return str(binding.get_process_triple())


def levels() -> Mapping[str, frozenset[str]]:
    """The levels of this kind of machine, the highest first; one without a name of a rare kind."""
    machine = triple().partition("-")[0]
    return LEVELS.get(machine, {machine: frozenset()})


def lowest() -> str:
    """The level that every processor of this kind of machine has."""
    return list(levels())[-1]


@cache
def level() -> str:
    """The level that this process compiles for.

    That is what the variable `VARIABLE` of the environment says, or the highest one that this
    processor has. Raises ParameterError where the variable is no level of this kind of machine.
    """
    if wanted := os.environ.get(VARIABLE):
        return checked(wanted)
    return next((name for name in levels() if not missing(name)), lowest())


def checked(name: str) -> str:
    """Return the name of a level; raises ParameterError where this kind of machine has none."""
    if name not in levels():
        raise ParameterError(f"{name!r} is not a level of this machine: {', '.join(levels())}")
    return name


@cache
def missing(name: str) -> list[str]:
    """The features that this processor lacks to run code of a level."""
    from llvmlite import binding

    features = binding.get_host_cpu_features()
    return sorted(feature for feature in levels()[name] if not features.get(feature))


@cache
def check_processor() -> None:
    """Raise YehuError where this processor cannot run code of this level."""
    if lacking := missing(level()):
        raise YehuError(f"this processor cannot run {level()}: it lacks {', '.join(lacking)}")


def cpu(name: str) -> str:
    """LLVM's name of the processor that a level's code is for."""
    return name if name.startswith("x86") else "generic"
