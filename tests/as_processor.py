"""Runs a command as another x86-64 processor would run it, rounding for rounding.

    .venv/bin/python tests/as_processor.py generic .venv/bin/pytest tests/core/physics

numba compiles for that processor; numpy, its linear algebra and the C library do not use the code
that they have for newer ones. Where this processor can't run the other's code, the script says so
and exits with 77. Set `NUMBA_CACHE_DIR` to a folder for each processor.
"""

from __future__ import annotations

import os
import platform
import sys
from dataclasses import dataclass

CANNOT = 77  # exit code
NUMPY_WITHOUT = "NPY_DISABLE_CPU_FEATURES"


@dataclass(frozen=True)
class Processor:
    """The features of an x86-64 processor, as each library names them."""

    needs: frozenset[str]  # LLVM's features beyond those of 2003
    openblas: str
    numpy: frozenset[str]  # levels that numpy has code for
    without: str = ""  # glibc's features that it lacks


OF_2013 = frozenset(("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"))
AVX_512 = frozenset(("avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"))

PROCESSORS = {  # by LLVM's names
    "generic": Processor(frozenset(), "Nehalem", frozenset(), "-AVX2,-AVX,-FMA,-FMA4"),
    "haswell": Processor(OF_2013, "Haswell", frozenset(("X86_V3",))),
    "skylake-avx512": Processor(OF_2013 | AVX_512, "SkylakeX", frozenset(("X86_V3", "X86_V4"))),
}


def missing(name: str) -> list[str]:
    """The features that this processor lacks to run code for the named one."""
    if platform.machine() not in {"x86_64", "AMD64"}:
        return ["x86-64"]
    from llvmlite import binding

    here = binding.get_host_cpu_features()
    return sorted(feature for feature in PROCESSORS[name].needs if not here.get(feature))


def environment(name: str) -> dict[str, str]:
    """The environment that makes libraries take this processor for the named one."""
    import numpy as np

    processor = PROCESSORS[name]
    levels = set(np.show_config(mode="dicts")["SIMD Extensions"].get("found", []))
    levels |= set(os.environ.get(NUMPY_WITHOUT, "").split())  # where we run inside of ourselves
    return {
        "NUMBA_CPU_NAME": name,
        "NUMBA_CPU_FEATURES": "",  # else those of this processor stay
        NUMPY_WITHOUT: " ".join(sorted(levels - processor.numpy)),
        "OPENBLAS_CORETYPE": processor.openblas,
        "GLIBC_TUNABLES": f"glibc.cpu.hwcaps={processor.without}",
    }


def main() -> None:
    """Replace this process with the command, or say why that is impossible."""
    name, *command = sys.argv[1:]
    if lacking := missing(name):
        sys.stderr.write(f"its code does not run here, for lack of {', '.join(lacking)}\n")
        sys.exit(CANNOT)
    os.execvpe(command[0], command, {**os.environ, **environment(name)})  # noqa: S606


if __name__ == "__main__":
    main()
