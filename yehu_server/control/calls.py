"""The table of OSC calls beside the parameters, for OSCQuery and the surfaces.

``osc.OscHandler`` carries them out; docs/osc.md describes them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from yehu_server.params.table import PREFIX, find
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
    """A call: its address after the prefix, what it does, and its arguments."""

    address: str
    doc: str
    arguments: tuple[Argument, ...] = ()


def _of(address: str, name: str) -> Argument:
    """An argument with the range of a parameter."""
    param = find(address)
    return Argument(name, lo=param.lo, hi=param.hi, unit=param.unit)


NOTE = Argument("note", lo=0.0, hi=127.0, unit="MIDI note")
SECONDS = Argument("seconds", lo=0.0, hi=LONGEST_SUBSCRIPTION_S, unit="s")
NAME = Argument("name", "s")
FROM, TO = Argument("from", "s"), Argument("to", "s")
AMOUNT = Argument("amount", lo=0.0, hi=1.0)

CALLS: tuple[Call, ...] = (
    Call(
        "/note",
        "Begins a note; velocity 0 ends it.",
        (NOTE, Argument("velocity", lo=0.0, hi=127.0)),
    ),
    Call("/note/off", "Ends a note.", (NOTE,)),
    Call("/pitch", "Slides the finger to a pitch: the sounding note's, or the next.", (NOTE,)),
    Call(
        "/bend",
        "Slides the finger away from the note.",
        (_of("/playing/bend", "semitones"),),
    ),
    Call(
        "/press",
        "How hard the finger presses the string.",
        (_of("/playing/press", "newtons"),),
    ),
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
    Call("/get", "Sends the value of a parameter, or a status value.", (Argument("address", "s"),)),
    Call("/params", "Sends all parameters: value, range, default, unit, meaning."),
    Call("/status", "Sends all status values."),
    Call("/subscribe", "Sends all parameters, and for some time every change.", (SECONDS,)),
    Call("/subscribe/unit", "The same, with values as 0 to 1, at ADDRESS/unit.", (SECONDS,)),
    Call(
        "/subscribe/status", "Sends all status values, and for some time every change.", (SECONDS,)
    ),
    Call("/unsubscribe", "Ends all subscriptions."),
    Call("/preset/load", "Sets the parameters of a preset.", (NAME,)),
    Call("/preset/morph", "Sets values between those of two presets.", (FROM, TO, AMOUNT)),
    Call("/preset/save", "Saves the parameters as a preset.", (NAME,)),
    Call("/preset/delete", "Removes a preset of the player's own.", (NAME,)),
    Call("/preset/list", "Sends all presets: name, MIDI program, description."),
    Call(
        "/learn",
        "Binds the controller that is moved next to a parameter; without one, ends learning.",
        (Argument("address", "s"),),
    ),
    Call("/unlearn", "Forgets what was learned for a parameter.", (Argument("address", "s"),)),
    Call("/bindings", "Sends all bindings: source, target, span, curve, place, value."),
    Call("/record/start", "Records into the recordings folder.", (NAME,)),
    Call("/record/stop", "Ends the recording."),
    Call("/ping", "Answers with the same arguments."),
)


def preset_calls(names: tuple[str, ...]) -> list[Call]:
    """The calls that take a preset, with the names there are; addresses include the prefix."""
    choice = replace(NAME, choices=names)
    takes = {
        "/preset/load": (choice,),
        "/preset/morph": (replace(FROM, choices=names), replace(TO, choices=names), AMOUNT),
    }
    return [
        replace(call, address=PREFIX + call.address, arguments=takes[call.address])
        for call in CALLS
        if call.address in takes
    ]


def own_calls(mapping: Mapping) -> list[Call]:
    """The OSC addresses of the user's own that a mapping binds, as calls."""
    return [
        Call(
            bind.source,
            f"Moves {PREFIX}{bind.target}, by the mapping {mapping.name}.",
            (Argument("place", lo=min(bind.input_range), hi=max(bind.input_range)),),
        )
        for bind in mapping.binds
        if is_address(bind.source)
    ]
