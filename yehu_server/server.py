"""The live composition: instrument, player, audio output, OSC, MIDI and OSCQuery.

web thread ─> OSC thread ──┐
                           ├─> LivePlayer ─> ring ─> C callback, in the audio process ─> device
              MIDI process ┘                              └─> meters, applied events, tape
"""

from __future__ import annotations

import contextlib
import gc
import logging
import math
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from platformdirs import user_music_path

from yehu_server.audio.output import Output, OutputOptions
from yehu_server.audio.recorder import Recorder
from yehu_server.control.addresses import Address, Allowed
from yehu_server.control.announce import Announcer, announced
from yehu_server.control.calls import Call, own_calls, preset_calls
from yehu_server.control.osc import OscHandler
from yehu_server.control.peers import WebTraffic
from yehu_server.control.ports import MidiOptions, MidiPorts
from yehu_server.control.sockets import OscPorts
from yehu_server.control.web import Sources, WebOptions, WebServer
from yehu_server.engine import native
from yehu_server.engine.instrument import Instrument
from yehu_server.errors import MappingError, OutputError
from yehu_server.files import (
    anything,
    check_free,
    check_target,
    inside,
    nothing,
    shipped_folder,
)
from yehu_server.lasting import keep_on
from yehu_server.physics.quantities import Quantities
from yehu_server.playing.calibration import Progress
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.delay import Delay
from yehu_server.playing.live import LivePlayer
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.mapping_watch import MappingWatch
from yehu_server.playing.style import Style
from yehu_server.score.capture import CaptureWriter

log = logging.getLogger(__name__)

KEEP_EVERY_S = 0.05
LOOK_EVERY_S = 0.5  # at the mapping's files
FADE_MS = 50.0  # after the notes' release
# Short turns for Python's threads, so that handlers are not late when one is busy.
SWITCH_INTERVAL_S = 0.0001


@dataclass
class ServeOptions:
    """How to serve; see ``yehu-server serve --help``."""

    output: OutputOptions = field(default_factory=OutputOptions)
    midi: MidiOptions | None = field(default_factory=MidiOptions)  # None: no MIDI
    osc: Address = ("127.0.0.1", 9000)
    allowed: Allowed = field(default_factory=Allowed)
    http: WebOptions | None = None  # None: no OSCQuery
    announce: bool | None = None  # None: where it listens beyond this machine
    style: Style = field(default_factory=Style)
    reread: Callable[[], Mapping] | None = None  # the mapping's files; None: they are not watched
    jitter_ms: float | None = None  # None: see playing.delay
    record: Path | None = None
    capture: Path | None = None
    overwrite: bool = False  # whether these two may take the place of older files
    recordings: Path = field(default_factory=lambda: user_music_path() / "yehu-server")


