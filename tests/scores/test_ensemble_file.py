"""Ensemble files: what they say, and what is wrong with them, by line."""

import re
from pathlib import Path

import pytest
from commands import is_one_line

from yehu_server.errors import EnsembleError
from yehu_server.scores.ensemble_file import read_ensemble

ROOT = Path(__file__).resolve().parents[2]
PART = "[[part]]\nchannel = 1\n"


@pytest.fixture
def read(tmp_path):
    def run(text: str | bytes):
        path = tmp_path / "band.toml"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return read_ensemble(path)

    return run


def test_what_a_part_leaves_out_is_left_open_and_files_are_found_beside_it(read, tmp_path):
    (part,) = read(PART).parts
    left_open = (part.track, part.preset, part.seed, part.pan, part.distance, part.gain_db)
    assert (part.channel, *left_open) == (0, None, None, None, None, None, 0.0)
    text = f'{PART}mapping = "mine.toml"\npreset = "tremolo"\ninstrument = "slack.json"\n'
    (part,) = read(text).parts
    assert part.mapping == str(tmp_path / "mine.toml")
    assert (part.preset, part.instrument) == ("tremolo", tmp_path / "slack.json")


def test_a_room_has_values_or_a_name(read):
    values = (("/room/size", 8.0), ("/room/level", 0.3))
    assert read(f"[room]\nsize = 8\nlevel = 0.3\n{PART}").room == values
    assert read(f'room = "hall"\n{PART}').room_name == "hall"


def test_the_example_of_the_documentation_is_one(read):
    text = (ROOT / "docs" / "ensemble.md").read_text(encoding="utf-8")
    ensemble = read(text.partition("```toml\n")[2].partition("```")[0])
    assert [part.channel for part in ensemble.parts] == [0, 1]
    assert ensemble.room[0] == ("/room/size", 9.0)


def test_errors_have_their_line(subtests, read):
    for text, line, error in [
        ("[[part]]\nchannel = 17\n", 2, "part 1: channel: expected a whole number from 1 to"),
        (f"{PART}track = 1.5\n", 3, "track: expected a whole number from 1 to"),
        (f"{PART}\n[[part]]\nname = 'x'\n", 4, "part 2: needs a channel or a track"),
        (f"[room]\ndecay = 2.0\n{PART}", 1, "room: needs a size in metres"),
        (f"[room]\nsize = 0.1\n{PART}", 2, "room.size: 0.1 is not within"),
        (f"[room]\nsize = 9\npan = 1\n{PART}", 3, "room.pan: unknown entry"),
        (f"rooms = 3\n{PART}", 1, "rooms: unknown entry; did you mean room?"),
        (f"{PART}place = 3\n", 3, "part 1: place: unknown entry"),
        (f"{PART}gain = 60\n", 3, "gain: 60 is not within"),
        (f"{PART}section = 17\n", 3, "section: expected a whole number from 1 to 16, got 17"),
        (f"{PART}seed = -1\n", 3, "seed: expected a whole number from 0 to 65535"),
        (f'{PART}set = {{ "/no" = 1 }}\n', 3, "set: "),
        (f'{PART}set = {{ "/finger/1/press" = 1 }}\n', 3, "moved by the player"),
        (PART * 17, 33, "part: expected 1 to 16 of [[part]], got 17"),
        ("part = []\n", 1, "part: expected 1 to 16 of [[part]], got 0"),
        ("part = 3\n", 1, "write each as [[part]]"),
        ("[[part]\n", 1, "not an ensemble file"),
    ]:
        with subtests.test(text=text, line=line, error=error):
            with pytest.raises(EnsembleError, match=re.escape(f"band.toml:{line}: ")) as raised:
                read(text)
            assert error in str(raised.value)
            assert is_one_line(f"{raised.value}\n")


def test_a_file_without_parts_is_refused(read):
    for text in ("", b"\xff\xfe", "about = 'nobody'\n", b"\0"):
        with pytest.raises(EnsembleError):
            read(text)
