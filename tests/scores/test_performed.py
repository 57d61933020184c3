"""Marks of a written score become notes, loudness and settings of bow and fingers."""

import math
from fractions import Fraction
from itertools import pairwise

import pytest
from shaping import phrased

from yehu_server.errors import ScoreError
from yehu_server.params.articulations import NUMBER
from yehu_server.params.table import find
from yehu_server.scores.events import Setting
from yehu_server.scores.written import performed as performing
from yehu_server.scores.written.mark_settings import PLACES, QUICK_TREMOLO
from yehu_server.scores.written.notated import (
    DYNAMICS,
    MARKS,
    Grace,
    Mark,
    Note,
    Part,
    Sign,
    Span,
    Tempo,
    Written,
)
from yehu_server.scores.written.performed import CHANNELS, performed

QUARTER_S = 0.5
STEADY = (Tempo(Fraction(0), 120.0),)


def note(beat, length, pitch, *marks, **more) -> Note:
    named = tuple(mark if isinstance(mark, Mark) else Mark(mark) for mark in marks)
    return Note(Fraction(beat), Fraction(length), float(pitch), named, **more)


def span(name, begin, end, value=None) -> Span:
    return Span(name, Fraction(begin), Fraction(end), value)


def sign(beat, name, value=None) -> Sign:
    return Sign(Fraction(beat), name, value)


def play(*notes, spans=(), signs=(), tempi=STEADY):
    return performed(Written((Part("", notes, tuple(spans), tuple(signs)),), tempi))


def settings(score, address) -> list[tuple[float, float | None]]:
    """When a parameter is set, and to what; None where it is put back."""
    return [
        (round(event.time_s, 6), event.message.value)
        for event in score.events
        if isinstance(event.message, Setting) and event.message.address == address
    ]


def expressions(score) -> list[tuple[float, int]]:
    return [
        (event.time_s, event.message.value)
        for event in score.events
        if event.message.type == "control_change" and event.message.control == 11
    ]


FOUR = [note(n, 1, 67 + 2 * n) for n in range(4)]


def four(number, *marks) -> list[Note]:
    """Four quarters; one of them has marks."""
    return [note(n, 1, 67 + 2 * n, *(marks if n == number else ())) for n in range(4)]


# -- time ---------------------------------------------------------------------------------------


def test_plain_notes_sound_for_their_full_length_at_the_tempo():
    score = play(*FOUR)
    assert [(each.start_s, each.end_s, each.key) for each in score.notes] == [
        (n * QUARTER_S, (n + 1) * QUARTER_S, 67 + 2 * n) for n in range(4)
    ]
    assert {event.message.type for event in score.events} == {"note_on", "note_off"}
    assert score.duration_s == 4 * QUARTER_S


def test_a_tempo_holds_from_its_beat_on_and_its_change_is_gradual_and_complete_at_its_end():
    score = play(*FOUR, tempi=(Tempo(Fraction(0), 120.0), Tempo(Fraction(2), 60.0)))
    assert [each.start_s for each in score.notes] == [0.0, 0.5, 1.0, 2.0]
    notes = [note(n, 1, 67) for n in range(12)]
    for name, share in (("ritardando", 0.7), ("accelerando", 1.25)):
        starts = [each.start_s for each in play(*notes, spans=[span(name, 0, 8)]).notes]
        steps = [b - a for a, b in pairwise(starts)]
        assert steps[:8] == sorted(steps[:8], reverse=share > 1.0)
        assert len({round(step, 6) for step in steps[:8]}) == 8
        assert steps[8:] == pytest.approx([QUARTER_S / share] * 3)


def test_a_fermata_holds_its_note_and_lets_all_parts_wait():
    notes = (note(0, 1, 67), note(1, 1, 69, "fermata"), note(2, 1, 71))
    other = (note(0, 3, 60), note(3, 1, 62))
    parts = (Part("", notes), Part("", other))
    score = performed(Written(parts, STEADY))
    held = [each for each in score.notes if each.key == 69]
    assert held[0].length_s == pytest.approx(1.8 * QUARTER_S)
    assert [each.start_s for each in score.notes if each.key == 62] == [
        pytest.approx(3.8 * QUARTER_S)
    ]


def test_a_caesura_is_a_silence():
    before, after = play(note(0, 2, 69, "caesura"), note(2, 1, 72)).notes
    assert before.length_s == pytest.approx(2 * QUARTER_S)
    assert after.start_s - before.end_s == pytest.approx(0.4)


