"""Coarse and fine tuning (RPN 1, 2) in a score of MIDI, as far as it moves the pitch of keys."""

from __future__ import annotations

from yehu_server.scores.score import Score

DATA, DATA_FINE, NRPN_FINE, NRPN, RPN_FINE, RPN = 6, 38, 98, 99, 100, 101
FINE, COARSE = 1, 2
CENTRE = 64


def transposed_keys(score: Score) -> dict[int, float]:
    """Return the semitones above their keys of notes that are tuned, by the numbers of events."""
    selected: dict[int, list[int]] = {}  # by channel: coarse and fine half of the parameter
    coarse: dict[int, float] = {}
    fine: dict[int, float] = {}
    found: dict[int, float] = {}
    for number, event in enumerate(score.events):
        message = event.message
        if message.type == "reset":
            for held in (selected, coarse, fine):
                held.clear()
        elif message.type == "note_on" and message.velocity > 0:
            by = coarse.get(message.channel, 0.0) + fine.get(message.channel, 0.0)
            if by:
                found[number] = by
        elif message.type == "control_change":
            channel, value = message.channel, message.value
            if message.control in (RPN, RPN_FINE):
                selected.setdefault(channel, [-1, -1])[message.control == RPN_FINE] = value
            elif message.control in (NRPN, NRPN_FINE):
                selected[channel] = [-1, -1]
            elif message.control == DATA and selected.get(channel) == [0, COARSE]:
                coarse[channel] = float(value - CENTRE)
            elif message.control == DATA and selected.get(channel) == [0, FINE]:
                fine[channel] = (value - CENTRE) / CENTRE
    return found
