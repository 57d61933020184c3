"""The scope of a controller: the notes of its channel, or all notes."""

import pytest

from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import load

VOLUME, PRESS, BEND = "/playing/volume", "/playing/press", "/playing/bend"
KEYS, BREATH = 0, 1  # ports


@pytest.fixture
def studio(make):
    """A volume pedal, aftertouch and a wheel, each bound for the notes of its channel."""
    return make(Bind("cc 7", VOLUME), Bind("pressure", PRESS), Bind("bend", BEND))


@pytest.fixture
def learned(make):
    """One knob that moves the volume of all notes."""
    return make(Bind("cc 7", VOLUME, is_global=True))


# ---------------------------------------------------------------- a port that plays no notes


def test_a_breath_controller_at_a_port_of_its_own_plays_the_keyboards_note(make, listener):
    wind = load("wind")
    studio = make(*wind.binds, start=wind.start)
    studio.on(75)
    studio.cc(2, 0, port=BREATH)
    assert listener["/bow/side"] == 0.0
    studio.cc(2, 127, port=BREATH)
    assert listener["/bow/side"] != 0.0
    studio.cc(2, 40, port=BREATH)
    quiet = listener["/output/level"]
    studio.on(77)  # the next note is as quiet
    assert listener["/output/level"] == quiet


def test_a_box_without_keys_moves_the_notes_of_every_port_and_by_osc(studio, player):
    for port, channel in ((KEYS, 1), (KEYS, 5), (7, 16)):
        studio.on(75, channel=channel, port=port)
        studio.cc(7, 7 * channel, port=BREATH)
        assert player.value(VOLUME) == 7 * channel / 127
        studio.on(76)
        assert player.value(VOLUME) == 7 * channel / 127
    studio.player.key_on(75.0, 64.0)
    studio.cc(7, 30, port=BREATH)
    assert player.value(VOLUME) == 30 / 127


def test_of_a_keyboards_own_controller_and_a_box_the_one_moved_last_counts(studio, player):
    studio.cc(7, 30, port=BREATH)
    for note, port, value in ((75, None, 30), (77, KEYS, 90), (75, BREATH, 20)):
        if port is not None:
            studio.cc(7, value, port=port)
            assert player.value(VOLUME) == value / 127
        studio.on(note)
        assert player.value(VOLUME) == value / 127


def test_from_its_first_note_on_a_port_has_its_controllers_to_itself(studio, player):
    studio.on(75)
    studio.cc(7, 30, port=BREATH)
    studio.on(80, port=BREATH)  # it is a keyboard after all
    assert player.value(VOLUME) == 30 / 127
    studio.on(77)
    assert player.value(VOLUME) == 1.0
    studio.cc(7, 60, port=BREATH)
    assert player.value(VOLUME) == 1.0


def test_a_box_that_ends_its_sound_or_is_reset_lets_go_of_the_keyboards_notes(make, player):
    studio = make(Bind("cc 11", "/playing/expression"))
    for control in (120, 121):
        studio.cc(64, 127, port=BREATH)
        studio.on(75)
        studio.off(75)
        studio.cc(11, 20, port=BREATH)
        studio.cc(control, 0, port=BREATH)
        assert player.sounding is None
    studio.on(75)
    assert player.value("/playing/expression") == 1.0


def test_a_soft_knob_of_a_box_waits_for_where_the_keyboards_note_has_it(make, player):
    studio = make(Bind("cc 7", VOLUME, is_soft=True))
    studio.on(75)
    studio.player.set(VOLUME, 0.5)
    studio.cc(7, 10, port=BREATH)
    assert player.value(VOLUME) == 0.5
    studio.cc(7, 64, port=BREATH)
    studio.cc(7, 40, port=BREATH)
    assert player.value(VOLUME) == 40 / 127


# ---------------------------------------------------------------- boxes that come and go