def overlaps(score) -> list[bool]:
    """Of each two notes, whether the first sounds into the second."""
    return [one.end_s > other.start_s for one, other in pairwise(score.notes)]


# -- strokes ------------------------------------------------------------------------------------


def test_slurred_notes_overlap_and_others_do_not():
    two_strokes = [span("slur", 0, 1), span("slur", 2, 3)]
    assert overlaps(play(*FOUR, spans=[span("slur", 1, 2)])) == [False, True, False]
    assert overlaps(play(*FOUR, spans=two_strokes)) == [True, False, True]
    words = [sign(0, "legato"), sign(2, "non-legato")]
    assert overlaps(play(*FOUR, signs=words)) == [True, True, False]


def test_a_repeated_note_under_a_slur_goes_on_in_the_same_direction():
    score = play(note(0, 1, 67), note(1, 1, 67), spans=[span("slur", 0, 1)])
    notes = score.notes
    assert notes[0].end_s <= notes[1].start_s
    directions = settings(score, "/playing/direction")
    assert directions[0][0] == 0.0
    assert {value for _, value in directions[:-1]} == {1.0}


def test_short_marks_shorten_and_as_a_word_all_notes_but_slurred_ones():
    shares = {"staccato": 0.5, "staccatissimo": 0.3, "spiccato": 0.35, "tenuto": 1.0}
    for mark, share in shares.items():
        notes = play(*four(1, mark)).notes
        assert notes[1].length_s == pytest.approx(share * QUARTER_S), mark
        assert notes[2].start_s == 2 * QUARTER_S
    for end in ("non-staccato", "ordinary"):
        signs = [sign(0, "staccato"), sign(3, end)]
        notes = play(*FOUR, signs=signs, spans=[span("slur", 1, 2)]).notes
        assert [round(each.length_s / QUARTER_S, 1) for each in notes] == [0.5, 1.0, 1.0, 1.0]


def test_a_mark_sets_its_parameter_for_its_note_alone(subtests):
    for mark, address, value in [
        ("up-bow", "/playing/direction", -1.0),
        ("down-bow", "/playing/direction", 1.0),
        ("pizzicato", "/playing/pizzicato", 1.0),
        ("tremolo", "/playing/tremolo", QUICK_TREMOLO),
        (Mark("tremolo", 2), "/playing/tremolo", 8.0),
        (Mark("vibrato", 40.0), "/playing/vibrato", 40.0),
        (Mark("vibrato", 0.0), "/playing/left_hand", 0.0),
        ("spiccato", "/playing/articulation", float(NUMBER["spiccato"])),
        (Mark("articulation", 14), "/playing/articulation", 14.0),
        ("slide-in-up", "/playing/articulation", float(NUMBER["slide-up"])),
        ("slide-in-down", "/playing/articulation", float(NUMBER["slide-down"])),
        ("inner-string", "/playing/string", 1.0),
        ("outer-string", "/playing/string", 2.0),
    ]:
        with subtests.test(mark=mark, address=address, value=value):
            assert settings(play(*four(2, mark)), address) == [(1.0, value), (1.5, None)]
            last = play(*four(3, mark))
            assert settings(last, address)[-1][1] is None
            assert last.duration_s >= last.events[-1].time_s


def test_articulations_of_the_bow_hold_and_those_of_the_fingers_are_for_one_note():
    bow, finger = float(NUMBER["padded"]), float(NUMBER["slide-down"])
    signs = [sign(0, "articulation", bow), sign(1, "gesture", finger), sign(3, "ordinary")]
    found = settings(play(*FOUR, signs=signs), "/playing/articulation")
    assert found == [(0.0, bow), (0.5, finger), (1.0, bow), (1.5, None)]


def test_a_forced_note_is_a_sforzando_where_it_is_long():
    notes = [note(0, 2, 67), note(2, 2, 69), note(4, 0.5, 67)]
    found = settings(play(*notes, signs=[sign(2, "sfz"), sign(4, "sfz")]), "/playing/articulation")
    assert found == [(1.0, float(NUMBER["sforzando"])), (2.0, None)]


