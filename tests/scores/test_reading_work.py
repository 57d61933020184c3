"""Reading a file of any shape takes time in proportion to its size.

What is counted is the lines of Python that a reader goes through, so load has no part in it.
"""

import sys
import time
from collections import deque
from collections.abc import Callable
from itertools import count
from pathlib import Path

import pytest
from midi_bytes import END, midi, off, on

from yehu_server.errors import YehuError
from yehu_server.scores.abc.tokens import TOKEN
from yehu_server.scores.reading import read_any, read_written
from yehu_server.scores.written.ticks import FINEST, TICKS

FEW, MORE = 100, 400
MAX_RATIO = 7  # times the lines for 4 times the file; 16 times is quadratic
ABC = "X:1\nT:t\nM:4/4\nL:1/64\nK:C\n"
HEAD = '<?xml version="1.0"?><score-partwise version="4.0"><part-list><score-part id="P">'
XML = f"{HEAD}<part-name>n</part-name></score-part></part-list><part id='P'>"
DIVISIONS = "<attributes><divisions>64</divisions></attributes>"
NOTE = "<note><pitch><step>A</step><octave>4</octave></pitch><duration>1</duration>{}</note>"


def bars(*music: str) -> str:
    each = (f'<measure number="{n}">{text}</measure>' for n, text in zip(count(), music))
    return f"{XML}{''.join(each)}</part></score-partwise>"


def tracks(n: int, apart: int = 0) -> bytes:
    notes = (on(apart * at, 69, channel=at % 16) + off(9, 69, at % 16) + END for at in range(n))
    return midi(*notes)


