"""The command line: words, help, bad input, full disks, interrupts."""

import argparse
import io
import itertools
import json
import os
import re
import resource
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import soundfile
from commands import COMMAND, is_one_line
from forks import start
from midi_files import midi_file, notes

from yehu_server.cli import _parser, main
from yehu_server.cli.arguments import Parser
from yehu_server.cli.serve import _Ending
from yehu_server.errors import DeviceError
from yehu_server.live.audio.output import shared_memory
from yehu_server.scores.score import LONGEST_DURATION_H
from yehu_server.system.terminals import quoted
from yehu_server.util.sound_file import sound_file

FULL = Path("/dev/full")
EXAMPLE = {
    "duration": 0.05,
    "controls": {"bow_force": 0.5, "bow_velocity": [[0, 0.0], [0.03, 0.2]]},
}
# A disk with 64 kB left. The kernel has been compiled: its cache needs more.
FULL_DISK = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (65536, 65536));" + COMMAND


@pytest.fixture
def tune(tmp_path) -> Path:
    return one_note(tmp_path / "tune.mid", seconds=0.4)


@pytest.fixture
def gesture(tmp_path) -> Path:
    path = tmp_path / "gesture.json"
    path.write_text(json.dumps(EXAMPLE))
    return path


@pytest.fixture
def out(tmp_path) -> Path:
    """An empty folder for results."""
    folder = tmp_path / "out"
    folder.mkdir()
    return folder


@pytest.fixture(params=["render", "simulate"])
def into(request, tune, gesture):
    """A valid command line without its target."""
    return request.param, tune if request.param == "render" else gesture, "-o"


def one_note(path: Path, seconds: float) -> Path:
    return midi_file(path, notes((0.0, seconds, 70, 64)))


# ---------------------------------------------------------------- help


COMMANDS = (
    *("serve", "body", "build", "dataset", "devices", "follow", "learn", "mappings", "page"),
    *("practise", "presets", "render", "replay", "score", "simulate", "surfaces", "sweep"),
    *("body fit", "mappings show", "mappings convert", "presets check"),
)


def test_help_lists_all_commands(command):
    code, out, err = command("--help")
    assert (code, err) == (0, "")
    listed = re.findall(r"^    ?([a-z]+)  ", out, re.MULTILINE)
    assert set(listed) == {name for name in COMMANDS if " " not in name}


def parsers() -> Iterator[Parser]:
    """Those of all commands and their actions."""
    waiting = [_parser()]
    while waiting:
        parser = waiting.pop()
        yield parser
        for action in parser._actions:
            if isinstance(action, argparse._SubParsersAction):
                waiting += action.choices.values()
        waiting += parser._actions_by_word.values()


