"""The live server: connects instrument, player, audio output, OSC, MIDI, OSCQuery and the page.

web thread ─> OSC thread ──┐
             pages process ┤
                           ├─> LivePlayer ─> ring ─> C callback, in the audio process ─> device
              MIDI process ┘                              └─> meters, applied wishes, tape
"""

from __future__ import annotations

import contextlib
import gc
import logging
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from platformdirs import user_music_path

from yehu_server.audio.output import Output, OutputOptions
from yehu_server.audio.takes import Takes
from yehu_server.control.addresses import OSC_ADDRESS, Address, Allowed
from yehu_server.control.announce import Announcer, announced
from yehu_server.control.calls import Call, own_calls, preset_calls
from yehu_server.control.mapping_follower import MappingFollower
from yehu_server.control.osc import OscHandler
from yehu_server.control.peers import WebTraffic
from yehu_server.control.ports import MidiOptions, MidiPorts
from yehu_server.control.sockets import OscPorts
from yehu_server.control.status import StatusSources, read_status
from yehu_server.control.troubles import Troubles
from yehu_server.control.web import Sources, WebOptions, WebServer
from yehu_server.engine.warming import warm_up
from yehu_server.errors import YehuError
from yehu_server.files import anything, check_free, check_target, nothing, shipped_folder
from yehu_server.jit import IS_PLAIN
from yehu_server.lasting import keep_on
from yehu_server.panel.pages import PageOptions, Pages
from yehu_server.playing.calibration import Progress
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.delay import Delay
from yehu_server.playing.live import LivePlayer
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.style import Style
from yehu_server.score.live_capture import LiveCapture

log = logging.getLogger(__name__)
KEEP_EVERY_S = 0.05
FADE_MS = 50.0  # waited for after the notes' release
# Python's threads take short turns, so that a busy one does not delay the others.
SWITCH_INTERVAL_S = 0.0001


@dataclass
class ServeOptions:
    """Options of a server; see ``yehu-server serve --help``."""

    output: OutputOptions = field(default_factory=OutputOptions)
    midi: MidiOptions | None = field(default_factory=MidiOptions)  # None: no MIDI
    osc: Address = OSC_ADDRESS
    allowed: Allowed = field(default_factory=Allowed)
    http: WebOptions | None = None  # None: no OSCQuery
    page: PageOptions | None = None  # None: no page
    announce: bool | None = None  # None: what other machines can reach
    style: Style = field(default_factory=Style)
    reread: Callable[[], Mapping] | None = (
        None  # reads the mapping's files; None: they are not watched
    )
    jitter_ms: float | None = None  # None: see playing.delay
    record: Path | None = None
    capture: Path | None = None
    overwrite: bool = False  # whether these two may replace older files
    recordings: Path = field(default_factory=lambda: user_music_path() / "yehu-server")


