"""``yehu-server follow``: what it writes, and what it refuses."""

import json

import numpy as np
import pytest
import soundfile

RATE = 16000


@pytest.fixture(scope="module")
def hum(tmp_path_factory):
    time = np.arange(RATE) / RATE
    tone = sum(np.sin(2.0 * np.pi * 220.0 * n * time) / n for n in (1, 2, 3, 4)) / 5.0
    sound = np.concatenate((np.zeros(2000), tone * np.minimum(1.0, 20.0 * time), np.zeros(2000)))
    path = tmp_path_factory.mktemp("hum") / "hum.wav"
    soundfile.write(path, sound, RATE)
    return path


def test_a_capture_of_it_replays_to_the_same_samples(command, hum, tmp_path):
    files = [tmp_path / name for name in ("one.wav", "take.jsonl", "two.wav")]
    words = ("--tail", 0.2, "--rate", 22050, "--quiet")
    assert command("follow", hum, "-o", files[0], "--subtype", "float", *words)[0] == 0
    assert command("follow", hum, "-o", files[1], *words)[0] == 0
    assert command("replay", files[1], "-o", files[2], "--quiet")[0] == 0
    assert files[0].read_bytes() == files[2].read_bytes()


def test_it_tells_what_it_did(command, hum, tmp_path):
    code, out, _ = command("follow", hum, "-o", tmp_path / "hum.mid", "--json")
    told = json.loads(out)
    assert code == 0
    assert (told["notes"], told["strokes"], told["transposed"]) == (1, 1, 12.0)


def test_what_is_wrong_is_reported_before_it_listens(command, hum, tmp_path, monkeypatch):
    def listen(*_):
        raise AssertionError

    monkeypatch.setattr("yehu_server.following.heard.hear", listen)
    wrong = []
    for words in (
        (hum, "-o", tmp_path / "a.mp3"),
        (hum, "-o", hum),
        (hum, "-o", tmp_path / "a.mid", "--plot", tmp_path / "a.png"),
        (hum, "-o", tmp_path / "a.wav", "--dry", "--room", "hall"),
        (tmp_path / "none.wav", "-o", tmp_path / "a.wav"),
        (__file__, "-o", tmp_path / "a.wav"),
        (tmp_path, "-o", tmp_path / "a.wav"),
        (hum, "-o", tmp_path / "a.wav", "--max-duration", 0.0001),
    ):
        code, out, err = command("follow", *words)
        if (code, out, err.count("\n")) != (2, "", 1):
            wrong.append((words, code, err))
    assert not wrong