def test_a_box_that_is_gone_leaves_its_faders_where_they_were(studio, player):
    studio.on(75)
    studio.cc(7, 30, port=BREATH)
    studio.player.end_port_notes(BREATH)
    assert player.value(VOLUME) == 30 / 127
    studio.on(77)
    assert player.value(VOLUME) == 30 / 127
    studio.cc(7, 50, port=BREATH)  # and is heard when it is back
    assert player.value(VOLUME) == 50 / 127


def test_a_box_that_is_gone_bends_presses_and_holds_no_more(studio, player):
    for is_held in (True, False):
        studio.cc(64, 127, port=BREATH)
        studio.on(75)
        studio.bend(8191, port=BREATH)
        studio.touch(127, port=BREATH)
        assert player.value(PRESS) > 2.0
        if not is_held:
            studio.off(75)
        studio.player.end_port_notes(BREATH)
        assert (player.sounding is not None) == is_held
        assert not is_held or player.pitch == 75.0  # at once
    studio.on(75)
    assert player.pitch == 75.0
    assert player.value(PRESS) == 1.5


def test_a_keyboard_that_is_gone_leaves_nothing_to_others_but_what_is_global(learned, player):
    learned.on(75, port=BREATH)
    learned.on(75)
    learned.cc(7, 30, port=BREATH)
    learned.player.end_port_notes(BREATH)
    learned.on(76)
    assert player.value(VOLUME) == 30 / 127


# ---------------------------------------------------------------- what is global


def test_a_global_controller_of_another_keyboard_or_channel_moves_the_note(learned, player):
    """Of two with one number the one moved last counts."""
    learned.on(80, port=BREATH)
    learned.on(75)
    for value, port, channel in ((30, BREATH, 1), (60, KEYS, 1), (90, BREATH, 1), (40, KEYS, 2)):
        learned.cc(7, value, channel=channel, port=port)
        assert player.value(VOLUME) == value / 127
        for note, other in ((76, 1), (75, 3)):
            learned.on(note, channel=other)
            assert player.value(VOLUME) == value / 127


# ---------------------------------------------------------------- what stays with its channel


def test_channels_of_a_port_with_notes_keep_their_own_as_in_files(studio, player):
    for channel in range(1, 5):
        studio.cc(7, 10 * channel, channel=channel)
    for channel in (3, 1, 2, 4):
        studio.on(75, channel=channel)
        assert player.value(VOLUME) == 10 * channel / 127
    studio.cc(7, 100, channel=5)  # which plays none
    assert player.value(VOLUME) == 40 / 127
    studio.on(75, channel=6)
    assert player.value(VOLUME) == 1.0


@pytest.mark.parametrize("is_global", [False, True])
def test_what_a_member_of_an_mpe_zone_moves_is_its_notes_alone(make, player, is_global):
    studio = make(Bind("pressure", PRESS, is_global=is_global), Bind("bend", BEND))
    studio.rpn(0, 6, (6, 15), port=BREATH)
    studio.on(75)
    studio.touch(127, channel=4, port=BREATH)
    studio.bend(4096, channel=4, port=BREATH)
    assert (player.value(PRESS), player.pitch) == (1.5, 75.0)
    studio.on(70, channel=5, port=BREATH)
    assert (player.value(PRESS), player.pitch) == (1.5, 70.0)
    studio.on(70, channel=4, port=BREATH)
    assert player.value(PRESS) == 6.0
    assert player.pitch == pytest.approx(94.0, abs=0.01)


def test_the_master_of_a_zone_speaks_for_its_zone_alone_unless_it_is_global(make, player):
    studio = make(Bind("cc 7", VOLUME), Bind("cc 11", "/playing/expression", is_global=True))
    studio.rpn(0, 6, (6, 15), port=BREATH)
    studio.on(70, channel=2, port=BREATH)
    studio.on(75)
    studio.cc(7, 30, port=BREATH)
    studio.cc(11, 30, port=BREATH)
    assert player.value(VOLUME) == 1.0
    assert player.value("/playing/expression") == 30 / 127