SHAPES: dict[str, Callable[[int], bytes | str]] = {
    "notes of one tick.mid": lambda n: midi(b"".join(on(0, 60 + at % 24) for at in range(n)) + END),
    "held.mid": lambda n: midi(
        b"".join(on(1, at % 128, channel=at // 128 % 16) for at in range(n)) + END
    ),
    "channels.mid": lambda n: midi(
        b"".join(on(0, 60, channel=at % 16) + off(1, 60, at % 16) for at in range(n)) + END
    ),
    "tracks.mid": tracks,
    "tracks in turn.mid": lambda n: tracks(n, apart=10),
    "notes.abc": lambda n: ABC + "a" * n,
    "repeats.abc": lambda n: ABC + "|::::A" * n,
    "many repeats.abc": lambda n: ABC + "|::A::|" * n,
    "bars.abc": lambda n: ABC + "A|" * n,
    "rests.abc": lambda n: ABC + "Z|" * n + "A",
    "long rests.abc": lambda n: ABC + "A|" + "Z1000|" * n,
    "grace notes.abc": lambda n: ABC + "{" + "a" * n + "}A|",
    "endings.abc": lambda n: ABC + "|1A:|2A|" * (n // 4),
    "chords.abc": lambda n: ABC + "[ac]" * n,
    "slurs.abc": lambda n: ABC + "(" * n + "A" + ")" * n,
    "notes.jianpu": lambda n: "title=t\n1=F 4/4 4=60\n\n" + "s5 s5 s5 s5 q5 5 - 5 |\n" * (n // 8),
    "dense bar.musicxml": lambda n: bars(DIVISIONS + NOTE.format("") * n),
    "bars.musicxml": lambda n: bars(DIVISIONS + NOTE.format(""), *([NOTE.format("")] * n)),
    "ties.musicxml": lambda n: bars(
        DIVISIONS
        + "".join(
            NOTE.format('<tie type="start"/>').replace(
                "<octave>", f"<alter>{at / n}</alter><octave>"
            )
            + "<backup><duration>1</duration></backup><forward><duration>1</duration></forward>"
            for at in range(n)
        )
    ),
    "grace notes.musicxml": lambda n: bars(
        DIVISIONS + NOTE.format("") + NOTE.format("").replace("<note>", "<note><grace/>") * n
    ),
}


def lines_of(path: Path) -> int:
    """Number of lines of Python that reading a file goes through."""
    lines = 0

    def trace(_frame: object, event: str, _value: object) -> object:
        nonlocal lines
        lines += event in ("line", "call")
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        read_any(path)
    except YehuError:
        pass  # refused, which takes time too
    finally:
        sys.settrace(before)
    return lines


@pytest.mark.parametrize("shape", SHAPES)
def test_reading_takes_time_in_proportion(tmp_path, shape):
    lines = []
    for n in (FEW, FEW, MORE):  # once to warm caches
        data = SHAPES[shape](n)
        path = tmp_path / f"{n} {shape}"
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        lines.append(lines_of(path))
    assert lines[2] < MAX_RATIO * lines[1]


# Lines of Python for each note of a dense file, and of all that is below them. With a fraction for
# each beat and a note performed at a time there were half as many again, to four times as many.
SLOW = ABC.replace("1/64", "1/8")
TRILL = NOTE.format("<notations><ornaments><trill-mark/></ornaments></notations>")
DENSE: dict[str, tuple[Callable[[int], bytes | str], int]] = {
    "dense.mid": (
        lambda n: midi(b"".join(on(1, 40 + at % 50) + off(0, 40 + at % 50) for at in range(n))),
        60,
    ),
    "dense.abc": (lambda n: ABC + "a3/2b|" * (n // 2), 300),
    "triplets.abc": (lambda n: ABC + "(3abc" * (n // 3), 220),
    "slurs.abc": (lambda n: ABC + "(ab)" * (n // 2), 290),
    "ornaments.abc": (lambda n: ABC + "T{g}a" * n, 460),
    "bows.abc": (lambda n: ABC + "uavb" * (n // 2), 320),
    "fermatas.abc": (lambda n: ABC + "aHb" * (n // 2), 290),
    "slides.abc": (lambda n: SLOW + "!slide!a!fall!b" * (n // 2), 460),
    "swells.abc": (lambda n: SLOW + "!<(!a!<)!!>(!b!>)!" * (n // 2), 530),
    "dynamics.abc": (lambda n: ABC + "!p!a!f!b" * (n // 2), 430),
    "dense.jianpu": (lambda n: "1=C\n" + "q1 ( s2 ) " * (n // 2), 400),
    "triplets.jianpu": (lambda n: "1=C\n" + "3[ q1 q2 q3 ] " * (n // 3), 340),
    "living.jianpu": (lambda n: "notation=二四谱\nmode=活五\n" + "五 三 " * (n // 2), 1250),
    "trills.musicxml": (lambda n: bars(DIVISIONS + TRILL * n), 890),
}


@pytest.mark.parametrize("shape", DENSE)
def test_a_note_of_a_dense_file_takes_few_lines(tmp_path, shape):
    make, most = DENSE[shape]
    lines = []
    for n in (FEW, FEW, MORE):
        data = make(n)
        path = tmp_path / f"{n} {shape}"
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        lines.append(lines_of(path))
    a_note = (lines[2] - lines[1]) / (MORE - FEW)
    assert a_note < most


def test_odd_lengths_do_not_make_ever_finer_beats(tmp_path):
    path = tmp_path / "odd.abc"
    path.write_text(ABC + "".join(f"a{number}/{number + 1}" for number in range(3000, 4000)))
    beats = [note.beat for note in read_written(path).parts[0].notes]
    assert len(beats) == 1000
    assert all(beat.denominator <= TICKS * FINEST for beat in beats)
    assert max(abs(beat * 16 - number) for number, beat in enumerate(beats)) < 0.5


def test_what_lasts_too_long_is_refused_before_it_is_performed(tmp_path, monkeypatch):
    monkeypatch.setattr("yehu_server.scores.reading.performed", None)
    path = tmp_path / "long.abc"
    path.write_text("X:1\nT:t\nM:4/4\nL:1/1\nK:C\n" + "a|" * 5000)
    with pytest.raises(YehuError, match=r"long\.abc: the score lasts 3\.33 hours, more than 2"):
        read_any(path)


def test_what_is_never_closed_is_looked_for_once():
    def seconds(n: int) -> float:
        """Of the thread, for 16,000 of them in texts of n; a busy machine has no part in it."""
        times = []
        for _ in range(3):
            begun = time.thread_time()
            for _ in range(16_000 // n):
                deque(TOKEN.finditer(unclosed * n), maxlen=0)
            times.append(time.thread_time() - begun)
        return min(times)

    # Each once would be as long; looked for from each of them, 32 times. Windows counts 16 ms.
    for unclosed in ("[", "[a", "{", "{a", "[K:", '"', "!", "+", ":", ".", "(3"):
        assert seconds(16_000) < 5.0 * seconds(500) + 0.02, unclosed
