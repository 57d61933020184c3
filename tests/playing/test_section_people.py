"""Players of a section have instruments of one maker, seats and random numbers of their own."""

from itertools import pairwise, product

import numpy as np
import pytest
from hands import ideal

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.midi.section_players import DISTANCE, GAIN, PAN, own_value
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.radiation import response
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.playing.parts import MODE, SIZE, section_specs, vary

SEEDS = range(20)


def own(address, value, people):
    return [own_value(INDEX[address], value, number, people) for number in range(people)]


def test_a_section_has_the_power_of_one_player_at_the_distance_of_the_part():
    for people in range(2, 17):
        gains, distances = own(GAIN, -6.0, people), own(DISTANCE, 4.0, people)
        assert sum(10.0 ** (0.1 * gain) for gain in gains) == pytest.approx(10.0**-0.6)
        assert distances == distances[::-1]  # both sides are as far away
        assert len(set(distances)) == (1 if people == 2 else 2)  # rows
    distances = own(DISTANCE, 4.0, 8)
    assert min(distances) < 4.0 < max(distances)
    power = np.mean([(4.0 / distance) ** 2 for distance in distances])
    assert abs(10.0 * np.log10(power)) < 0.25
    assert [own_value(INDEX[a], 0.3, 0, 1) for a in (GAIN, PAN, DISTANCE)] == [0.3] * 3


def test_players_sit_beside_each_other_around_the_place_of_the_part():
    for people, place in product((2, 3, 8, 16), (-1.0, -0.2, 0.0, 0.9, 1.0)):
        pans = own(PAN, place, people)
        assert -1.0 <= min(pans) < max(pans) <= 1.0
        assert all(left < right for left, right in pairwise(pans))
        side = 0.5 * (pans[-1] - pans[0])
        assert side == pytest.approx(min(0.06 * (people - 1), 0.35))
        assert np.mean(pans) == pytest.approx(min(max(place, side - 1.0), 1.0 - side))


def test_strings_hair_and_rosin_differ_within_the_tolerances_of_one_maker():
    base = Quantities()
    others = [vary(ideal(), base, seed)[1] for seed in range(200)]

    def check(values: list[float], measured: float, tolerance: float) -> None:
        ratios = np.array(values) / measured
        assert abs(ratios - 1.0).max() <= tolerance
        # As far apart as evenly spread values are.
        assert ratios.std() == pytest.approx(tolerance / np.sqrt(3.0), rel=0.2)

    for name in ("string_1", "string_2"):
        strings, measured = [getattr(own, name) for own in others], getattr(base, name)
        for quantity, tolerance in (("rho", 0.02), ("E", 0.05), ("sigma_0", 0.1), ("sigma_1", 0.1)):
            values = [getattr(string, quantity) for string in strings]
            check(values, getattr(measured, quantity), tolerance)
    for quantity in ("mu_C", "mu_S"):
        check([getattr(own.bow, quantity) for own in others], getattr(base.bow, quantity), 0.03)
    assert len({own.bow.hair for own in others}) > 190


def test_each_player_of_a_section_has_an_instrument_and_sides_of_their_own():
    playing = PlayingOptions(seed=3)
    specs = section_specs(playing, 44100.0, ideal(), players=4)
    alone = playing.spec(44100.0, ideal())
    assert specs[0].quantities == alone.quantities  # the first has the measured one
    bodies = [spec.quantities.body for spec in specs]
    assert len({body.frequency_hz for body in bodies}) == 4
    assert len({spec.quantities.bow.hair for spec in specs}) == 4
    made = map(Instrument, (*specs, alone))
    turns = [tuple(instrument._rig["seat"]["sides"]["c_1"][0]) for instrument in made]
    assert len(set(turns)) == 4
    assert turns[0] == turns[-1]


def test_bodies_are_passive_within_the_tolerances_and_radiate_about_alike(subtests):
    measured, hertz = Quantities().body, np.geomspace(300.0, 8000.0, 400)

    def radiated(body) -> np.ndarray:
        gain = np.array([body.direct_gain])
        return abs(response(np.array(body.sections), gain, 44100.0, hertz)) ** 2

    for seed in SEEDS:
        with subtests.test(seed=seed):
            body = vary(ideal(), Quantities(), seed)[1].body
            assert min(*body.mass, *body.damping) > 0.0
            ratio = np.array(body.frequency_hz) / measured.frequency_hz
            assert abs(ratio - 1.0).max() <= (1.0 + SIZE) * (1.0 + MODE) - 1.0
            assert ratio.std() <= MODE
            for (*_, a1, a2), (*_, before) in zip(body.sections, measured.sections, strict=True):
                assert a2 == pytest.approx(before)  # decays as quickly
                assert a1 * a1 < 4.0 * a2 < 4.0
            own, usual = radiated(body), radiated(measured)
            assert abs(10.0 * np.log10(own.mean() / usual.mean())) < 2.0
            assert abs(10.0 * np.log10(own / usual)).mean() > 0.3  # and yet not the same


def test_a_part_of_one_player_is_the_instrument_of_its_style():
    playing = PlayingOptions(seed=3)
    out = []
    for spec in (
        *section_specs(playing, 44100.0, ideal(), players=1),
        playing.spec(44100.0, ideal()),
    ):
        instrument = Instrument(spec)
        commands = playing.player(instrument)
        commands.draw(0.2, 0.6, frame=0)
        out.append(np.zeros(4410, np.float32))
        instrument.process(out[-1])
    assert np.abs(out[0]).max() > 1e-3
    assert np.array_equal(*out)


def vibratos(variation):
    """Rate and depth of the vibrato of each of six, and its phase as their note begins."""
    specs = section_specs(PlayingOptions(), 44100.0, ideal(), players=6)
    ensemble = Ensemble(specs, has_room=False)
    commands = PlayingOptions().player(ensemble.instruments)
    commands.write("/playing/variation", variation)
    commands.write("/playing/vibrato", 30.0)
    commands.note_on(Key(0, 74))
    ensemble.process(np.zeros((441, 2), np.float32))
    found = []
    for instrument in ensemble.instruments:
        controls = instrument._rig["controls"][0]
        asked = (instrument.target(f"/vibrato/{name}") for name in ("rate", "depth"))
        found.append((*asked, float(controls["vibrato"])))
    return np.array(found).T


def test_people_have_vibratos_of_their_own_and_the_first_that_of_the_part():
    rates, depths, phases = vibratos(0.25)
    assert (rates[0], depths[0]) == (6.0, 30.0)
    for own_values, least in ((rates, 0.2), (depths, 3.0), (phases, 0.1)):
        assert np.std(own_values) > least
    assert all(np.ptp(values) == 0.0 for values in vibratos(0.0))
