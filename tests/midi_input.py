"""MIDI messages to a live player, as those of an input reach it."""

import mido

from yehu_server.core.midi.events import MESSAGE
from yehu_server.core.midi.packing import packed
from yehu_server.playing.player import Player


def receive(player: Player, message: mido.Message, *, frame: int, port: int) -> None:
    """Have a player play a message of a port at a frame, and hear it where it listens."""
    player.learning.hear_message(message, port)
    player.instrument.post(MESSAGE, frame=frame, index=packed(message.bytes(), port))
