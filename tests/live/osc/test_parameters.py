"""Parameters by OSC: set, echoed, asked for, by pattern, and what is refused."""

import itertools
import math

import pytest
from wire import f32, values

from yehu_server.live.osc import clients
from yehu_server.params.spec import Place
from yehu_server.params.table import NAMES, offered
from yehu_server.params.table import TABLE as ALL

# A section has as many players as there are, whatever is asked for.
TABLE = [param for param in ALL if param.address != "/playing/section"]
CONTINUOUS = [param for param in TABLE if not param.is_choice]
CHOICES = [param for param in ALL if param.is_choice]


def test_every_parameter_is_set_echoed_asked_for_and_kept_within_its_bounds(still):
    for param in CONTINUOUS:
        third = param.lo + (param.hi - param.lo) / 3.0
        for sent, accepted in (
            *((param.hi, param.hi), (param.lo, param.lo), (third, third)),
            *((1e30, param.hi), (-1e30, param.lo), (param.default, param.default)),
        ):
            sent_back = [("/yehu" + param.address, [f32(accepted)])]
            assert still.ask(param.address, sent) == sent_back
            assert still.ask("/get", param.address) == sent_back
        if param.place is Place.ENGINE:
            still.pass_time(0.02)
            assert still.target(param.address) == pytest.approx(param.default, rel=1e-6)


def test_every_parameter_also_answers_as_zero_to_one(still):
    for param in TABLE:
        at = param.address + "/unit"
        there = offered(param)  # the faders of surfaces end where its choices do
        for sent in (1.0, 0.0, 0.25, 7.0, -7.0):
            value = there.from_unit(sent)
            value = math.floor(value + 0.5) if param.is_choice else value
            sent_back = [("/yehu" + at, [pytest.approx(there.to_unit(value), abs=1e-6)])]
            assert still.ask(at, sent) == sent_back
            assert still.ask("/get", at) == sent_back
            assert still.player.value(param.address) == value


def test_every_parameter_takes_any_number_and_refuses_what_is_none(still):
    numbers = [
        *((1, "i"), (-3, "i"), (2**31 - 1, "i"), (2**62, "h")),
        *((0.37, "f"), (0.37, "d"), (-1e300, "d"), (True, "T"), (False, "F")),
    ]
    others = [(), (0.5, 0.5), ("0.5",), (b"0.5",), (None,), (math.nan,), (math.inf,), (-math.inf,)]
    for param in CONTINUOUS:
        for value, tags in numbers:
            still.send(param.address, value, tags=tags)
            sent = f32(value) if tags == "f" else float(value)
            assert still.player.value(param.address) == min(max(sent, param.lo), param.hi)
        before = still.player.values()
        still.ask("/ping")  # all is sent
        still.clock.now += clients.FORGIVEN_S
        for arguments, tags in [*((words, None) for words in others), ((0.5,), "[f]")]:
            (refused,) = still.ask(param.address, *arguments, tags=tags)
            address, reason = refused.arguments
            assert (refused.address, address) == ("/yehu/error", "/yehu" + param.address)
            assert reason
        assert still.player.values() == before


def test_what_a_choice_answers_is_what_plays(still):
    for param in CHOICES:
        at = param.address
        numbers = NAMES.get(at, {}).values() or (param.lo, param.hi)
        lo, hi = min(numbers), max(numbers)
        for sent in (lo, lo + 0.4, lo + 0.5, hi):
            plays = math.floor(sent + 0.5) if at != "/playing/section" else 1.0
            assert still.ask(at, sent) == [("/yehu" + at, [plays])]
            assert still.player.value(at) == plays
        for sent in (lo - 1.0, hi + 1.0, 1e30, "spicato"):
            (refused,) = still.ask(at, sent)
            what = "number" if sent == "spicato" else f"whole number from {lo:g} to {hi:g}, got"
            assert what in refused.arguments[1]
            assert still.player.value(at) == plays
            still.clock.now += clients.FORGIVEN_S
    for at, name, number in (
        ("/playing/articulation", "spiccato", NAMES["/playing/articulation"]["spiccato"]),
        ("/playing/direction", "up", -1.0),
    ):
        assert still.ask(at, name) == [("/yehu" + at, [number])]


