"""Several parts by OSC: whose notes, values and services are whose."""

from pathlib import Path

import pytest
from web_client import walk
from wire import f32

from yehu_server.core.engine.instrument import Instrument
from yehu_server.live.osc import clients, handler
from yehu_server.live.osc.all_calls import CALLS, more_calls
from yehu_server.live.osc.osc_addresses import readable
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.status import PART_STATUS, STATUS
from yehu_server.live.part_addresses import OF_PARTS, group_of
from yehu_server.live.web.query import find, node_at
from yehu_server.params.preset_file import Preset
from yehu_server.params.table import TABLE
from yehu_server.playing import learn as learned
from yehu_server.playing.bind import Bind
from yehu_server.playing.learner import LearnedSource
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import player_of
from yehu_server.playing.player import Player

VOLUME = "/playing/volume"
SHARED = [param.address for param in TABLE if param.is_shared]
PARTS = 3


@pytest.fixture
def players(still) -> list[Player]:
    """Those of three parts; the first is the server's own."""
    more = []
    for part in range(1, PARTS):
        instrument = Instrument(
            PlayingOptions().spec(still.RATE, still.instrument.spec.calibration)
        )
        instrument.frame_at = still.instrument.frame_at
        still.others.append(instrument)
        more.append(player_of(part, PlayingOptions(), [instrument], delay_ms=3.0))
    still.handler = handler.OscHandler(still.services.context([still.player, *more]))
    return [still.player, *more]


def values(players, address: str = VOLUME) -> list[float]:
    return [round(player.value(address), 3) for player in players]


def keys(still, players) -> list[int]:
    """The number of keys that each part holds, after everything said up to now was played."""
    still.pass_time(0.01)
    return [player.keys for player in players]


def errors(heard) -> list[str]:
    return [one.arguments[1] for one in heard if one.address == "/yehu/error"]


def test_each_part_has_addresses_and_the_first_also_without_and_a_pattern_reaches_all(
    still, players
):
    for number, address in enumerate(["", "/part/1", "/part/2", "/part/3"]):
        heard = still.ask(address + VOLUME, 0.1 + 0.1 * number)
        assert [one.address for one in heard] == [f"/yehu{address}{VOLUME}"]
    assert values(players) == [0.2, 0.3, 0.4]
    still.ask("/part/2/playing/bow_position/unit", 1.0)
    assert values(players, "/playing/bow_position") == [0.13, 0.3, 0.13]
    still.ask("/part/*/playing/volume", 0.5)
    assert values(players) == [0.5, 0.5, 0.5]
    still.ask("/part/[23]/playing/volume", 0.25)
    assert values(players) == [0.5, 0.25, 0.25]
    heard = still.ask("/get", "/yehu/part/*/playing/volume")
    assert [one.arguments for one in heard] == [[0.5], [0.25], [0.25]]


def test_notes_are_of_their_part(still, players):
    still.send("/part/2/note", 67.0, 90.0)
    assert keys(still, players) == [0, 1, 0]
    still.send("/note", 69.0, 90.0)
    still.send("/part/3/note", 71.0, 90.0)
    still.send("/part/1/note/off", 69.0)
    assert keys(still, players) == [0, 1, 1]
    still.send("/part/3/panic")
    assert keys(still, players) == [0, 1, 0]
    still.send("/part/3/note", 71.0, 90.0)
    still.send("/panic")
    assert keys(still, players) == [0, 0, 0]


def test_a_part_is_reset_without_the_others_and_all_at_once(still, players):
    still.ask("/part/*/playing/volume", 0.5)
    still.ask("/room/size", 20.0)
    heard = still.ask("/part/2/reset")
    assert values(players) == [0.5, 1.0, 0.5]
    assert {one.address for one in heard} <= {f"/yehu/part/2{one}" for one in OF_PARTS}
    assert players[0].value("/room/size") == 20.0
    still.ask("/reset")
    assert values(players) == [1.0, 1.0, 1.0]
    assert players[0].value("/room/size") != 20.0


def test_what_all_share_is_of_no_part(still, players):
    before = [player.values() for player in players]
    for address in SHARED:
        still.clock.now += clients.FORGIVEN_S
        for part, asked in (1, address), (2, f"{address}/unit"):
            (error,) = errors(still.ask(f"/part/{part}{asked}", 1.0))
            assert error == f"{asked} is one for all parts: /yehu{asked}"
        (error,) = errors(still.ask("/get", f"/yehu/part/2{address}"))
        assert "one for all parts" in error
    for call in (call.address for call in CALLS if call.is_for_all):
        still.clock.now += clients.FORGIVEN_S
        (error,) = errors(still.ask(f"/part/2{call}", "x"))
        assert error == f"{call} is one for all parts: /yehu{call}"
    assert [player.values() for player in players] == before


