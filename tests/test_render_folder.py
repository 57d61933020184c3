"""``yehu-server render FOLDER``: a folder of scores to a folder of sounds."""

import io
import json
import multiprocessing
import os
import shutil
import signal
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest
import soundfile
from commands import COMMAND, is_one_line
from fiddles import SLACK_TOML
from forks import in_the_place_of_workers, start
from midi_files import midi_file, notes
from waiting import LONG_S, until

from yehu_lab.practising.practice_file import write_bowing_table
from yehu_server.cli import main
from yehu_server.core.player.bowing import default_bowing_table
from yehu_server.util.sound_file import is_rendered

# Where a whole command starts them, its workers are new Pythons.
pytestmark = pytest.mark.usefixtures("_forked_workers")

DRY = ("--dry", "--mono", "--tail", 0)  # in little time
ODD = ("with space.mid", "line\nbreak.mid", "no\udcffutf-8.mid", "x/y.mid", "x/Y.kar")


def tune(path: Path, note: int = 67, seconds: float = 0.1) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    made = midi_file(path.with_name("made.mid_"), notes((0.0, seconds, note, 90)))
    made.rename(path)
    return path


@pytest.fixture(scope="module")
def once(tmp_path_factory):
    """A folder of scores, two of them broken, and what becomes of it on two cores."""
    folder = tmp_path_factory.mktemp("folder")
    for number, name in enumerate(ODD):
        tune(folder / "in" / name, 66 + number)
    (folder / "in" / "empty.mid").touch()
    (folder / "in" / "broken.mid").write_bytes(b"MThd")
    words = ["render", folder / "in", "-o", folder / "out", *DRY, "--jobs", 2, "--json"]
    out, err = io.StringIO(), io.StringIO()
    with in_the_place_of_workers(), redirect_stdout(out), redirect_stderr(err):
        code = main([*map(str, words)])
    return folder, code, out.getvalue(), err.getvalue()


@pytest.fixture
def folder(once, tmp_path) -> Path:
    """A copy of that folder, of its own."""
    shutil.copytree(once[0], tmp_path / "f", symlinks=True)
    return tmp_path / "f"


def manifest(out: Path) -> dict[str, dict]:
    lines = (out / "manifest.jsonl").read_text().splitlines()
    return {line["file"]: line for line in map(json.loads, lines)}


def sounds(out: Path) -> dict[str, bytes]:
    return {str(path.relative_to(out)): path.read_bytes() for path in out.rglob("*.wav")}


def times(out: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in out.rglob("*.wav")}


def leavings(out: Path) -> list[Path]:
    """What is half made."""
    return [path for path in out.rglob("*") if path.suffix == ".part"]


# ---------------------------------------------------------------- a whole folder


def test_all_scores_are_rendered_and_the_broken_ones_reported(once):
    folder, code, out, err = once
    assert code == 1
    assert sorted(err.splitlines()) == [
        "yehu-server: broken.mid: has a damaged header at byte 0",
        "yehu-server: empty.mid: is empty",
    ]
    assert set(sounds(folder / "out")) == {
        "with space.wav",
        "line\nbreak.wav",
        os.fsdecode(b"no\xffutf-8.wav"),
        "x/y.wav",
        "x/Y.kar.wav",
    }
    lines = manifest(folder / "out")
    assert list(lines) == sorted([*ODD, "empty.mid", "broken.mid"])
    assert sorted(map(str, map(json.loads, out.splitlines()))) == sorted(map(str, lines.values()))
    assert not leavings(folder / "out")


def test_the_manifest_tells_what_became_of_each(once):
    lines = manifest(once[0] / "out")
    assert lines["empty.mid"] == {"file": "empty.mid", "error": "is empty"}
    line = lines["with space.mid"]
    sound, rate = soundfile.read(once[0] / "out" / line["output"])
    assert line["duration_s"] == len(sound) / rate
    assert line["peak"] == pytest.approx(abs(sound).max(), abs=1e-6)
    assert (line["notes"], line["out_of_range"], line["warnings"]) == (1, 0, [])


