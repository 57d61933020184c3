"""Address patterns: what they match, what they refuse, and that none takes long."""

import itertools
import re
import time

from hypothesis import example, given
from hypothesis import strategies as st
from wire import errors

from yehu_server.errors import RefusedError
from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc import clients
from yehu_server.live.osc.all_calls import CALLS
from yehu_server.live.osc.osc_addresses import matches
from yehu_server.params.table import TABLE

LETTERS = "ab-/"
ITEMS = ["a", "b", "a-b", "b-a", "c-z", "/", "z"]  # of sets
ADDRESSES = ["".join(p) for n in range(5) for p in itertools.product(LETTERS, repeat=n)]


def one_of(letters: set[str]) -> str:
    return f"(?:{'|'.join(map(re.escape, sorted(letters)))})" if letters else "(?!)"


@st.composite
def sets(draw: st.DrawFn) -> tuple[str, str]:
    """A set of letters and ranges, as a pattern and as a regular expression."""
    text, letters = "", set()
    for item in draw(st.lists(st.sampled_from(ITEMS), max_size=3)):
        lo, hi = item[0], item[-1]
        letters |= {c for c in LETTERS if lo <= c <= hi}
        text += item
    if draw(st.booleans()):  # a dash at an end is a dash
        text += "-"
        letters.add("-")
    if draw(st.booleans()):
        return f"[!{text}]", one_of(set(LETTERS) - letters - {"/"})
    return f"[{text}]", one_of(letters - {"/"})


words = st.lists(st.text("ab-", max_size=2), min_size=1, max_size=3)
pieces = st.one_of(
    st.just(("*", "[^/]*")),
    st.just(("?", "[^/]")),
    st.sampled_from(LETTERS).map(lambda c: (c, re.escape(c))),
    sets(),
    words.map(lambda w: (f"{{{','.join(w)}}}", f"(?:{'|'.join(map(re.escape, w))})")),
)


@given(st.lists(pieces, max_size=6))
@example([("*", "[^/]*"), ("a", "a"), ("*", "[^/]*"), ("a", "a")])
@example([("{,ab}", "(?:|ab)"), ("{a,}", "(?:a|)")])
def test_a_pattern_fits_just_what_the_same_regular_expression_fits(made):
    pattern = "".join(text for text, _ in made)
    expression = re.compile("".join(regex for _, regex in made))
    fitting = [address for address in ADDRESSES if matches(pattern, address)]
    assert fitting == [address for address in ADDRESSES if expression.fullmatch(address)]


def test_patterns_fit_as_the_specification_says():
    for pattern, address, fits in [
        ("/yehu/bow/*", "/yehu/bow/force", True),
        ("/yehu/*", "/yehu/bow/force", False),
        ("/yehu/b?w/force", "/yehu/bow/force", True),
        ("/yehu/bow/[!f]*", "/yehu/bow/force", False),
        ("/yehu/bow/[e-g]orce", "/yehu/bow/force", True),
        ("/yehu/bow/{force,side}", "/yehu/bow/side", True),
        ("/YEHU/bow/force", "/yehu/bow/force", False),
        ("", "", True),
        ("?", "", False),
    ]:
        assert matches(pattern, address) is fits, (pattern, address)


@given(st.text("/*?[]{}!-,ab", max_size=30), st.text("/ab-", max_size=10))
def test_whatever_a_pattern_is_it_fits_does_not_fit_or_is_refused(pattern, address):
    try:
        assert matches(pattern, address) in (True, False)
    except RefusedError:
        assert {"[", "{"} & set(pattern)


def test_a_twisted_pattern_takes_no_longer_than_a_plain_one_should(subtests):
    for pattern in [
        "*" * limits.PATTERN,
        "/yehu" + "/*" * 100,
        "/yehu/" + "*?" * 120,
        "/yehu/bow/" + "*o*r" * 60,
        "/yehu/" + "{,b,bo,bow}" * 22,
        "/yehu/{" + "," * 248 + "}",
        "/yehu/" + "[!z]*" * 50,
        "/yehu/bow/" + "{f,}{o,}{r,}{c,}{e,}" * 12,
        "/*" + "[a-zA-Z0-9!-~]" * 17,
    ]:
        with subtests.test(pattern=pattern):
            started = time.thread_time()
            for param in TABLE:
                matches(pattern[: limits.PATTERN], "/yehu" + param.address)
            assert time.thread_time() - started < 0.5


# ---------------------------------------------------------------- what they reach

PLAYS = {"/note", "/note/off", "/pitch", "/bow", "/bend", "/press", "/articulation", "/release"}


def test_a_pattern_reaches_what_plays_and_nothing_that_loses_something(
    still, subtests, own_presets
):
    assert {call.address for call in CALLS if call.takes_patterns} == PLAYS
    still.ask("/preset/save", "mine")
    before = still.player.values()
    for call in CALLS:
        pattern = f"/yehu{call.address[:-1]}[{call.address[-1]}]"
        if call.address not in PLAYS:
            with subtests.test(call=call.address):
                still.clock.now += clients.FORGIVEN_S
                (refused,) = still.ask(pattern.removeprefix("/yehu"), "mine")
                assert refused.arguments == [pattern, refused_of(call.address)]
    still.ask("/*", 1)
    still.ask("/preset/*", "mine")
    still.pass_time(0.01)
    (own_presets / "mine.toml").unlink()  # which is still there
    assert still.handler.clients.subscribers == 0
    changed = {"/playing/bend", "/playing/press"}
    assert {one for one, value in still.player.values().items() if before[one] != value} == changed


def refused_of(call: str) -> str:
    return f"/yehu{call} takes no pattern: send its whole address"


def test_the_error_of_a_pattern_names_the_address_that_failed(still):
    heard = still.ask("/{note,pitch,bend}", 67)
    assert errors(heard) == ["/yehu/note"]
