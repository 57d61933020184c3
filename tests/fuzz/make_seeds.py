"""Writes the made seeds: MIDI, OSC, WebSocket frames, and what the laboratory reads.

    .venv/bin/python tests/fuzz/make_seeds.py

Text seeds, and those that once broke something, are written by hand.
"""

from __future__ import annotations

import functools
import io
import pickle
import struct
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np

sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[2])]

from fuzz.target import SEEDS
from midi_bytes import END, midi, off, on, riff, tempo
from wire import SINCE_1900_S, Wire

midi_file = functools.partial(midi, kind=0, division=96)
NOTE = on(0, 67, 90) + off(96, 67)
TEMPO = tempo(0, 500_000)

MIDI_FILES = {
    "one-note": midi_file(NOTE + END),
    "running-status": midi_file(b"\x00\x90\x43\x5a\x30\x43\x00\x00\x45\x5a\x30\x45\x00" + END),
    "two-tracks": midi_file(TEMPO + END, NOTE + b"\x00\xb0\x01\x40" + END, kind=1),
    "one-after-another": midi_file(NOTE + END, TEMPO + NOTE + END, kind=2),
    "smpte-time": midi_file(NOTE + END, division=0xE728),
    "sysex-and-escape": midi_file(b"\x00\xf0\x03\x7e\x00\xf7\x00\xf7\x01\xf8" + NOTE + END),
    "all-kinds-of-messages": midi_file(
        NOTE + b"\x00\xe0\x00\x40\x00\xd0\x30\x00\xa0\x43\x30\x00\xc0\x05\x00\xb0\x40\x7f" + END
    ),
    "in-riff": riff(midi_file(NOTE + END)),
    "cut-short": midi_file(NOTE + NOTE)[:-3],
    "velocity-above-127": midi_file(b"\x00\x90\x43\xff" + NOTE + END),
    "division-0": midi_file(NOTE + END, division=0),
    "junk-before": b"From: a friend\n\n" + midi_file(NOTE + END),
    "joined": midi_file(NOTE + END) * 2,
    "a-length-of-0": midi_file(NOTE + END).replace(b"MTrk\0\0\0\x0c", b"MTrk\0\0\0\0"),
    "a-very-long-rest": midi_file(b"\xff\xff\xff\x7f\x90\x43\x5a" + NOTE + END, division=1),
}

# Programs for the target: a wrapper, the header's numbers and whether its length is true; then
# parts. In a track, each event begins with its kind and its delay.
TRUE = b"\1"
PLAIN = b"\0\1\0\x60" + TRUE
NOTE_EVENTS = b"\6\x90\x43\x5a" + b"\x66\x80\x43\0" + b"\0"
MIDI_STRUCTURES = {
    "one-track": b"\0" + PLAIN + b"\3" + NOTE_EVENTS + TRUE,
    "two-tracks-in-riff": b"\1\1\2\0\x60" + TRUE + (b"\3" + NOTE_EVENTS + TRUE) * 2,
    "songs-in-macbinary": b"\2\2\2\0\x60" + TRUE + (b"\3" + NOTE_EVENTS + TRUE) * 2,
    "junk-before": b"\x0b" + PLAIN + b"\3" + NOTE_EVENTS + TRUE,
    "joined": (b"\0" + PLAIN + b"\3" + NOTE_EVENTS + TRUE) * 2,
    "wrong-lengths": b"\0" + PLAIN + b"\3" + NOTE_EVENTS + b"\x88" + b"\3" + NOTE_EVENTS + b"\0",
    "running-status": b"\0" + PLAIN + b"\3\6\x90\x43\x5a\x65\x43\0\x65\x45\x40\x65\x45\0\0" + TRUE,
    "no-end-and-a-tempo": b"\0" + PLAIN + b"\3\2\3\0\0" + NOTE_EVENTS[:-1] + b"\x08\0" + TRUE,
    "sysex-text-and-damage": b"\0" + PLAIN + b"\3\3\2\x7e\xf7\0\4\2la\1\1\3\xff\1\2" + NOTE_EVENTS,
    "division-0": b"\0\0\1\0\0" + TRUE + b"\3" + NOTE_EVENTS + TRUE,
    "frames": b"\0\0\1\xe7\x28" + TRUE + b"\3" + NOTE_EVENTS + TRUE,
    "a-long-rest": b"\0" + PLAIN + b"\3\6\x90\x43\x5a\xfe\x14\x80\x43\0\0" + TRUE,
}


