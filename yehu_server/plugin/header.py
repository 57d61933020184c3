"""Write the C++ header of a plug-in: its parameters, and what it carries."""

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.plugin.carried import Carried
from yehu_server.plugin.parameters import (
    ARTICULATION,
    CHANCE,
    MAPPING,
    PRESET,
    ROOM,
    TUNING,
    HostParameter,
)
from yehu_server.util import __version__

Array = Any

IDENTITY = "yehu-server.yehu"
LV2_URI = "urn:yehu-server:yehu"
# Of VST3, at random, for ever.
VST3_ID = (0x6C1B9E54, 0x3F0A4D27, 0x9D52E8B1, 0x70C4A63F)
# Status, controller, neutral value, and the range of the expression. Bends are of the 48 semitones
# of a member channel.
EXPRESSIONS = {
    "volume": (0xB0, 7, 127, 0.0, 1.0),
    "pan": (0xB0, 10, 64, 0.0, 1.0),
    "tuning": (0xE0, 0, 64, -48.0, 48.0),
    "vibrato": (0xB0, 77, 0, 0.0, 1.0),
    "expression": (0xB0, 11, 127, 0.0, 1.0),
    "brightness": (0xB0, 74, 64, 0.0, 1.0),
    "pressure": (0xD0, 0, 0, 0.0, 1.0),
}
# Parameters that the wrappers ask for, and those that the window has sliders of.
PLACES = {
    "RELEASE": "/playing/release",
    "DECAY": "/room/decay",
    "VIBRATO": "/playing/vibrato",
    "VIBRATO_RATE": "/playing/vibrato_rate",
    "VIBRATO_DELAY": "/playing/vibrato_delay",
    "DYNAMICS": "/playing/dynamics",
    "BOW_POSITION": "/playing/bow_position",
    "PRESSURE_OF_BOW": "/playing/pressure",
    "BRILLIANCE": "/playing/brilliance",
    "ROOM_LEVEL": "/room/level",
    "ROOM_DISTANCE": "/room/distance",
    "ROOM_PAN": "/room/pan",
    "SWAY": "/body/sway",
    "GAIN": "/output/gain",
}
OUTLINE = """\
/* The parameters of the plug-in, and the presets, mappings and tunings it carries. Generated. */
#ifndef YEHU_CARRIED_H
#define YEHU_CARRIED_H

#include <stdint.h>

#define YEHU_VERSION "{version}"
#define YEHU_IDENTITY "{identity}"
#define YEHU_LV2_URI "{uri}"
#define YEHU_VST3_ID V3_ID({vst3})

namespace yehu {{

struct Parameter {{
    uint32_t number;   /* for ever */
    int32_t index;     /* in the instrument; -1: a choice of the plug-in's own */
    int32_t steps;     /* 0: continuous */
    bool exponential;  /* equal steps are equal ratios */
    double lo, hi, usual;
    const char *address, *name, *group, *unit;
    const char *const *choices; /* one for each step; or null */
}};
struct Expression {{ int32_t status, controller, neutral; double lo, hi; }};
struct Value {{ int32_t parameter; double value; }};
struct Values {{ int32_t count; const Value *values; }};
/* Runs of words of yehu_tables: the number of the first, how many, and the words; again. */
struct Runs {{ int32_t words; const int64_t *word; }};

{choices}

static const Parameter parameters[] = {{
{parameters}
}};
enum {{ PARAMETERS = {count} }};
enum {{ PRESET = {preset}, ROOM = {room}, SETS }}; /* which set others; a value 0 is none of them */
enum {{ MAPPING = {mapping}, TUNING = {tuning}, CHANCE = {chance} }};
enum {{ ARTICULATION = {articulation}, ARTICULATIONS = {articulations} }};
/* Of each mapping the key that chooses the first articulation, others upwards; or -1. */
static const int16_t first_switches[] = {{{switches}}};

{lists}

/* The message that an expression of a note becomes, by its number in CLAP and VST3; neutral: the
 * value of a note without one. */
static const Expression expressions[] = {{
{expressions}
}};
enum {{ EXPRESSIONS = {expression_count} }};

{values}
static const Values *const sets[] = {{presets, rooms}};

{tables}

}} /* namespace yehu */

#endif
"""


