"""Write the C header of the library: functions, events, parameters, tables, snapshots."""

import inspect
import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from types import ModuleType
from typing import Any

from yehu_server.compile.jit import Native
from yehu_server.core.engine.snapshot import SNAPSHOT
from yehu_server.core.midi import events, packing, tables
from yehu_server.core.midi.record import PORT_COUNT
from yehu_server.core.player import commands
from yehu_server.params.table import TABLE

WIDTH = 100
READ_ONLY = ("data", "tables")  # arguments that point to what a function reads
CODES = {
    "SOURCE": ("PAIR", "BEND", "PRESSURE", "POLY_PRESSURE", "VELOCITY", "NOTE", "NRPN", "CONTROL"),
    "CURVE": ("LINEAR", "EXPONENTIAL", "S", "POINTS"),
    "RANGE": ("TRANSPOSE", "CLAMP", "SKIP"),
}
KINDS_OF_C = {"void": "void ", "voidptr": "void *", "int64": "int64_t ", "float64": "double "}
OUTLINE = """\
/* The yehu, a Chinese fiddle, as a library: a physical model and its player, without Python.
 *
 * Give an instrument yehu_size() bytes aligned to 64, prepare it at a rate, play MIDI at numbered
 * frames, or post events, and compute blocks of samples: left and right in turn, or one channel.
 * Nothing is allocated.
 *
 *     void *yehu = aligned_alloc(64, (yehu_size() + 63) / 64 * 64);
 *     uint8_t note_on[] = {{0x90, 69, 100}};
 *     yehu_prepare(yehu, 48000.0, 2);
 *     yehu_midi(yehu, 0, note_on, sizeof note_on);
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

/* Kinds of events. Some say what the player is to do: what their index, value and other are.
{commands}
 *
 * The others are interpreted, by mapping and tuning. yehu_midi, yehu_control and yehu_use_tables
 * post MESSAGE (of port 0; see YEHU_PACKED), CONTROL and TABLES_TO.
{events} */
enum yehu_event {{
{kinds}
}};

/* The index of MESSAGE: the bytes of a MIDI message, 0 for those that it does not have, their
 * number (1 to 3), and its port (0 to {last_port}), which has 16 channels of its own. */
#define YEHU_PACKED(status, one, two, length, port) \\
    ((int64_t)(status) | (int64_t)(one) << {byte} | (int64_t)(two) << {twice} \\
     | (int64_t)(length) << {length_at} | (int64_t)(port) << {port_at})

/* Parameters, by number: index of YEHU_WRITE, YEHU_HOLD, YEHU_EXPRESS, YEHU_SET and YEHU_LOAD. */
enum yehu_parameter {{
{parameters}
}};

/* Codes of yehu_tables. A source is the number of a control change; PAIR and the coarse half of
 * one of 14 bits; NRPN and its number; CONTROL and the number of a named control; or another. */
enum yehu_code {{
{codes}
}};

/* What yehu_use_tables takes: a mapping, a tuning, presets. `yehu-server build tables` writes it
 * for files; parameters have the numbers of its own version. It has {table_bytes} bytes. */
struct yehu_tables {{
{tables}
}};

/* What yehu_snapshot copies. */
struct yehu_snapshot {{
{snapshot}
}};
#define yehu_look yehu_snapshot /* its name in earlier versions */

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

    `sources`: the hash of what it is made from.
    `rates`: the rates (Hz) that it can be prepared at.
    """
    kinds = (*commands.KINDS, *events.EVENTS)
    return OUTLINE.format(
        version=version,
        sources=sources,
        rates=", ".join(f"{rate:g}" for rate in rates),
        commands=_table(commands),
        events=_table(events),
        kinds="\n".join(f"    YEHU_{kind.upper()} = {i}," for i, kind in enumerate(kinds)),
        last_port=PORT_COUNT - 1,
        byte=packing.BYTE_BITS,
        twice=2 * packing.BYTE_BITS,
        length_at=packing.LENGTH_SHIFT,
        port_at=packing.PORT_SHIFT,
        parameters="\n".join(map(_parameter, range(len(TABLE)))),
        codes="\n".join(
            f"    YEHU_{group}_{name} = {getattr(tables, name)},"
            for group, names in CODES.items()
            for name in names
        ),
        table_bytes=tables.TABLES.itemsize,
        tables="\n".join(_members(tables.TABLES, _comments(tables, "TABLES"))),
        snapshot="\n".join(_members(SNAPSHOT)),
        functions="\n\n".join(map(_prototype, functions)),
    )


def _parameter(index: int) -> str:
    param = TABLE[index]
    name = re.sub(r"[^A-Z0-9]+", "_", param.address.upper()).strip("_")
    unit = f" {param.unit}" if param.unit else ""
    return (
        f"    /* {param.doc} {param.lo:g} to {param.hi:g}{unit}; at first {param.default:g}. */\n"
        f"    YEHU_{name} = {index},"
    )


def _table(module: ModuleType) -> str:
    """The table of a module's docstring, as lines of a comment."""
    lines = (module.__doc__ or "").splitlines()
    text = "\n".join(f" * {line}" for line in lines if line.startswith("| "))
    return text.replace("``midi.packing.packed``", "YEHU_PACKED")


def _members(record: Any, comments: Mapping[str, str] | None = None) -> Iterable[str]:
    """The members of a record of numbers; those that have a comment, with it."""
    for name in record.names:
        sizes = "".join(f"[{size}]" for size in record[name].shape)
        comment = (comments or {}).get(name)
        yield f"    double {name}{sizes};" + (f" /* {comment} */" if comment else "")


def _comments(module: ModuleType, record: str) -> dict[str, str]:
    """The comments that stand beside the fields of a record in its module."""
    source = inspect.getsource(module).partition(f"\n{record} = np.dtype(")[2].partition("\n)\n")[0]
    return dict(re.findall(r'\("(\w+)", .*?\),  # (.+)', source))


def _prototype(function: Native) -> str:
    names = list(inspect.signature(function.function).parameters)
    returned, *kinds = (KINDS_OF_C[kind] for kind in function.types)
    arguments = ", ".join(
        f"{'const ' if name in READ_ONLY else ''}{kind}{name}"
        for kind, name in zip(kinds, names, strict=True)
    )
    about = inspect.cleandoc(function.function.__doc__ or "").partition("\n\nParameters\n")[0]
    about = " ".join(about.replace("`", "").split())
    comment = textwrap.fill(f"/* {about} */", WIDTH, subsequent_indent=" * ")
    return f"{comment}\n{returned}{function.name}({arguments or 'void'});"
