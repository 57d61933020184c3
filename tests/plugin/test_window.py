"""The plug-in's window, in a small CLAP host under Xvfb."""

import os
import shutil
import subprocess
import time

import numpy as np
import pytest
from plugin.conftest import HEADERS, HERE

from yehu_server.plugin import build as building

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("Xvfb") is None, reason="there is no Xvfb"),
]
PREV, NEXT = (40, 324), (125, 324)  # places in the chooser of presets
SLIDER = 108, 205  # four fifths of the first
WOOD = 0xE2, 0xBF, 0x8D
TAB, RIGHT, END = 23, 114, 115  # codes of keys
KEYS = {**dict(zip("1234567890-", range(10, 21), strict=True)), ".": 60, "p": 33}
ENTER, ESCAPE, BACK = 36, 9, 22
TRIES, BETWEEN = 100, 0.005  # s


@pytest.fixture
def watched(tmp_path, monkeypatch):
    """A folder with a plug-in whose C++ reports races."""
    options = ("-g", "-fsanitize=thread")
    monkeypatch.setattr(building, "FLAGS", (*building.FLAGS, *options))
    monkeypatch.setattr(building, "LINKING", ("-shared", *options))
    monkeypatch.setattr(building, "FORMATS", building.FORMATS[:1])
    building.build(tmp_path / "watched", "linux")
    return tmp_path / "watched"


@pytest.fixture
def window(request, tmp_path, built, display):
    """Say a line to the host; what it answers: value, timers, edits, size asked for, size.

    Parametrized by options of the compilers, for the host and for a plug-in of its own.
    """
    options = getattr(request, "param", ())
    folder = request.getfixturevalue("watched") if options else built
    program = tmp_path / "window_host"
    flags = ["-std=gnu11", "-O1", "-Wall", "-Wextra", "-Werror", f"-I{HEADERS}", *options]
    command = ["cc", *flags, str(HERE / "window_host.c"), "-o", str(program)]
    subprocess.run([*command, "-ldl", "-lxcb", "-lpthread"], check=True)
    host = subprocess.Popen(
        [program, str(folder / "Yehu.clap")],
        env={**os.environ, "DISPLAY": display, "TSAN_OPTIONS": "exitcode=66"},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )

    def say(line):
        host.stdin.write(f"{line}\n")
        host.stdin.flush()
        value, *numbers = host.stdout.readline().split()
        return float(value), *map(int, numbers)

    with host:
        yield say
        host.stdin.close()
        assert host.wait() == 0


def seen(say, path, wanted):
    """The pixels of the window [shape=(height, width, 3)] when they are as wanted.

    X draws when it likes: it is asked again until then, or for the last time.
    """
    for _ in range(TRIES):
        say(f"shot {path}")
        heading, _, data = path.read_bytes().partition(b"\n")
        width, height = map(int, heading.split()[1:3])
        pixels = np.frombuffer(data, np.uint8).reshape(height, width, 3).astype(int)
        if wanted(pixels):
            return pixels
    pytest.fail("the window never was as wanted")


def becomes(say, number, wanted):
    """Whether a parameter has a value, after some ticks: X delivers events when it likes."""
    for _ in range(TRIES):
        say("tick")
        if say(f"value {number}")[0] == wanted:
            return True
        time.sleep(BETWEEN)
    return False


def coloured(pixels, red, green, blue):
    """How many pixels have a colour."""
    return int((pixels == (red, green, blue)).all(axis=2).sum())


def test_strings_and_bow_move_and_rest_costs_nothing(window, tmp_path):
    window("open")  # a picture is there before the host's first tick
    strings, regime = np.s_[70:170, 40:410], np.s_[75:100, 500:]

    def is_good(pixels):  # "Helmholtz motion"
        return coloured(pixels[regime], 0x23, 0x70, 0x3F) > 0

    rest = seen(window, tmp_path / "rest", lambda pixels: coloured(pixels, *WOOD) > 10000)
    assert not is_good(rest)
    window("play 150")
    window("tick")
    first = seen(window, tmp_path / "first", lambda pixels: (pixels != rest)[strings].any())

    def plays_on(pixels) -> bool:
        window("play 7")
        window("tick")
        return (pixels != first)[strings].any() and is_good(pixels)

    seen(window, tmp_path / "second", plays_on)


def test_it_is_played_by_mouse_and_keys_and_the_host_hears_of_it(window, shown):
    preset, mapping = shown["/preset"], shown["/mapping"]
    window("open")
    window(f"click {NEXT[0]} {NEXT[1]}")
    assert becomes(window, preset.number, preset.default + 1)
    assert window("play 1")[2] > 1  # the preset, and what it moves
    window(f"click {PREV[0]} {PREV[1]}")
    assert becomes(window, preset.number, preset.default)
    for code in (TAB, TAB, RIGHT, TAB, END):
        window(f"key {code}")
    assert becomes(window, mapping.number, len(mapping.choices) - 1)
    assert becomes(window, shown["/playing/articulation"].number, 1.0)
    window(f"key {RIGHT}")  # there is none after the last
    assert not becomes(window, mapping.number, len(mapping.choices))


