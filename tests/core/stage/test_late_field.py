"""The late field of a room decays as asked, is dense, even, and as loud as a diffuse field."""

import numpy as np
import pytest
from acoustics import OCTAVES, decay_line, decay_time, echo_density, highest_mode_db, octave
from rooms import Asked, Room

STUDY, CHAMBER = Asked(5.0, 0.4, 0.4), Asked(7.0, 0.7, 0.2)
COURTYARD, HALL = Asked(14.0, 0.8, 0.6), Asked(25.0, 1.6, 0.35)
PRESETS = {"study": STUDY, "chamber": CHAMBER, "courtyard": COURTYARD, "hall": HALL}
SOUND = 343.0
ROOMS = [
    (STUDY, 44100.0),
    (STUDY, 96000.0),
    (CHAMBER, 44100.0),
    (COURTYARD, 48000.0),
    (HALL, 48000.0),
    (Asked(3.0, 0.25, 0.3), 48000.0),
    pytest.param(Asked(40.0, 5.0, 0.5), 44100.0, marks=pytest.mark.slow),
    (Asked(8.0, 0.8, 0.0), 22050.0),
    (Asked(10.0, 1.0, 0.5), 192000.0),
]


def decay_at(hertz: float, decay: float, damping: float) -> float:
    """Decay time (s) that is asked for at a frequency: the loss per second grows about 2.5 kHz."""
    share = hertz**2 / (hertz**2 + 2500.0**2)
    return 1.0 / ((1.0 - share) / decay + share / (decay * (1.0 - 0.8 * damping)))


def responses(asked: Asked, rate: float) -> np.ndarray:
    """From both sides to both ears [shape=(frames, 4)]."""
    seconds = 1.7 * asked.decay + 0.15
    return np.hstack([Room(rate, asked).response(seconds, *sides) for sides in ((1, 0), (0, 1))])


@pytest.mark.parametrize(("asked", "rate"), ROOMS)
def test_each_octave_decays_within_five_percent_of_what_is_asked(asked, rate):
    heard = responses(asked, rate)
    for centre in OCTAVES:
        if centre * 2.0**0.5 < 0.45 * rate:
            measured = decay_time(octave(heard, rate, centre), rate)
            requested = decay_at(centre, asked.decay, asked.damping)
            assert measured == pytest.approx(requested, rel=0.05), centre


@pytest.mark.parametrize("before", [
    Asked(5.0, 1.6, 0.4), Asked(5.0, 0.4, 0.9), Asked(25.0, 0.4, 0.4),
], ids=["decay", "damping", "size"])  # fmt: skip
def test_a_room_that_was_changed_decays_as_is_asked_of_it_now(before):
    rate = 44100.0
    room = Room(rate, before)
    room.asked = STUDY
    room.hear(np.zeros((round(0.2 * rate), 2)))
    heard = room.response(1.7 * STUDY.decay + 0.15)
    for centre in OCTAVES:
        measured = decay_time(octave(heard, rate, centre), rate)
        assert measured == pytest.approx(decay_at(centre, 0.4, 0.4), rel=0.05), centre


def stored(room: Room) -> float:
    """Energy of all that is on its way in the lines."""
    record = room.record[0]
    lines = zip(record["line"], record["length"], strict=True)
    on_their_way = (line[(room.frame - 1 - np.arange(n)) & record["mask"]] for line, n in lines)
    return float(sum(np.square(samples).sum() for samples in on_their_way))


def test_a_network_without_loss_keeps_its_energy():
    room = Room(48000.0, HALL)
    room.record["b_0"], room.record["b_1"], room.record["a_1"] = 1.0, 0.0, 0.0
    room.response(0.5)
    before = stored(room)
    assert before > 0.01
    room.hear(np.zeros((10 * 48000, 2)))
    assert stored(room) == pytest.approx(before, rel=1e-12)


# By when a field is as dense as nature's: 4000 echoes a second, by Kuttruff's formula.
@pytest.mark.parametrize("rate", [44100.0, 96000.0])
@pytest.mark.parametrize(("name", "begins_s", "full_s"), [
    ("study", 0.06, 0.1), ("chamber", 0.06, 0.1), ("courtyard", 0.15, 0.2), ("hall", 0.25, 0.3),
])  # fmt: skip
def test_echoes_grow_dense_and_stay_so(name, begins_s, full_s, rate):
    heard = responses(PRESETS[name], rate)
    assert echo_density(heard, rate, begins_s) > 0.7
    for at_s in np.linspace(full_s, full_s + 0.3 * PRESETS[name].decay, 4):
        assert echo_density(heard, rate, at_s) > 0.88, at_s


@pytest.mark.parametrize("rate", [44100.0, 48000.0, 96000.0])
@pytest.mark.parametrize("name", PRESETS)
def test_no_mode_of_the_tail_rings(name, rate):
    asked = PRESETS[name]
    heard = responses(asked, rate)
    frames = round(asked.decay * rate)
    for start_s in (0.05, 0.05 + 0.5 * asked.decay):
        start = round(start_s * rate)
        assert highest_mode_db(heard[start : start + frames], rate) < 10.0


@pytest.mark.parametrize("size", [3.0, 5.0, 14.0, 25.0, 40.0])
@pytest.mark.parametrize("decay", [0.3, 0.8, 2.0])
def test_the_late_field_is_as_loud_as_a_diffuse_one(size, decay):
    rate = 44100.0
    heard = responses(Asked(size, decay, 0.0), rate)
    level = decay_line(heard, rate, -10.0, -50.0)[1] - 10.0 * np.log10(2.0)  # of one ear
    volume = size * 0.83 * size * 0.62 * size
    absorbing = 24.0 * np.log(10.0) / SOUND * volume / decay  # m^2, by Sabine's formula
    direct = 1.0 / (4.0 * np.pi * 2.0**2)  # at 2 m, of a source of power 1
    assert level == pytest.approx(10.0 * np.log10(4.0 / absorbing / direct), abs=1.0)


@pytest.mark.parametrize("name", PRESETS)
def test_the_late_field_is_as_bright_as_what_decays_in_it(name):
    # A band's energy is in proportion to its decay time, since all bands enter alike.
    asked, rate = PRESETS[name], 48000.0
    heard = responses(asked, rate)

    def brightness_db(centre: float) -> float:
        energy = np.sum(np.square(octave(heard, rate, centre))) / centre
        return float(10.0 * np.log10(energy / decay_at(centre, asked.decay, asked.damping)))

    for centre in OCTAVES[1:]:
        assert brightness_db(centre) == pytest.approx(brightness_db(1000.0), abs=1.5), centre
