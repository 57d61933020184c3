"""`scripts/listen`: pairs are blind and equally loud, votes are counted, distances are right."""

import json
import re

import numpy as np
import pytest
import soundfile
from listening.__main__ import group, main
from listening.pairs import interval
from measures.bs1770 import lufs

RATE = 22050


def tone(hz: float, gain: float, sway: float = 0.0) -> np.ndarray:
    """Two seconds of some partials, whose level sways twice a second."""
    t = np.arange(2 * RATE) / RATE
    partials = sum(np.sin(2.0 * np.pi * hz * n * t) / n for n in range(1, 9))
    return gain * (1.0 + sway * np.sin(4.0 * np.pi * t)) * partials


@pytest.fixture
def folders(tmp_path):
    """Two groups, with pieces of the same names, one loud and one soft."""
    for name, gain, sway in (("old", 0.01, 0.0), ("new", 0.3, 0.5)):
        (tmp_path / name).mkdir()
        for number in range(3):
            sound = tone(300.0 + 50.0 * number, gain, sway)
            soundfile.write(tmp_path / name / f"piece {number}.wav", sound, RATE)
    return tmp_path


@pytest.fixture
def listen(monkeypatch, capsys):
    def run(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr("sys.argv", ["listen", *map(str, words)])
        code = main()
        return (code, *capsys.readouterr())

    return run


def test_each_pair_is_one_piece_equally_loud_and_the_page_does_not_say_which(folders, listen):
    out = folders / "page"
    groups = [f"Old={folders / 'old'}", f"New={folders / 'new'}"]
    assert listen("pairs", *groups, "-o", out, "--seconds", 1.5)[0] == 0
    key = json.loads((out / "key.json").read_text())
    assert [sorted(pair) for pair in key.values()] == [["New", "Old"]] * 3
    page = (out / "index.html").read_text()
    assert "Old" not in page
    pairs = json.loads(re.search(r"const pairs = (.*);", page)[1])
    for pair in pairs:
        sounds = [soundfile.read(out / file, always_2d=True)[0] for file in pair]
        assert [len(sound) for sound in sounds] == [round(1.5 * RATE)] * 2
        one, other = (lufs(sound, RATE) for sound in sounds)
        assert one == pytest.approx(other, abs=0.1)
    code, _, err = listen("pairs", *groups, "-o", out)
    assert (code, "not empty" in err) == (2, True)


def test_votes_are_counted_for_what_was_heard_and_not_for_its_side(folders, listen):
    out = folders / "page"
    listen("pairs", f"Old={folders / 'old'}", f"New={folders / 'new'}", "-o", out)
    key = json.loads((out / "key.json").read_text())
    votes = {number: "ab"[pair.index("New")] for number, pair in key.items()}
    (folders / "votes.json").write_text(json.dumps({**votes, "1": ""}))
    code, said, _ = listen("votes", out, folders / "votes.json")
    assert code == 0
    assert said.startswith("New 2, Old 0, neither 1: New was chosen in 100 %")
    (folders / "votes.json").write_text('{"99": "a"}')
    assert listen("votes", out, folders / "votes.json")[0] == 2
    low, high = interval(50, 100)
    assert (low, high) == pytest.approx((0.404, 0.596), abs=1e-3)


def test_distances_are_small_for_the_same_kind_and_see_spectrum_and_motion_apart(folders, listen):
    (folders / "recorded").mkdir()
    for number in range(2):
        soundfile.write(folders / "recorded" / f"{number}.wav", tone(310.0, 0.1, 0.5), RATE)
    code, said, _ = listen("distances", folders / "recorded", folders / "old", folders / "new")
    assert code == 0
    found = {line[:24].strip(): [*map(float, line[24:].split())] for line in said.splitlines()[2:]}
    assert found["old"][1] > found["new"][1] + 3.0  # it does not sway
    assert found["old"][0] == pytest.approx(found["new"][0], abs=0.5)


def test_what_cannot_be_compared_is_refused_in_a_line(folders, listen):
    (folders / "empty").mkdir()
    code, _, err = listen("distances", folders / "old", folders / "empty")
    assert (code, err.count("\n")) == (2, 1)
    (folders / "empty" / "no.wav").write_text("no sound")
    code, _, err = listen("distances", folders / "old", folders / "empty")
    assert (code, err.count("\n")) == (2, 1)
    assert group(str(folders / "old")).name == "old"
