"""The order of bars: forms that are written in odd ways, and any form, unrolled a second way."""

from dataclasses import dataclass, field

from hypothesis import example, given
from hypothesis import strategies as st

from yehu_server.scores.written.repeats import BarLines, left_out, order_of


def bar(signs: str = "") -> BarLines:
    """A bar: `|:`, `:|`, `||`, and words such as `1` or `1,2` (ending), `+1` (goes on), `fine`."""
    lines = BarLines()
    for word in signs.split():
        if word == "|:":
            lines.forward = True
        elif word == "||":
            lines.double = True
        elif word.startswith(":|"):
            lines.times = int(word[2:] or 2)
        elif word.lstrip("+")[0].isdigit():
            lines.endings = frozenset(int(each) for each in word.lstrip("+").split(","))
            lines.opens = not word.startswith("+")
        else:
            lines.jumps.add(word)
    return lines


# Signs of bars, and their numbers as they are played.
# Signs of bars, and their numbers as they are played: forms that no property below makes.
FORMS = {
    ("", ":|", ":|"): "1 2 1 2 3 3",
    ("", "|| :|", ""): "1 2 2 3",
    ("", "|:", "|| :|"): "1 2 3 2 3",  # it has a beginning
    ("", "||", "1 :|", "2"): "1 2 3 2 4",
    ("", "1,2 :|", "3", ""): "1 2 1 2 1 3 4",
    ("", "1 :|", ""): "1 2 1 3",
    ("", "1,3 :|", "2 :|", ""): "1 2 1 3 1 2 4",
    ("", "1 :|", "3 :|", ""): "1 2 1 2 1 3 4",
    ("", "1", "2", ""): "1 2 1 3 4",  # a repeat that nobody wrote
    ("", "1", ":|", "2", ""): "1 2 3 1 4 5",  # an ending that is drawn too short
    ("", "1 :|", "+1", "2"): "1 2 1 3 4",  # and too long
    ("", "1 :|", "2", "", ":|"): "1 2 1 3 4 5 4 5",
    ("", "1", "+1 |: :|", "+1 :|", "2"): "1 2 3 3 4 1 5",  # a repeat within an ending
    ("", "1 |: :|", "+1 :|", "2"): "1 2 2 3 1 4",
    ("", ":|", "2", ""): "1 2 1 2 3 4",
    ("", "1", ""): "1 2 3",
    ("", "|: fine", "1 :|", "2 dacapo"): "1 2 3 2 4 1 2",
    ("fine", "", ":|", "dacapo"): "1 2 3 2 3 4 1",  # a trio
    ("", "segno", "", "dalsegno", ""): "1 2 3 4 2 3 4 5",
    ("", ":|", "dacapo", ""): "1 2 1 2 3 1 2 3 4",
    ("fine", "dacapo", "", "fine", "dacapo"): "1 2 1 3 4 5 3 4",  # two movements
    ("", "segno", "1 :|", "2 tocoda", "dalsegno", "coda :|"): "1 2 3 1 2 4 5 2 4 6 6",
}  # fmt: skip


def test_forms_are_played_as_players_read_them():
    wrong = []
    for signs, expected in FORMS.items():
        played = " ".join(str(at + 1) for at in order_of([bar(each) for each in signs]))
        if played != expected:
            wrong.append((signs, expected, played))
    assert not wrong


# -- any form -----------------------------------------------------------------------------------


@dataclass
class Block:
    """Bars that are played `times` times; the last bars of each time may be of their own."""

    body: int
    times: int = 1
    endings: list[int] = field(default_factory=list)


@dataclass
class Form:
    """Blocks, and a jump from the end back to one of them, up to the end of another."""

    blocks: list[Block]
    jump: str = ""
    target: int = 0
    stop: int = 0  # the block that ends with Fine, or from which is jumped to the coda
    coda: int = 0  # bars


@st.composite
def forms(draw) -> Form:
    blocks = []
    for _ in range(draw(st.integers(1, 5))):
        body, kind = draw(st.integers(1, 3)), draw(st.sampled_from(["", "times", "endings"]))
        if kind == "endings":
            endings = draw(st.lists(st.integers(1, 2), min_size=2, max_size=3))
            blocks.append(Block(body, len(endings), endings))
        else:
            blocks.append(Block(body, draw(st.integers(2, 3)) if kind else 1))
    stop = draw(st.integers(0, len(blocks) - 1))
    jump = draw(st.sampled_from(["", "dacapo", "dalsegno", "fine", "coda"]))
    target = draw(st.integers(0, stop)) if jump == "dalsegno" else 0
    return Form(blocks, jump, target, stop, draw(st.integers(1, 2)) if jump == "coda" else 0)


def written(form: Form) -> list[BarLines]:
    """The bars of a form, with all signs."""
    bars: list[BarLines] = []
    last: list[int] = []  # bar of each block's end
    first: list[int] = []
    for block in form.blocks:
        first.append(len(bars))
        begin = len(bars)
        bars += [BarLines() for _ in range(block.body)]
        bars[begin].forward = block.times > 1
        if block.times > 1 and not block.endings:
            bars[-1].times = block.times
        for number, length in enumerate(block.endings, start=1):
            own = [BarLines(endings=frozenset({number})) for _ in range(length)]
            own[0].opens = True
            own[-1].times = 2 if number < len(block.endings) else 0
            bars += own
        last.append(len(bars) - 1)
    if form.jump:
        bars[-1].jumps.add("dalsegno" if form.jump == "dalsegno" else "dacapo")
    if form.jump == "dalsegno":
        bars[first[form.target]].jumps.add("segno")
    if form.jump == "fine":
        bars[last[form.stop]].jumps.add("fine")
    if form.jump == "coda":
        bars[last[form.stop]].jumps.add("tocoda")
        begin = len(bars)
        bars += [BarLines() for _ in range(form.coda)]
        bars[begin].jumps.add("coda")
    return bars


def unrolled(form: Form) -> list[int]:
    """The bars of a form in the order in which it was made, without its signs."""
    pieces: list[tuple[list[int], list[int]]] = []  # of each block: with repeats, and without
    at = 0
    for block in form.blocks:
        body = [*range(at, at + block.body)]
        at += block.body
        endings = []
        for length in block.endings:
            endings.append([*range(at, at + length)])
            at += length
        turns = [body + ending for ending in endings] or [body] * block.times
        pieces.append(([bar for turn in turns for bar in turn], turns[-1]))
    played = [bar for often, _ in pieces for bar in often]
    if form.jump == "":
        return played
    end = form.stop + 1 if form.jump in ("fine", "coda") else len(pieces)
    played += [bar for _, once in pieces[form.target : end] for bar in once]
    return [*played, *range(at, at + form.coda)]


@given(forms())
def test_any_form_is_unrolled_as_it_was_made_and_no_bar_is_lost(form):
    bars = written(form)
    order = order_of(bars)
    assert order == unrolled(form)
    assert not left_out(len(bars), order)


@given(
    st.lists(
        st.builds(
            BarLines,
            st.booleans(),
            st.sampled_from([0, 0, 2, 3]),
            st.frozensets(st.integers(1, 3), max_size=2),
            st.booleans(),
            st.sets(st.sampled_from(["dacapo", "dalsegno", "fine", "segno"]), max_size=1),
            st.booleans(),
        ),
        max_size=12,
    )
)
@example([BarLines(jumps={"dalsegno"}), BarLines(), BarLines(jumps={"segno"})])
def test_whatever_signs_there_are_each_bar_sounds(bars):
    """Only a coda may be left out, and only what lies between it and a jump to it."""
    assert not left_out(len(bars), order_of(bars))
