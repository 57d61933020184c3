"""What was practised is kept in files; practising tells a good manner from a bad one."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import soundfile
from commands import is_one_line
from fiddles import SLACK_TOML
from midi_files import midi_file, notes

from yehu_server.core.physics.quantities import Quantities
from yehu_server.core.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    AT_LIGHT,
    DISTANCE_FACTOR,
    FIRST,
    LAST,
    PLACES,
    TOP_SPEED,
    default_bowing_table,
)
from yehu_server.core.player.note_range import LOWEST_NOTE
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.params.table import find
from yehu_server.playing import practice as practising
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.practice import (
    BEFORE_S,
    EACH_S,
    EARLY_S,
    LATE_S,
    LISTEN_S,
    Practice,
    has_pitch,
)
from yehu_server.playing.practice_files import (
    FORMAT,
    HIGHEST,
    LOWEST,
    VERSION,
    as_data,
    practice_beside,
    read_practice,
    shipped_practice,
    write_practice,
)
from yehu_server.playing.practice_passages import Passage, Search
from yehu_server.playing.practice_recipes import slower

RATE = 44100.0
PLACE = PLACES.index(0.1)
DEFAULT = PLACES.index(find("/playing/bow_position").default)
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
    for table in (practised(), default_bowing_table(), shipped_practice(RATE)):
        write_practice(path, table, RATE)
        np.testing.assert_allclose(read_practice(path), table, atol=1.1e-4)
    again = read_practice(path)
    write_practice(path, again, RATE)
    assert np.array_equal(read_practice(path), again)


def test_only_notes_that_are_bowed_otherwise_are_written():
    table = default_bowing_table()
    usual = as_data(table, RATE)["bowing"]
    assert not any(notes for places in usual.values() for notes in places.values())
    table[0, PLACE, 70 - FIRST, AT_LIGHT] = 0.7
    usual["inner"]["0.1"] = {"70": as_data(table, RATE)["bowing"]["inner"]["0.1"]["70"]}
    assert as_data(table, RATE)["bowing"] == usual


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
    *(with_row(GOOD, note) for note in (str(FIRST - 1), str(LAST + 1), "-1", "x", "70.5", "")),
    *(with_row(GOOD, place=place) for place in ("0.11", "0", "-0.1", "x", "nan", "")),
    *(with_row(GOOD, string=string) for string in ("0", "1", "F", "")),
]


def test_a_bad_practice_is_refused_in_one_line(file, refused, tune, tmp_path):
    for content in BAD:
        path = file(content)
        with pytest.raises(ParameterError) as error:
            read_practice(path)
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
            read_practice(path)
        line = refused("render", tune, "-o", tmp_path / "out.wav", "--practice", path)
        assert str(path) in line
    path = file(with_row(GOOD))
    assert "practice" in refused("render", tune, "-o", path, "--format", "wav", "--practice", path)
    assert list(read_practice(path)[0, PLACE, 70 - FIRST]) == GOOD


def test_what_was_practised_is_heard_and_named(render, tmp_path):
    usual, summary = render()
    assert summary["practice"] == "shipped"
    path = tmp_path / "mine.json"
    table = shipped_practice(RATE)
    write_practice(path, table, RATE)
    same, _ = render("--practice", path)
    np.testing.assert_allclose(same, usual, atol=0.05)
    table[..., AT_FLAUTANDO : AT_FIRM + 1] *= 1.3
    write_practice(path, table, RATE)
    other, summary = render("--practice", path)
    assert summary["practice"] == str(path)
    assert not np.array_equal(other, same)


def test_the_practice_beside_an_instrument_is_found_where_it_is_a_file(tmp_path):
    instrument, beside = tmp_path / "mine.toml", tmp_path / "mine.practice.json"
    (tmp_path / "folder.practice.json").mkdir()
    named = (None, Path(), Path("/"), instrument, tmp_path / "folder.toml")
    assert [practice_beside(path) for path in named] == [None] * len(named)
    beside.touch()
    assert practice_beside(instrument) == beside


# ---------------------------------------------------------------- what is shipped


def test_what_is_shipped_is_within_bounds():
    for rate in (44100.0, 48000.0, 96000.0):
        table = shipped_practice(rate)
        assert table.shape == default_bowing_table().shape
        assert np.all((table >= LOWEST) & (table <= HIGHEST))
        positions = table[..., DISTANCE_FACTOR] * np.array(PLACES)[:, None]
        assert 0.05 < positions.min() < positions.max() < 0.5


def test_what_is_shipped_belongs_to_the_nearest_rate_and_cannot_be_spoiled():
    table = shipped_practice(44100.0)
    assert np.array_equal(shipped_practice(43000.0), table)
    table[:] = 0.0
    assert shipped_practice(44100.0).any()


# ---------------------------------------------------------------- practising

PASSAGES = [
    Passage(before, speed, 0.42, is_slurred, 0.12)
    for before, speed, is_slurred in ((71, 0.16, True), (78, 0.2, False), (76, 0.2, True))
]


@pytest.fixture(scope="module")
def practice() -> Practice:
    return Practice(RATE, Quantities(), calibration_for(RATE))


@pytest.mark.parametrize(("note", "factor"), [(70, 0.02), (70, 30.0), (74, 0.02), (80, 30.0)])
def test_a_manner_that_speaks_is_told_from_one_that_cannot(practice, note, factor):
    string = int(note > 71)
    good = shipped_practice(RATE)[string, DEFAULT, note - FIRST]
    bad = good.copy()  # too light, or too heavy
    bad[AT_FLAUTANDO : AT_FIRM + 1] *= factor
    search = Search(string, note, DEFAULT, good)
    assert 0.7 < practice.score(search, good, PASSAGES) <= 1.0
    assert practice.score(search, bad, PASSAGES) < 0.6


def test_a_mode_that_drowns_a_note_is_not_taken_for_it():
    time = np.arange(round(LISTEN_S * RATE)) / RATE
    note, mode = (np.sin(2.0 * np.pi * hz * time) for hz in (1318.51, 566.0))
    for loudness, has in ((0.0, True), (0.1, True), (0.8, False), (3.0, False)):
        assert has_pitch(note + loudness * mode, RATE, 88.0) == has, loudness
    assert not has_pitch(0.0 * note, RATE, 88.0)


def test_the_score_of_a_manner_is_always_the_same(practice):
    manner = default_bowing_table()[0, PLACE, 70 - FIRST]
    search = Search(0, 70, PLACE, manner)
    scores = {practice.score(search, manner, PASSAGES) for _ in range(3)}
    assert len(scores) == 1


def test_a_tuning_moves_each_note_to_its_nearest_pitch():
    tuned = practising.pitches_near_notes({66.0: 66.3, 67.0: 66.9, 68.0: 68.6}.get)
    assert [tuned[note] for note in (65, 66, 67, 68, 69)] == [65.0, 66.3, 66.9, 68.0, 68.6]


def test_notes_are_practised_at_the_pitches_of_a_tuning_and_heard_early_and_late(monkeypatch):
    played, heard_s = [], []

    def speaks(instrument, _near):
        player = instrument._rig["player"][0]
        played.append(float(player["held_pitch"][player["sounding"]]))
        heard_s.append(instrument.frame / RATE)
        return True, 0.0

    monkeypatch.setattr(practising, "_speaks", speaks)
    monkeypatch.setattr(practising, "has_pitch", lambda *_: True)
    practice = Practice(RATE, Quantities(), calibration_for(RATE), tuning=lambda key: key + 0.35)
    manner = default_bowing_table()[0, PLACE, 70 - FIRST]
    assert practice.score(Search(0, 70, PLACE, manner), manner, PASSAGES) == 1.0
    assert set(played) == {70.35}
    each_s = BEFORE_S + EACH_S
    told = [BEFORE_S + at for at in (EARLY_S, LATE_S)]
    expected = [each_s * number + at for number in range(len(PASSAGES)) for at in told]
    assert heard_s == pytest.approx(expected, abs=0.001)


@pytest.fixture
def one_note(monkeypatch) -> None:
    """Practise a single note, with a single passage at each trial, and one short round of them.

    It speaks in any manner but that which ships: whether a note does hangs on a chaotic run.
    """
    shipped = shipped_practice(RATE)

    def score(_practice, search, manner, _passages):
        return float(
            not np.isclose(manner, shipped[search.string, :, search.note - FIRST])
            .all(axis=-1)
            .any()
        )

    monkeypatch.setattr(Practice, "score", score)
    monkeypatch.setattr(practising, "ROUNDS", [slower])
    monkeypatch.setattr(practising, "stops_of", lambda _notes: [(0, 70)])
    monkeypatch.setattr(practising, "TRIES", 1)
    monkeypatch.setattr(practising, "QUICK_TRIES", 1)


@pytest.mark.usefixtures("one_note")
def test_what_practise_writes_render_takes(command, render, tmp_path):
    """It is for its preset and tuning, and leaves other places alone."""
    path = tmp_path / "mine.json"
    near = ("--preset", "sul-ponticello", "--tuning", "chaozhou-seven-equal")
    for words in ((), near):
        code, out, error = command("practise", "-o", path, *words, "--json")
        assert code == 0, error
        summary = json.loads(out)
        assert summary["rate"] == RATE
        changed = ~np.isclose(read_practice(path), shipped_practice(RATE), atol=1e-4).all(axis=-1)
        assert changed.sum() == summary["improved"] > 0 or words
        assert set(zip(*np.nonzero(changed.any(axis=1)), strict=True)) <= {(0, 70 - FIRST)}
        assert not (words and changed[:, np.array(PLACES) > 0.1].any())
        assert render("--practice", path)[1]["practice"] == str(path)
        path.unlink()


@pytest.mark.usefixtures("one_note")
def test_practising_goes_on_from_what_lies_beside_the_instrument(command, tmp_path):
    instrument, beside = tmp_path / "mine.toml", tmp_path / "mine.practice.json"
    instrument.write_text("[string_1]\nreach = 6.0\n[string_2]\nreach = 3.0\n")  # tuned sooner
    table = practised()
    write_practice(beside, table, RATE)
    code, _, error = command("practise", "--instrument", instrument, "-o", beside, "--quiet")
    assert code == 0, error
    same = np.isclose(read_practice(beside), table, atol=1e-4).all(axis=-1)
    same[0, :, 70 - FIRST] = True
    same[0, :, : LOWEST_NOTE - FIRST] = True  # as the open string
    assert same.all()


def test_practising_what_is_not_there_is_refused_in_one_line(refused, tmp_path):
    for words in [
        ("--rate", "100"),
        ("--rate", "nan"),
        ("--preset", "no-such"),
        ("--instrument", "no.toml"),
    ]:
        refused("practise", "-o", tmp_path / "mine.json", *words)
    a_map = ("--keyboard-map", "chaozhou")
    assert "needs a scale" in refused("practise", "-o", tmp_path / "mine.json", *a_map)
    assert "does not exist" in refused("practise", "-o", tmp_path / "none" / "mine.json")
    assert list(tmp_path.iterdir()) == []
