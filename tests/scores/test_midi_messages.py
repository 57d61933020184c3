"""Messages of MIDI files are those that mido makes of the same bytes."""

import mido
import pytest

from yehu_server.scores.smf.track import Clock, MessagesOfStatus


@pytest.mark.parametrize("kind", range(0x80, 0xF0, 0x10))
def test_a_message_is_as_mido_reads_it_and_a_damaged_one_is_none(kind: int) -> None:
    messages = MessagesOfStatus(kind + 5)
    for data in ((0, 0), (127, 127), (3, 64)):
        body = bytes(data[: messages.length])
        assert messages[body] == mido.Message.from_bytes([kind + 5, *body])
        assert messages[body] is messages[body]
    assert messages[bytes((200, 0)[: messages.length])] is None


@pytest.mark.parametrize("division", [480, 0xE728])
def test_times_of_ticks_in_order_are_those_of_each(division: int) -> None:
    clock = Clock(division, [(0, 400_000), (100, 1), (100, 700_000), (5000, 10**7)])
    ticks = [0, 0, 99, 100, 101, 4999, 5000, 2**28]
    assert str([*clock.times(ticks)]) == str([(clock.seconds(n), clock.beat(n)) for n in ticks])
