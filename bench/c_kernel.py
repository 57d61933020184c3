"""The model's loop in C (``bench/c/kernel.c``): its records written, compiled, and loaded."""

from __future__ import annotations

import ctypes
import platform
import shutil
import subprocess
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.physics import bow, elementary, friction, kernel, layout, power

SOURCE = Path(__file__).resolve().parent / "c" / "kernel.c"
TYPES = {"f8": "double", "i8": "int64_t", "u1": "uint8_t", "u2": "uint16_t", "b1": "bool"}
OPTIMISED = ("-O3", "-march=native")
# What jit.FASTMATH allows numba: sums reordered, multiply-adds fused, reciprocals; and, as in
# Python, no errno. NaN and infinity keep their meaning.
SAME_LICENCE = (
    "-ffp-contract=fast",
    "-fassociative-math",
    "-fno-signed-zeros",
    "-freciprocal-math",
    "-fno-trapping-math",
    "-fno-math-errno",
)
# gcc up to 12 does not know Zen 4 and takes vectors of 512 bits there, which are slower.
TUNED = ("-mprefer-vector-width=256",) if platform.machine() in {"x86_64", "AMD64"} else ()
FLAGS = (*OPTIMISED, *SAME_LICENCE, *TUNED)

Advance = Callable[[Any, Any, Any, Any], None]  # of model, state, controls, probes


class CompilerError(Exception):
    """The compiler refused."""


class NoCompilerError(CompilerError):
    """There is no such compiler."""


def constants() -> dict[str, int | float]:
    """Every plain constant of the modules that the loop is made of."""
    return {
        name: value
        for module in (layout, elementary, power, bow, friction, kernel)
        for name, value in vars(module).items()
        if name.isupper() and type(value) in {int, float}
    }


def struct(name: str, record: np.dtype[Any]) -> str:
    """A C struct with the fields, shapes and, asserted, the places of a numpy record."""
    members = []
    asserts = [f'_Static_assert(sizeof(struct {name}) == {record.itemsize}, "{name}");']
    end = 0
    for field, (dtype, offset, *_) in (record.fields or {}).items():
        if offset - end >= dtype.alignment:
            members.append(f"    char before_{field}[{offset - end}];")
        end = offset + dtype.itemsize
        shape = "".join(f"[{size}]" for size in dtype.shape)
        members.append(f"    {TYPES[dtype.base.str[1:]]} {field}{shape};")
        place = f"offsetof(struct {name}, {field})"
        asserts.append(f'_Static_assert({place} == {offset}, "{name}.{field}");')
    if record.itemsize - end >= record.alignment:
        members.append(f"    char after[{record.itemsize - end}];")
    return "\n".join([f"struct {name} {{", *members, "};", *asserts])


def header() -> str:
    """``records.h``: the constants, and the records of model and state."""
    lines = ["#include <stdbool.h>", "#include <stddef.h>", "#include <stdint.h>"]
    for name, value in constants().items():
        text = value.hex() if isinstance(value, float) else str(value)
        lines.append(f"#define {name} ({text})")
    return "\n".join([*lines, struct("model", layout.MODEL), struct("state", layout.STATE), ""])


def compiler_version(compiler: str) -> str:
    """What a compiler says it is. Errors: NoCompilerError."""
    if shutil.which(compiler) is None:
        raise NoCompilerError(f"no C compiler: {compiler} is not installed")
    told = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True)  # noqa: S603
    return told.stdout.splitlines()[0]


class CKernel:
    """The loop in C, compiled into a folder; called as `kernel.advance` is, without the ledger.

    Errors: NoCompilerError, CompilerError.
    """

    def __init__(self, folder: Path, compiler: str = "gcc", flags: Sequence[str] = FLAGS) -> None:
        self.version = compiler_version(compiler)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "records.h").write_text(header(), encoding="utf-8")
        library = folder / "kernel.so"
        command = [compiler, "-std=gnu11", *flags, "-shared", "-fPIC", f"-I{folder}"]
        command += [str(SOURCE), "-o", str(library), "-lm"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
        if done.returncode:
            raise CompilerError(f"{' '.join(command)}\n{done.stderr}")
        self._function = ctypes.CDLL(str(library)).advance
        self._function.restype = None

    def __call__(self, model: Any, state: Any, controls: Any, probes: Any) -> None:
        """Run the model over one row of controls a sample."""
        self.bound(model, state, controls, probes)()

    def bound(self, model: Any, state: Any, controls: Any, probes: Any) -> Callable[[], None]:
        """The same, to be called again and again on these arrays."""
        fingers, frames = int(model["fingers"][0]), len(controls)
        for array, columns in (
            (controls, layout.control_columns(fingers)),
            (probes, layout.probe_columns(fingers)),
        ):
            if array.shape != (frames, columns) or not array.flags.c_contiguous:
                raise ValueError(f"{frames} rows of {columns} columns, not {array.shape}")
        arrays = (model, state, controls, probes)
        places = [array.ctypes.data_as(ctypes.c_void_p) for array in arrays]  # keeps them alive
        return partial(self._function, *places, ctypes.c_int64(frames))
