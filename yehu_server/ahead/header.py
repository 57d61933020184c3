"""Write the C header of the library: its functions, wishes, parameters, and what `look` sees."""

from __future__ import annotations

import inspect
import re
from collections.abc import Sequence

from yehu_server.engine.look import LOOK
from yehu_server.jit import Native
from yehu_server.params.table import TABLE
from yehu_server.player.wishes import KINDS

KINDS_OF_C = {
    "void": "void",
    "voidptr": "void *",
    "int64": "int64_t ",
    "float64": "double ",
}
OUTLINE = """\
/* The yehu, a Chinese fiddle, as a library: a physical model and its player, without Python.
 *
 * Give an instrument yehu_size() bytes aligned to 64, prepare it at a rate, post wishes for
 * numbered frames, and compute blocks of samples: left and right in turn, or one channel. Nothing
 * is allocated.
 *
 *     void *yehu = aligned_alloc(64, (yehu_size() + 63) / 64 * 64);
 *     yehu_prepare(yehu, 48000.0, 2);
 *     yehu_post(yehu, 0, YEHU_BEGIN, 0, 69.0, 69.0);
 *     yehu_process(yehu, out, 256);
 *
 * Made by yehu-server {version} from sources {sources}. Rates: {rates} Hz.
 */
#ifndef YEHU_H
#define YEHU_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {{
#endif

#define YEHU_SOURCES "{sources}"

/* Kinds of wishes: what each asks for, and what its index, value and other are.
{wishes} */
enum yehu_wish {{
{kinds}
}};

/* Parameters, by number: index of YEHU_WRITE, YEHU_HOLD and YEHU_EXPRESS. */
enum yehu_parameter {{
{parameters}
}};

/* What yehu_look sees. */
struct yehu_look {{
{look}
}};

{functions}

#ifdef __cplusplus
}}
#endif

#endif
"""


def header(
    functions: Sequence[Native], *, version: str, sources: str, rates: Sequence[float]
) -> str:
    """Write the header of a library of some functions.

    Parameters
    ----------
    sources : str
        The hash of what it is made from.
    rates : sequence of float
        The rates (Hz) that it can be prepared at.
    """
    from yehu_server.player import wishes

    table = (wishes.__doc__ or "").partition("\n\n")[2].strip()
    return OUTLINE.format(
        version=version,
        sources=sources,
        rates=", ".join(f"{rate:g}" for rate in rates),
        wishes="\n".join(f" * {line}" for line in table.splitlines() if "---" not in line),
        kinds="\n".join(f"    YEHU_{kind.upper()} = {i}," for i, kind in enumerate(KINDS)),
        parameters="\n".join(map(_parameter, range(len(TABLE)))),
        look="\n".join(map(_member, LOOK.names or ())),
        functions="\n\n".join(map(_prototype, functions)),
    )


def _parameter(row: int) -> str:
    param = TABLE[row]
    name = re.sub(r"[^A-Z0-9]+", "_", param.address.upper()).strip("_")
    unit = f" {param.unit}" if param.unit else ""
    return (
        f"    /* {param.doc} {param.lo:g} to {param.hi:g}{unit}; at first {param.default:g}. */\n"
        f"    YEHU_{name} = {row},"
    )


def _member(name: str) -> str:
    shape = LOOK[name].shape
    return f"    double {name}{''.join(f'[{size}]' for size in shape)};"


def _prototype(function: Native) -> str:
    returned, _, taken = function.signature.partition("(")
    names = list(inspect.signature(function.function).parameters)
    kinds = [KINDS_OF_C[kind.strip()] for kind in taken.rstrip(")").split(",") if kind.strip()]
    arguments = ", ".join(f"{kind}{name}" for kind, name in zip(kinds, names, strict=True))
    summary = inspect.cleandoc(function.function.__doc__ or "").partition("\n\n")[0]
    about = " ".join(summary.replace("`", "").split())
    kind = "void " if returned == "void" else KINDS_OF_C[returned]
    return f"/* {about} */\n{kind}{function.name}({arguments or 'void'});"
