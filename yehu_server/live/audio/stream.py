"""The process that holds an audio stream: ``python -m yehu_server.live.audio.stream``.

It searches for the device until it is found, opens a stream with a compiled callback, and reports
when the device is lost. The instruments lie in memory shared with the parent, so that another such
process, or the silent clock, continues where this one stopped. An output computes their sound; an
input follows a voice, and posts events to them.
"""

import itertools
import os
import queue
import threading
import time
from typing import Any

from yehu_server.errors import DeviceError
from yehu_server.live.audio.devices import OUTPUT, AudioDevice, choose, devices, load_portaudio
from yehu_server.system.memory import map_all, open_shared
from yehu_server.util.processes import Message, Parent

SEARCH_EVERY_S, LATER_EVERY_S = 0.5, 2.0
LATER = 60  # searches
WATCH_EVERY_S = 0.1
STALLED = 10  # of these, with nothing new from an input: it is lost, though it does not say so
CLOSE_WITHIN_S = 0.5
MAX_CHANNELS = 64
MAX_LATENCY_S = 60.0  # a longer one is none


class Stream:
    """A PortAudio stream, of the kind that an order asks for."""

    def __init__(self, sounddevice: Any, device: AudioDevice, order: Message) -> None:
        import numpy as np

        self._memory = open_shared(order["memory"])
        map_all(self._memory)
        address = np.frombuffer(self._memory, np.uint8).ctypes.data
        callback, self._own = (_playing if order["kind"] == OUTPUT else _following)(address, order)
        foreign = sounddevice._ffi  # noqa: SLF001 - the documented way for C callbacks
        self._stream = sounddevice._StreamBase(  # noqa: SLF001
            kind=order["kind"],
            device=device.index,
            samplerate=order["rate"],
            blocksize=order["blocksize"],
            channels=order["channels"],
            latency=order["latency"],
            dtype="float32",
            clip_off=True,
            dither_off=True,
            callback=foreign.cast("PaStreamCallback*", callback.address),
            userdata=foreign.cast("void*", address if self._own is None else self._own.ctypes.data),
            wrap_callback=None,
        )

    @property
    def is_active(self) -> bool:
        """Whether the device still asks for samples."""
        return bool(self._stream.active)

    @property
    def heard(self) -> int | None:
        """Number of frames that an input has received; None of an output."""
        return None if self._own is None else int(self._own["detector"]["sample_count"][0])

    @property
    def latency_ms(self) -> float:
        """Latency between callback and device by PortAudio; 0 where it does not know."""
        reported_s = float(self._stream.latency)
        return 1e3 * reported_s if 0.0 <= reported_s < MAX_LATENCY_S else 0.0

    def start(self) -> None:
        """Start the callbacks."""
        self._stream.start()

    def close(self) -> None:
        """Close the stream; give up where PortAudio hangs, as it does without JACK's server."""
        closing = threading.Thread(target=self._stream.close, daemon=True)
        closing.start()
        closing.join(CLOSE_WITHIN_S)


def _playing(_address: int, _order: Message) -> tuple[Any, Any]:
    """The callback of an output, whose data are the instruments themselves."""
    from yehu_server.core.engine import native

    return native.callback, None


def _following(address: int, order: Message) -> tuple[Any, Any]:
    """The callback of an input, and its data: the record of a follower."""
    import numpy as np

    from yehu_server.core.engine.voice_callback import follow_input, voice_prepare
    from yehu_server.core.voice.note_detection import FOLLOWER

    voice = np.zeros(1, FOLLOWER)
    voice_prepare.call(voice.ctypes.data, order["rate"], order["transpose"], order["correct"])
    for field, value in order["fields"].items():
        voice[field] = value
    voice["rig"] = address
    return follow_input, voice


def main() -> None:
    """Serve the parent process until it closes the pipe."""
    parent = Parent()
    orders: queue.Queue[Message | None] = queue.Queue()

    def listen() -> None:
        for order in parent.orders():
            orders.put(order)
        orders.put(None)

    threading.Thread(target=listen, daemon=True).start()
    stream = None
    try:
        stream = _serve(parent, orders)
    except DeviceError as error:
        parent.send("failed", reason=str(error))
    if stream is not None:
        stream.close()
    os._exit(0)  # PortAudio's own clean-up may hang


def _serve(parent: Parent, orders: queue.Queue[Message | None]) -> Stream | None:
    order = orders.get()
    if order is None:
        return None
    sounddevice = load_portaudio(order["kind"])
    device = _search(parent, orders, sounddevice, order)
    if device is None:
        return None
    order = orders.get()
    if order is None:
        return None
    from yehu_server.core.engine.warming import is_warm

    if order["kind"] == OUTPUT and not is_warm():
        parent.send("compiling")
    try:
        stream = Stream(sounddevice, device, order)
    except sounddevice.PortAudioError as error:
        raise DeviceError(_reason(sounddevice, device, order, error)) from error
    parent.send("ready", latency_ms=stream.latency_ms)
    if orders.get() is not None:
        try:
            stream.start()
        except sounddevice.PortAudioError as error:
            raise DeviceError(f"{device.full_name}: {error}") from error
        parent.send("started")
        _watch(parent, orders, stream)
    return stream


def _search(
    parent: Parent, orders: queue.Queue[Message | None], sounddevice: Any, order: Message
) -> AudioDevice | None:
    """Wait for the device. PortAudio lists new devices only after it is started again."""
    missing = ""
    for search in itertools.count():
        try:
            there = devices(sounddevice, order["kind"])
            device = choose(there, order["device"], order["kind"])
        except DeviceError as error:
            if str(error) != missing:
                missing = str(error)
                parent.send("missing", reason=missing)
        else:
            parent.send(
                "found",
                name=device.full_name,
                rate=device.rate,
                channels=min(device.channels, MAX_CHANNELS),
            )
            return device
        try:
            if orders.get(timeout=SEARCH_EVERY_S if search < LATER else LATER_EVERY_S) is None:
                return None
        except queue.Empty:
            pass
        sounddevice._terminate()  # noqa: SLF001 - there is no other way to search again
        sounddevice._initialize()  # noqa: SLF001
    return None


def _watch(parent: Parent, orders: queue.Queue[Message | None], stream: Stream) -> None:
    heard, still = stream.heard, 0
    while stream.is_active and still < STALLED:
        try:
            if orders.get(timeout=WATCH_EVERY_S) is None:
                return
        except queue.Empty:
            before, heard = heard, stream.heard
            still = still + 1 if heard is not None and heard == before else 0
    parent.send("lost", at=time.monotonic())
    os._exit(1)


def _reason(sounddevice: Any, device: AudioDevice, order: Message, error: Exception) -> str:
    if getattr(error, "args", (0, 0))[-1] == sounddevice._lib.paInvalidSampleRate:  # noqa: SLF001
        return (
            f"{device.full_name} does not run at {order['rate']:g} Hz "
            f"(its own rate is {device.rate:g} Hz: --rate {device.rate:g})"
        )
    return f"{device.full_name}: {str(error).replace(chr(10), ' ')}"


if __name__ == "__main__":
    main()