def test_headings_of_help_are_written_as_their_words_are(monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    headings = set()
    for parser in parsers():
        titles = [group.title for group in parser._action_groups if group._group_actions]
        found = re.findall(r"^(\w.*):$", parser.format_help(), re.MULTILINE)
        found = [each for each in found if each != "examples"]
        assert found == [title[0].upper() + title[1:] for title in titles]
        headings |= set(found)
    assert {"MIDI", "OSC", "OSCQuery", "The page", "Options", "Commands", "Actions"} <= headings


def test_help_names_its_pages_from_where_one_is(monkeypatch, tmp_path):
    root = Path(__file__).parents[1]
    for folder, home, begin in (root, tmp_path, ""), (tmp_path, root.parent, f"~/{root.name}/"):
        monkeypatch.chdir(folder)
        monkeypatch.setattr(Path, "home", lambda home=home: home)
        text = "\n".join(parser.epilog or "" for parser in parsers())
        assert text.count(f"{begin}docs/") == text.count("docs/") > 10
        assert ("/docs/" in text) == bool(begin)


def test_the_examples_of_help_can_be_given():
    examples = [
        shlex.split(line)[1:]
        for parser in parsers()
        for line in re.findall(r"^  (yehu-server .*)", parser.epilog or "", re.MULTILINE)
    ]
    assert {words[0] for words in examples} == {name for name in COMMANDS if " " not in name}
    for words in examples:
        given = list(itertools.takewhile(lambda word: word not in ("<", ">", "|"), words))
        _parser(given).parse_args(given)  # exits where one is wrong


def test_a_call_that_is_not_complete_gets_one_line(subtests, refused):
    for words in [
        (),
        ("rendr",),
        ("--rate", "44100"),
        ("render", "tune.mid"),
        ("render", "-o", "x.wav"),
        ("simulate", "g.json"),
        ("simulate", "one.json", "two.json", "-o", "x.npz"),
        ("body", "taps.csv"),
        ("build", "wasm"),
        ("dataset", "sounds.toml"),
        ("follow", "hum.wav"),
        ("practise",),
        ("score", "tune.mid"),
        ("sweep", "study.toml"),
    ]:
        with subtests.test(words=words):
            assert "--help" in refused(*words)


def test_a_command_in_a_folder_with_a_space_is_named_as_one_types_it(monkeypatch, capsys):
    monkeypatch.setenv("YEHU_COMMAND", "/my music/yehu")
    with pytest.raises(SystemExit):
        main(["learn", "--help"])
    help_text = capsys.readouterr().out
    assert f"\n  {quoted('/my music/yehu')} learn --soft " in help_text
    assert quoted("/my music/yehu") != "/my music/yehu"


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="no terminal is hung up here")
def test_a_wrong_word_gets_a_near_one_and_the_hint_names_the_command_as_called(
    subtests, refused, monkeypatch
):
    monkeypatch.setenv("YEHU_COMMAND", "scripts/yehu")
    for words, message in {
        ("rendr", "a.mid"): "did you mean render? (see scripts/yehu --help)",
        ("presets", "lst"): "did you mean list? (see scripts/yehu presets --help)",
        ("render", "a.mid", "-o", "a.wav", "--scale=x"): "; did you mean --tuning? ",
        ("render", "a.mid", "-o", "a.wav", "--reverb=x"): "; did you mean --room? ",
        ("render", "a.mid", "-o", "a.wav", "--articulation=x"): "did you mean --set ",
        ("render", "a.mid", "-o", "a.wav", "--tempo=90"): "--tempo; that is done in the file",
        ("render", "a.mid", "--out=x"): "no option --out; did you mean --output? ",
        ("play",): "did you mean render or serve? ",
        ("render", "a.mid", "-o", "a.wav", "--rom=hall"): "no option --rom; did you mean --room? "
        "(see scripts/yehu render --help)",
        ("devices", "all"): "scripts/yehu devices: all: one argument too many",
    }.items():
        with subtests.test(words):
            assert message in refused(*words)


