"""The constants that the page's modules share with those of ``playing`` of the same names."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from yehu_server.analysis.pitch import NOTE_NAMES
from yehu_server.midi import channels, controllers, curves, messages
from yehu_server.params import preset, spec, table
from yehu_server.player import fingering
from yehu_server.player.calibration import OPEN_NOTES
from yehu_server.playing import learner, live, sources, tuning
from yehu_server.playing.range_policy import RangePolicy


def constants() -> dict[str, Any]:
    """The constants by the part of playing that they belong to, under their Python names."""
    return {
        "notes": {
            "NAMES": list(NOTE_NAMES),
            "OPEN": list(map(float, OPEN_NOTES)),
            **_of(fingering, "LOWEST_NOTE", "HIGHEST_NOTE", "OPEN_WITHIN"),
            "POLICIES": [policy.value for policy in RangePolicy],
        },
        "spec": _of(spec, "TURNED_ON") | {"CURVES": {each.name: each.value for each in spec.Curve}},
        "table": _of(table, "PREFIX", "UNIT"),
        "preset": {"PROGRAMS": [preset.PROGRAMS[0], preset.PROGRAMS[-1]]},
        "sources": _of(
            sources, "BEND", "PRESSURE", "POLY_PRESSURE", "VELOCITY", "NOTE", "OF_ONE_NOTE",
            "COARSE", "FINE_ABOVE", "STEPS", "FINEST", "CHANNELS", "RESERVED", "NO_NRPN",
        ),
        "binds": _of(curves, "PICKUP_WINDOW"),
        "controllers": {
            "KEPT_ON_RESET": sorted(
                table.TABLE[row].address for row in (controllers.VOLUME, controllers.PAN)
            ),
            "SPRUNG": [sources.BEND, sources.PRESSURE],
            **_of(controllers, "FINE_BITS"),
        },
        "midiChannel": {
            **_of(messages, "DATA_ENTRY", "DATA_ENTRY_FINE", "INCREMENT", "DECREMENT", "NRPN_FINE"),
            "NRPN": messages.NRPN_COARSE,
            "RPN": messages.RPN_COARSE,
            **_of(messages, "RPN_FINE"),
        },
        "messages": {
            **_of(messages, "BANK", "BANK_FINE", "SUSTAIN", "ALL_SOUND_OFF", "RESET_CONTROLLERS"),
            **_of(messages, "ALL_NOTES_OFF"),
            "SUSTAIN_SOURCE": sources.control(messages.SUSTAIN),
            "BEND_RANGE": list(divmod(messages.BEND_RANGE, 128)),
            "MPE_CONFIGURATION": list(divmod(messages.MPE_CONFIGURATION, 128)),
            **_of(channels, "PERCUSSION"),
        },
        "zones": _of(
            channels, "LOWER_MASTER", "UPPER_MASTER", "MOST_MEMBERS", "MEMBER_BEND", "MASTER_BEND",
        ),
        "tuning": _of(tuning, "KEYS", "STANDARD_A4"),
        "learner": _of(learner, "DISTANCE", "AT_REST"),
        "live": _of(live, "ELSEWHERE"),
    }  # fmt: skip


def _of(module: ModuleType, *names: str) -> dict[str, Any]:
    return {name: _plain(getattr(module, name)) for name in names}


def _plain(value: Any) -> Any:
    """A value of JSON's types; a range becomes its first and its last number."""
    if isinstance(value, range):
        return [value[0], value[-1]]
    if isinstance(value, set | frozenset):
        return sorted(value)
    return list(value) if isinstance(value, tuple) else value