class Server:
    """A yehu that is played live, from `start` to `stop`.

    Parameters
    ----------
    said : callable
        Told in a line what a player should know: devices that come and go, troubles.
    progress : callable, optional
        Told notes done and in all, where the instrument has to be calibrated first.

    Errors: DeviceError where a named device or the OSC address cannot be had; OutputError
    where `record` or `capture` cannot be written.
    """

    def __init__(
        self,
        options: ServeOptions,
        said: Callable[[str], None] = log.info,
        progress: Progress | None = None,
    ) -> None:
        for target in (options.record, options.capture):
            if target is not None:
                check_target(target)
                check_free(target, anything if options.overwrite else nothing)
        self.options = options
        self._said = said
        self._started = time.monotonic()
        with contextlib.ExitStack() as undo:
            self.output = Output(options.output, said)
            undo.callback(self.output.end)
            native.warm_up()  # while the device is looked for
            rate = self.output.find()
            calibration = calibration_for(rate, a4=options.style.a4, progress=progress)
            quantities = calibration.tuned(Quantities())
            self.instrument = Instrument(rate, quantities, memory=self.output.memory.buffer)
            self._delay = Delay(self.instrument, options.output.blocksize, options.jitter_ms)
            self.player = LivePlayer(
                self.instrument,
                options.style,
                calibration=calibration,
                delay_ms=1e3 * self._delay.frames / rate,
            )
            self.player.presets.all()  # read now, so that to tell of them takes no time later
            self.handler = OscHandler(self.player, self)
            self.osc = OscPorts(*options.osc, options.allowed, self.handler)
            undo.callback(self.osc.stop)
            self.web: WebServer | None = None
            if options.http is not None:
                folder = shipped_folder("mappings")
                sources = Sources(self.player.values, self.status, folder, self._more_calls)
                self.web = WebServer(options.http, self.osc, self.handler.clients, sources)
                undo.callback(self.web.stop)
            if options.capture is not None:
                self.instrument.report_events()
            for address, value in options.style.settings:
                self.player.hold(address, value)
            undo.pop_all()
        self._take: Recorder | None = None  # of the command; it ends with the server
        self._recorder: Recorder | None = None  # of whoever asked for it by OSC
        self._capture: CaptureWriter | None = None
        self._lost_capture = False
        self.is_interruptible = False  # whether an exception may cut `stop` short just now
        self._hurry = threading.Event()
        self.midi = MidiPorts(self.player, options.midi, said) if options.midi else None
        self._watch = (
            MappingWatch(options.style.mapping, options.reread) if options.reread else None
        )
        self._next_look = 0.0
        services = announced(self.osc, self.web, options.announce)
        self._announcer = Announcer(services, said) if services else None
        self._ending = threading.Event()
        self._keeper = threading.Thread(target=self._keep, name="keeper", daemon=True)
        self._rests = 0
        self._unreported = 0
        self._troubles: dict[str, int] = {}

    def start(self) -> None:
        """Begin to play.

        Errors: DeviceError where a named device cannot be opened; OutputError.
        """
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        gc.collect()
        gc.freeze()  # what is loaded by now stays: later collections need not look at it
        with contextlib.ExitStack() as undo:
            undo.callback(self.osc.stop)
            if self.web is not None:
                undo.callback(self.web.stop)
            undo.callback(self.output.end)
            self.output.begin(self.instrument)
            if self.options.capture is not None:
                self._capture = CaptureWriter(
                    self.options.capture,
                    rate=self.instrument.rate,
                    seed=self.options.style.seed,
                    tensions=[silk.T for silk in self.instrument.quantities.strings],
                    overwrite=self.options.overwrite,
                )
                undo.callback(self._capture.discard)
            if self.options.record is not None:
                self._take = Recorder(
                    self.instrument,
                    self.options.record,
                    0,
                    self._said,
                    overwrite=self.options.overwrite,
                )
            undo.pop_all()
        self.osc.start()
        if self.web is not None:
            self.web.start()
        if self._announcer is not None:
            self._announcer.start()
        if self.midi is not None:
            self.midi.start()
        self._keeper.start()

    def stop(self) -> None:
        """End all notes, let them fade, close everything; the takes whatever else fails."""
        try:
            self.is_interruptible = True
            self._end_playing()
        finally:
            self.is_interruptible = False
            self._ending.set()
            self._keeper.join()
            self._close_takes()

    def hurry(self) -> None:
        """Let `stop` not wait for what fades; any thread may call, and a signal's handler."""
        self._hurry.set()

    @property
    def kept_all(self) -> bool:
        """Whether nothing is missing in what the command was to record and to capture."""
        return not self._lost_capture and (self._take is None or self._take.is_whole)

    def _end_playing(self) -> None:
        if self.midi is not None:
            self.midi.stop()
        if self._announcer is not None:
            self._announcer.stop()
        if self.web is not None:
            self.web.stop()
        self.osc.stop()
        frame = self.player.frame_of()
        self.player.end_notes(frame=frame)
        fade_ms = self.player.value("/playing/release") + FADE_MS
        self._wait_for(frame + self.instrument.frames(fade_ms))
        self.output.end()

    def _close_takes(self) -> None:
        if self._capture is not None:
            self._write_capture(self._capture)
        capture, self._capture = self._capture, None
        if capture is not None:
            try:
                capture.close(self.instrument.frame)
            except OutputError as error:
                self._lose_capture(error)
        for recorder in (self._take, self._recorder):
            if recorder is not None:
                recorder.stop()
                self._tell_of(recorder)

    def _wait_for(self, frame: int) -> None:
        """Until a frame is played, the clock stands still, or somebody is in a hurry."""
        patience = time.monotonic() + 1.0 + (frame - self.instrument.frame) / self.instrument.rate
        while self.instrument.frame < frame and time.monotonic() < patience:
            if self._hurry.wait(0.005):
                return

    # -- what is kept beside playing -----------------------------------------------------------

    def _keep(self) -> None:
        keep_on(self._keep_up, self._ending, KEEP_EVERY_S, "beside playing", self._said)

    def _keep_up(self) -> None:
        self._follow_device()
        if self._capture is not None:
            self._write_capture(self._capture)
        self._report_troubles()
        if self._watch is not None and time.monotonic() >= self._next_look:
            self._next_look = time.monotonic() + LOOK_EVERY_S
            self._look_at(self._watch)

    def _follow_device(self) -> None:
        """Let the delay of what arrives be as long as the device's period asks for."""
        self._delay.look()
        self.player.delay = self._delay.frames

    def _look_at(self, watch: MappingWatch) -> None:
        """Take up the mapping if its files have changed and are right."""
        try:
            mapping = watch.look()
        except MappingError as error:
            self._said(f"{error}; the mapping stays as it was")
            return
        if mapping is not None:
            self.player.remap(mapping, frame=self.player.frame_of())
            self.tree_changed("/")
            self._said(f"the mapping {mapping.name} has changed, and is taken up")

    def _write_capture(self, capture: CaptureWriter) -> None:
        try:
            for since, frame in self.instrument.rests[self._rests :]:
                capture.note("rest", frame, since=since)
                self._rests += 1
            capture.events(self.instrument.applied_events())
            meters = self.instrument.meters()
            unreported = int(meters["unreported"])
            if unreported > self._unreported:
                lost = unreported - self._unreported
                capture.note("lost", int(meters["frame"]), events=lost)
                self._unreported = unreported
        except OutputError as error:
            self._lose_capture(error)

    def _lose_capture(self, error: OutputError) -> None:
        self._capture = None
        self._lost_capture = True
        self._said(f"capture ended: {error}; it is kept as far as it got")

    def _report_troubles(self) -> None:
        meters = self.instrument.meters()
        troubles = {
            "the state was lost and put back to rest": int(meters["lost"]),
            "events found the ring full": self.instrument.dropped_events,
            "OSC packets were dropped by the system": self.osc.traffic.kernel_drops,
        }
        for what, count in troubles.items():
            if count > self._troubles.get(what, 0):
                self._said(f"{what} ({count} so far)")
        self._troubles = troubles

    # -- what OSC may ask for ------------------------------------------------------------------

    def soon(self, action: Callable[[], None]) -> None:
        """See `osc.Desk`."""
        self.osc.call_soon(action)

    def say(self, line: str) -> None:
        """See `osc.Desk`."""
        self._said(line)

    def tree_changed(self, path: str) -> None:
        """See `osc.Desk`."""
        if self.web is not None:
            self.web.tree_changed(path)

    def _more_calls(self) -> list[Call]:
        """What can be called only here: presets by their names, addresses of the user's own."""
        names = tuple(self.player.presets.names())
        mapping = self.player.mapping
        return [*preset_calls(names), *own_calls(mapping)]

    def start_recording(self, name: str) -> str:
        """Record under a plain name, into the recordings folder; return the file's name.

        Errors: OutputError.
        """
        ending = "" if Path(name).suffix in (".wav", ".flac") else ".wav"
        target = inside(self.options.recordings, name, ending)
        if self._recorder is not None and self._recorder.is_running:
            raise OutputError(f"already recording {self._recorder.target.name}")
        folder = self.options.recordings
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if target.exists():
                raise OutputError(f"{target.name} exists")
        except OSError as error:
            raise OutputError(f"{folder}: {error.strerror}") from error
        self._recorder = Recorder(self.instrument, target, self.instrument.frame, self._said)
        self._said(f"recording {target}")
        return target.name

    def stop_recording(self) -> str:
        """End what `start_recording` began; return the file's name.

        Errors: OutputError where none runs, or it has ended by itself.
        """
        recorder, self._recorder = self._recorder, None
        if recorder is None:
            more = "; --record ends with the server" if self._take is not None else ""
            raise OutputError(f"nothing is being recorded{more}")
        recorder.stop()
        if recorder.failure:
            raise OutputError(f"the recording has ended: {recorder.failure}")
        self._tell_of(recorder)
        return recorder.target.name

    def _tell_of(self, recorder: Recorder) -> None:
        if not recorder.failure:  # or it has been told
            self._said(f"{recorder.target}: {recorder.seconds:.1f} s")

    @property
    def recording(self) -> str:
        """The names of the files that are being recorded, or nothing."""
        recorders = (self._take, self._recorder)
        running = [each for each in recorders if each is not None and each.is_running]
        return "; ".join(each.target.name for each in running)

    def status(self) -> dict[str, float | str]:
        """How things stand, by the names of `control.status.STATUS`; any thread may call."""
        meters = self.instrument.meters()
        output, traffic, counts = self.output.state, self.osc.traffic, self.handler.counts
        pitch = self.player.pitch
        midi = self.midi
        web = WebTraffic() if self.web is None else self.web.traffic
        return {
            "device": output.device or "silent clock",
            "problem": output.problem,
            "rate": self.instrument.rate,
            "blocksize": self.options.output.blocksize,
            "period": self._delay.period,
            "latency_ms": output.latency_ms,
            "delay_ms": 1e3 * self.player.delay / self.instrument.rate,
            "uptime_s": time.monotonic() - self._started,
            "frame": int(meters["frame"]),
            "peak_db": _decibels(meters["peak"]),
            "rms_db": _decibels(meters["rms"]),
            "note": -1.0 if pitch is None else pitch,
            "bow_speed": self.player.value("/bow/speed"),
            "bow_side": self.player.value("/bow/side"),
            "load": float(meters["load"]),
            "worst_load": float(meters["worst_load"]),
            "missed_deadlines": int(meters["missed"]),
            "late_callbacks": int(meters["late_callbacks"]),
            "underruns": int(meters["underruns"]),
            "device_losses": output.losses,
            "applied_events": int(meters["applied"]),
            "late_events": int(meters["late_events"]),
            "dropped_events": self.instrument.dropped_events,
            "waiting_events": int(meters["waiting"]),
            "unconverged_solves": int(meters["unconverged"]),
            "lost_states": int(meters["lost"]),
            "osc_packets": traffic.packets,
            "osc_messages": counts.messages,
            "osc_malformed": counts.malformed,
            "osc_errors": counts.errors,
            "osc_refused": traffic.refused,
            "osc_dropped": traffic.kernel_drops,
            "osc_excess": traffic.excess,
            "osc_unsent": traffic.unsent,
            "osc_failures": traffic.failures,
            "osc_buffer_bytes": traffic.buffer_bytes,
            "osc_connections": traffic.connections,
            "osc_subscribers": self.handler.clients.subscribers,
            "scheduled": self.handler.waiting,
            "late_bundles": counts.late_bundles,
            "midi_ports": "; ".join(midi.connected) if midi else "",
            "midi_connected": len(midi.connected) if midi else 0,
            "midi_messages": midi.received if midi else 0,
            "midi_malformed": midi.malformed if midi else 0,
            "http_requests": web.requests,
            "http_refused": web.refused,
            "http_failures": web.failures,
            "http_unsent": web.unsent,
            "web_sockets": web.web_sockets,
            "recording": self.recording,
        }


def _decibels(level: float) -> float:
    return 20.0 * math.log10(max(float(level), 1e-6))