def test_a_part_that_is_not_there_is_reported_with_those_that_are(still, players):
    for number in ("0", "4", "99", "123456789"):
        still.clock.now += clients.FORGIVEN_S
        for asked, words in [
            (f"/part/{number}/note", (67.0, 90.0)),
            (f"/part/{number}/playing/volume", (0.5,)),
            ("/get", (f"/part/{number}/playing/volume",)),
        ]:
            (error,) = errors(still.ask(asked, *words))
            about = f"/yehu{words[0]}: " if asked == "/get" else ""
            assert error == f"{about}no part {number}: there are parts 1 to 3"
    for number in ("", "01", "x", "-1", "1.0", "9" * 5000, "1/part/2"):
        (error,) = errors(still.ask(f"/part/{number}/note", 67.0, 90.0))
        assert "unknown" in error
    assert values(players) == [1.0, 1.0, 1.0]
    assert keys(still, players) == [0, 0, 0]
    still.handler = handler.OscHandler(still.services.context(players[:1]))
    assert not errors(still.ask("/part/1/playing/volume", 0.5))
    (error,) = errors(still.ask("/part/2/playing/volume", 0.5))
    assert error == "no part 2: there is only part 1"


# ---------------------------------------------------------------- subscriptions


def test_a_subscription_is_of_the_addresses_where_it_was_asked_for(still, players):
    heard = still.ask("/part/2/subscribe", 60.0)
    assert heard[0].address == "/yehu/part/2/subscribed"
    sent = {one.address for one in heard[1:]}
    assert sent == {f"/yehu/part/2{one}" for one in OF_PARTS if not one.endswith("/unit")}
    for part, player in enumerate(players):
        player.set(VOLUME, 0.1 * part + 0.3, frame=0)
    still.pass_time(0.05)
    heard = {one.address: one.arguments for one in still.peer.received()}
    assert heard.keys() == {f"/yehu/part/2{VOLUME}", "/yehu/part/2/output/level"}  # it moves both
    assert heard[f"/yehu/part/2{VOLUME}"] == [f32(0.4)]


def test_one_may_subscribe_to_several_parts_each_in_its_form(still, players):
    still.ask("/subscribe", 60.0)
    still.ask("/part/3/subscribe/unit", 60.0)
    still.pass_time(0.5)
    still.peer.received()
    for player in players:
        player.set("/playing/bow_length", 2.0, frame=0)
    still.pass_time(0.05)
    heard = {one.address: one.arguments for one in still.peer.received()}
    assert heard == {
        "/yehu/playing/bow_length": [2.0],
        "/yehu/part/3/playing/bow_length/unit": [1.0],
    }
    still.ask("/unsubscribe")
    for player in players:
        player.set("/playing/bow_length", 1.0, frame=0)
    still.pass_time(0.05)
    assert still.peer.received() == []


@pytest.mark.usefixtures("players")
def test_a_part_has_a_status(still):
    names = [row.name for row in PART_STATUS]
    heard = still.ask("/part/3/status")
    assert [one.address for one in heard] == [f"/yehu/part/3/status/{name}" for name in names]
    heard = still.ask("/get", "/yehu/part/2/status/keys")
    assert [one.arguments for one in heard] == [[1.0]]  # which the services of the tests give
    still.ask("/part/2/subscribe/status", 60.0)
    (error,) = errors(still.ask("/part/2/status/keys", 1.0))
    assert "cannot be set" in error


# ---------------------------------------------------------------- mappings, learning, presets


def test_ones_own_address_moves_the_first_part_that_binds_it_or_below_a_part_that_part(
    still, players, wire
):
    for player, source in zip(players, ["/fader1", "/fader1", "/fader3"], strict=True):
        mapping = Mapping("own", (Bind(source, VOLUME), Bind(source, "/playing/bend")))
        player.remap(mapping, frame=0)
    still.take(wire.message("/fader1", 0.5))
    still.take(wire.message("/fader3", 0.25))
    still.pass_time(0.01)
    assert values(players) == [0.5, 1.0, 0.25]
    still.send("/part/2/fader1", 0.75)
    still.pass_time(0.01)
    assert values(players) == [0.5, 0.75, 0.25]
    (error,) = errors(still.ask("/part/3/fader1", 0.5))
    assert "unknown" in error


def test_what_a_part_learns_all_parts_of_its_mapping_have(still, players, monkeypatch):
    other = Mapping("other", ())
    players[2].remap(other, frame=0)
    new = Mapping("keyboard", (Bind("cc 20", VOLUME),))
    monkeypatch.setattr(learned, "learn", lambda *_, **__: (new, Path("a file")))
    (answer,) = still.ask("/part/2/learn", "/yehu/part/2/playing/volume")
    assert (answer.address, answer.arguments[0]) == (
        "/yehu/part/2/learning",
        f"/yehu/part/2{VOLUME}",
    )
    assert [player.learning.waits for player in players] == [False, True, False]
    players[1].learning._found(LearnedSource("cc 20"))
    assert [player.mapping for player in players] == [new, new, other]
    heard = still.ask("/part/2/bindings")
    assert heard[-2].arguments[1] == f"/yehu/part/2{VOLUME}"
    (error,) = errors(still.ask("/part/2/learn", "/room/size"))
    assert "one for all parts" in error
    (error,) = errors(still.ask("/part/2/learn", "/yehu/part/3/playing/volume"))
    assert "another part" in error


