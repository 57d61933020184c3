"""The libraries that read MIDI: which one is used, and that each gives the same."""

import importlib
import queue
import sys
import threading
from types import ModuleType, SimpleNamespace

import pytest

from yehu_server.core.midi.events import DISCONNECT, MESSAGE
from yehu_server.errors import DeviceError
from yehu_server.live.midi import input_process, systems
from yehu_server.live.midi.feed import MidiFeed
from yehu_server.live.midi.input_process import Inputs
from yehu_server.live.midi.ports import StableNames
from yehu_server.live.midi.routes import Router

KEYS, KNOBS = "Keystep:Keystep MIDI 1 24:0", "nanoKONTROL:nanoKONTROL MIDI 1 28:0"
WITHIN_S = 5.0


class PretendRtMidi(ModuleType):
    """python-rtmidi on a machine with two controllers."""

    API_LINUX_ALSA, API_MACOSX_CORE, API_WINDOWS_MM = 1, 2, 3

    class RtMidiError(Exception):
        pass

    def __init__(self) -> None:
        super().__init__("rtmidi")
        self.listening: dict[str, object] = {}
        outer = self

        class MidiIn:
            def __init__(self, _api: int, **_name: str) -> None:
                if outer.is_missing:
                    raise SystemError("no sequencer")

            def get_ports(self) -> list[str]:
                return [KEYS, KNOBS]

            def ignore_types(self, *, active_sense: bool, **_others: bool) -> None:
                assert not active_sense

            def set_callback(self, callback) -> None:
                self.callback = callback

            def open_port(self, number: int, **_name: str) -> None:
                self.at = self.get_ports()[number]
                outer.listening[self.at] = self.callback

            def open_virtual_port(self, name: str) -> None:
                self.at = name
                outer.listening[name] = self.callback

            def cancel_callback(self) -> None:
                outer.listening.pop(self.at)

            def close_port(self) -> None:
                pass

        self.MidiIn, self.is_missing = MidiIn, False

    def get_compiled_api(self) -> list[int]:
        return [self.API_LINUX_ALSA]

    def get_api_display_name(self, _number: int) -> str:
        return "ALSA"

    def play(self, port: str, data: list[int]) -> None:
        if port in self.listening:
            self.listening[port]((data, 0.0), None)


class PretendAlsaMidi(ModuleType):
    """alsa-midi on the same machine."""

    class ALSAError(Exception):
        pass

    class StateError(Exception):
        pass

    EventType = SimpleNamespace(SYSEX="sysex")
    PortCaps = SimpleNamespace(WRITE=1, SUBS_WRITE=2, NO_EXPORT=4)

    class PortType(int):
        MIDI_GENERIC, SYNTHESIZER, APPLICATION = 1, 2, 4

    class MidiBytesEvent(SimpleNamespace):
        pass

    PortInfo = SimpleNamespace

    def __init__(self) -> None:
        super().__init__("alsa_midi")
        self.is_missing = False
        self.events: queue.Queue = queue.Queue()
        self.sources: dict[str, int] = {}  # number of our port, by what it hears
        outer = self

        class SequencerClient:
            def __init__(self, _name: str) -> None:
                if outer.is_missing:
                    raise outer.ALSAError("No such file or directory")

            def list_ports(self, **_which: object) -> list[SimpleNamespace]:
                rows = [("Keystep", 24), ("nanoKONTROL", 28), ("timer", 30)]
                return [
                    SimpleNamespace(
                        client_name=name, name=f"{name} MIDI 1", client_id=at, port_id=0,
                        type=1 if name != "timer" else 8,
                    )
                    for name, at in rows
                ]  # fmt: skip

            def create_port(self, name: str, _caps: int, _type: int) -> SimpleNamespace:
                number = len(outer.sources)
                outer.sources[name] = number

                def connect_from(source: SimpleNamespace) -> None:
                    full = f"{source.client_name}:{source.name} {source.client_id}:{source.port_id}"
                    outer.sources[full] = number

                return SimpleNamespace(
                    port_id=number, connect_from=connect_from, close=lambda: None
                )

            def event_input(self, **_form: bool) -> object:
                event = outer.events.get()
                if isinstance(event, Exception):
                    raise event
                return event

        self.SequencerClient = SequencerClient

    def play(self, port: str, data: list[int]) -> None:
        kind = "sysex" if data[0] == 0xF0 else "other"
        dest = SimpleNamespace(port_id=self.sources.get(port, 99))
        self.events.put(self.MidiBytesEvent(type=kind, dest=dest, midi_bytes=bytes(data)))