def heard(*messages: bytes, port: int = 0, mapping: int = 1) -> bytes:
    """Messages at a port, each 10 ms after the one before; see the target."""
    heads = (bytes([0xA0 | port << 2 | len(message) - 1]) for message in messages)
    return bytes([mapping]) + b"".join(map(bytes.__add__, heads, messages))


ON, OFF = b"\x90\x43\x5a", b"\x80\x43\x00"
MIDI_MESSAGES = {
    "a-note": heard(ON, OFF),
    "a-chord-and-the-pedal": heard(b"\xb0\x40\x7f", ON, b"\x90\x48\x5a", OFF, b"\xb0\x40\x00"),
    "bend-and-pressure": heard(ON, b"\xe0\x00\x60", b"\xd0\x40", b"\xa0\x43\x40", OFF),
    "bend-range": heard(b"\xb0\x65\x00", b"\xb0\x64\x00", b"\xb0\x06\x30", ON, b"\xe0\x7f\x7f"),
    "an-mpe-zone": heard(
        b"\xb0\x65\x00", b"\xb0\x64\x06", b"\xb0\x06\x04", b"\x91\x43\x5a", b"\xe1\x00\x50"
    ),
    "mpe": heard(b"\x92\x43\x5a", b"\xe2\x00\x50", b"\xb2\x4a\x40", b"\x82\x43\x00", mapping=2),
    "a-wind-controller": heard(b"\xb0\x02\x40", ON, b"\xb0\x02\x00", OFF, mapping=4),
    "an-nrpn": heard(b"\xb0\x63\x01", b"\xb0\x62\x05", b"\xb0\x06\x40", b"\xb0\x60\x00"),
    "programs": heard(b"\xc0\x00", ON, b"\xc0\x05", OFF),
    "mode-messages": heard(ON, b"\xb0\x7b\x00", ON, b"\xb0\x78\x00", b"\xb0\x79\x00"),
    "damaged": heard(b"\x90", b"\x90\x43", b"\x43\x5a", b"\xf0\x7e\xf7", b"\xff", b"\xfe"),
}


OSC_NOTE = Wire.message("/yehu/note", 67.0, 90.0)
BLOB = Wire.message("/a", b"abc")
DEEP = OSC_NOTE
for _ in range(40):
    DEEP = Wire.bundle(None, DEEP)
IN_1968, IN_2019 = (0x80000000 - SINCE_1900_S, 0xE0000000 - SINCE_1900_S)  # s

OSC_PACKETS = {
    "a-note": OSC_NOTE,
    "no-tags": b"/yehu/panic\0",
    "all-types": Wire.message(
        "/all",
        *(-5, 0.5, "word", "symbol", b"x", -1, 2.5, 1, ord("c"), 0x01020304, b"\0\x90\x43\x5a"),
        tags="ifsSbhdtcrmTFNI",
    ),
    "lists-in-lists": Wire.message("/lists", 1.0, 2, "x", tags="[f[i]s]"),
    "a-bundle-for-now": Wire.bundle(None, OSC_NOTE, OSC_NOTE),
    "a-bundle-for-later": Wire.bundle(IN_2019, OSC_NOTE, Wire.bundle(IN_1968, BLOB)),
    "bundles-too-deep": DEEP,
    "an-element-of-no-length": Wire.bundle(None, b""),
    "a-blob-longer-than-the-packet": b"/a\0\0,b\0\0\x7f\xff\xff\xff",
    "a-blob-of-negative-length": b"/a\0\0,b\0\0\xff\xff\xff\xff",
    "a-list-never-closed": Wire.message("/a", tags="[[[["),
    "text-that-is-none": b"/\xff\xfe\0,\0\0\0",
    "not-a-number": Wire.message("/a", float("nan"), float("inf"), tags="fd"),
}


def prefixed(*packets: bytes) -> bytes:
    return b"".join(struct.pack(">I", len(packet)) + packet for packet in packets)


def slip(*packets: bytes) -> bytes:
    escaped = (
        packet.replace(b"\xdb", b"\xdb\xdd").replace(b"\xc0", b"\xdb\xdc") for packet in packets
    )
    return b"".join(b"\xc0" + packet + b"\xc0" for packet in escaped)


