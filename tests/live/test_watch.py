"""``serve --watch``: a mapping that changes while the server plays."""

import mido
import pytest
from midi_input import receive

from yehu_server.playing.mapping import load
from yehu_server.playing.options import PlayingOptions

BIND = '[[bind]]\nsource = "cc {}"\ntarget = "/playing/volume"\n'


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(BIND.format(20))
    return path


@pytest.fixture
def watched(make_live, path):
    mapping = load(str(path))
    return make_live(playing=PlayingOptions(mapping=mapping), reread=lambda: load(str(path)))


def test_a_changed_file_is_taken_up_while_a_note_sounds_or_refused_whole(watched, path, until):
    def send(control: int) -> float:
        message = mido.Message("control_change", control=control, value=0, channel=0)
        receive(watched.player, message, frame=watched.player.frame_of(), port=0)
        watched.settle()
        return watched.player.value("/playing/volume")

    note = mido.Message("note_on", note=70, velocity=90, channel=0)
    receive(watched.player, note, frame=watched.player.frame_of(), port=0)
    path.write_text(BIND.format(21) + BIND.format(2100))
    refused, kept = until(lambda: watched.said[1:] and watched.said, "a line on what is wrong")
    assert refused.startswith(f"{path}:5: bind 2: source: unknown source 'cc 2100'")
    assert kept == "the mapping stays as it was"
    assert send(21) == 1.0
    path.write_text(BIND.format(21) + BIND.format(22))
    until(lambda: len(watched.said) == 3, "the mapping to be taken up")
    assert watched.said[2] == "the mapping mine has changed; it is used from now on"
    assert watched.player.pitch is not None
    assert send(20) == 1.0
    assert send(22) == 0.0
