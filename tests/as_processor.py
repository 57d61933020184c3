"""Runs a command as a processor of another level of x86-64 would run it, rounding for rounding.

    .venv/bin/python tests/as_processor.py x86-64-v2 .venv/bin/pytest tests/core/physics

Our code is compiled for that level; numpy, its linear algebra and the C library do not use the code
that they have for newer processors. Where this processor can't run the other's code, the script
says so and exits with 77.
"""

import os
import platform
import sys
from dataclasses import dataclass

CANNOT = 77  # exit code
NUMPY_WITHOUT = "NPY_DISABLE_CPU_FEATURES"
V2, V3, V4 = "x86-64-v2", "x86-64-v3", "x86-64-v4"


@dataclass(frozen=True)
class Processor:
    """What libraries use on processors of a level, as each library names it."""

    level: str  # of our code
    openblas: str
    numpy: frozenset[str]  # levels that numpy has code for
    without: str = ""  # glibc's features that it lacks
    needs: frozenset[str] = frozenset()  # LLVM's features, beyond those of the level of our code


AVX_512 = frozenset(("avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"))

PROCESSORS = {
    V2: Processor(V2, "Nehalem", frozenset(), "-AVX2,-AVX,-FMA,-FMA4"),
    V3: Processor(V3, "Haswell", frozenset(("X86_V3",)), "-AVX512F,-AVX512VL"),
    V4: Processor(V3, "SkylakeX", frozenset(("X86_V3", "X86_V4")), needs=AVX_512),
}


def missing(name: str) -> list[str]:
    """The features that this processor lacks to run code for the named one."""
    if platform.machine() not in {"x86_64", "AMD64"}:
        return ["x86-64"]
    from llvmlite import binding

    from yehu_server.compile.levels import LEVELS

    here = binding.get_host_cpu_features()
    needs = LEVELS["x86_64"][PROCESSORS[name].level] | PROCESSORS[name].needs
    return sorted(feature for feature in needs if not here.get(feature))


def environment(name: str) -> dict[str, str]:
    """The environment that makes libraries take this processor for the named one."""
    import numpy as np

    processor = PROCESSORS[name]
    levels = set(np.show_config(mode="dicts")["SIMD Extensions"].get("found", []))
    levels |= set(os.environ.get(NUMPY_WITHOUT, "").split())  # where we run inside of ourselves
    return {
        "YEHU_LEVEL": processor.level,
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
