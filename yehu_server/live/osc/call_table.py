"""The table of OSC calls beside the parameters, for OSCQuery and the surfaces.

``part_calls`` and ``handler`` carry them out; docs/osc.md describes them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from yehu_server.live.part_addresses import FIRST, group
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.table import PREFIX, find
from yehu_server.playing.live_player import LivePlayer
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.sources import is_address

LONGEST_SUBSCRIPTION_S = 3600.0


@dataclass(frozen=True)
class Argument:
    """An argument of a call: a number (``f``) in a range, or a string (``s``), maybe of `choices`.

    `kind` is its OSC type tag; `choices`, where there are any, are all that it may be.
    """

    name: str
    kind: str = "f"
    lo: float | None = None
    hi: float | None = None
    unit: str = "1"
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Call:
    """A call: its address after the prefix, what it does, and its arguments.

    `is_for_all` marks calls that no part has of its own.
    """

    address: str
    doc: str
    arguments: tuple[Argument, ...] = ()
    is_for_all: bool = False


def _of(address: str, name: str) -> Argument:
    """An argument with the range of a parameter."""
    param = find(address)
    return Argument(name, lo=param.lo, hi=param.hi, unit=param.unit)


NOTE = Argument("note", lo=0.0, hi=127.0, unit="MIDI note")
SECONDS = Argument("seconds", lo=0.0, hi=LONGEST_SUBSCRIPTION_S, unit="s")
VELOCITY = Argument("velocity", lo=0.0, hi=127.0)
ARTICULATION = Argument(
    "articulation", "s", choices=tuple(articulation.name for articulation in ARTICULATIONS)
)
ADDRESS, NAME = Argument("address", "s"), Argument("name", "s")
FROM, TO = Argument("from", "s"), Argument("to", "s")
AMOUNT = Argument("amount", lo=0.0, hi=1.0)

CALLS: tuple[Call, ...] = (
    Call("/note", "Begins a note; velocity 0 ends it.", (NOTE, VELOCITY)),
    Call("/note/off", "Ends a note.", (NOTE,)),
    Call("/pitch", "Slides the finger to a pitch: the sounding note's, or the next.", (NOTE,)),
    Call("/bend", "Slides the finger away from the note.", (_of("/playing/bend", "semitones"),)),
    Call("/press", "How hard the finger presses the string.", (_of("/playing/press", "newtons"),)),
    Call("/articulation", "Chooses what both hands do in the next notes.", (ARTICULATION,)),
    Call(
        "/bow",
        "Draws the bow by hand; no speed and no force lifts it.",
        (_of("/bow/speed", "speed"), _of("/bow/force", "force")),
    ),
    Call(
        "/release",
        "Gives the bow and fingers that you moved directly back to the player (no time).",
    ),
    Call("/panic", "Ends all notes and all sound, and drops messages that wait for their time."),
    Call("/reset", "The same, and sets every parameter to its default."),
    Call(
        "/get",
        "Sends the value of a parameter, or a status value.",
        (ADDRESS,),
        is_for_all=True,
    ),
    Call("/params", "Sends all parameters: value, range, default, unit, meaning."),
    Call("/status", "Sends all status values."),
    Call("/subscribe", "Sends all parameters, and for some time every change.", (SECONDS,)),
    Call("/subscribe/unit", "The same, with values as 0 to 1, at ADDRESS/unit.", (SECONDS,)),
    Call(
        "/subscribe/status", "Sends all status values, and for some time every change.", (SECONDS,)
    ),
    Call("/unsubscribe", "Ends all subscriptions.", is_for_all=True),
    Call("/preset/load", "Sets the parameters of a preset.", (NAME,)),
    Call("/preset/morph", "Sets values between those of two presets.", (FROM, TO, AMOUNT)),
    Call("/preset/save", "Saves the parameters as a preset.", (NAME,)),
    Call("/preset/delete", "Removes a preset of the player's own.", (NAME,), is_for_all=True),
    Call("/preset/list", "Sends all presets: name, MIDI program, description.", is_for_all=True),
    Call(
        "/learn",
        "Binds the controller that is moved next to a parameter; without one, ends learning.",
        (ADDRESS,),
    ),
    Call("/unlearn", "Forgets what was learned for a parameter.", (ADDRESS,)),
    Call("/bindings", "Sends all bindings: source, target, span, curve, place, value."),
    Call("/record/start", "Records into the recordings folder.", (NAME,), is_for_all=True),
    Call("/record/stop", "Ends the recording.", is_for_all=True),
    Call("/ping", "Answers with the same arguments.", is_for_all=True),
)


def preset_calls(names: tuple[str, ...], addressed: str = FIRST) -> list[Call]:
    """The calls of a group that take a preset, with the names there are.

    Addresses include the prefix.
    """
    choice = replace(NAME, choices=names)
    takes = {
        "/preset/load": (choice,),
        "/preset/morph": (replace(FROM, choices=names), replace(TO, choices=names), AMOUNT),
    }
    return [
        replace(call, address=PREFIX + addressed + call.address, arguments=takes[call.address])
        for call in CALLS
        if call.address in takes
    ]


def own_calls(mapping: Mapping, addressed: str = FIRST, below: str = "") -> list[Call]:
    """The OSC addresses of the user's own that a mapping of a group binds, as calls.

    `below` is put before the addresses.
    """
    return [
        Call(
            below + bind.source,
            f"Moves {PREFIX}{addressed}{bind.target}, by the mapping {mapping.name}.",
            (Argument("place", lo=min(bind.input_range), hi=max(bind.input_range)),),
        )
        for bind in mapping.binds
        if is_address(bind.source)
    ]


def more_calls(players: Sequence[LivePlayer]) -> list[Call]:
    """The calls with the presets there are, and the user's own addresses, of some parts."""
    names = tuple(players[0].presets.names())
    calls = preset_calls(names)
    plain: dict[str, Call] = {}  # of the first part that binds each
    for part, player in enumerate(players):
        mapping = player.mapping
        own = own_calls(mapping, group(part) if part else FIRST)
        plain = {call.address: call for call in own} | plain
        if len(players) > 1:
            calls += preset_calls(names, group(part))
            calls += own_calls(mapping, group(part), PREFIX + group(part))
    return [*calls, *plain.values()]
