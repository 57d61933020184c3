"""The table of OSC calls beside the parameters: what each does, and how clients are shown it.

``playing_calls``, ``preset_calls``, ``learn_calls`` and ``server_calls`` have the rows, each beside
the method that carries it out; docs/osc.md describes them.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import partial

from yehu_server.errors import RefusedError
from yehu_server.live.osc.call import Argument, Call, CountError, KindError, Request
from yehu_server.live.osc.context import Act, CallContext, GroupCalls
from yehu_server.live.osc.learn_calls import LearnCalls
from yehu_server.live.osc.playing_calls import PartCalls
from yehu_server.live.osc.preset_calls import PRESETS, PresetCalls
from yehu_server.live.osc.server_calls import ServerCalls
from yehu_server.live.part_addresses import FIRST, group_of
from yehu_server.params.table import PREFIX, UNIT
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.player import Player
from yehu_server.playing.sources import is_address

_KINDS: tuple[type[GroupCalls], ...] = (PartCalls, PresetCalls, LearnCalls, ServerCalls)
_ROWS = [(kind, row) for kind in _KINDS for row in vars(kind).values() if isinstance(row, Call)]
CALLS: tuple[Call, ...] = tuple(row for _, row in _ROWS)
NAMED_IN_FULL = frozenset(call.address for call in CALLS if not call.takes_patterns)


def acts(group: str, context: CallContext) -> dict[str, Act]:
    """What carries out each call of a group, and sets each of its parameters, by address."""
    carriers = {kind: kind(group, context) for kind in _KINDS}
    part = PartCalls(group, context)
    found: dict[str, Act] = {}
    for param in part.params:
        found[param.address] = partial(part.set, param=param)
        found[param.address + UNIT] = partial(part.set_unit, param=param)
    for kind, row in _ROWS:
        if not (group and row.is_for_all):
            act = partial(_carry_out, row, carriers[kind])
            waiting = partial(carriers[kind].after_writes, row.address, act)
            found[row.address] = waiting if row.reads_files else act
    return {group + address: act for address, act in found.items()}


def _carry_out(row: Call, carrier: GroupCalls, request: Request) -> None:
    """Carry out a call; the error of wrong arguments names them."""
    try:
        if not (row.is_momentary and request.is_let_go):
            row.act(carrier, request)
    except CountError as error:
        names = " ".join(argument.name.upper() for argument in row.arguments)
        raise RefusedError(f"{error} ({names})" if names else str(error)) from None
    except KindError as error:
        own = row.arguments[error.place : error.place + 1] or (
            Argument(f"argument {error.place + 1}"),
        )
        raise RefusedError(f"{own[0].name.upper()}: {own[0].wanted}, got {error.given}") from None


def preset_calls(names: tuple[str, ...], group: str = FIRST) -> list[Call]:
    """The calls of a group that take a preset, with the names there are."""

    def with_names(argument: Argument) -> Argument:
        return replace(argument, choices=names) if argument in PRESETS else argument

    return [
        replace(
            call,
            address=PREFIX + group + call.address,
            arguments=tuple(map(with_names, call.arguments)),
        )
        for call in CALLS
        if not PRESETS.isdisjoint(call.arguments)
    ]


def own_calls(mapping: Mapping, group: str = FIRST, below: str = "") -> list[Call]:
    """The user's own OSC addresses that a mapping of a group binds, `below` another, as calls."""
    return [
        Call(
            below + bind.source,
            f"Moves {PREFIX}{group}{bind.target}, by the mapping {mapping.name}.",
            (Argument("place", lo=min(bind.input_range), hi=max(bind.input_range)),),
            partial(PartCalls.move, bind=bind),
        )
        for bind in mapping.binds
        if is_address(bind.source)
    ]


def owners(mappings: Iterable[Mapping]) -> dict[str, int]:
    """The part, from 0, that each of the user's own addresses moves where it is sent without one.

    That is the part that its bind names, else the first whose mapping binds it.
    """
    found: dict[str, int] = {}
    for part, mapping in enumerate(mappings):
        for bind in mapping.binds:
            if is_address(bind.source) and (bind.part == part + 1 or bind.source not in found):
                found[bind.source] = part
    return found


def more_calls(players: Sequence[Player]) -> list[Call]:
    """The calls with the presets there are, and the user's own addresses, of some parts."""
    names = tuple(players[0].presets.names())
    calls = preset_calls(names)
    own_parts = owners(player.mapping for player in players)
    for part, player in enumerate(players):
        mapping = player.mapping
        own = own_calls(mapping, group_of(part) if part else FIRST)
        calls += [call for call in own if own_parts[call.address] == part]
        if len(players) > 1:
            calls += preset_calls(names, group_of(part))
            calls += own_calls(mapping, group_of(part), PREFIX + group_of(part))
    return calls
