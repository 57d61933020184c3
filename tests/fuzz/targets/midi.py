"""Messages from MIDI ports."""

import functools
from types import SimpleNamespace

from fuzz.instrument import Instrument, check_silence, check_values
from fuzz.target import Program, target

from yehu_server.core.midi.events import DISCONNECT, MESSAGE
from yehu_server.live.midi.feed import MidiFeed
from yehu_server.live.midi.input_process import Input
from yehu_server.live.midi.routes import Router
from yehu_server.playing.mapping import load, shipped_mappings
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import player_of

PORTS = 4
MAX_MESSAGES = 1000


@functools.cache
def with_each_mapping() -> list[PlayingOptions]:
    return [PlayingOptions(mapping=load(name), programs=True) for name in shipped_mappings()]


@target("midi-messages", words=(b"\x33\x90\x43\x5a", b"\x33\xb0\x01\x7f", b"\x32\xd0\x40"))
def midi_messages(data: bytes) -> None:
    """Any messages give the instrument finite values within range, and it can be silenced.

    The first byte chooses the mapping. Each message begins with a byte: its length in two bits,
    the port in two, and milliseconds since the one before.
    """
    program = Program(data)
    every = with_each_mapping()
    instrument = Instrument()
    playing = every[program.byte() % len(every)]
    player = player_of(0, playing, [instrument], delay_ms=3.0)

    def post(_time_ns: int, kind: int, index: int) -> bool:
        return instrument.post(kind, frame=player.frame_of(), index=index)

    router = Router([], 1)
    feed = MidiFeed([SimpleNamespace(post=post)], router, message=MESSAGE, disconnect=DISCONNECT)
    inputs = [Input(f"port {number}", None, feed, None) for number in range(PORTS)]
    for each in inputs:
        feed.open(each.name)
    for _ in range(MAX_MESSAGES):
        if not program:
            break
        head = program.byte()
        message = program.take(1 + head % 4)
        instrument.now_s += 1e-3 * (head >> 4)
        if message:
            inputs[head // 4 % PORTS].receive(list(message))
    check_values(player)
    player.panic(frame=player.frame_of())
    check_silence(player, instrument)
