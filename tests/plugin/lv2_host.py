"""An LV2 host in Python: plays messages by a plug-in whose ports it knows."""

import ctypes
import struct

import numpy as np

Connect = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_uint32, ctypes.c_void_p)
Simple = ctypes.CFUNCTYPE(None, ctypes.c_void_p)
Run = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_uint32)
Map = ctypes.CFUNCTYPE(ctypes.c_uint32, ctypes.c_void_p, ctypes.c_char_p)


class Mapper(ctypes.Structure):
    _fields_ = (("handle", ctypes.c_void_p), ("map", Map))


Request = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_uint32, ctypes.c_float)
REQUESTS = b"http://kx.studio/ns/lv2ext/control-input-port-change-request"


class Requester(ctypes.Structure):
    _fields_ = (("handle", ctypes.c_void_p), ("change", Request))


class Feature(ctypes.Structure):
    _fields_ = (("uri", ctypes.c_char_p), ("data", ctypes.c_void_p))


class Descriptor(ctypes.Structure):
    _fields_ = (
        ("uri", ctypes.c_char_p),
        (
            "instantiate",
            ctypes.CFUNCTYPE(
                *(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_double, ctypes.c_char_p),
                ctypes.POINTER(ctypes.c_void_p),
            ),
        ),
        ("connect", Connect),
        ("activate", Simple),
        ("run", Run),
        ("deactivate", ctypes.c_void_p),
        ("cleanup", Simple),
        ("extension_data", ctypes.c_void_p),
    )


class Plugin:
    """An instance; `ports` has values of parameters, by number of the port.

    What it asks for is set, and is in `requests`, by port.
    """

    def __init__(self, library, rate, ports):
        self._uris: dict[bytes, int] = {}
        self._map = Map(lambda _, uri: self._uris.setdefault(uri, len(self._uris) + 1))
        self._mapper = Mapper(None, self._map)
        mapper = ctypes.cast(ctypes.pointer(self._mapper), ctypes.c_void_p)
        self._feature = Feature(b"http://lv2plug.in/ns/ext/urid#map", mapper)
        self.requests: dict[int, float] = {}
        self._request = Request(self._set)
        self._requester = Requester(None, self._request)
        requester = ctypes.cast(ctypes.pointer(self._requester), ctypes.c_void_p)
        self._second = Feature(REQUESTS, requester)
        places = map(ctypes.addressof, (self._feature, self._second))
        features = (ctypes.c_void_p * 3)(*places, None)
        entry = ctypes.CDLL(str(library)).lv2_descriptor
        entry.restype = ctypes.POINTER(Descriptor)
        self._plugin = entry(0).contents
        about = ctypes.addressof(self._plugin)
        self._handle = self._plugin.instantiate(about, rate, b"", features)
        self.ports = {number: np.array([value], np.float32) for number, value in ports.items()}
        self.latency = np.zeros(1, np.float32)
        for number, value in (self.ports | {3: self.latency}).items():
            self._plugin.connect(self._handle, number, value.ctypes.data)
        self._plugin.activate(self._handle)

    def _set(self, _, port, value):
        self.requests[port] = value
        self.ports[port][0] = value
        return 0

    def close(self):
        self._plugin.cleanup(self._handle)

    def _number(self, uri):
        return self._map(None, uri)

    def _sequence(self, messages, speed):
        events = []
        if speed is not None:  # an object of one property
            names = (
                b"http://lv2plug.in/ns/ext/time#Position",
                b"http://lv2plug.in/ns/ext/time#speed",
            )
            words = (*map(self._number, names), 0, 4)
            atom = b"http://lv2plug.in/ns/ext/atom#"
            body = struct.pack("<IIIIIIfI", 0, *words, self._number(atom + b"Float"), speed, 0)
            events.append((0, self._number(atom + b"Object"), body))
        midi = self._number(b"http://lv2plug.in/ns/ext/midi#MidiEvent")
        events += [(at, midi, bytes(message)) for at, message in messages]
        data = b""
        for at, kind, body in events:
            data += struct.pack("<qII", at, len(body), kind) + body + bytes(-len(body) % 8)
        return struct.pack("<IIII", 8 + len(data), 0, 0, 0) + data

    def play(self, messages, frames, block, speed=None):
        """Play messages, each a frame and its bytes; the transport's speed comes first."""
        samples = np.zeros((2, frames), np.float32)
        for start in range(0, frames, block):
            now = min(block, frames - start)
            inside = [(f - start, m) for f, *m in messages if start <= f < start + now]
            data = self._sequence(inside, speed if start == 0 else None)
            events = ctypes.create_string_buffer(data)
            self._plugin.connect(self._handle, 0, ctypes.addressof(events))
            for channel in range(2):
                place = samples[channel, start:].ctypes.data
                self._plugin.connect(self._handle, 1 + channel, place)
            self._plugin.run(self._handle, now)
        return samples.T
