"""``yehu-server render`` of damaged files: what it tells, and its options about them."""

import json
from pathlib import Path

import pytest
from midi_bytes import END, midi, off, on

SONGS = midi(on(0, 67) + off(20, 67) + END, on(0, 69) + off(60, 69) + END, kind=2)
DAMAGED = midi(on(0, 71, 200) + on(0, 67) + off(20, 67) + END, count=2)

pytestmark = pytest.mark.usefixtures("config_home")


@pytest.fixture
def render(command, tmp_path):
    """Render files of these bytes; return the exit code, stdout, stderr."""

    def run(*files: bytes, options: tuple[object, ...] = ()) -> tuple[int, str, str]:
        paths = [tmp_path / f"{number}.mid" for number in range(len(files))]
        for path, data in zip(paths, files, strict=True):
            path.write_bytes(data)
        return command("render", *paths, "-o", tmp_path / "out.wav", "--json", *options)

    return run


def out(tmp_path: Path) -> bool:
    return (tmp_path / "out.wav").exists()


def test_damage_is_reported_with_its_place_and_the_rest_is_played(render, tmp_path):
    code, printed, err = render(DAMAGED)
    assert code == 0
    assert err.splitlines() == [
        "yehu-server: 0: 2 tracks announced, 1 found, at byte 10",
        "yehu-server: 0: a damaged message dropped, at byte 22",
    ]
    assert json.loads(printed)["notes_played"] == 1
    assert out(tmp_path)


def test_a_strict_rendering_refuses_damage_and_writes_nothing(render, tmp_path):
    code, printed, err = render(DAMAGED, options=("--strict",))
    assert (code, printed) == (1, "")
    told = "2 tracks announced, 1 found, at byte 10: refused by --strict"
    assert err == f"yehu-server: {tmp_path / '0.mid'}: {told}\n"
    assert not out(tmp_path)


def test_a_song_is_rendered_alone(render):
    lengths = {}
    for song in (None, 1, 2):
        options = ("--tail", 0) if song is None else ("--tail", 0, "--song", song)
        code, printed, err = render(SONGS, options=options)
        assert (code, err) == (0, "")
        lengths[song] = json.loads(printed)["duration_s"]
    assert lengths == pytest.approx({None: 0.4, 1: 0.1, 2: 0.3}, abs=1e-4)


def test_the_longest_duration_is_of_each_file_and_of_all_together(render, tmp_path):
    second = midi(on(0, 67) + off(200, 67) + END)
    code, _, err = render(second, options=("--max-duration", 0.0002))
    assert code == 2
    assert "0.mid: the score lasts 0.000278 hours, more than 0.0002: see --max-duration" in err
    code, _, err = render(second, second, options=("--max-duration", 0.0005))
    assert code == 2
    assert err == (
        "yehu-server: all scores last 0.000556 hours, more than 0.0005: see --max-duration\n"
    )
    assert not out(tmp_path)