def test_reset_puts_every_parameter_back_and_tells(still):
    for param in TABLE:
        still.send(param.address, param.lo)
    heard = values(still.ask("/reset"))
    assert heard == {"/yehu" + param.address: f32(param.default) for param in ALL}
    still.pass_time(0.1)
    for param in TABLE:
        assert still.player.value(param.address) == param.default
        moves = [value for _, address, value in still.events if address == param.address]
        if param.place is Place.ENGINE and param.lo != param.default:
            assert moves[-1] == param.default


def test_parameters_are_listed_with_all_that_a_client_needs(shared_server):
    client = shared_server.client()
    client.send("/params")
    heard = list(itertools.takewhile(lambda m: m.address == "/yehu/param", iter(client.next, 0)))
    assert [message.arguments for message in heard] == [
        [
            "/yehu" + param.address,
            f32(shared_server.player.value(param.address)),
            *map(f32, (param.lo, param.hi, param.default)),
            param.unit,
            param.doc,
        ]
        for param in ALL
    ]


# ---------------------------------------------------------------- asking for values


@pytest.mark.parametrize("address", ["/bow/force", "/playing/pressure"])
def test_a_get_after_a_set_answers_the_value_set_while_python_is_busy(shared_server, busy, address):
    client = shared_server.client()
    with busy():
        for step in range(100):
            value = f32(0.3 + 0.001 * step)
            client.send(address, value)
            client.send("/get", address)
            client.send("/ping", step)
            sent_back = list(iter(client.next, ("/yehu/pong", [step])))
            # The value set before may be echoed, first or, on a busy machine, last.
            assert ("/yehu" + address, [value]) in sent_back
    assert shared_server.is_well()


# ---------------------------------------------------------------- patterns


def test_a_pattern_sets_all_that_it_fits(still):
    heard = values(still.ask("/bow/{force,position}", 0.3))
    assert heard == {"/yehu/bow/force": f32(0.3), "/yehu/bow/position": f32(0.3)}
    heard = values(still.ask("/*/speed", 0.25))
    assert heard == {"/yehu/bow/speed": 0.25, "/yehu/playing/speed": 0.25}
    pressed = {f"/yehu/finger/{number}/press": 2.0 for number in (1, 2, 3, 4)}
    assert values(still.ask("/finger/?/pre[a-z]s", 2.0)) == pressed
    assert values(still.ask("/get", "/finger/?/pre[a-z]s")) == pressed


def test_a_message_alone_is_a_single_step_and_others_are_one_each(still, wire):
    message, past = wire.message("/yehu/playing/pressure", 0.3), still.clock.time() - 1.0
    assert list(still.handler.handle(message, still.peer)) == []
    assert still.value("/playing/pressure") == pytest.approx(0.3)
    for several in (wire.bundle(past, *[message] * 3), wire.message("/yehu/finger/?/press", 0.0)):
        assert len([*still.handler.handle(several, still.peer)]) >= 2


def test_a_held_parameter_refuses_other_values_and_says_where_it_stays(still):
    still.player.hold("/playing/pressure", 0.5)
    still.pass_time(0.01)
    assert "error" not in str(still.ask("/playing/pressure", 0.5))
    (error,) = still.ask("/playing/pressure", 99.0)
    assert error.arguments[1] == "is held at 0.5 by --set; /yehu/release frees it"


def test_true_and_false_are_no_numbers_but_of_switches(still):
    for call, *words in (
        ("/note", True, 90.0),
        ("/note", 67.0, True),
        ("/note/off", True),
        ("/pitch", True),
        ("/bow", 0.2, True),
        ("/subscribe", True),
    ):
        (refused,) = still.ask(call, *words)
        assert "got T" in refused.arguments[1]
        still.clock.now += clients.FORGIVEN_S
    assert still.ask("/bow/assist", False)[0].arguments == [0.0]


def test_a_fader_as_velocity_is_told_once_of_the_range(still):
    heard = still.ask("/note", 67.0, 0.8) + still.ask("/note", 67.0, 0.7)
    assert [m.arguments for m in heard if m.address == "/yehu/moved"] == [
        ["/yehu/note", "velocity 0.8 is nearly silent: it is 1 to 127"]
    ]