def test_an_address_that_a_part_has_learned_moves_that_part(still, players, wire, config_home):
    del config_home
    still.ask("/part/2/learn", VOLUME)
    for place in (0.0, 0.5, 0.25):
        still.take(wire.message("/fader1", place))
    still.pass_time(0.01)
    (bind,) = players[1].mapping.of("/fader1")
    assert bind.part == 2
    assert values(players) == [1.0, 0.25, 1.0]
    plain = [call for call in more_calls(players) if call.address == "/fader1"]
    assert [call.doc.split()[1] for call in plain] == [f"/yehu/part/2{VOLUME},"]
    still.take(wire.message("/yehu/part/3/fader1", 0.5))
    still.pass_time(0.01)
    assert values(players) == [1.0, 0.25, 0.5]


def test_a_preset_is_loaded_by_a_part_and_leaves_what_all_share(still, players, monkeypatch):
    preset = Preset("loud", {VOLUME: 0.5, "/room/size": 30.0})
    monkeypatch.setattr(players[0].presets, "load", lambda _name: preset)
    monkeypatch.setattr(players[1].presets, "load", lambda _name: preset)
    heard = still.ask("/part/2/preset/load", "loud")
    assert {one.address for one in heard} == {
        "/yehu/part/2/preset/loaded",
        f"/yehu/part/2{VOLUME}",
        "/yehu/error",
    }
    expected = "/room/size: one for all parts, left out; /yehu/preset/load sets what all share"
    assert errors(heard) == [expected]
    assert values(players) == [1.0, 0.5, 1.0]
    assert [player.value("/room/size") for player in players] == [7.0] * 3
    assert not {*players[1].sound()} & {*SHARED}
    assert {*SHARED} < {*players[0].sound()}
    for first in ("", "/part/1"):
        players[0].write("/room/size", 5.0, frame=0)
        assert not errors(still.ask(f"{first}/preset/load", "loud"))
        assert players[0].value("/room/size") == 30.0


# ---------------------------------------------------------------- messages that wait


@pytest.mark.parametrize(
    ("panic", "kept"), [("/panic", []), ("/part/2/panic", [0, 2]), ("/part/1/panic", [1, 2])]
)
def test_a_panic_drops_what_waits_for_its_part(still, players, wire, panic, kept):
    due = still.clock.time() + 0.1
    for address in ("/yehu/note", "/yehu/part/1/note", "/yehu/part/2/note", "/yehu/part/3/note"):
        still.take(wire.bundle(due, pack(address, 67.0, 90.0)))
    assert still.handler.waiting == 4
    still.send(panic)
    still.pass_time(0.2)
    assert [part for part, player in enumerate(players) if player.keys] == kept
    assert still.handler.waiting == 0


# ---------------------------------------------------------------- OSCQuery


def test_the_tree_has_each_part_with_all_that_is_its_own(still, players):
    states = {row.name: 0.0 for row in STATUS}
    own = {row.name: 0.0 for row in PART_STATUS}
    values = {group_of(n): player.values() for n, player in enumerate(players)}
    values[""] = players[0].values()
    status = lambda group: own if group else states  # noqa: E731
    root = node_at("/", values.__getitem__, status, len(players))
    part = find(root, "/yehu/part/2")
    assert part["DESCRIPTION"].startswith("Part 2")
    with_value = {path for path, node in walk(part) if "VALUE" in node}
    assert with_value == {
        "/yehu" + address for address in readable(2) if address.startswith("/part/2/")
    }
    writable = {path for path, node in walk(part) if node["ACCESS"] & 2}
    known = {one for one in still.handler.addresses if one.startswith("/yehu/part/2/")}
    assert writable == known


# ---------------------------------------------------------------- a whole server


def test_a_server_of_three_plays_three(make_live, until):
    live = make_live(parts=3)
    client = live.client()
    client.send("/part/2/note", 67.0, 90.0)
    client.send("/part/3/note", 72.0, 90.0)
    client.sync()
    players = live.server.players
    until(lambda: [player.pitch is None for player in players] == [True, False, False], "notes")
    status = live.server.status()
    assert (status["parts"], status["note"]) == (3, -1.0)
    parts = [live.server.status(group_of(part)) for part in range(3)]
    assert [part["keys"] for part in parts] == [0, 1, 1]
    assert status["applied_events"] == sum(part["applied_events"] for part in parts) > 0
    pans = [player.value("/room/pan") for player in players]
    assert pans[0] == -pans[2] < pans[1] == 0.0
    seeds = [player.value("/engine/seed") for player in players]
    assert len(set(seeds)) == 3
    client.send("/panic")
    client.sync()
    live.settle()
    assert [player.keys for player in players] == [0, 0, 0]
