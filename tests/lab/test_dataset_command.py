"""``yehu-server dataset``: labelled sounds, the same each time."""

import contextlib
import hashlib
import io
import json
import signal
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import soundfile
from clusters import cluster_in
from commands import results_in
from forks import in_the_place_of_workers, start
from waiting import LONG_S, until

from yehu_lab.dataset import making
from yehu_lab.dataset.card import card_of
from yehu_lab.dataset.description import read_description
from yehu_server.cli import main
from yehu_server.errors import OutputError
from yehu_server.rendering import cluster_worker
from yehu_server.util import __version__

# Where a whole command starts them, its workers are new Pythons.
pytestmark = pytest.mark.usefixtures("_forked_workers")

COUNT = 24
TEXT = """\
count = 24
seed = 5
[split]
train = 3
test = 1
[draw]
duration = 0.1
bow_force = { from = 0.1, to = 2.0 }
[keep]
every = 100
signals = ["relative_velocity"]
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    """A folder with a description, and the data set of it, made on two cores."""
    folder = tmp_path_factory.mktemp("dataset")
    (folder / "d.toml").write_text(TEXT)
    words = ("dataset", folder / "d.toml", "-o", folder / "out", "--jobs", 2)
    out, err = io.StringIO(), io.StringIO()
    with in_the_place_of_workers(), redirect_stdout(out), redirect_stderr(err):
        assert main([*map(str, words)]) == 0
    assert "24 made, 0 up to date, 0 failed" in out.getvalue()
    assert err.getvalue() == ""
    return folder


def lines(out: Path) -> list[dict]:
    return [json.loads(line) for line in (out / "manifest.jsonl").read_text().splitlines()]


# ---------------------------------------------------------------- what is there


def test_the_manifest_tells_all_files_and_their_hashes(made):
    found = results_in(made / "out")
    told = lines(made / "out")
    assert [line["number"] for line in told] == list(range(COUNT))
    of_sounds = {line[name] for line in told for name in ("file", "arrays")}
    assert set(found) == of_sounds | {"README.md", "dataset.json", "manifest.jsonl"}
    for line in told:
        assert line["hash"] == hashlib.sha256(found[line["file"]]).hexdigest()
        assert line["arrays_hash"] == hashlib.sha256(found[line["arrays"]]).hexdigest()
        assert line["file"].startswith(f"{line['split']}/")
        assert 0.1 <= line["drawn"]["bow_force"] <= 2.0


def test_the_card_tells_licence_version_and_units(made):
    facts = json.loads((made / "out" / "dataset.json").read_text())
    line = lines(made / "out")[3]
    assert set(facts["arrays"]) == set(np.load(made / "out" / line["arrays"]).files)
    assert all(each["unit"] and each["what"] for each in facts["arrays"].values())
    assert (facts["sounds"], facts["seed"], facts["license"]) == (COUNT, 5, "MIT")
    assert facts["made_by"] == f"yehu-server {__version__}"
    assert facts["description"]["draw"]["duration"] == 0.1
    card = (made / "out" / "README.md").read_text()
    for told in ('license: "mit"', facts["made_by"], "| `bow_velocity` | m s-1 |"):
        assert told in card
    assert "Torsion of strings: off; width of the hair:\n0 mm." in card
    facts["instrument"] |= {"torsion": "on", "bow": facts["instrument"]["bow"] | {"width": 0.008}}
    assert "Torsion of strings: on; width of the hair:\n8 mm." in card_of(facts)


def test_sound_and_arrays_are_of_one_stroke(made):
    line = lines(made / "out")[3]
    sound, rate = soundfile.read(made / "out" / line["file"])
    arrays = np.load(made / "out" / line["arrays"])
    assert (len(sound), rate) == (4410, 44100)
    assert arrays["bow_force"].max() == pytest.approx(line["drawn"]["bow_force"])
    assert len(arrays["bow_force"]) == len(arrays["time"]) == 45
    assert arrays["signal_relative_velocity"].shape == (4410,)
    assert len(arrays["regime"]) == len(arrays["regime_time"]) == 5


# ---------------------------------------------------------------- the same each time


def test_one_core_makes_the_same_bytes_as_two(made, command, tmp_path):
    assert command("dataset", made / "d.toml", "-o", tmp_path / "one", "--jobs", 1)[0] == 0
    assert results_in(tmp_path / "one") == results_in(made / "out")


def test_another_seed_changes_all_draws_and_another_entry_no_other(made):
    description = read_description(made / "d.toml")
    (made / "more.toml").write_text(TEXT.replace("[keep]", "stop = { from = 0, to = 5 }\n[keep]"))
    more = read_description(made / "more.toml")
    (made / "seed.toml").write_text(TEXT.replace("seed = 5", "seed = 6"))
    usual, same, other = (
        [each.draw(number, "bow_force") for number in range(9)]
        for each in (description, more, read_description(made / "seed.toml"))
    )
    assert same == usual
    assert set(other).isdisjoint(usual)


@pytest.mark.parametrize(
    "signum", [pytest.param(signal.SIGTERM, marks=pytest.mark.slow), signal.SIGKILL]
)
def test_an_interrupted_data_set_goes_on_where_it_was(command, tmp_path, signum):
    longer = TEXT.replace("duration = 0.1", "duration = 0.2").replace("count = 24", "count = 32")
    (tmp_path / "d.toml").write_text(longer)
    words = (tmp_path / "d.toml", "-o", tmp_path / "out")
    process = start("dataset", *words, "--jobs", 1)
    hidden = tmp_path / "out" / ".yehu-server"
    until(
        # A record that is being put in its place is empty for a moment.
        lambda: (
            process.poll() is not None
            or any(record.stat().st_size for record in hidden.glob("sounds-*.json"))
        ),
        within_s=LONG_S,
    )
    process.send_signal(signum)
    _, err = process.communicate(timeout=60)
    if signum == signal.SIGTERM:
        assert process.returncode == 130
        assert "sounds are in" in err
    code, out, _ = command("dataset", *words)
    assert code == 0
    assert "16 up to date" in out or "32 up to date" in out
    whole = results_in(tmp_path / "out")
    command("dataset", tmp_path / "d.toml", "-o", tmp_path / "whole")
    assert whole == results_in(tmp_path / "whole")


# ---------------------------------------------------------------- on a cluster


@pytest.mark.slow
def test_a_cluster_makes_the_same_bytes(made, command, tmp_path):
    pytest.importorskip("distributed")
    cluster_worker.identity.cache_clear()
    with cluster_in(tmp_path) as processes:
        words = ("dataset", made / "d.toml", "-o", tmp_path / "out", "--dask", processes.file)
        code, _, err = command(*words)
    assert (code, err) == (0, "")
    assert results_in(tmp_path / "out") == results_in(made / "out")


def test_sounds_travel_where_the_folder_is_not_seen(made, tmp_path):
    description = replace(read_description(made / "d.toml"), count=2)
    [part] = making.parts_of(description, tmp_path / "out", "key")
    far = replace(part, folder=Path("/nowhere/at/all"), mark=Path("/nowhere/mark"))
    told = making.perform(far)
    assert len(told["files"]) == 4
    assert list(making.received(part, told)) == lines(made / "out")[:2]
    for name, data in results_in(tmp_path / "out").items():
        assert data == results_in(made / "out")[name]
    assert making.split_up_to_date([part]) == ([], lines(made / "out")[:2])


def test_an_answer_that_is_no_sounds_is_refused_and_nothing_written(made, tmp_path):
    description = replace(read_description(made / "d.toml"), count=1)
    [part] = making.parts_of(description, tmp_path / "out", "key")
    [line] = lines(made / "out")[:1]
    taken = []
    for told in (
        None,
        {"lines": [line]},
        {"lines": [], "files": {}},
        {"lines": [{**line, "number": 2}], "files": {}},
        {"lines": [{**line, "labels": {"regime": []}}], "files": {}},
        {"lines": [line], "files": {"../away": b"x"}},
        {"lines": [line], "files": {line["file"]: "text"}},
        {"lines": [line], "files": {}},
        {"lines": [{**line, "more": "x" * 2**20}], "files": dict.fromkeys(part.names, b"x")},
    ):
        with contextlib.suppress(OutputError):
            making.received(part, told)
            taken.append(told)
    assert taken == []
    assert not list(tmp_path.iterdir())


# ---------------------------------------------------------------- what goes wrong


def test_sounds_that_cannot_be_made_are_reported_and_the_others_made(command, tmp_path):
    # All but a single note would last too long.
    draw = "[draw]\nnotes = {choose = [1, 31, 32]}\nlength = 9.5\ngap = 10\n"
    (tmp_path / "d.toml").write_text(f'kind = "notes"\ncount = 4\nseed = 6\n{draw}')
    description = read_description(tmp_path / "d.toml")
    failing = sum(description.draw(number, "notes") > 1 for number in range(4))
    assert 0 < failing < 4
    code, out, err = command("dataset", tmp_path / "d.toml", "-o", tmp_path / "out")
    assert code == 1
    assert len(err.splitlines()) == failing
    assert "longer than 600" in err.splitlines()[0]
    assert f"{4 - failing} made, 0 up to date, {failing} failed" in out
    assert sum("error" in line for line in lines(tmp_path / "out")) == failing


def test_a_wrong_call_gets_one_line_and_makes_nothing(refused, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "d.toml").write_text(TEXT)
    (tmp_path / "bad.toml").write_text("count = [")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine").touch()
    (tmp_path / "file").touch()
    for words, wrong in (
        ("none.toml -o out", "none.toml: no such file"),
        ("bad.toml -o out", "bad.toml:1: not a description of a data set (expected a value"),
        ("d.toml -o full", "is not empty, and is not a data set"),
        ("d.toml -o file", "is a file; name a folder"),
        ("d.toml -o none/out", "does not exist"),
        ("d.toml -o out --count 0", "0 is not 1 or more"),
        ("d.toml -o out --dask x --jobs 1", "--jobs is for this machine"),
    ):
        assert wrong in refused("dataset", *words.split())
        assert not (tmp_path / "out").exists()