def test_an_error_that_names_a_file_says_what_reads_it_or_how_its_name_is_written(
    refused, subtests, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("YEHU_COMMAND", "scripts/yehu")
    for path in ("tune.mid", "my tune.mid"):
        Path(path).write_bytes(b"MThd")
    soundfile.write("take.wav", np.zeros(9), 8000)
    Path("take.jsonl").write_text('{"format": "yehu-server capture"}\n', "utf-8")
    out = ("-o", "out.wav")
    for words, message in {
        ("replay", "take.wav"): "; scripts/yehu follow plays sound files",
        ("render", "take.wav"): "; scripts/yehu follow plays sound files",
        ("render", "take.jsonl"): "; scripts/yehu replay plays captured sessions",
        ("replay", "tune.mid"): "; scripts/yehu render plays scores",
        ("render", "tun.mid"): "no such file; did you mean tune.mid?",
        ("render", "my", "tune.mid"): "my: no such file; a name with a space is written 'my tune.",
        ("render", "–preset", "hall"): "; an option begins with two hyphens: --preset",  # noqa: RUF001
        ("render", "“my", "tune.mid”"): "; these are no quotation marks of a command line",
        ("render", "tune.mid", "--preset=trill"): "; trill is an articulation: --set articulation=",
    }.items():
        with subtests.test(words):
            assert message in refused(*words, *out)
    assert "too many; scripts/yehu render plays scores" in refused("serve", "tune.mid")


def test_behind_nohup_a_command_outlives_its_terminal(command):
    for before, is_handled in ((signal.SIG_IGN, False), (signal.SIG_DFL, True)):
        signal.signal(signal.SIGHUP, before)
        command("mappings")
        assert (signal.getsignal(signal.SIGHUP) is not before) == is_handled


# ---------------------------------------------------------------- what is said when all is well


def test_a_person_reads_what_came_of_it_a_program_one_object_and_who_wants_it_nothing(
    command, into, out
):
    code, told, err = command(*into, out / "x")
    assert (code, err) == (0, "")  # no bar in a pipe
    assert str(out / "x") in told
    assert ("\nMIDI channel 1 (1 note)" in told) == (into[0] == "render")
    assert "outside" not in told
    into = (*into, out / "x", "--overwrite")
    assert command(*into, "--quiet") == (0, "", "")
    for extra in ((), ("--quiet",)):
        code, told, err = command(*into, "--json", *extra)
        assert (code, err) == (0, "")
        assert told.endswith("}\n")
        assert isinstance(json.loads(told), dict)
    assert (out / "x").read_bytes()[:4] in {b"RIFF", b"PK\x03\x04"}
    assert len(list(out.iterdir())) == 1  # each replaced the one before


def test_a_terminal_gets_a_progress_bar_and_a_pipe_its_summary(tmp_path, out):
    tune = one_note(tmp_path / "tune.mid", seconds=6.0)
    pty = pytest.importorskip("pty", reason="Windows has no such terminals")
    ours, theirs = pty.openpty()
    process = start("render", tune, "-o", out / "x.wav", stderr=theirs)
    os.close(theirs)
    seen = b""
    try:
        while chunk := os.read(ours, 4096):
            seen += chunk
    except OSError:  # the process closed the terminal
        pass
    os.close(ours)
    stdout, _ = process.communicate(timeout=60)
    assert process.returncode == 0
    assert b"rendering" in seen
    assert "rendering" not in stdout
    assert stdout.count("\n") == 2


# ---------------------------------------------------------------- bad input


def test_what_is_no_midi_file_among_good_ones_is_refused_in_one_line(refused, tune, tmp_path, out):
    (tmp_path / "text.mid").write_text("O Yehu, play!")
    for name, wrong in (
        ("none.mid", "none.mid"),
        (".", str(tmp_path)),
        ("text.mid", "not a MIDI file"),
    ):
        for more in ((), ("--strict",)):
            words = (tune, tmp_path / name, tune, "-o", out / "x.wav", *more)
            assert wrong in refused("render", *words)
            assert not list(out.iterdir())


def test_a_wrong_option_gets_one_line_and_no_file(subtests, refused, tune, gesture, out):
    render, simulate = ("render", tune, "-o", out / "x.wav"), ("simulate", gesture, "-o", out / "x")
    for command, words, wrong in [
        (render, ("--rate", "8000"), "22050 to 192000"),
        (render, ("--rate", "1e9"), "1e9"),
        (render, ("--rate", "1" + "0" * 5000), "rate"),
        (render, ("--rate",), "--rate"),
        (render, ("--tail", "-1"), "--tail"),
        (render, ("--tail", "nan"), "--tail"),
        (render, ("--gain-db", "25"), "--gain-db"),
        (render, ("--max-duration", LONGEST_DURATION_H + 1), "--max-duration"),
        (render, ("--channel", "0"), "--channel"),
        (render, ("--channel", "17"), "--channel"),
        (render, ("--format", "mp3"), "--format"),
        (render, ("--format", "flac", "--subtype", "float"), "flac"),
        (render, ("--seed", "1.5"), "--seed"),
        (render, ("--norm",), "--norm"),
        (render, ("--phrasing", "1.5"), "1.5 is not within 0 to 1"),
        (render, ("--set", "/bow/sped=0.1"), "/bow/speed"),
        (render, ("--set", "/bow/position=0.9"), "0.04 to 0.5"),
        (render, ("--set", "bow\nposition=0.1"), "position"),
        (render, ("--a4", 389), "390 to 480 Hz"),
        (render, ("--a4", 481), "390 to 480 Hz"),
        (render, ("--keyboard-map", "white.kbm"), "--tuning"),
        (render, ("--mapping", "none"), "none"),
        (simulate, ("--strings", "0"), "--strings"),
        (simulate, ("--strings", "some"), "--strings"),
        (simulate, ("--rate", "44100"), "--rate"),
        (("simulate", gesture, "-o", out / "x.wav"), (), "name an .npz file"),
    ]:
        with subtests.test(words=words):
            assert wrong in refused(*command, *words)
            assert not list(out.iterdir())


def test_a_wrong_instrument_or_gesture_gets_one_line_and_no_file(
    subtests, refused, tune, tmp_path, out
):
    rod = {"string_1": {"r": 1.47e-3, "rho": 100, "E": 1e12}}
    for name, content, wrong in [
        ("x.toml", "T = ", "not an instrument file"),
        ("x.json", "[]", "instrument"),
        ("x.toml", "tension = 1", "x.toml:1: tension: unknown entry"),
        ("x.toml", 'body = "none.json"', "none.json"),
        ("x.json", json.dumps(rod), "grid"),
        ("gesture.json", "MThd", "not a gesture file (no JSON from column 1 on)"),
        ("gesture.json", '{"controls": {"bow\\nforce": 1}}', "force"),
        ("gesture.json", json.dumps({"instrument": rod}), "grid"),
        ("gesture.json", '{"duration": 3600}', "GiB"),
    ]:
        with subtests.test(content):
            (tmp_path / name).write_text(content)
            words = ("simulate", tmp_path / name, "-o", out / "x.npz")
            if name != "gesture.json":
                words = ("render", tune, "-o", out / "x", "--instrument", tmp_path / name)
            assert wrong in refused(*words)
            assert not list(out.iterdir())


# ---------------------------------------------------------------- where results go


def test_a_place_where_nothing_can_be_written_is_refused_and_left_as_it_is(
    refused, into, tmp_path, out
):
    (tmp_path / "file").write_text("mine")
    for place, wrong in (
        (tmp_path / "none" / "x", str(tmp_path / "none")),
        (out, str(out)),
        (tmp_path / "file" / "x", "file"),
        (out / ("x" * 300), "name too long"),
        (Path("/proc/x"), "/proc/x"),
    ):
        assert wrong in refused(*into, place)
    assert (tmp_path / "file").read_text() == "mine"
    assert not (tmp_path / "none").exists()
    assert not list(out.iterdir())


@pytest.mark.parametrize("name", ["x", "x.wav", "x.flac"])
def test_what_is_no_result_of_a_rendering_is_replaced_only_when_asked(
    refused, command, tune, out, name
):
    target = out / name
    soundfile.write(target, np.ones(100), 44100, format="FLAC" if "flac" in name else "WAV")
    before = target.read_bytes()
    assert f"{name}: exists; --overwrite" in refused("render", tune, "-o", target)
    assert target.read_bytes() == before
    assert command("render", tune, "-o", target, "--overwrite")[0] == 0
    assert command("render", tune, "-o", target)[0] == 0
    assert list(out.iterdir()) == [target]


def test_a_dash_is_no_file_to_write(subtests, refused, out, monkeypatch):
    monkeypatch.chdir(out)
    for words in (
        ("render", "tune.mid", "-o", "x.wav", "--plot"),
        ("replay", "take.jsonl", "-o"),
        ("simulate", "gesture.json", "-o"),
        ("sweep", "gesture.json", "--vary", "bow_force=1", "-o"),
        ("mappings", "convert", "keyboard", "-o"),
        ("surfaces", "-o"),
        ("build", "wasm", "-o"),
        ("serve", "--record"),
        ("serve", "--capture"),
    ):
        with subtests.test(words=words):
            assert "standard output" in refused(*words, "-")
            assert not list(out.iterdir())


# ---------------------------------------------------------------- full disks and interrupts


@pytest.mark.parametrize(
    "words", ["x.wav", "x.wav --subtype float", "x.flac", "x.wav --normalize", "x.npz"]
)
def test_a_full_disk_is_reported_in_one_line_and_an_older_file_stays(tmp_path, out, words):
    name, *options = words.split()
    if name == "x.npz":
        first, source = "simulate", tmp_path / "gesture.json"
        source.write_text(json.dumps(EXAMPLE | {"duration": 3.0}))
        (out / name).write_text("older")
        options = ["--overwrite"]
    else:
        first, source = "render", one_note(tmp_path / "tune.mid", seconds=3.0)
        with sound_file(out / name, 44100, name.partition(".")[2], "16") as older:
            older.write(np.ones(100, np.float32))
    before = (out / name).read_bytes()
    process = start(first, source, "-o", out / name, *options, code=FULL_DISK)
    stdout, err = process.communicate(timeout=60)
    assert (process.returncode, stdout) == (2, "")
    assert is_one_line(err)
    assert "file too large" in err
    assert (out / name).read_bytes() == before
    assert len(list(out.iterdir())) == 1


@pytest.mark.parametrize(
    ("signum", "options"),
    [(signal.SIGINT, ()), (signal.SIGTERM, ()), (signal.SIGTERM, ("--normalize",))],
)
def test_an_interrupted_rendering_leaves_no_file(tmp_path, out, signum, options):
    tune = one_note(tmp_path / "tune.mid", seconds=1800.0)
    handled = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler);" + COMMAND
    process = start("render", tune, "-o", out / "x.wav", *options, code=handled)
    deadline = time.monotonic() + 60.0
    while not any(out.iterdir()):  # it is rendering once its partial file is there
        assert process.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.02)
    time.sleep(0.2)
    process.send_signal(signum)
    stdout, err = process.communicate(timeout=30)
    assert process.returncode != 0
    assert stdout == ""
    assert is_one_line(err)
    assert not list(out.iterdir())