def test_sliders_are_moved_by_mouse_and_keys_and_have_a_usual_value(window, shown):
    vibrato, gain = shown["/playing/vibrato"], shown["/output/gain"]
    window("open")
    window(f"click {SLIDER[0]} {SLIDER[1]}")
    assert becomes(window, vibrato.number, 80.0)
    assert becomes(window, shown["/preset"].number, 0.0)  # it is none of its values
    assert window("play 1")[2] == 2
    window(f"click {SLIDER[0]} {SLIDER[1]}")
    assert becomes(window, vibrato.number, vibrato.default)
    assert becomes(window, shown["/preset"].number, shown["/preset"].default)
    for code in (TAB, TAB, TAB, END):
        window(f"key {code}")
    assert becomes(window, gain.number, gain.hi)


def test_arrows_step_from_a_preset_that_was_changed_and_its_name_restores_it(window, shown):
    preset, vibrato = shown["/preset"], shown["/playing/vibrato"]
    less, name, more = (f"click {x} 324" for x in (20, 72, 125))
    window("open")
    for step, click, back in ((0, name, None), (1, more, less), (-1, less, None)):
        window(f"click {SLIDER[0]} {SLIDER[1]}")
        assert becomes(window, vibrato.number, 80.0)
        assert becomes(window, preset.number, 0.0)
        window(click)
        assert becomes(window, preset.number, preset.default + step)
        if back:
            window(back)
            assert becomes(window, preset.number, preset.default)
    for value in 80.0, 0.0:  # which the preset "ordinary" has
        window(f"click {SLIDER[0]} {SLIDER[1]}")
        assert becomes(window, vibrato.number, value)


def test_values_are_typed(window, shown):
    vibrato, gain, pan = (shown[at] for at in ("/playing/vibrato", "/output/gain", "/room/pan"))
    preset = shown["/preset"]

    def press(*keys):
        for key in keys:
            window(f"key {KEYS.get(key, key)}")

    window("open")
    press("p")  # the next whose name begins so
    after = [i for i, name in enumerate(preset.choices) if name[0] == "p" and i > preset.default]
    assert becomes(window, preset.number, after[0])
    press(*5 * [TAB], *"31", BACK, *"2.5", ENTER)
    assert becomes(window, vibrato.number, 32.5)
    assert window("play 1")[2] >= 1  # the host hears of it
    press(ENTER, *"9", ESCAPE, ENTER, ENTER, ".", ENTER)  # no number
    press(*3 * [TAB], *"-20", TAB)
    assert becomes(window, gain.number, -20.0)
    assert window(f"value {vibrato.number}")[0] == 32.5
    window("click 330 248")  # the words of the last but one
    press(*"-999", ENTER)
    assert becomes(window, pan.number, pan.lo)


def test_closed_it_has_no_timer_and_opens_again(window):
    assert window("play 1")[1] == 0
    for _ in range(3):
        assert window("open")[1] == 1
        window("tick")
        assert window("close")[1] == 0
    assert window("play 10")[1] == 0


@pytest.mark.parametrize("window", [("-fsanitize=thread",)], indirect=True)
def test_sound_and_window_do_not_disturb_each_other(window, shown):
    """ThreadSanitizer's word: the host ends with a code of its own where there was a race."""
    window("open")
    window("begin 400")
    for turn in range(12):
        window("tick")
        window(f"click {(NEXT, PREV)[turn % 3 == 2][0]} {NEXT[1]}")
        window(f"key {(TAB, RIGHT)[turn % 2]}")
        window(f"value {shown['/room/size'].number}")
        window("state")
        window(f"size {680 + turn} {330 + turn}")
    window("end")
    window("close")


@pytest.fixture
def vst3_window(built, display, tmp_path):
    """Click at a place in the window of a small VST3 host; what it heard."""
    program = tmp_path / "vst3_window"
    flags = ["-std=c++17", "-Wall", "-Wextra", "-Werror", f"-I{HEADERS}", "-o", str(program)]
    command = ["g++", *flags, str(HERE / "vst3_window.cpp"), "-ldl", "-lxcb"]
    subprocess.run(command, check=True)
    library = next((built / "Yehu.vst3").rglob("*.so"))

    def click(x, y):
        done = subprocess.run(
            [program, library, str(x), str(y)],
            env={**os.environ, "DISPLAY": display},
            stdout=subprocess.PIPE,
            check=True,
        )
        return map(float, done.stdout.split())

    return click


def test_a_vst3_host_hears_of_a_choice_and_of_a_slider_that_is_held(vst3_window, shown):
    opened, closed, edits, number, value, kept, width, restarted, held, left = vst3_window(*NEXT)
    assert (opened, closed, edits) == (1, 0, 1)
    assert number == shown["/preset"].number
    wanted = (shown["/preset"].default + 1) / shown["/preset"].steps
    assert value == kept == pytest.approx(wanted, abs=1e-6)
    assert restarted == 1 << 2  # values of parameters have changed
    assert width == 1020
    assert (held, left) == (0, 0)
    *_, edits, number, _, _, _, _, held, left = vst3_window(*SLIDER)
    assert (edits, number, held, left) == (1, shown["/playing/vibrato"].number, 1, 0)


def test_a_drag_is_one_gesture(window, shown):
    """Hosts that record automation while something is touched would have holes in it."""
    vibrato = shown["/playing/vibrato"].number
    window("open")
    window(f"click {SLIDER[0]} {SLIDER[1]}")
    for x, value in ((87, 60.0), (66, 40.0)):
        assert becomes(window, vibrato, value + 20.0)
        *_, begun, ended = window("play 1")
        assert (begun, ended) == (1, 0)
        window(f"drag {x} {SLIDER[1]}")
        assert becomes(window, vibrato, value)
    window("release")
    window("tick")
    *_, begun, ended = window("play 1")
    assert (begun, ended) == (1, 1)