@pytest.mark.parametrize("quiet", [[], ["--quiet"]])
def test_the_manifest_tells_what_was_moved_and_the_last_line_where_that_is(
    command, tmp_path, quiet
):
    tune(tmp_path / "in" / "low.mid", 50)
    words = ("render", tmp_path / "in", "-o", tmp_path / "out", *DRY, "--jobs", 1, *quiet)
    code, out, _ = command(*words)
    assert code == 0
    assert "moved to fit" in manifest(tmp_path / "out")["low.mid"]["warnings"][0]
    shown = "manifest.jsonl says what was chosen or moved in 1"
    assert (shown in out) is not bool(quiet)


def test_each_sound_is_that_of_the_score_rendered_alone(once, command, tmp_path):
    alone = tmp_path / "alone.wav"
    assert command("render", once[0] / "in" / "x" / "Y.kar", "-o", alone, *DRY)[0] == 0
    assert alone.read_bytes() == (once[0] / "out" / "x" / "Y.kar.wav").read_bytes()


# ---------------------------------------------------------------- again


def test_what_is_up_to_date_is_not_rendered_again(folder, command):
    before, told = times(folder / "out"), (folder / "out" / "manifest.jsonl").read_bytes()
    for name in ("empty.mid", "broken.mid"):
        (folder / "in" / name).unlink()
    code, out, err = command("render", folder / "in", "-o", folder / "out", *DRY)
    assert (code, err) == (0, "")
    assert "0 rendered, 5 up to date, 0 failed" in out
    assert times(folder / "out") == before
    kept = [line for line in told.splitlines() if b"error" not in line]
    assert (folder / "out" / "manifest.jsonl").read_bytes().splitlines() == kept


def test_only_what_changed_is_rendered_again(folder, command):
    before = times(folder / "out")
    tune(folder / "in" / "x" / "y.mid", 75)
    (folder / "out" / "with space.wav").unlink()
    code, out, _ = command("render", folder / "in", "-o", folder / "out", *DRY)
    assert code == 1
    assert "2 rendered, 3 up to date, 2 failed" in out
    after = times(folder / "out")
    changed = {path.name for path in before if after[path] != before[path]}
    assert changed == {"y.wav", "with space.wav"}


def test_a_changed_mapping_or_a_practice_beside_the_instrument_renders_again(tmp_path, command):
    tune(tmp_path / "in" / "a.mid")
    mapping, instrument = tmp_path / "m.toml", tmp_path / "mine.toml"
    mapping.write_text('base = "keyboard"\n')
    instrument.write_text(SLACK_TOML)
    words = ("render", tmp_path / "in", "-o", tmp_path / "out", *DRY)
    words += ("--mapping", mapping, "--instrument", instrument)
    assert "1 rendered, 0 up" in command(*words)[1]
    assert "0 rendered, 1 up" in command(*words)[1]
    mapping.write_text('base = "keyboard"\n[start]\n"/playing/pressure" = 0.9\n')
    assert "1 rendered, 0 up" in command(*words)[1]
    write_bowing_table(tmp_path / "mine.practice.json", default_bowing_table(), 44100.0)
    assert "1 rendered, 0 up" in command(*words)[1]
    assert "0 rendered, 1 up" in command(*words)[1]


def test_a_file_of_the_users_own_is_not_replaced(folder, command):
    own = folder / "out" / "with space.wav"
    own.write_bytes(b"my own")
    code, _, err = command("render", folder / "in", "-o", folder / "out", *DRY)
    assert code == 1
    assert "with space.mid: exists; --overwrite" in err
    assert own.read_bytes() == b"my own"
    command("render", folder / "in", "-o", folder / "out", *DRY, "--overwrite")
    assert is_rendered(own)