HUNG = """
import ctypes
from yehu_server.cli.terminal import ending_at_once, interrupt
import signal
import threading
signal.signal(signal.SIGTERM, interrupt)
libc = ctypes.CDLL(None)
lock, condition = ctypes.create_string_buffer(256), ctypes.create_string_buffer(256)
def tell():
    libc.pthread_mutex_lock(lock)  # free as soon as the main thread waits
    print("begun", flush=True)
with ending_at_once():
    libc.pthread_mutex_lock(lock)
    threading.Thread(target=tell, daemon=True).start()
    libc.pthread_cond_wait(condition, lock)  # as in a compiler: no signal brings it back to Python
"""


def test_a_signal_ends_a_command_that_compiles_though_the_compiler_does_not_return():
    with subprocess.Popen(
        [sys.executable, "-c", HUNG], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout.readline() == "begun\n"
        process.send_signal(signal.SIGTERM)
        _, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (130, "yehu-server: interrupted, nothing written\n")


def test_a_server_that_is_not_made_yet_ends_at_the_first_signal():
    ending = _Ending()
    with pytest.raises(KeyboardInterrupt):
        ending(signal.SIGTERM, None)
    ending.server = SimpleNamespace(skip_fade_out=lambda: None, is_interruptible=True)
    ending(signal.SIGINT, None)
    assert ending.requested.is_set()


def test_the_second_ctrl_c_ends_the_fade_out_and_a_third_all_that_may_be_cut_off():
    for is_interruptible in (True, False):  # not while files are closed
        done: list[str] = []
        ending = _Ending()
        ending.server = SimpleNamespace(
            skip_fade_out=lambda done=done: done.append("hurries"),
            is_interruptible=is_interruptible,
        )
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGINT, signal.SIGINT):
            try:
                ending(number, None)
                done.append("goes on")
            except KeyboardInterrupt:
                done.append("is cut off")
        third = "is cut off" if is_interruptible else "goes on"
        assert done == ["goes on", "goes on", "hurries", "goes on", "hurries", third]