def test_the_place_of_the_bow_and_pizzicato_hold_until_they_are_taken_back():
    for name, values, end in [
        *((name, values, "ordinary") for name, values in PLACES.items()),
        ("pizz", {"/playing/pizzicato": 1.0}, "arco"),
    ]:
        score = play(*FOUR, signs=[sign(1, name), sign(3, end)])
        for address, value in values.items():
            assert settings(score, address) == [(0.5, value), (1.5, None)], name


def test_an_open_string_at_its_pitch_is_played_open_and_with_a_finger_on_the_other():
    for mark, string in (
        ("open-string", 2.0),
        (Mark("finger", 0.0), 2.0),
        (Mark("finger", 4.0), 1.0),
    ):
        assert settings(play(note(0, 1, 72, mark)), "/playing/string")[0] == (0.0, string)


# -- loudness -----------------------------------------------------------------------------------


def test_dynamics_are_velocities_and_a_forced_note_is_loud_alone():
    for name, velocity in DYNAMICS.items():
        notes = play(*FOUR, signs=[sign(1, name)]).notes
        assert [each.velocity for each in notes] == [80, *[velocity] * 3], name
    notes = play(*FOUR, signs=[sign(0, "p"), sign(1, "fp")]).notes
    assert [each.velocity for each in notes] == [50, 96, 50, 50]


def test_accents_are_louder_by_their_strength():
    velocities = [
        play(*four(1, mark)).notes[1].velocity
        for mark in ("unstress", "stress", "accent", "marcato")
    ]
    assert velocities == sorted(velocities)
    assert velocities[0] < 80 < velocities[1]


def test_a_hairpin_leads_to_the_dynamic_after_it():
    score = play(
        *FOUR, note(4, 1, 67), signs=[sign(0, "p"), sign(4, "f")], spans=[span("crescendo", 0, 4)]
    )
    velocities = [each.velocity for each in score.notes]
    assert velocities == sorted(velocities)
    assert velocities[-1] == 96
    assert velocities[1] == pytest.approx(50 + 46 * 2 / 4, abs=1)  # its end is its loudest moment


def levels_db(score) -> list[tuple[float, float]]:
    """The level (dB) as time goes, by velocities and controller 11."""
    velocities = {note.start_s: note.velocity for note in score.notes}
    times = sorted({*velocities, *(time for time, _ in expressions(score))})
    found, velocity, expression = [], 80, 127
    for time in times:
        velocity = velocities.get(time, velocity)
        expression = dict(expressions(score)).get(time, expression)
        level = velocity * 18 / 126 + 40 * math.log10(expression / 127)
        found.append((time, level))
    return found


def test_a_dynamic_within_a_held_note_is_no_jump():
    notes = [note(0, 4, 67), note(4, 1, 69)]
    for before, after in (("f", "p"), ("p", "f")):
        found = levels_db(play(*notes, signs=[sign(0, before), sign(2, after)]))
        assert max(abs(one - other) for (_, one), (_, other) in pairwise(found)) < 1.0
        way = [time for time, level in found if abs(level - found[0][1]) > 0.1 and time < 2.0]
        assert 1.0 < way[0] < 1.05
        steps = (found[-1][1] - found[0][1]) * 126 / 18
        assert steps == pytest.approx(DYNAMICS[after] - DYNAMICS[before], abs=1)
        assert abs(found[-1][1] - max(item for item in found if item[0] < 1.35)[1]) < 0.2


def test_between_marks_of_loudness_phrases_are_shaped_less():
    notes = [note(n, 1, 67) for n in range(8)]
    bare, marked = (
        [each.velocity for each in phrased(play(*notes, signs=signs), 0.5).notes]
        for signs in ([], [sign(0, "mf")])
    )
    assert (
        3.0 * (max(marked) - min(marked)) > max(bare) - min(bare) > max(marked) - min(marked) + 10
    )
    assert sum(marked) / len(marked) == pytest.approx(80.0, abs=3.0)


def test_marks_of_loudness_lie_farther_from_their_mean_by_phrasing():
    """An arch over p and f bends neither towards the other, and a hairpin goes on."""
    notes = [note(n, 1, 67) for n in range(12)]
    signs, spans = [sign(0, "p"), sign(8, "f")], [span("crescendo", 4, 8)]
    score = play(*notes, signs=signs, spans=spans)
    written, found = (
        [each.velocity for each in each.notes] for each in (score, phrased(score, 0.5))
    )
    mean = sum(written) / len(written)
    assert sum(found[:4]) / 4 == pytest.approx(mean + 2.0 * (50.0 - mean), abs=3.0)
    assert sum(found[8:]) / 4 == pytest.approx(mean + 2.0 * (96.0 - mean), abs=3.0)
    assert found[3:8] == sorted(found[3:8])


