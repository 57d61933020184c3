"""Options of serve, from the command line and from a file."""

import sys
from pathlib import Path

import pytest

from yehu_server import cli
from yehu_server.cli.config import MAX_VALUES, parse
from yehu_server.cli.serve_options import options_of

# A MIDI system of other machines.
ELSEWHERE = "core" if sys.platform != "darwin" else "windows"


def options(*words: str):
    return options_of(parse(["serve", *words], cli._parser()))


@pytest.fixture
def file(tmp_path) -> Path:
    return tmp_path / "serve.toml"


def test_without_options_this_machine_alone_is_heard():
    plain = options()
    assert plain.osc == ("127.0.0.1", 9000)
    assert (plain.output.blocksize, plain.output.channels) == (128, 2)
    assert plain.midi is not None
    assert plain.midi.patterns == []


def test_any_option_may_stand_in_the_file(file):
    file.write_text(
        'rate = 48000\nmidi-in = ["keystep", "breath"]\nosc = ":9100"\nlatency = 0.01\n'
        'set = { "/bow/position" = 0.1 }\nosc_allow = ["10.0.0.0/8"]\njitter-buffer = 5\n'
        "programs = true\nwatch = false\nannounce = false\nno-http = true\n"
    )
    read = options("--config", str(file))
    assert read.output.rate == 48000
    assert read.output.latency == 0.01
    assert read.midi.patterns == ["keystep", "breath"]
    assert read.osc == ("127.0.0.1", 9100)
    assert read.parts[0].playing.settings == (("/bow/position", 0.1),)
    assert "10.1.2.3" in read.allowed
    assert "192.168.0.1" not in read.allowed
    assert read.jitter_ms == 5.0
    assert read.parts[0].playing.programs
    assert read.parts[0].reread is None
    assert read.announce is False
    assert read.http is None


def test_presets_combine_by_a_plus_or_one_after_another(file, tmp_path):
    file.write_text("preset = ['sul-tasto', 'hall']\n")
    (tmp_path / "own.toml").write_text("version = 1\n[values]\n'/room/level' = 0.5\n")
    starts = [
        dict(options(*words).parts[0].playing.start)
        for words in (
            ("--preset", "sul-tasto+hall"),
            ("--preset", "sul-tasto", "--preset=hall"),
            ("--config", str(file)),
            ("--preset", "sul-tasto+hall", "--preset", str(tmp_path / "own.toml")),
        )
    ]
    assert starts[0] == starts[1] == starts[2] == {**starts[3], "/room/level": 1.0}
    assert starts[3]["/room/level"] == 0.5


def test_an_option_of_one_value_that_is_given_twice_is_told(file, capsys):
    file.write_text("rate = 48000\n")
    options("--rate", "44100", "--midi-in", "a", "--midi-in", "b", "--config", str(file))
    assert capsys.readouterr().err == ""
    options("--room=hall", "--room", "dry", "--config", str(file))
    assert capsys.readouterr().err.count("--room is given 2 times: the last counts") == 1


@pytest.mark.parametrize("order", [0, 1])
def test_the_command_line_wins_wherever_the_file_is_named(file, order):
    file.write_text("rate = 48000\nblocksize = 64\n")
    words = [["--rate", "44100"], [f"--config={file}"]]
    read = options(*words[order], *words[1 - order])
    assert (read.output.rate, read.output.blocksize) == (44100, 64)


def test_an_option_that_may_be_repeated_adds_to_those_of_the_file(file):
    file.write_text('midi-in = "keystep"\n[set]\n"/playing/volume" = 0.5\n')
    words = ("--midi-in", "breath", "--set", "/playing/volume=0.25")
    read = options(*words, "--config", str(file))
    assert read.midi.patterns == ["keystep", "breath"]
    assert read.parts[0].playing.settings == (("/playing/volume", 0.5), ("/playing/volume", 0.25))


def test_an_error_in_the_file_names_file_and_line(subtests, file, refused):
    for text, reason in [
        ("help = true", "cannot ask for help"),
        (f"midi-in = [{'1,' * 30_000}]", f"midi-in: more than {MAX_VALUES} values"),
        ("rate = 'fast'", ":2: rate: 'fast' is not a number"),
        ("rat = 48000", ":2: rat: unknown option; did you mean rate?"),
        ("rate = [", "not a config file (expected a value; text is quoted, got 'rate = [')"),
        ("rate = 5", ":2: rate: 5 is not within 22050 to 192000 Hz"),
        ("config = 'other.toml'", ":2: config: a config file cannot name another"),
        ("rate = 1979-05-27", ":2: rate: expected text or a number"),
        ("blocksize = 0", ":2: blocksize: 0 is not within 1 to 8192 frames"),
        ("http = false", ":2: http: expected text or a number, got false"),
        ("watch = 1", ":2: watch: expected true or false, got 1"),
        ("range = 'fold'", ":2: range: 'fold' is not one of transpose, "),
        ("\n[set]\n'/playing/volume' = 'x'", ":3: set: /playing/volume: 'x' is not a number"),
        ("set = {'/playing/volume' = 1000}", ":2: set: /playing/volume: 1000 is not within"),
        ("[set]\n'/no/such' = 1", ":2: set: unknown parameter"),
        ("preset = 'flautand'", ":2: preset: no preset 'flautand'"),
        ("mapping = 'nope'", ":2: mapping: no mapping 'nope'"),
        ("osc = 99999", ":2: osc: "),
        ("[[bind]]", ":2: bind: unknown option; it looks like a mapping"),
        ("\n[set]\n'/playing/volume' = []", ":3: set: expected text or a number"),
    ]:
        with subtests.test(text[:30]):
            file.write_text(f"mpe = true\n{text}")
            error = refused("serve", "--config", file)
            assert f"{file}{reason}" in error if reason.startswith(":") else reason in error
            assert str(file) in error


def test_a_wrong_option_is_one_clear_line(subtests, refused):
    for words, reason in [
        (["--osc", "127.0.0.1:port"], "expected HOST:PORT"),
        (["--osc", "127.0.0.1:99999"], "expected HOST:PORT"),
        (["--osc-allow", "everyone"], "is not a network"),
        (["--set", "/no/such=1"], "unknown parameter"),
        (["--midi-api", ELSEWHERE], f"--midi-api {ELSEWHERE}: not available here; there are: "),
        (["--mapping", "none"], "no mapping 'none'"),
        (["--config", "/no/such/file.toml"], "no such file"),
        (["--latency", "soon"], "'soon' is not a number"),
    ]:
        with subtests.test(reason):
            assert reason in refused("serve", *words)


def test_oscquery_is_for_this_machine_until_said_otherwise():
    http = options().http
    assert http.address == ("127.0.0.1", 9001)
    assert options("--http", "192.0.2.5:80").http.address == ("192.0.2.5", 80)
    assert options("--http", ":0").http.address == ("127.0.0.1", 0)
    assert "192.0.2.7" not in options("--http-allow", "198.51.100.0/24").http.allowed
    assert options("--http", "none").http is None
    assert options("--no-http").http is None
