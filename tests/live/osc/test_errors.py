"""What cannot be done is answered with the reason, changes nothing, and costs little."""

import math
from typing import Any

from wire import FakePeer

from yehu_server.live import traffic_limits as limits

NAN, INF = math.nan, math.inf
NOTHING: tuple[Any, ...] = ()

# Calls below /yehu, arguments of each that are refused, and words of the reason.
REFUSED: list[tuple[str, list[tuple[Any, ...]], str]] = [
    ("/note", [NOTHING, (67,), (67, 90, 1)], "expected 2 arguments"),
    ("/note", [("G4", 90)], "NOTE: expected a MIDI note number, got a string"),
    ("/note", [(67, None)], "VELOCITY: expected a number, got nil"),
    *((call, [(3, 4), ("x",)], "") for call in ("/panic", "/reset", "/release")),
    ("/note", [(-1, 90), (127.5, 90), (67, -1), (67, 127.5)], "not within"),
    ("/note", [(NAN, 90.0), (67.0, NAN), (67.0, INF)], "not finite"),
    ("/note/off", [(-1,), (127.5, 0)], "not within"),
    ("/pitch", [(-1,), (127.5,)], "not within"),
    ("/subscribe", [(9777,), (9777, 600)], "for a port, send seconds first: 600 9777"),
    ("/subscribe", [(-1,), (-1, 7400)], "-1 s is less than nothing"),
    ("/bow", [NOTHING, (0.2,), (0.2, 0.5, 1.0)], "expected 2 arguments"),
    ("/bow", [(0.2, "x"), (NAN, 0.5), (0.2, INF)], ""),
    ("/bend", [("x",)], "expected a number"),
    ("/press", [("x",)], "expected a number"),
    ("/get", [NOTHING, (1,), ("/bow/force", "/bow/side"), (b"/bow/force",)], "one string"),
    ("/get", [("",), ("/nothing",), ("/note",), ("/z*",), ("/yehu",)], ""),
    ("/get", [("/bow/[fs",), ("/bow/{force,side",), ("[",), ("{",)], "never closed"),
    ("/get", [("/bow/" + "*" * 5000,)], "too long"),
    ("/get", [("/status/nota",)], "did you mean /yehu/status/note?"),
    ("/get", [("/yehu/playing/vibratto",)], "did you mean /yehu/playing/vibrato"),
    ("/get", [("/yehu/note",)], "/yehu/note has no value"),
    ("/get", [("/yehu/*/status/note",)], "matches no address; * ends at a /"),
    ("/status/nota", [(1.0,)], "did you mean /yehu/status/note?"),
    ("/status/note", [(60.0,)], "the status cannot be set; ask for it by /yehu/get"),
    ("/subscribe", [("x",), (10, "x"), (10, 0), (10, -1), (10, 65536), (10, 7.5), (1, 2, 3)], ""),
    ("/subscribe", [(NAN,), (10, INF)], ""),
    ("/unsubscribe", [(-1,), (65536,), (99999,), (7.5,)], ""),
    ("/record/start", [NOTHING, (1,), ("a", "b"), (b"a",)], ""),
    ("/learn", [("/bow/speed",)], "is moved by the player"),
    ("/learn", [("/playing/vibrat",)], "did you mean /playing/vibrato"),
    ("/learn", [(3,)], "expected one string"),
    ("/learn", [("/playing/speed", "x")], "ARGUMENT 2: expected a number"),
    ("/articulation", [(3,), (3.0,)], "numbers are for /yehu/playing/articulation"),
    ("/unlearn", [NOTHING], "expected one string"),
    ("/bindings", [(1.0,)], "expected 0 arguments"),
    ("/preset/load", [NOTHING, (3.0,)], "expected one string"),
    *((f"/preset/{call}", [("../x",)], "not a plain name") for call in ("load", "save", "delete")),
    ("/preset/load", [("nothing",)], "no preset 'nothing'"),
    ("/preset/save", [("tremolo",)], "save under another name"),
    ("/preset/delete", [("tremolo",)], "comes with the program"),
    ("/preset/delete", [("nothing",)], "no preset 'nothing'"),
    ("/preset/morph", [("ordinary", "tremolo"), (0.5, "a", "b")], "a number from 0 to 1 (FROM TO"),
    ("/preset/morph", [("ordinary", 3.0, 0.5)], "expected two names and a number"),
    ("/preset/morph", [("ordinary", "tremolo", 1.5)], "AMOUNT: 1.5 is not within 0 to 1"),
    ("/preset/morph", [("ordinary", "nothing", 0.5)], "no preset 'nothing'"),
    ("/preset/morph", [("ordinary", "tremolo", "half")], "expected two names and a number"),
    ("/preset/morph", [("ordinary", "tremolo", NAN)], "not finite"),
    ("/preset/morph", [("ordinary", "../x", 0.5)], "is not a plain name"),
    ("/bow", [(1.0,)], "expected 2 arguments"),
    # A similar address is suggested, of parameters and of calls.
    ("/bow/forc", [(0.5,)], "did you mean /yehu/bow/force?"),
    ("/bow/forc/unit", [(0.5,)], "did you mean /yehu/bow/force/unit?"),
    ("/save", [(0.5,)], "did you mean /yehu/preset/save?"),
    ("/position", [(0.5,)], "did you mean /yehu/bow/position or /yehu/finger/1/position?"),
    ("/stop", [NOTHING], "did you mean /yehu/panic or /yehu/record/stop?"),
    ("/note/on", [(67, 90)], "did you mean /yehu/note?"),
    ("/volum", [(0.5,)], "did you mean /yehu/playing/volume?"),
    ("/slide", [(67,)], "did you mean /yehu/pitch?"),
    ("/aftertouch", [(0.5,)], "did you mean /yehu/playing/press?"),
    ("/note_off", [(67,)], "did you mean /yehu/note?"),
    ("/bow_speed", [(0.5,)], "did you mean /yehu/playing/speed?"),
    ("/pitchbend", [(0.5,)], "did you mean /yehu/playing/bend?"),
    ("/part/two/note", [(67, 90)], "a part is a number: /yehu/part/1/..."),
    ("/plaing", [(0.5,)], "did you mean /yehu/playing/...?"),
    ("/reverb", [(0.5,)], "did you mean /yehu/room/level?"),
    ("/room", [("hall",)], "a room is a preset: /yehu/preset/load hall"),
    ("/room/load", [("hall",)], "a room is a preset: /yehu/preset/load hall"),
    ("/preset/lod", [("ordinary",)], "did you mean /yehu/preset/load?"),
    ("/load", [("ordinary",)], "did you mean /yehu/preset/load?"),
    ("/recrod/start", [("take",)], "did you mean /yehu/record/start?"),
    *(
        (address, [(0.123,)], "")
        for address in (
            *("", "/", "/bow/", "/bow/force/", "//bow/force", "/bow/force ", "/bow/fôrce"),
            *("/bow/[z]*", "/nothing*", "/bow**/", "/?", "/bow/[", "/bow/{a", "/" + "*" * 300),
        )
    ),
]
UNKNOWN = ["/bow/force", "/yehubow/force", "/", "//", "/ÿehu/" + "x" * 300]