# -- fingers ------------------------------------------------------------------------------------


def test_a_trill_holds_its_note_and_taps_the_other_under_one_bow():
    main, *taps = play(note(0, 4, 67, Mark("trill", 1.0))).notes
    assert (main.key, main.start_s, main.end_s) == (67, 0.0, 2.0)
    assert {tap.key for tap in taps} == {68}
    assert 10 <= len(taps) <= 16
    assert all(main.start_s < tap.start_s < tap.end_s < main.end_s for tap in taps)


def test_ornaments_tap_their_notes_while_the_own_is_held():
    for mark, keys in {
        Mark("mordent", 1.0): [67, 66],
        Mark("inverted-mordent", 2.0): [67, 69],
        Mark("turn", 2.0): [67, 69, 66],
        Mark("inverted-turn", 2.0): [67, 66, 69],
    }.items():
        notes = play(note(0, 2, 67, mark)).notes
        assert [each.key for each in notes] == keys
        assert all(each.end_s < notes[0].end_s for each in notes[1:])


def test_grace_notes_take_their_time_from_their_note():
    graces = (Grace(65.0), Grace(69.0))
    notes = play(note(0, 1, 65), note(1, 1, 67, before=graces), note(2, 1, 67, after=graces)).notes
    assert [each.key for each in notes] == [65, 65, 69, 67, 67, 65, 69]
    starts = [each.start_s for each in notes]
    assert starts == sorted(starts)
    assert starts[1] == QUARTER_S
    assert starts[3] < 1.5 * QUARTER_S
    assert notes[-1].end_s == pytest.approx(3 * QUARTER_S)
    assert notes[1].end_s > notes[2].start_s  # on one bow


def test_a_grace_note_of_the_same_pitch_does_not_end_its_note():
    small, own = play(note(0, 2, 67, before=(Grace(67.0),))).notes
    assert small.end_s == own.start_s
    assert own.end_s == 2 * QUARTER_S


def test_a_note_between_the_keys_is_bent_there():
    score = play(note(0, 1, 66.75), note(1, 1, 69))
    assert [each.key for each in score.notes] == [67, 69]
    assert settings(score, "/playing/bend") == [(0.0, -0.25), (0.5, None)]


def test_a_note_that_slides_does_so_once_plucked_too_and_has_no_other_articulation():
    """Not again where a finger that tapped the string leaves it."""
    address, slide = "/playing/articulation", float(NUMBER["slide-up"])
    tapped = settings(play(*four(1, "slide-in-up", "mordent")), address)
    assert tapped == [(0.5, slide), (0.575, None)]
    assert settings(play(*four(1, "slide-in-up", "pizzicato")), address)[0] == (0.5, slide)
    rolled = play(note(0, 1, 67, "slide-in-up"), signs=[sign(0, "gesture", 11.0)])
    assert settings(rolled, address)[0] == (0.0, slide)
    assert "slides" in rolled.warnings[0]


def test_slides_bend_out_of_a_note():
    for mark, last in (("slide-out-up", 2.0), ("slide-out-down", -2.0)):
        bends = settings(play(*four(1, mark)), "/playing/bend")
        assert (bends[0], bends[-1]) == ((0.5, 0.0), (1.0, None))
        assert bends[-2][1] == pytest.approx(last)
        assert bends[-2][0] < 1.0
        steps = [abs(after - one) for (_, one), (_, after) in pairwise(bends[:-1])]
        assert max(steps[0], steps[-1]) < 0.7 * max(steps)  # no straight line


def test_a_contour_is_followed():
    contour = ((0.0, 0.0), (0.5, 3.0), (1.0, 1.0))
    bends = settings(play(note(0, 4, 67, contour=contour)), "/playing/bend")
    at = dict(bends)
    assert at[1.0] == pytest.approx(3.0)
    assert at[0.5] == pytest.approx(1.5)
    assert bends[-2][1] == pytest.approx(1.0, abs=0.02)


