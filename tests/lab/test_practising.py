"""Practising tells a good bowing from a bad one, and goes on from what was practised before."""

import json

import numpy as np
import pytest
from fiddles import SLACK_TOML
from midi_files import midi_file, notes

from yehu_lab.practising import bowing_search as practising
from yehu_lab.practising.bowing_search import BEFORE_S, EACH_S, EARLY_S, LATE_S, BowingSearch
from yehu_lab.practising.candidates import slower
from yehu_lab.practising.passages import Passage, SearchedNote
from yehu_lab.practising.practice_file import write_bowing_table
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    BOW_POSITIONS,
    FIRST_NOTE,
    default_bowing_table,
)
from yehu_server.core.player.note_range import LOWEST_NOTE
from yehu_server.params.table import find
from yehu_server.playing.bowing_tables import read_bowing_table, shipped_bowing_table
from yehu_server.playing.calibration_store import calibration_for

RATE = 44100.0
PLACE = BOW_POSITIONS.index(0.1)
DEFAULT = BOW_POSITIONS.index(find("/playing/bow_position").default)

PASSAGES = [
    Passage(before, speed, 0.42, is_slurred, 0.12)
    for before, speed, is_slurred in ((71, 0.16, True), (78, 0.2, False), (76, 0.2, True))
]


@pytest.fixture(scope="module")
def table_search() -> BowingSearch:
    return BowingSearch(RATE, Quantities(), calibration_for(RATE))


@pytest.mark.parametrize(("note", "factor"), [(70, 0.02), (70, 30.0), (74, 0.02), (80, 30.0)])
def test_a_manner_that_speaks_is_distinguished_from_one_that_cannot(table_search, note, factor):
    string = int(note > 71)
    good = shipped_bowing_table(RATE)[string, DEFAULT, note - FIRST_NOTE]
    bad = good.copy()  # too light, or too heavy
    bad[AT_FLAUTANDO : AT_FIRM + 1] *= factor
    search = SearchedNote(string, note, DEFAULT, good)
    assert 0.7 < table_search.score(search, good, PASSAGES) <= 1.0
    assert table_search.score(search, bad, PASSAGES) < 0.6


def test_notes_are_practised_at_the_pitches_of_a_tuning_and_heard_early_and_late(monkeypatch):
    played, heard_s = [], []

    def speaks(instrument, _near):
        player = instrument._rig["player"][0]
        played.append(float(player["held_pitch"][player["sounding"]]))
        heard_s.append(instrument.frame / RATE)
        return True, 0.0

    monkeypatch.setattr(practising, "_speaks", speaks)
    monkeypatch.setattr(practising, "has_pitch", lambda *_: True)
    table_search = BowingSearch(
        RATE, Quantities(), calibration_for(RATE), tuning=lambda key: key + 0.35
    )
    bowing = default_bowing_table()[0, PLACE, 70 - FIRST_NOTE]
    assert table_search.score(SearchedNote(0, 70, PLACE, bowing), bowing, PASSAGES) == 1.0
    assert set(played) == {70.35}
    each_s = BEFORE_S + EACH_S
    told = [BEFORE_S + at for at in (EARLY_S, LATE_S)]
    expected = [each_s * number + at for number in range(len(PASSAGES)) for at in told]
    assert heard_s == pytest.approx(expected, abs=0.001)


@pytest.fixture
def one_note(monkeypatch) -> None:
    """Practise a single note, with a single passage at each trial, and one short round of them.

    It speaks in any bowing but that which ships: whether a note does hangs on a chaotic run.
    """
    shipped = shipped_bowing_table(RATE)

    def score(_self, search, bowing, _passages):
        return float(
            not np.isclose(bowing, shipped[search.string, :, search.note - FIRST_NOTE])
            .all(axis=-1)
            .any()
        )

    monkeypatch.setattr(BowingSearch, "score", score)
    monkeypatch.setattr(practising, "ROUNDS", [slower])
    monkeypatch.setattr(practising, "stops_of", lambda _notes: [(0, 70)])
    monkeypatch.setattr(practising, "TRIES", 1)
    monkeypatch.setattr(practising, "QUICK_TRIES", 1)


@pytest.mark.usefixtures("one_note")
def test_what_practise_writes_render_takes(command, tmp_path):
    """It is for its preset and tuning, and leaves other places alone."""
    path, instrument = tmp_path / "mine.json", tmp_path / "slack.toml"
    instrument.write_text(SLACK_TOML)
    tune = midi_file(tmp_path / "tune.mid", notes((0.0, 0.3, 70, 80)))
    rendered = (tune, "-o", tmp_path / "out.wav", "--instrument", instrument, "--json")
    near = ("--preset", "sul-ponticello", "--tuning", "chaozhou-seven-equal")
    for words in ((), near):
        code, out, error = command("practise", "-o", path, *words, "--json")
        assert code == 0, error
        summary = json.loads(out)
        assert summary["rate"] == RATE
        changed = ~np.isclose(read_bowing_table(path), shipped_bowing_table(RATE), atol=1e-4).all(
            axis=-1
        )
        assert changed.sum() == summary["improved"] > 0 or words
        assert set(zip(*np.nonzero(changed.any(axis=1)), strict=True)) <= {(0, 70 - FIRST_NOTE)}
        assert not (words and changed[:, np.array(BOW_POSITIONS) > 0.1].any())
        _, summary, _ = command("render", *rendered, "--practice", path, "--overwrite")
        assert json.loads(summary)["practice"] == str(path)
        path.unlink()


@pytest.mark.usefixtures("one_note")
def test_practising_goes_on_from_what_lies_beside_the_instrument(command, tmp_path):
    instrument, beside = tmp_path / "mine.toml", tmp_path / "mine.practice.json"
    instrument.write_text("[string_1]\nreach = 6.0\n[string_2]\nreach = 3.0\n")  # tuned sooner
    table = default_bowing_table()
    write_bowing_table(beside, table, RATE)
    code, _, error = command(
        "practise", "--instrument", instrument, "-o", beside, "--overwrite", "--quiet"
    )
    assert code == 0, error
    same = np.isclose(read_bowing_table(beside), table, atol=1e-4).all(axis=-1)
    same[0, :, 70 - FIRST_NOTE] = True
    same[0, :, : LOWEST_NOTE - FIRST_NOTE] = True  # as the open string
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