# The first byte is the number of bytes in each read; the target adds the framing's first byte.
OSC_PREFIXED = {
    "two-packets": b"\x06" + prefixed(OSC_NOTE, BLOB),
    "byte-by-byte": b"\x00" + prefixed(OSC_NOTE),
    "too-long": b"\x04" + b"\0\x10\0\1",
    "empty-packets": b"\x04" + b"\0" * 32,
}
OSC_PREFIXED = {name: data[:1] + data[2:] for name, data in OSC_PREFIXED.items()}
OSC_SLIP = {
    "two-packets": b"\x06" + slip(OSC_NOTE, BLOB)[1:],
    "byte-by-byte": b"\x00" + slip(OSC_NOTE)[1:],
    "escapes": b"\x03" + slip(b"/\xc0\xdb\0", b"/\xdb\xdc\xdb\xdd\0")[1:],
    "wrong-escapes": b"\x05" + b"/\xdb\xdb\xdb\x00\xc0/\xdb\xc0\xc0\xc0",
    "never-ending": b"\xff" + b"/" * 1000,
}


# Programs for the target. Each message is a kind (48 plus the number of arguments), the number of
# an address in two bytes, arguments, and a pause.
def said(number: int, *arguments: bytes, pause_ms: int = 10) -> bytes:
    kind = 48 + len(arguments)
    return bytes([kind]) + struct.pack("<H", number) + b"".join(arguments) + bytes([pause_ms])


OSC_CALLS = {
    "calls-with-a-number": b"".join(said(number, b"\x01\0") for number in range(8, 40)),
    "calls-without": b"".join(said(number) for number in range(8, 40)),
    "calls-with-a-word": b"".join(said(number, b"\xbf\x01") for number in range(8, 40)),
    "calls-with-two-numbers": b"".join(said(n, b"\x43\0", b"\x5a\0") for n in range(8, 40)),
    "patterns-and-the-own-fader": b"".join(said(number, b"\x43\0") for number in range(8)),
    "parameters": b"".join(said(number, b"\x01\0") for number in range(40, 70)),
    "bundles-ahead-of-their-time": b"\x21\x60" + said(0, b"\x43\0", b"\x5a\0") + b"\x05",
    "no-packets": b"\x00\x08/yehu/no\x00\x01\x04\xff\xff\xff\xff\x01",
}


def frame(opcode: int, data: bytes, *, mask: bytes = b"\1\2\3\4", final: bool = True) -> bytes:
    length = bytes([0x80 | len(data)])
    if len(data) > 125:
        length = b"\xfe" + struct.pack(">H", len(data))
    masked = bytes(byte ^ mask[place % 4] for place, byte in enumerate(data))
    return bytes([0x80 * final | opcode]) + length + mask + masked


LISTEN = b'{"COMMAND": "LISTEN", "DATA": "/yehu/bow/force"}'
WEB_SOCKETS = {
    "listening": frame(1, LISTEN),
    "an-osc-packet": frame(2, OSC_NOTE),
    "a-command-in-parts": frame(1, LISTEN[:9], final=False) + frame(0, LISTEN[9:]),
    "ping-and-close": frame(9, b"hello") + frame(8, b"\x03\xe8bye"),
    "no-text": frame(1, b"\xff\xfe"),
    "unknown-opcode": frame(5, b""),
    "a-control-frame-too-long": frame(9, b"x" * 126),
    "a-frame-of-2^63-bytes": b"\x82\xff" + b"\xff" * 8 + b"\1\2\3\4",
    "unmasked": b"\x81\x02{}",
    "cut-short": frame(1, LISTEN)[:-5],
}


def request(*lines: str, body: bytes = b"") -> bytes:
    return "".join(f"{line}\r\n" for line in (*lines, "")).encode("latin-1") + body