def test_letters_that_a_terminal_has_not_are_no_traceback(tmp_path, monkeypatch):
    (tmp_path / "tune.jianpu").write_text("title=十杯酒\n1=F 2/4 4=120\n\n1 2 |\n", "utf-8")
    terminal = io.TextIOWrapper(io.BytesIO(), "latin-1", write_through=True)
    monkeypatch.setattr(sys, "stdout", terminal)
    assert main(["score", "show", str(tmp_path / "tune.jianpu")]) == 0
    assert terminal.buffer.getvalue().startswith(rb"\u5341\u676f\u9152")


def test_a_limit_on_files_is_reported_where_it_leaves_no_memory_for_instruments():
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, before[1]))
    try:
        with pytest.raises(DeviceError, match=r"no memory of \d+ MB for .*: file too large"):
            shared_memory()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_simulation_without_memory_says_so(refused, gesture, out, monkeypatch):
    def no_memory(*_, **__):
        raise MemoryError

    monkeypatch.setattr("yehu_server.simulation.run.simulate", no_memory)
    refused("simulate", gesture, "-o", out / "x.npz")
    assert not list(out.iterdir())


def test_a_whole_run_in_a_new_python(tune, out):
    command = [sys.executable, "-c", COMMAND, "render", tune, "-o", out / "x.wav", "--json"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (run.returncode, run.stderr) == (0, "")
    sound, rate = soundfile.read(out / "x.wav")
    assert json.loads(run.stdout)["duration_s"] == len(sound) / rate
    assert np.abs(sound).max() > 0.01


@pytest.mark.skipif(not FULL.exists(), reason="Linux has a file that is full")
@pytest.mark.parametrize("words", [("presets", "list"), ("--help",)])
def test_a_full_standard_output_is_reported_in_one_line(words):
    with FULL.open("w") as full, start(*words, stdout=full) as process:
        _, said = process.communicate(timeout=60)
    assert process.returncode == 2
    assert is_one_line(said)
    assert "standard output: no space left on device" in said