def test_what_cannot_be_done_is_answered_with_the_reason_and_changes_nothing(
    still, wire, subtests, own_presets
):
    before, count = still.player.values(), 0
    asked = [("/yehu" + call, words, why) for call, calls, why in REFUSED for words in calls]
    for address, words, why in [*asked, *((address, (0.123,), "") for address in UNKNOWN)]:
        with subtests.test(address=address[:80], words=words):
            peer = FakePeer(count)  # one alone would be sent only some
            still.take(wire.message(address, *words), peer)
            (refused,) = peer.received()
            assert (refused.address, refused.arguments[0]) == ("/yehu/error", address)
            assert why in refused.arguments[1]
            count += 1
    assert still.handler.counts.errors == count
    still.pass_time(0.05)
    assert still.player.values() == before
    assert still.player.pitch is None
    assert not still.player.learning.waits
    assert still.frames("/bow/speed") == []
    assert still.handler.clients.subscribers == 0
    assert not list(own_presets.parent.rglob("*.toml"))


def test_nothing_is_suggested_that_is_little_like_it(still, subtests):
    for name in ("quit", "mute", "tempo", "playing/nix", "bow_speeed"):
        with subtests.test(name=name):
            (refused,) = still.ask(f"/{name}", 1.0)
            assert refused.arguments[1] == "unknown address"


