"""A mapping replaced while notes sound."""

import os

import pytest

from yehu_server.errors import MappingError
from yehu_server.live.housekeeper import MappingWatch
from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import Mapping, load

VOLUME, EXPRESSION = "/playing/volume", "/playing/expression"


def to(midi, *binds: Bind, **options) -> None:
    midi.player.remap(Mapping("other", binds, **options), frame=7)


def test_a_sounding_note_goes_on_and_follows_the_new_mapping(make, player, listener):
    midi = make(Bind("cc 1", VOLUME), start=((EXPRESSION, 0.5),))
    midi.on(75)
    heard = len(listener.moves)
    to(midi, Bind("cc 1", VOLUME), start=((EXPRESSION, 0.5),))  # the same again
    assert len(listener.moves) == heard
    speed = len(listener.of("/bow/speed"))
    to(midi, Bind("cc 2", VOLUME))
    assert player.sounding is not None
    assert len(listener.of("/bow/speed")) == speed
    midi.cc(1, 0)
    assert player.value(VOLUME) == 1.0
    midi.cc(2, 0)
    assert player.value(VOLUME) == 0.0


def test_what_was_moved_stays_where_its_source_is_still_bound(make, player):
    midi = make(Bind("cc 1", VOLUME), Bind("cc 2", EXPRESSION))
    midi.on(75)
    midi.cc(1, 127)
    midi.cc(2, 0)
    midi.cc(3, 0)  # not bound: moves nothing when it is
    to(midi, Bind("cc 1", VOLUME, (0.0, 0.5)), Bind("cc 3", EXPRESSION))
    assert player.value(VOLUME) == 0.5  # the wheel is where it was, and means less
    assert player.value(EXPRESSION) == 1.0  # as before anything moved it
    to(midi, Bind("cc 1", VOLUME), Bind("cc 2", EXPRESSION))
    assert player.value(EXPRESSION) == 1.0  # its pedal was forgotten


def test_a_new_beginning_is_taken_where_nobody_has_moved_it(make, player):
    starts = {VOLUME: 0.5, EXPRESSION: 0.5, "/playing/attack": 50.0}
    midi = make(Bind("cc 1", EXPRESSION), start=tuple(starts.items()))
    midi.on(75)
    midi.player.set(VOLUME, 0.1)
    midi.cc(1, 127)
    to(midi, Bind("cc 1", EXPRESSION), start=((VOLUME, 0.7), (EXPRESSION, 0.7)))
    assert player.value(VOLUME) == 0.1  # written since
    assert player.value(EXPRESSION) == 1.0  # moved since
    assert player.value("/playing/attack") == 40.0  # begins at its default again
    midi.cc(121, 0)
    assert player.value(EXPRESSION) == 0.7


# ---------------------------------------------------------------- its file


BIND = '[[bind]]\nsource = "cc {}"\ntarget = "/playing/volume"\n'


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(BIND.format(1))
    return path


@pytest.fixture
def watch(path):
    return MappingWatch(load(str(path)), lambda: load(str(path)))


def settled(watch: MappingWatch) -> Mapping | None:
    """The result of polling the file until it no longer changes."""
    return watch.poll() or watch.poll()


def refusal(watch: MappingWatch) -> str:
    watch.poll()
    with pytest.raises(MappingError) as refused:
        watch.poll()
    return str(refused.value)


@pytest.fixture
def below(config_home):
    """A mapping of the user's own that there is not yet."""
    file = config_home / "yehu-server" / "mappings" / "below.toml"
    file.parent.mkdir(parents=True)
    return file


def test_a_changed_file_is_read_once_it_stands_still_and_says_something_else(watch, path):
    assert settled(watch) is None
    path.write_text("# mine\n" + BIND.format(1))
    assert settled(watch) is None
    path.write_text(BIND.format(1) + BIND.format(23))
    assert watch.poll() is None
    changed = watch.poll()
    assert [bind.source for bind in changed.binds] == ["cc 1", "cc 23"]
    assert settled(watch) is None


def test_a_wrong_file_is_refused_once_and_read_again_when_it_is_right(watch, path):
    path.write_text(BIND.format(1000))
    assert "mine.toml:2: bind 1: source: unknown source" in refusal(watch)
    assert settled(watch) is None
    path.write_text(BIND.format(77))
    assert settled(watch).binds[0].source == "cc 77"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_pipe_in_the_place_of_a_file_is_refused_and_not_waited_for(watch, path, below):
    path.unlink()
    os.mkfifo(path)
    assert "not a regular file" in refusal(watch)
    assert watch.poll() is None
    os.mkfifo(below)
    path.unlink()
    path.write_text('base = "below"\n')
    assert "no mapping 'below'" in refusal(watch)


def test_the_base_of_a_file_is_watched_with_it_and_may_come_later(watch, path, below):
    path.write_text('base = "below"\n')
    assert "no mapping 'below'" in refusal(watch)
    for control in (22, 23):
        below.write_text(BIND.format(control))
        assert settled(watch).binds[0].source == f"cc {control}"
