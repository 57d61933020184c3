"""What was practised is kept in files, heard and named."""

import json
from pathlib import Path

import numpy as np
import pytest
import soundfile
from commands import is_one_line
from fiddles import SLACK_TOML
from midi_files import midi_file, notes

from yehu_lab.practising.practice_file import write_bowing_table
from yehu_server.core.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    BOW_POSITIONS,
    FIRST_NOTE,
    LAST_NOTE,
    TOP_SPEED,
    default_bowing_table,
)
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.playing.bowing_tables import (
    FORMAT,
    VERSION,
    bowing_table_beside,
    read_bowing_table,
    shipped_bowing_table,
)

RATE = 44100.0
PLACE = BOW_POSITIONS.index(0.1)
NAN = float("nan")


def practised() -> np.ndarray:
    """A table that somebody might have practised."""
    table = default_bowing_table()
    chance = np.random.default_rng(1)
    table[:, 1:, 3:20] *= chance.uniform(0.8, 1.25, table[:, 1:, 3:20].shape)
    table[1, :, -1, TOP_SPEED] = 0.11
    return table


@pytest.fixture
def file(tmp_path):
    """Write a file; text, bytes, or JSON values."""

    def write(content: object):
        path = tmp_path / "mine.json"
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    return write


@pytest.fixture
def tune(tmp_path):
    return midi_file(tmp_path / "tune.mid", notes((0.0, 0.3, 70, 80), (0.3, 0.3, 74, 80)))


@pytest.fixture
def render(command, tmp_path, tune):
    """Render the tune with options; its sound and the summary."""
    instrument = tmp_path / "slack.toml"
    instrument.write_text(SLACK_TOML)
    form = ("--instrument", instrument, "--tail", 0.1, "--json")

    def run(*words: object) -> tuple[np.ndarray, dict]:
        out = tmp_path / "out.wav"
        code, summary, error = command("render", tune, "-o", out, *form, *words)
        assert code == 0, error
        return soundfile.read(out)[0], json.loads(summary)

    return run


# ---------------------------------------------------------------- files


def test_a_table_that_was_written_is_read_back(tmp_path):
    path = tmp_path / "mine.json"
    for table in (practised(), default_bowing_table(), shipped_bowing_table(RATE)):
        write_bowing_table(path, table, RATE)
        np.testing.assert_allclose(read_bowing_table(path), table, atol=1.1e-4)
    again = read_bowing_table(path)
    write_bowing_table(path, again, RATE)
    assert np.array_equal(read_bowing_table(path), again)


def spoiled(**changes: object) -> dict:
    return {"format": FORMAT, "version": VERSION, "rate": RATE, "bowing": {}, **changes}


def with_row(row: object, note: str = "70", place: str = "0.1", string: str = "inner") -> dict:
    return spoiled(bowing={string: {place: {note: row}}})


GOOD = [0.2, 0.1, 0.3, 0.5, 1.0, 0.0]
BAD = [
    *("", "{", "practice", b"\xff\xfe\x00", "[1, 2", '"x"', "null", "3", "[]", "{}"),
    *(spoiled(format="yehu-server capture"), spoiled(version=1), spoiled(version=None)),
    *(spoiled(bowing=None), spoiled(bowing=[]), spoiled(bowing="x"), spoiled(bowing={"inner": []})),
    *(with_row(GOOD[:-1]), with_row([*GOOD, 0.0]), with_row([]), with_row(0.2), with_row(None)),
    *(with_row(["a"] * 6), with_row([GOOD]), with_row([None] * 6), with_row({"a": 1})),
    *(with_row([value, *GOOD[1:]]) for value in (NAN, float("inf"), 0.0, -0.2, 3.0, 10**400)),
    *(with_row([*GOOD[:-1], value]) for value in (NAN, -0.1, 11.0)),
    *(with_row([*GOOD[:4], value, 0.0]) for value in (NAN, 0.0, 6.0)),
    *(with_row([*GOOD[:1], value, *GOOD[2:]]) for value in (NAN, -0.1, 13.0)),
    *(
        with_row(GOOD, note)
        for note in (str(FIRST_NOTE - 1), str(LAST_NOTE + 1), "-1", "x", "70.5", "")
    ),
    *(with_row(GOOD, place=place) for place in ("0.11", "0", "-0.1", "x", "nan", "")),
    *(with_row(GOOD, string=string) for string in ("0", "1", "F", "")),
]


def test_a_bad_practice_is_refused_in_one_line(file, refused, tune, tmp_path):
    for content in BAD:
        path = file(content)
        with pytest.raises(ParameterError) as error:
            read_bowing_table(path)
        assert is_one_line(f"{error.value}\n"), content
        assert str(error.value).startswith(f"{path}: "), content
    line = refused("render", tune, "-o", tmp_path / "out.wav", "--practice", path)
    assert str(path) in line
    assert not (tmp_path / "out.wav").exists()


def test_a_practice_that_is_missing_or_a_folder_or_the_target_is_refused_in_one_line(
    file, refused, tune, tmp_path
):
    for path in (tmp_path / "none.json", tmp_path):
        with pytest.raises(ScoreError):
            read_bowing_table(path)
        line = refused("render", tune, "-o", tmp_path / "out.wav", "--practice", path)
        assert str(path) in line
    path = file(with_row(GOOD))
    assert "practice" in refused("render", tune, "-o", path, "--format", "wav", "--practice", path)
    assert list(read_bowing_table(path)[0, PLACE, 70 - FIRST_NOTE]) == GOOD


def test_what_was_practised_is_heard_and_named(render, tmp_path):
    usual, summary = render()
    assert summary["practice"] == "shipped"
    path = tmp_path / "mine.json"
    table = shipped_bowing_table(RATE)
    write_bowing_table(path, table, RATE)
    same, _ = render("--practice", path)
    np.testing.assert_allclose(same, usual, atol=0.05)
    table[..., AT_FLAUTANDO : AT_FIRM + 1] *= 1.3
    write_bowing_table(path, table, RATE)
    other, summary = render("--practice", path)
    assert summary["practice"] == str(path)
    assert not np.array_equal(other, same)


def test_the_practice_beside_an_instrument_is_found_where_it_is_a_file(tmp_path):
    instrument, beside = tmp_path / "mine.toml", tmp_path / "mine.practice.json"
    (tmp_path / "folder.practice.json").mkdir()
    named = (None, Path(), Path("/"), instrument, tmp_path / "folder.toml")
    assert [bowing_table_beside(path) for path in named] == [None] * len(named)
    beside.touch()
    assert bowing_table_beside(instrument) == beside


# ---------------------------------------------------------------- what is shipped


def test_what_is_shipped_belongs_to_the_nearest_rate_and_cannot_be_spoiled():
    table = shipped_bowing_table(44100.0)
    assert np.array_equal(shipped_bowing_table(43000.0), table)
    table[:] = 0.0
    assert shipped_bowing_table(44100.0).any()