# ---------------------------------------------------------------- interrupted


def is_at_second(out: Path) -> bool:
    """Whether a first score is whole, and another one is being made."""
    return (out / ".yehu-server" / "a.wav.json").exists() and bool(leavings(out))


@pytest.fixture
def long(tmp_path) -> Path:
    """A folder with a score that takes long, between two that do not."""
    tune(tmp_path / "in" / "a.mid")
    tune(tmp_path / "in" / "b.mid", seconds=3000.0)
    tune(tmp_path / "in" / "c.mid")
    return tmp_path


@pytest.mark.parametrize(
    "signum", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow), signal.SIGKILL]
)
def test_an_interrupted_folder_goes_on_where_it_was(long, command, signum):
    handled = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler);" + COMMAND
    words = ("render", long / "in", "-o", long / "out", *DRY, "--jobs", 1)
    process = start(*words, code=handled)
    until(lambda: process.poll() is not None or is_at_second(long / "out"), within_s=LONG_S)
    process.send_signal(signum)
    _, err = process.communicate(timeout=60)
    until(lambda: not leavings(long / "out"), within_s=LONG_S)
    if signum != signal.SIGKILL:
        assert process.returncode == 130
        assert is_one_line(err)
        # The first is counted once the process that made it has said so.
        done = list(manifest(long / "out"))
        assert done in ([], ["a.mid"])
        assert f"{len(done)} of 3 scores are in" in err
    before = times(long / "out")
    tune(long / "in" / "b.mid")
    code, out, err = command(*words)
    assert (code, err) == (0, "")
    assert "2 rendered, 1 up to date, 0 failed" in out
    assert times(long / "out").items() >= before.items()


def test_a_process_that_is_killed_takes_no_other_score_with_it(long, command):
    def kill_two() -> None:
        for _ in range(2):
            until(lambda: is_at_second(long / "out"), within_s=LONG_S)
            before = leavings(long / "out")
            [worker] = multiprocessing.active_children()
            worker.kill()
            until(lambda before=before: leavings(long / "out") != before, within_s=LONG_S)

    with ThreadPoolExecutor(1) as beside:
        killed = beside.submit(kill_two)
        code, _, err = command("render", long / "in", "-o", long / "out", *DRY, "--jobs", 1)
    killed.result()
    assert code == 1
    assert err == "yehu-server: b.mid: the process that rendered it was killed by signal 9\n"
    assert set(sounds(long / "out")) == {"a.wav", "c.wav"}
    assert not leavings(long / "out")


# ---------------------------------------------------------------- wrong calls


def test_a_wrong_call_gets_one_line_and_makes_nothing(subtests, refused, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tune(tmp_path / "in" / "a.mid")
    for name in ("bare", "taken"):
        (tmp_path / name).mkdir()
    (tmp_path / "file").touch()
    (tmp_path / "taken" / "manifest.jsonl").write_text("mine\n")
    for words, wrong in [
        ("in -o -", "a folder is rendered to a folder"),
        ("in -o file", "file: is a file; name a folder"),
        ("in -o x.wav", "in: is a folder, which is rendered to a folder, not to x.wav"),
        ("in -o none/out", "does not exist"),
        ("in in/a.mid -o out", "in: is a folder; name it alone"),
        ("in -o out --stems s", "--stems is for one score"),
        ("in -o out --plot s.png", "--plot is for one score"),
        ("in -o out --format raw", "--format raw is for"),
        ("in -o out --format flac --subtype float", "cannot hold float"),
        ("in -o out --mapping none.toml", "none.toml"),
        ("bare -o out", "bare: has no scores"),
        ("in -o taken", "is not a manifest of yehu-server; move it away"),
    ]:
        with subtests.test(words):
            assert wrong in refused("render", *words.split())
            assert not list(tmp_path.rglob("*.wav"))
    assert (tmp_path / "taken" / "manifest.jsonl").read_text() == "mine\n"