def test_a_portamento_is_there_on_the_beat_and_a_glissando_takes_most_of_its_note():
    for name, length, least, most in (
        ("portamento", 1, 0.1, 0.5),
        ("glissando", 4, 0.7 * 4 * QUARTER_S - 1e-6, 0.7 * 4 * QUARTER_S + 1e-6),
    ):
        score = play(note(0, length, 67), note(length, 1, 79), spans=[span(name, 0, length)])
        begin = score.notes[1].start_s
        slide_s = settings(score, "/playing/portamento_time")[0][1] / 1e3
        assert least < slide_s < most
        assert begin + slide_s == pytest.approx(length * QUARTER_S)
        assert settings(score, "/playing/portamento")[0] == (pytest.approx(begin), 1.0)


def test_a_harmonic_touches_the_node_of_an_open_string_or_is_warned_of():
    score = play(note(0, 1, 91, "harmonic"), note(1, 1, 67))
    assert [each.key for each in score.notes] == [79, 67]  # a fifth above the open string
    flageolet = NUMBER["flageolet"]
    for address, value in (("/playing/articulation", flageolet), ("/playing/string", 2)):
        assert settings(score, address) == [(0.0, value), (QUARTER_S, None)]  # for this note alone
    assert not score.warnings
    score = play(note(0, 1, 80, "harmonic"))
    assert [each.key for each in score.notes] == [80]
    assert "harmonic" in score.warnings[0]


# -- all of it ----------------------------------------------------------------------------------


def test_every_mark_changes_what_is_played_or_says_nothing_about_it():
    plain = [*map(str, play(*FOUR).events)]
    same = {name for name in MARKS if [*map(str, play(*four(1, name)).events)] == plain}
    assert same == {"finger", "open-string", "tenuto", "arpeggio", "articulation"}  # of this note


def test_settings_are_within_the_range_of_their_parameters():
    wrong = []
    for name in MARKS:
        for value in (None, 0.0, 1.0, 5.0, -1e9, 1e9):
            for event in play(*four(1, Mark(name, value))).events:
                if isinstance(event.message, Setting) and event.message.value is not None:
                    param = find(event.message.address)
                    if not param.lo <= event.message.value <= param.hi:
                        wrong.append((name, value, event.message))
    assert not wrong


def test_each_part_has_a_channel_and_none_is_percussion():
    parts = tuple(Part(str(n), (note(0, 1, 67),)) for n in range(20))
    score = performed(Written(parts))
    assert {event.message.channel for event in score.events} == set(CHANNELS)
    assert 9 not in CHANNELS
    assert "20 parts" in score.warnings[0]


def test_marks_that_were_not_understood_are_listed_and_a_score_without_notes_is_refused():
    score = performed(Written((Part("", tuple(FOUR)),), unknown={"squiggle": 2, "blob": 1}))
    assert score.warnings == ("not understood: squiggle (2 times), blob",)
    with pytest.raises(ScoreError, match="no note"):
        performed(Written((Part("", ()),)))


def test_a_score_of_too_many_moves_is_refused(monkeypatch):
    monkeypatch.setattr(performing, "MAX_EVENTS", 1000)
    # Slides for a quarter of an hour each.
    notes = [note(10 * n, 10, 67, contour=((0.0, 0.0), (1.0, 12.0))) for n in range(3)]
    with pytest.raises(ScoreError, match="more than 1000 moves"):
        play(*notes, tempi=(Tempo(Fraction(0), 5.0),))


def test_at_one_time_notes_end_then_settings_change_then_notes_begin():
    """In all parts; what changes with a note has its beat, and what ends with one that beat."""
    slide = (span("portamento", 1, 2),)
    parts = tuple(Part("", tuple(four(2, "up-bow")), slide) for _ in range(2))
    events = [
        event
        for event in performed(Written(parts, STEADY)).events
        if event.message.type != "control_change"
    ]
    kinds = [("note_off", "setting", "note_on").index(each.message.type) for each in events]
    places = [(each.time_s, kind) for each, kind in zip(events, kinds, strict=True)]
    assert places == sorted(places)
    struck = [event.beat for event in events if event.message.type == "note_on"]
    assert struck[:4] == [0.0, 0.0, 1.0, 1.0]
    moved = [event.beat for event in events if isinstance(event.message, Setting)]
    assert {*moved} == {2.0, 3.0}
    (off,) = (e for e in play(note(1, 1, 69, "staccato")).events if e.message.type == "note_off")
    assert (off.time_s, off.beat) == (0.75, 1.5)  # where it is let go