@pytest.fixture(params=[PretendRtMidi, PretendAlsaMidi])
def library(request, monkeypatch):
    """A library of ALSA's, and the system that uses it."""
    pretended = request.param()
    monkeypatch.setitem(sys.modules, pretended.__name__, pretended)
    name = f"yehu_server.live.midi.{pretended.__name__.removesuffix('_midi')}_system"
    monkeypatch.delitem(sys.modules, name, raising=False)
    yield pretended, importlib.import_module(name).System
    sys.modules.pop(name, None)
    if isinstance(pretended, PretendAlsaMidi):
        pretended.events.put(pretended.StateError())  # its thread ends


class Heard:
    """The messages that arrive."""

    def __init__(self) -> None:
        self.messages: list[list[int]] = []
        self._came = threading.Semaphore(0)

    def receive(self, data) -> None:
        self.messages.append(list(data))
        self._came.release()

    def wait(self, count: int) -> list[list[int]]:
        for _ in range(count):
            assert self._came.acquire(timeout=WITHIN_S)
        return self.messages


def test_each_library_names_ports_alike_and_passes_messages_on(library):
    pretended, system_of = library
    system = system_of("alsa")
    assert system.name == "ALSA"
    assert system.ports() == [KEYS, KNOBS]
    assert StableNames().of(system.ports()) == ["Keystep MIDI 1", "nanoKONTROL MIDI 1"]
    assert system.left() == set()
    keys, knobs, virtual = Heard(), Heard(), Heard()
    system.open(KEYS, "Keystep MIDI 1", keys.receive)
    close = system.open(KNOBS, "nanoKONTROL MIDI 1", knobs.receive)
    system.open(None, "yehu", virtual.receive)
    pretended.play(KNOBS, [0xB0, 1, 7])
    pretended.play("yehu", [0x90, 69, 80])
    assert knobs.wait(1) == [[0xB0, 1, 7]]
    assert virtual.wait(1) == [[0x90, 69, 80]]
    close()
    pretended.play(KNOBS, [0xB0, 1, 8])
    pretended.play(KEYS, [0xD0, 9])
    assert keys.wait(1) == [[0xD0, 9]]
    assert knobs.messages == [[0xB0, 1, 7]]


def test_each_library_says_what_cannot_be_opened(library):
    pretended, system_of = library
    system = system_of("alsa")
    with pytest.raises(DeviceError):
        system.open("gone:gone MIDI 1 99:0", "gone", lambda _data: None)
    pretended.is_missing = True
    with pytest.raises(DeviceError):
        system_of("alsa")


def test_alsa_gives_14_bit_controllers_as_messages_no_system_exclusive_and_goes_on_after_a_loss(
    monkeypatch,
):
    pretended = PretendAlsaMidi()
    monkeypatch.setitem(sys.modules, "alsa_midi", pretended)
    monkeypatch.delitem(sys.modules, "yehu_server.live.midi.alsa_system", raising=False)
    heard = Heard()
    system = importlib.import_module("yehu_server.live.midi.alsa_system").System("alsa")
    system.open(KEYS, "Keystep MIDI 1", heard.receive)
    pretended.play(KEYS, [0xF0, 0x7E, 9, 1, 0xF7])
    pretended.events.put(pretended.ALSAError("No space left on device"))
    pretended.events.put(SimpleNamespace(type="port start"))
    pretended.play(KEYS, [0xB0, 1, 7, 0xB0, 33, 5])
    assert heard.wait(2) == [[0xB0, 1, 7], [0xB0, 33, 5]]
    pretended.events.put(pretended.StateError())
    monkeypatch.delitem(sys.modules, "yehu_server.live.midi.alsa_system")