def test_a_malformed_packet_is_counted_and_answered(still):
    packets = [
        b"",
        b"\0",
        b"hello",
        b"/yehu/bow/force",
        b"/yehu/bow/force\0,i\0\0\0",
        b"#bundle\0\0",
    ]
    for packet in packets:
        still.take(packet)
        (refused,) = still.peer.received()
        assert "malformed" in refused.arguments[1]
        assert packet[:1] in b"/#" or "an address begins with /" in refused.arguments[1]
    assert still.handler.counts.malformed == len(packets)


def test_a_packet_that_is_none_or_too_long_is_answered_and_logged_like_a_wrong_message(still):
    still.take(b"hello")
    still.handler.refuse_long(still.peer)
    reasons = [refused.arguments[1] for refused in still.peer.received()]
    assert reasons[0] == "malformed packet: an address begins with /"
    assert f"at most {limits.DATAGRAM} bytes" in reasons[1]
    assert still.services.said == [f"OSC from peer:1: {reasons[0]}"]  # once for all
    assert still.handler.counts.errors == 0  # they are counted as malformed, and as excess


def test_a_wrong_message_is_logged_once_for_each_address_and_few_a_minute(still, wire):
    for _ in range(3):
        still.take(wire.message("/yehu/nots", 67.0, 90.0))
    still.take(wire.message("/yehu/note", 67.0))
    refused = "/yehu/note: expected 2 arguments, got 1 (NOTE VELOCITY)"
    assert still.services.said == [
        "OSC from peer:1: /yehu/nots: unknown address; did you mean /yehu/note?",
        f"OSC from peer:1: {refused} (2 errors before it not shown)",
    ]
    for number in range(100):
        still.take(wire.message(f"/yehu/{number}", 1.0))
    assert len(still.services.said) == limits.LOGGED_ERRORS_AT_ONCE
    still.pass_time(60.0 / 1000)
    still.clock.now += 60.0
    for number in range(100):
        still.take(wire.message(f"/yehu/more/{number}", 1.0))
    assert len(still.services.said) <= limits.LOGGED_ERRORS_AT_ONCE + 6


def test_the_last_errors_that_were_not_logged_are_counted_later_and_at_the_end(still, wire):
    told = []
    for count, pause_s, is_end in (
        (4, 1.0, False),
        (0, 1.1, False),
        (1, 3.0, False),
        (2, 3.0, False),
        (1, 0.0, True),
    ):
        for _ in range(count):
            still.take(wire.message("/yehu/nots", 67.0, 90.0))
        still.handler.context.last_error_s -= pause_s
        if is_end:
            still.handler.context.count_errors(is_end=True)
        list(still.handler.due())
        told += still.services.said[1 + len(told) :]
    assert told == [f"OSC: {n} errors after the last one not shown" for n in (3, 6, 7)]


def test_an_address_without_its_slash_is_named_with_it(still):
    (refused,) = still.ask("/get", "playing/vibrato")
    assert refused.arguments[1].startswith("/yehu/playing/vibrato: ")


def test_who_plays_beyond_the_range_is_told_once_what_sounds(still):
    for call, told in [
        (("/pitch", 30.0), "30 is outside F4 to F6; the finger goes to 65"),
        (("/note", 30.0, 90.0), "30 is outside F4 to F6; it sounds as 66"),
    ]:
        answers = [(message.address, message.arguments) for message in still.ask(*call)]
        assert answers == [("/yehu/moved", [f"/yehu{call[0]}", told])]
        assert still.ask(*call) == []
    assert still.ask("/pitch", 70.0) == still.ask("/note", 70.0, 90.0) == []
    assert still.handler.counts.errors == 0