HOST = "Host: 127.0.0.1:9001"
REQUESTS = {
    "the-tree": request("GET / HTTP/1.1", HOST),
    "a-page": request("GET / HTTP/1.1", HOST, "Accept: text/html"),
    "a-value": request("GET /yehu/bow/force?VALUE HTTP/1.1", HOST),
    "host-info": request("GET /?HOST_INFO HTTP/1.1", HOST),
    "metrics": request("GET /metrics HTTP/1.1", HOST, "Accept: application/openmetrics-text"),
    "two-in-a-row": request("HEAD /yehu HTTP/1.1", HOST) + request("GET /x HTTP/1.1", HOST),
    "from-another-page": request("GET / HTTP/1.1", HOST, "Origin: http://evil.example"),
    "another-host": request("GET / HTTP/1.1", "Host: evil.example"),
    "no-host": request("GET / HTTP/1.0"),
    "a-post": request("POST / HTTP/1.1", HOST, "Content-Length: 3", body=b"abc"),
    "chunks": request(
        "GET / HTTP/1.1", HOST, "Transfer-Encoding: chunked", body=b"3\r\nabc\r\n0\r\n\r\n"
    ),
    "a-body-too-long": request("GET / HTTP/1.1", HOST, "Content-Length: 99999999999"),
    "a-web-socket-of-no-key": request(
        "GET / HTTP/1.1", HOST, "Upgrade: websocket", "Connection: Upgrade"
    ),
    "no-http": b"\xc0/yehu/panic\0,\0\0\0\xc0",
    "a-host-that-is-an-odd-address": request("GET / HTTP/1.1", "Host: [::1%25x]:99999"),
    "an-origin-without-end": request("GET / HTTP/1.1", HOST, "Origin: " + "http://[" * 30),
}

# ---------------------------------------------------------------- the laboratory

HZ = np.linspace(120.0, 1900.0, 60)
RATE = 8000  # Hz, of taps
ENTRY: dict[str, Any] = {
    "type": 58, "func_type": 4, "rsp_node": 1, "rsp_dir": 3, "ref_node": 1, "ref_dir": 3,
    "id1": "id1", "rsp_ent_name": "NONE", "ref_ent_name": "NONE", "abscissa_spacing": 1,
    "abscissa_min": HZ[0], "abscissa_inc": HZ[1] - HZ[0], "num_pts": len(HZ), "ord_data_type": 6,
    "abscissa_spec_data_type": 18, "ordinate_spec_data_type": 11,
    "orddenom_spec_data_type": 13, "x": HZ,
}  # fmt: skip
UNITS: dict[str, Any] = {
    "type": 164, "units_code": 5, "units_description": "mm", "temp_mode": 1,
    "length": 1e3, "force": 1.0, "temp": 1.0, "temp_offset": 0.0,
}  # fmt: skip


def table(headings: str, *columns: Any) -> bytes:
    rows = [",".join(f"{value:.8g}" for value in row) for row in zip(*columns, strict=True)]
    return "\n".join([headings, *rows, ""]).encode()


def universal(*sets: dict[str, Any]) -> bytes:
    import pyuff

    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = Path(folder) / "seed.uff"
        pyuff.UFF(str(path)).write_sets(list(sets), "add")
        return path.read_bytes()


