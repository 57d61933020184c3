"""Finding the source that the user moves."""

import mido

from yehu_server.playing.learner import Learner


def cc(control: int, *values: int, channel: int = 0) -> list[mido.Message]:
    return [
        mido.Message("control_change", control=control, value=value, channel=channel)
        for value in values
    ]


def heard(messages: list[mido.Message]) -> list[str]:
    learner = Learner()
    return [found.source for message in messages if (found := learner.hear(message))]


def test_what_moves_a_sixteenth_of_its_way_is_found():
    for messages, found in [
        (cc(20, 60, 61, 62, 67), []),
        (cc(20, 60, 61, 62, 68), ["cc 20"]),
        (cc(80, 127), []),
        (cc(80, 127, 0), ["cc 80"]),  # a button that is let go
        (cc(64, 0, 127), ["cc 64"]),
        ([mido.Message("pitchwheel", pitch=4000)], ["bend"]),
        ([mido.Message("aftertouch", value=40)], ["pressure"]),
        ([mido.Message("polytouch", note=70, value=40)], ["poly-pressure"]),
        # A pedal trembles while a knob is moved.
        (
            [*cc(11, 100), *cc(20, 0), *cc(11, 101, 99), *cc(20, 5), *cc(11, 103), *cc(20, 10)],
            ["cc 20"],
        ),
    ]:
        assert heard(messages) == found, messages


def test_notes_and_what_has_a_meaning_of_its_own_are_not(subtests):
    for messages in [
        [mido.Message("pitchwheel", pitch=100)],
        [mido.Message("aftertouch", value=3)],
        [mido.Message("note_on", note=70, velocity=100), mido.Message("note_off", note=70)],
        [mido.Message("program_change", program=5)],
        [mido.Message("clock")] * 3,
        cc(123, 0, 127),
        cc(6, 0, 127),
        [*cc(101, 0), *cc(100, 0), *cc(6, 2, 12)],
        [*cc(20, 10, channel=0), *cc(20, 100, channel=1)],  # two knobs
    ]:
        with subtests.test(messages=messages):
            assert heard(messages) == []


def test_two_halves_are_found_as_one_of_fourteen_bits_where_there_are_two():
    pairs = [half for coarse in range(40, 60, 3) for half in (*cc(1, coarse), *cc(33, 77))]
    assert heard(pairs)[:1] == ["cc 1/33"]
    assert set(heard(pairs)) == {"cc 1/33"}
    assert heard(cc(33, 0, 64)) == ["cc 33"]