def header(shown: Sequence[HostParameter], data: Carried) -> str:
    """Write the header.

    `shown`: all parameters, in the order that hosts see.
    """
    place = {parameter.address: index for index, parameter in enumerate(shown)}
    return OUTLINE.format(
        version=__version__,
        identity=IDENTITY,
        uri=LV2_URI,
        vst3=", ".join(f"0x{word:08X}u" for word in VST3_ID),
        choices="\n".join(_choices(shown)),
        parameters="\n".join(_parameter(index, each) for index, each in enumerate(shown)),
        count=len(shown),
        preset=place[PRESET],
        room=place[ROOM],
        mapping=place[MAPPING],
        tuning=place[TUNING],
        chance=place[CHANCE],
        articulation=place[ARTICULATION],
        articulations=len(ARTICULATIONS),
        switches=", ".join(map(str, data.switches.values())),
        lists="\n".join(_places(shown)),
        expressions="\n".join(
            f"    {{0x{status:02X}, {controller}, {neutral}, {lo:g}, {hi:g}}}, /* {name} */"
            for name, (status, controller, neutral, lo, hi) in EXPRESSIONS.items()
        ),
        expression_count=len(EXPRESSIONS),
        values="\n\n".join(
            "\n".join(_values(name, sets, place))
            for name, sets in (
                ("presets", data.presets),
                ("rooms", data.rooms),
                ("starts", data.starts),
            )
        ),
        tables="\n\n".join(
            "\n".join(_runs(name, sets))
            for name, sets in (("mappings", data.mappings), ("tunings", data.tunings))
        ),
    )


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=True)


def _choices(shown: Sequence[HostParameter]) -> Iterable[str]:
    for index, parameter in enumerate(shown):
        if parameter.choices:
            names = ", ".join(map(_text, parameter.choices))
            yield f"static const char *const choices_{index}[] = {{{names}}};"


def _parameter(index: int, each: HostParameter) -> str:
    numbers = ", ".join(f"{number:.17g}" for number in (each.lo, each.hi, each.default))
    texts = ", ".join(map(_text, (each.address, each.name, each.group, each.unit)))
    choices = f"choices_{index}" if each.choices else "nullptr"
    is_exponential = str(each.is_exponential).lower()
    return (
        f"    {{{each.number}u, {each.index}, {each.steps}, {is_exponential}, {numbers}, "
        f"{texts}, {choices}}},"
    )


def _places(shown: Sequence[HostParameter]) -> Iterable[str]:
    """What the wrappers ask of certain parameters."""
    for name, address in PLACES.items():
        place = next(i for i, each in enumerate(shown) if each.address == address)
        yield f"enum {{ {name} = {place} }};"


def _values(
    name: str, sets: Mapping[str, Mapping[str, float]], place: Mapping[str, int]
) -> Iterable[str]:
    for number, values in enumerate(sets.values()):
        if values:
            pairs = ", ".join(f"{{{place[a]}, {value:.17g}}}" for a, value in values.items())
            yield f"static const Value {name}_{number}[] = {{{pairs}}};"
    lists = (
        f"{{{len(values)}, {f'{name}_{number}' if values else 'nullptr'}}}"
        for number, values in enumerate(sets.values())
    )
    yield f"static const Values {name}[] = {{{', '.join(lists)}}};"


def _runs(name: str, sets: Mapping[str, Array]) -> Iterable[str]:
    for number, words in enumerate(sets.values()):
        listed = ", ".join(f"{word}LL" for word in words.tolist())
        yield f"static const int64_t {name}_{number}[] = {{{listed}}};"
    lists = (f"{{{len(words)}, {name}_{number}}}" for number, words in enumerate(sets.values()))
    yield f"static const Runs {name}[] = {{{', '.join(lists)}}};"