@pytest.fixture
def jack_system():
    """A client of JACK that is connected to no server."""
    try:
        from yehu_server.live.midi.jack_system import System
    except (ImportError, OSError):
        pytest.skip("there is no JACK library")
    return object.__new__(System)


def test_over_jack_an_empty_message_is_no_message(jack_system):
    heard = Heard()
    port = SimpleNamespace(incoming_midi_events=lambda: [(0, b""), (5, b"\x90\x45\x50")])
    jack_system._open = ((port, heard.receive),)
    jack_system._process(64)
    assert heard.messages == [[0x90, 0x45, 0x50]]


def test_over_jack_what_others_connect_to_a_port_of_ours_is_not_heard_twice(jack_system):
    keys, knobs = SimpleNamespace(name="keys"), SimpleNamespace(name="knobs")
    own = SimpleNamespace(connections=[])
    jack_system._open, jack_system._virtual = (), []
    jack_system._client = SimpleNamespace(
        get_ports=lambda **_kind: [keys, knobs],
        midi_inports=SimpleNamespace(register=lambda _name: own),
    )
    jack_system.open(None, "yehu", Heard().receive)
    assert jack_system.ports() == ["keys", "knobs"]
    own.connections.append(keys)
    assert jack_system.ports() == ["knobs"]


# ---------------------------------------------------------------- which one


@pytest.mark.parametrize(
    ("api", "installed", "module"),
    [
        ("alsa", {"rtmidi", "alsa_midi"}, "rtmidi_system"),
        ("alsa", {"alsa_midi"}, "alsa_system"),
        ("jack", {"jack", "rtmidi"}, "jack_system"),
        ("core", {"rtmidi"}, "rtmidi_system"),
    ],
)
def test_the_library_is_the_first_that_is_installed(monkeypatch, api, installed, module):
    monkeypatch.setattr(systems.importlib.util, "find_spec", lambda name: name in installed or None)
    assert systems.library(api)[0] == module


@pytest.mark.parametrize(
    ("api", "version", "advice"),
    [
        ("alsa", (3, 13), "alsa-midi is not installed: pip install alsa-midi"),
        ("jack", (3, 13), "JACK-Client is not installed: pip install JACK-Client"),
        ("core", (3, 12), "python-rtmidi is not installed: pip install python-rtmidi"),
        (
            "windows",
            (3, 14),
            "python-rtmidi is not installed: pip install python-rtmidi, which needs",
        ),
    ],
)
def test_where_none_is_installed_a_line_says_how_to_get_one(monkeypatch, api, version, advice):
    monkeypatch.setattr(systems.importlib.util, "find_spec", lambda _name: None)
    monkeypatch.setattr(systems.sys, "version_info", version)
    with pytest.raises(DeviceError) as raised:
        systems.open_system(api)
    assert str(raised.value).startswith(advice)
    assert ("compiler" in str(raised.value)) == (api == "windows")


def test_without_any_library_the_process_says_so_once_and_goes_on(monkeypatch):
    monkeypatch.setattr(systems.importlib.util, "find_spec", lambda _name: None)
    sent = []
    parent = SimpleNamespace(send=lambda event, **details: sent.append((event, details)))
    ring = SimpleNamespace(post=lambda *_event: True)
    feed = MidiFeed([ring], Router([], 1), message=MESSAGE, disconnect=DISCONNECT)
    order = {"patterns": [], "virtual": None, "api": None}
    inputs = Inputs(parent, feed, order)
    for _ in range(3):
        inputs.poll()
    assert [event for event, _ in sent] == ["none"]
    assert "pip install" in sent[0][1]["reason"]
    assert not inputs.has_system
    assert input_process.list_inputs()[0] == ""