class Server:
    """A yehu that is played live, from `start` to `stop`.

    Parameters
    ----------
    said : callable
        Called with a line for the player: about devices that appear or disappear, and troubles.
    progress : callable, optional
        Called with the number of notes done and of all, while the instrument is calibrated.

    Raises
    ------
    YehuError
        Where nothing is compiled.
    DeviceError
        Where a named device is not there, or the address of OSC or OSCQuery cannot be used.
    OutputError
        Where `record` or `capture` cannot be written.
    """

    def __init__(
        self,
        options: ServeOptions,
        said: Callable[[str], None] = log.info,
        progress: Progress | None = None,
    ) -> None:
        if IS_PLAIN:
            raise YehuError("NUMBA_DISABLE_JIT: plain Python cannot play live, only render")
        for target in filter(None, (options.record, options.capture)):
            check_target(target)
            check_free(target, anything if options.overwrite else nothing)
        self.options = options
        self._said = said
        self._started = time.monotonic()
        with contextlib.ExitStack() as undo:
            self.output = Output(options.output, said)
            undo.callback(self.output.end)
            warm_up()  # meanwhile the device is looked for
            rate = self.output.find()
            calibration = calibration_for(rate, a4=options.style.a4, progress=progress)
            memory = self.output.memory.buffer
            self.instrument = options.style.instrument(rate, calibration, memory=memory)
            self._delay = Delay(self.instrument, options.output.blocksize, options.jitter_ms)
            self.player = LivePlayer(
                self.instrument,
                options.style,
                delay_ms=1e3 * self._delay.frames / rate,
            )
            self.player.presets.all()  # read now, so that listing them is quick later
            self.handler = OscHandler(self.player, self)
            self.osc = OscPorts(*options.osc, options.allowed, self.handler)
            undo.callback(self.osc.stop)
            self.pages = self._pages()
            undo.callback(self._close, self.pages)
            self.web = self._web()
            undo.callback(self._close, self.web)
            if options.capture is not None:
                self.instrument.report_wishes()
            for address, value in options.style.settings:
                self.player.hold(address, value)
            undo.pop_all()
        self.takes = Takes(self.instrument, options.recordings, said)
        self._capture: LiveCapture | None = None
        self.is_interruptible = False  # whether `stop` may be interrupted by an exception now
        self.midi = MidiPorts(self.player, options.midi, said) if options.midi else None
        self._follower: MappingFollower | None = None
        if options.reread is not None:
            changed = partial(self.tree_changed, "/")
            self._follower = MappingFollower(self.player, options.reread, changed, said)
        services = announced(self.osc, self.web, options.announce)
        self._announcer = Announcer(services, said) if services else None
        self._ways_in: list[OscPorts | WebServer | Announcer | MidiPorts | Pages] = [self.osc]
        others = (self.web, self._announcer, self.midi, self.pages)
        self._ways_in += [way for way in others if way is not None]
        self._ending, self._hurry = threading.Event(), threading.Event()
        self._troubles = Troubles(said)
        keep = (self._keep_up, self._ending, KEEP_EVERY_S, "beside playing", said)
        self._keeper = threading.Thread(target=keep_on, args=keep, name="keeper", daemon=True)

    def _pages(self) -> Pages | None:
        if self.options.page is None:
            return None
        memory = self.output.memory.descriptor
        return Pages(self.player, self.options.page, memory, self._for_pages, self._said)

    def _web(self) -> WebServer | None:
        if self.options.http is None:
            return None
        sources = Sources(
            self.player.values,
            self.status,
            shipped_folder("mappings"),
            self._more_calls,
            lambda: None if self.pages is None else self.pages.port,
        )
        return WebServer(self.options.http, self.osc, self.handler.clients, sources)

    @staticmethod
    def _close(way: WebServer | Pages | None) -> None:
        if way is not None:
            way.stop()

    def start(self) -> None:
        """Start to play.

        Raises
        ------
        DeviceError
            Where a named device cannot be opened.
        OutputError
            Where `record` or `capture` cannot be written.
        """
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        gc.collect()
        gc.freeze()  # later collections skip all objects of now, which stay
        with contextlib.ExitStack() as undo:
            undo.callback(self._close_ways_in)
            undo.callback(self.output.end)
            self.output.begin(self.instrument)
            if self.options.capture is not None:
                self._capture = LiveCapture(
                    self.instrument,
                    self.options.capture,
                    self._said,
                    overwrite=self.options.overwrite,
                )
                undo.callback(self._capture.discard)
            if self.options.record is not None:
                self.takes.record_everything(self.options.record, overwrite=self.options.overwrite)
            undo.pop_all()
        for way in self._ways_in:
            way.start()
        self._keeper.start()

    def stop(self) -> None:
        """End all notes, wait until they have faded, and close everything.

        Recording and capture are closed whatever else fails. Called again, it does nothing.
        """
        if self._ending.is_set():
            return
        try:
            self.is_interruptible = True
            self._end_playing()
        finally:
            self.is_interruptible = False
            self._ending.set()
            self._keeper.join()
            if self._capture is not None:
                self._capture.close()
            self.takes.close()

    def hurry(self) -> None:
        """Let `stop` not wait for notes to fade; any thread or signal handler may call."""
        self._hurry.set()

    @property
    def kept_all(self) -> bool:
        """Whether nothing is missing in the command's recording and capture."""
        return self.takes.is_whole and (self._capture is None or self._capture.is_whole)

    def _close_ways_in(self) -> None:
        for way in reversed(self._ways_in):
            way.stop()

    def _end_playing(self) -> None:
        self._close_ways_in()
        frame = self.player.frame_of()
        self.player.end_notes(frame=frame)
        fade_ms = self.player.value("/playing/release") + FADE_MS
        self._wait_for(frame + self.instrument.frames(fade_ms))
        self.output.end()

    def _wait_for(self, frame: int) -> None:
        """Wait until a frame is played, but not if the clock stands still or after `hurry`."""
        patience = time.monotonic() + 1.0 + (frame - self.instrument.frame) / self.instrument.rate
        while self.instrument.frame < frame and time.monotonic() < patience:
            if self._hurry.wait(0.005):
                return

    # -- done beside playing -------------------------------------------------------------------

    def _keep_up(self) -> None:
        self._delay.look()
        self.player.delay = self._delay.frames  # as the device's period requires
        if self._capture is not None:
            self._capture.keep_up()
        self._troubles.look(
            {
                "the model lost its state and was put back to rest": int(
                    self.instrument.meters()["lost"]
                ),
                "events were dropped, as the ring was full": self.instrument.dropped_events,
                "OSC packets were dropped by the system": self.osc.traffic.kernel_drops,
            }
        )
        if self._follower is not None:
            self._follower.look()

    # -- services for OSC calls ----------------------------------------------------------------

    def soon(self, action: Callable[[], None]) -> None:
        """See `request.Desk`."""
        self.osc.call_soon(action)

    def say(self, line: str) -> None:
        """See `request.Desk`."""
        self._said(line)

    def tree_changed(self, path: str) -> None:
        """See `request.Desk`."""
        if self.web is not None:
            self.web.tree_changed(path)

    def start_recording(self, name: str) -> str:
        """See `request.Desk`."""
        return self.takes.start(name)

    def stop_recording(self) -> str:
        """See `request.Desk`."""
        return self.takes.stop()

    def status(self) -> dict[str, float | str]:
        """See `request.Desk`; any thread may call."""
        return read_status(
            StatusSources(
                meters=self.instrument.meters(),
                instrument=self.instrument,
                player=self.player,
                delay=self._delay,
                output=self.output.state,
                blocksize=self.options.output.blocksize,
                osc=self.osc.traffic,
                messages=self.handler.counts,
                scheduled=self.handler.waiting,
                subscribers=self.handler.clients.subscribers,
                web=WebTraffic() if self.web is None else self.web.traffic,
                midi=self.midi,
                recording=self.takes.names,
                uptime_s=time.monotonic() - self._started,
            )
        )

    def _for_pages(self) -> dict[str, float | str | None]:
        """What pages are told of the sound; any thread may call."""
        state = self.output.state
        delay_ms = 1e3 * self.player.delay / self.instrument.rate
        return {"device": state.device, "latencyMs": state.latency_ms + delay_ms}

    def _more_calls(self) -> list[Call]:
        """The calls with this server's presets, and the user's own addresses."""
        presets = preset_calls(tuple(self.player.presets.names()))
        return [*presets, *own_calls(self.player.mapping)]
