"""The pads of the surfaces play a real server."""

from __future__ import annotations

from yehu_server.surfaces.layout import BOW_FORCE, BOW_SPEED, STRING_PITCH, STRING_PRESS, Axis


def along(axis: Axis, unit: float) -> float:
    return axis.lo + (axis.hi - axis.lo) * unit


def test_one_hand_on_the_string_and_one_on_the_bow_sound_until_the_bow_is_lifted(live, until):
    client = live.client()
    client.tell("/pitch", along(STRING_PITCH, 0.15))
    client.tell("/press", STRING_PRESS.start)
    client.tell("/bow", along(BOW_SPEED, 0.7), along(BOW_FORCE, 0.25))
    until(lambda: live.level() > 0.01, "sound")
    client.tell("/bow", along(BOW_SPEED, 0.5), along(BOW_FORCE, 0.0))
    until(lambda: live.target("/bow/speed") == 0.0, "the bow lifted")
    until(lambda: live.level() < 1e-3, "silence")


def test_the_pads_begin_with_a_bow_at_rest(live):
    client = live.client()
    client.tell("/bow", BOW_SPEED.start, BOW_FORCE.start)
    live.settle()
    assert live.level() < 1e-6