def tap() -> tuple[Any, Any, Any]:
    """A hit, and the velocity of one mode at 400 Hz."""
    time = np.arange(RATE // 2) / RATE
    force = np.where(time < 0.05, 0.0, 20.0 * np.exp(-(((time - 0.052) / 0.0005) ** 2)))
    ringing = np.exp(-60.0 * time) * np.cos(2.0 * np.pi * 400.0 * time) / 0.01 / RATE
    return time, force, np.convolve(force, ringing)[: len(time)]


def sound(*channels: Any) -> bytes:
    import soundfile

    file = io.BytesIO()
    soundfile.write(file, np.stack(channels, axis=1), RATE, "PCM_16", format="WAV")
    return file.getvalue()


def result() -> bytes:
    from yehu_server.lab.regimes.columns import FINDING
    from yehu_server.lab.sweeps.result import result_of
    from yehu_server.lab.sweeps.study import study_of

    stroke = {"string": 1, "note": 75}
    study = study_of({"stroke": stroke, "vary": {"force": [0.1, 1.0], "position": [0.1, 0.2]}})
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "seed.npz"
        result_of(study, np.arange(4), np.zeros(4, FINDING)).save(path)
        return path.read_bytes()


def laboratory() -> dict[str, dict[str, bytes]]:
    from lab.body.bodies import admittance

    from yehu_server.core.physics.quantities import measured_body
    from yehu_server.lab.body.body_file import as_text
    from yehu_server.lab.body.curve import Curve
    from yehu_server.lab.body.fitting import Fit
    from yehu_server.lab.body.measurement import Measurement

    mobility = admittance(HZ)
    level, phase = 20.0 * np.log10(np.abs(mobility)), np.degrees(np.angle(mobility))
    time, force, velocity = tap()
    some = slice(0, 1000)
    measured = Measurement(Curve(HZ, mobility, np.full(len(HZ), 0.9), 3), None, 2000.0)
    fit = Fit(measured_body(), measured, (100.0, 2000.0), None, None, ("rough",))
    return {
        "measured-table": {
            "real-and-imaginary": table("f,real mobility,imag", HZ, mobility.real, mobility.imag),
            "level-and-phase": table("freq_hz,mobility_dB level,phase_deg", HZ, level, phase),
            "a-tap": table(
                "time_s,force_N,velocity_m/s", time[some], force[some], 0.1 * velocity[some]
            ),
        },
        "measured-universal": {
            "a-response": universal({**ENTRY, "data": mobility, "binary": 0}),
            "binary": universal({**ENTRY, "data": mobility, "binary": 1}),
            "in-millimetres": universal(UNITS, {**ENTRY, "data": 1e3 * mobility, "binary": 0}),
        },
        "followed-sound": {"a-tap": sound(force[:2000] / 100.0, velocity[:2000])},
        "measured-sound": {"a-tap": sound(force / 100.0, 0.5 * velocity / np.abs(velocity).max())},
        "fitted-body": {
            "a-fit": as_text(fit).encode(),
        },
        "sweep-result": {"four-strokes": result()},
    }


EVENT = struct.pack("<qqqdd", 100, 4, 60, 69.0, 0.8)  # a note, by its frame, kind, index, values
EVENT_RINGS = {
    "two-notes": b"\0" + b"\x01" + EVENT + b"\0" + EVENT,
    "another-writer": b"\x01\0" + EVENT,
    "a-cursor-of-any-number": b"\x04\0" + EVENT,
    "a-cursor-that-goes-back": b"\x08\0" + EVENT,
    "a-lap-ahead": b"\x0e\0" + EVENT,
    "sound-input": b"\x03\0" + EVENT,
    "never": b"\0\0" + struct.pack("<qqqdd", 2**62, 4, 60, 69.0, 0.8),
    "long-ago": b"\x01\0" + struct.pack("<qqqdd", -(2**63), 11, -1, float("nan"), float("inf")),
}


class Calling:
    """Calls a function where it is unpickled."""

    def __reduce__(self) -> tuple[Any, ...]:
        return print, ("it ran",)


CLUSTER_PICKLES = {
    "a-result": pickle.dumps((1, "a", b"b", [None, 0.5], {"c": {"d"}})),
    "a-call": pickle.dumps([Calling()]),
    "an-exception": pickle.dumps(ValueError("wrong")),
    "a-class": pickle.dumps(Path),
    "an-object-with-a-state": pickle.dumps(Path("a/b")),
}
TUNES = {
    "repeats-and-two-voices": b"""X:1
T:A tune
M:6/8
L:1/8
Q:3/8=100
P:A(AB)2
K:Dm
V:1
P:A
|: ~D3 {ef}A2B | (3cde !trill!f3 :|1 z6 :|2 A>B c<d |]
P:B
V:2
[DA]6 | !crescendo(! uA3 !crescendo)! vB3- | B6 |]
w: la la
""",
    "a-latin-1-name": b"X:1\nT:Caf\xe9\nK:G\nGABc|",
}


MADE = {
    "abc": TUNES,
    "cluster-pickle": CLUSTER_PICKLES,
    "event-ring": EVENT_RINGS,
    "midi-file": MIDI_FILES,
    "midi-structure": MIDI_STRUCTURES,
    "midi-messages": MIDI_MESSAGES,
    "osc-packet": OSC_PACKETS,
    "osc-prefixed": OSC_PREFIXED,
    "osc-slip": OSC_SLIP,
    "osc-calls": OSC_CALLS,
    "websocket": WEB_SOCKETS,
    "http-request": REQUESTS,
}


def main() -> None:
    for target, seeds in (MADE | laboratory()).items():
        (SEEDS / target).mkdir(parents=True, exist_ok=True)
        for name, data in seeds.items():
            (SEEDS / target / name).write_bytes(data)


if __name__ == "__main__":
    main()
