"""Foreign text in terminals, logs and answers: bounded lines without control codes."""

import argparse
import io
import json
import logging
import os
import sys

import pytest

from yehu_server.cli import main, terminal
from yehu_server.cli.devices import devices_report
from yehu_server.cli.report import bindings_table, mapping_report, status_line
from yehu_server.errors import FIRST, LAST, one_line
from yehu_server.live.audio.devices import AudioDevice
from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import Mapping

EVIL = "\x1b]0;owned\x07\x1b[31mred\x9b2J\r\n\u202eevil\udcff[bold]:smile:"
SPELLED = r"\x1b]0;owned\x07\x1b[31mred\x9b2J\r\n\u202eevil\udcff[bold]:smile:"


def test_what_would_steer_a_terminal_is_spelled_out():
    assert one_line(EVIL) == SPELLED


@pytest.mark.parametrize("text", ["", "take 1.wav", "椰胡　〈曲〉.mid", "naïve\xa0ö"])
def test_ordinary_text_of_any_language_stays(text):
    assert one_line(text) == text


def is_plain(text: str) -> bool:
    return all(line.isprintable() for line in text.split("\n"))


def test_errors_are_bounded_lines_without_control_codes(subtests, refused, tmp_path):
    (tmp_path / "evil.toml").write_text(f"set = [{json.dumps(EVIL[:-20] * 200)}]\n")
    for words in (
        ("render", EVIL, "-o", "x.wav"),
        ("render", "x" * 5000, "-o", "x.wav"),
        ("presets", "show", EVIL),
        ("mappings", "check", EVIL),
        ("serve", "--osc-allow", EVIL),
        ("serve", "--set", EVIL),
        ("serve", "--rate", EVIL),
        (EVIL,),
        ("serve", "--config", tmp_path / "evil.toml"),
    ):
        with subtests.test(words[:2]):  # a control code takes some characters to spell
            assert len(refused(*words)) < 6 * (FIRST + LAST)


def test_text_of_a_preset_is_shown_and_steers_nothing(tmp_path, capsys):
    about = "soft\x9b2J\u202e" + "x" * 5000
    (tmp_path / "mine.toml").write_text(f'version = 1\nabout = "{about}"\n', encoding="utf-8")
    for words in (("list",), ("show", "mine")):
        assert main(["presets", *words, "--presets", str(tmp_path)]) == 0
        out, _ = capsys.readouterr()
        assert r"soft\x9b2J\u202ex" in out
        assert is_plain(out)
        assert max(map(len, out.split("\n"))) < 1100


def test_names_of_devices_are_no_markup_and_steer_nothing(capsys):
    device = AudioDevice(0, EVIL, "[red]api", 2, 48000.0, 1.0)
    devices_report([device], [device], "", "[red]", [EVIL], "")
    devices_report([], [], EVIL, "alsa", [], EVIL)
    out, _ = capsys.readouterr()
    assert is_plain(out)
    assert "[red]api" in out
    assert ":smile:" in out


def test_text_of_a_mapping_is_no_markup_and_steers_nothing(capsys):
    mapping_report(Mapping("[red]" + EVIL, (Bind("/a[bold]", "/playing/speed"),), about=EVIL))
    out, _ = capsys.readouterr()
    assert is_plain(out)
    assert "[red]" in out
    assert "/a[bold]" in out
    table = bindings_table([[EVIL, "/yehu/playing/speed", 0.0, 1.0, "linear", EVIL, 0.5, 0.2]])
    assert is_plain("".join(cell for column in table.columns for cell in column.cells))


def test_the_line_of_status_has_names_without_control_codes():
    status = dict.fromkeys(
        ("note", "bow_speed", "peak_db", "load", "missed_deadlines", "underruns"), 0.0
    )
    line = status_line(status | {"device": EVIL, "midi_ports": EVIL, "recording": EVIL})
    assert is_plain(line)


@pytest.mark.parametrize("is_json", [False, True])
def test_log_lines_are_bounded_and_steer_nothing(monkeypatch, is_json):
    before = logging.getLogger().handlers[:]
    stderr = io.StringIO()
    try:
        terminal.set_up_log(argparse.Namespace(json_log=is_json, log_level="info"))
        monkeypatch.setattr(sys, "stderr", stderr)
        logging.getLogger("yehu_server").info("MIDI: %s", EVIL + "x" * 100_000)
        logging.getLogger("yehu_server").error("a defect", exc_info=ValueError(EVIL))
    finally:
        logging.basicConfig(handlers=before, force=True)
        logging.getLogger("yehu_server").setLevel(logging.NOTSET)
    said = stderr.getvalue()
    assert is_plain(said)
    assert r"\x1b[31mred" in said.replace("\\\\", "\\")
    assert "ValueError" in said
    assert len(said) < 5000


def test_lines_of_a_journal_begin_with_their_level_and_those_of_other_files_do_not(
    monkeypatch, tmp_path
):
    before = logging.getLogger().handlers[:]
    for is_journal in (True, False):
        with (tmp_path / "stderr").open("w+") as stderr:
            at = os.fstat(stderr.fileno())
            journal = f"{at.st_dev}:{at.st_ino + (not is_journal)}"
            monkeypatch.setenv("JOURNAL_STREAM", journal)
            monkeypatch.setattr(sys, "stderr", stderr)
            try:
                terminal.set_up_log(argparse.Namespace(json_log=False, log_level="info"))
                log = logging.getLogger("yehu_server")
                log.info("MIDI: keys is connected")
                log.error("a defect", exc_info=ValueError("bad"))
            finally:
                logging.basicConfig(handlers=before, force=True)
                log.setLevel(logging.NOTSET)
            stderr.seek(0)
            said = stderr.read().splitlines()
        if is_journal:
            assert said[0] == "<6>MIDI: keys is connected"
            assert said[1] == "<3>a defect"
            assert said[-1] == "<3>ValueError: bad"
        else:
            assert said[:2] == ["yehu-server: MIDI: keys is connected", "yehu-server: a defect"]


def test_lines_of_one_cause_are_bounded_a_minute():
    few = terminal._RepeatFilter()
    times = [second / 10 for second in range(1000)]

    def logged(line: int, level: int = logging.INFO) -> list[str]:
        made = [logging.LogRecord("a", level, "a.py", line, "%d", (i,), None) for i in range(1000)]
        for record, at in zip(made, times, strict=True):
            record.created = at
        return [record.getMessage() for record in made if few.filter(record)]

    told = logged(1)
    assert len(told) == 2 * terminal.MAX_REPEATS
    assert told[terminal.MAX_REPEATS - 1].endswith("left out for a minute)")
    assert len(logged(2)) == len(told)  # each cause by itself
    assert len(logged(3, logging.DEBUG)) == 1000
