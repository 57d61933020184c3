"""The live server: constructs its services, starts them in order and stops them."""

import contextlib
import gc
import logging
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial

from yehu_server.compile.jit import IS_PLAIN
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.warming import warm_up
from yehu_server.errors import YehuError
from yehu_server.live.announce import Announcer, announced
from yehu_server.live.audio.output import Output
from yehu_server.live.audio.recordings import Recordings
from yehu_server.live.audio.voice_input import VoiceInput
from yehu_server.live.housekeeper import Housekeeper, MappingWatch
from yehu_server.live.midi.midi_inputs import MidiInputs
from yehu_server.live.options import ServeOptions
from yehu_server.live.osc.context import CallContext
from yehu_server.live.osc.handler import OscHandler
from yehu_server.live.osc.peers import WebTraffic
from yehu_server.live.osc.receiving import OscPorts
from yehu_server.live.osc.status import PART_STATUS, STATUS, PartSources, StatusSources, read_status
from yehu_server.live.osc.work_queue import Calls
from yehu_server.live.page.pages import Pages
from yehu_server.live.part_addresses import FIRST, part_of
from yehu_server.live.web.server import WebServer
from yehu_server.playing.calibration import Progress
from yehu_server.playing.delay import Delay
from yehu_server.playing.parts import assemble, number_of_instruments, player_of, seated
from yehu_server.playing.player import Player
from yehu_server.scores.capture_writer import LiveCapture
from yehu_server.system.processes import be_prompt
from yehu_server.util.files import check_free, check_target, replace_any, replace_none

log = logging.getLogger(__name__)
Input = OscPorts | WebServer | Announcer | MidiInputs | Pages | VoiceInput
FADE_MS = 50.0  # waited for after the notes' release


class Server:
    """Yehus that are played live, one or several on a stage, from `start` to `stop`.

    Raises YehuError where nothing is compiled; DeviceError where a named device is not there, or
    the address of OSC or OSCQuery cannot be used; OutputError where `record` or `capture` cannot be
    written.

    `on_message`: called with a line for the player: about devices that appear or disappear, and
    problems.
    `progress`: called with the number of notes done and of all, while the instrument is calibrated.
    """

    def __init__(
        self,
        options: ServeOptions,
        on_message: Callable[[str], None] = log.info,
        progress: Progress | None = None,
    ) -> None:
        if IS_PLAIN:
            raise YehuError("NUMBA_DISABLE_JIT: plain Python cannot play live, only render")
        for target in filter(None, (options.record, options.capture)):
            check_target(target)
            check_free(target, replace_any if options.overwrite else replace_none)
        self.options = options
        self._on_message = on_message
        with contextlib.ExitStack() as undo:
            per_part = seated([part.playing for part in options.parts])
            number = number_of_instruments(per_part)
            self.output = Output(replace(options.output, parts=number), on_message)
            undo.callback(self.output.end)
            warm_up()  # meanwhile the device is searched for
            rate = self.output.find()
            tuned = [playing.calibration(rate, progress) for playing in per_part]
            memory = self.output.memory.buffer
            self.ensemble, instruments = assemble(
                per_part, rate, tuned, memory=memory, has_room=options.has_room
            )
            self.delay = Delay(self.instrument, options.output.blocksize, options.jitter_ms)
            delay_ms = 1e3 * self.delay.frames / rate
            self.players = tuple(
                player_of(part, playing, own, delay_ms=delay_ms)
                for part, (playing, own) in enumerate(zip(per_part, instruments, strict=True))
            )
            self.player.presets.all()  # read now, so that listing them is quick later
            self.takes = Recordings(self.ensemble, options.recordings, on_message)
            self._files = ThreadPoolExecutor(1, "files")
            calls = Calls()
            undo.callback(calls.close)
            self.context = CallContext(
                self.players,
                self.status,
                self.takes.start,
                self.takes.stop,
                on_message,
                self._files.submit,
                calls.soon,
            )
            self.handler = OscHandler(self.context)
            self.osc = OscPorts(*options.osc, options.allowed, self.handler, calls)
            undo.callback(self.osc.stop)
            self.pages = self._pages()
            if self.pages is not None:
                undo.callback(self.pages.stop)
            self.web = self._web()
            if self.web is not None:
                undo.callback(self.web.stop)
                self.context.on_tree_change.append(self.web.tree_changed)
            if options.capture is not None:
                for instrument in self.ensemble.instruments:
                    instrument.report_commands()
            for player, playing in zip(self.players, per_part, strict=True):
                for address, value in playing.settings:
                    player.hold(address, value)
            undo.pop_all()
        self.is_interruptible = False  # whether `stop` may be interrupted by an exception now
        self.midi = self._midi()
        self._started = time.monotonic()
        services = announced(self.osc, self.web, options.announce)
        self._announcer = Announcer(services, on_message) if services else None
        self.voice = self._voice()
        self._inputs: list[Input] = [self.osc]
        others = (self.web, self._announcer, self.midi, self.pages, self.voice)
        self._inputs += [service for service in others if service is not None]
        self._hurry = threading.Event()
        self._housekeeper = self._make_housekeeper()

    @property
    def player(self) -> Player:
        """The player of the first part."""
        return self.players[0]

    @property
    def instrument(self) -> Instrument:
        """The first instrument, whose parameters are those that all share."""
        return self.ensemble.first

    def _make_housekeeper(self) -> Housekeeper:
        watches = [
            (player, MappingWatch(player.mapping, part.reread))
            for player, part in zip(self.players, self.options.parts, strict=True)
            if part.reread is not None
        ]
        return Housekeeper(
            self.ensemble,
            self.players,
            self.delay,
            watches,
            partial(self.context.tree_changed, "/"),
            lambda: self.osc.traffic.kernel_drops,
            self._on_message,
        )

    def _pages(self) -> Pages | None:
        if self.options.page is None:
            return None
        memory = self.output.memory
        return Pages(
            self.players, self.options.page, memory, self._sound, self._on_message, self._rigs
        )

    def _midi(self) -> MidiInputs | None:
        if not self.options.midi:
            return None
        memory = self.output.memory
        return MidiInputs(self.players, self.options.midi, memory, self._rigs, self._on_message)

    def _voice(self) -> VoiceInput | None:
        follow, output = self.options.follow, self.options.output
        if follow is None:
            return None
        playing, memory = self.options.parts[0].playing, self.output.memory
        return VoiceInput(self.player, follow, playing, output, memory, self._on_message)

    @property
    def _rigs(self) -> list[int]:
        """The first instrument of each part, by its number on the stage."""
        return [self.ensemble.instruments.index(player.instrument) for player in self.players]

    def _web(self) -> WebServer | None:
        if self.options.http is None:
            return None
        pages = self.pages
        page_port = (lambda: None) if pages is None else (lambda: pages.port)
        return WebServer(self.options.http, self.osc, self.context, page_port)

    def start(self) -> None:
        """Start to play.

        Raises DeviceError where a named device cannot be opened; OutputError where `record` or
        `capture` cannot be written.
        """
        be_prompt()
        gc.collect()
        gc.freeze()  # later collections skip all objects of now, which stay
        with contextlib.ExitStack() as undo:
            undo.callback(self._close_inputs)
            undo.callback(self.output.end)
            self.output.begin(self.ensemble)
            if self.options.capture is not None:
                self._housekeeper.capture = LiveCapture(
                    self.ensemble,
                    self.options.capture,
                    self._on_message,
                    has_room=self.options.has_room,
                    overwrite=self.options.overwrite,
                )
                undo.callback(self._housekeeper.capture.discard)
            if self.options.record is not None:
                self.takes.record_everything(
                    self.options.record,
                    overwrite=self.options.overwrite,
                    waits=self.options.waits_for_sound,
                )
            undo.pop_all()
        for service in self._inputs:
            service.start()
        self._housekeeper.start()

    def stop(self) -> None:
        """End all notes, let them fade, and close all, whatever fails; again, do nothing."""
        if self._housekeeper.is_ended:
            return
        try:
            self.is_interruptible = True
            self._end_playing()
        finally:
            self.is_interruptible = False
            self._housekeeper.stop()
            self._files.shutdown()
            self.takes.close()
            self.context.count_errors(is_end=True)

    def skip_fade_out(self) -> None:
        """Let `stop` not wait for notes to fade; any thread or signal handler may call."""
        self._hurry.set()

    @property
    def is_whole(self) -> bool:
        """Whether nothing is missing in the command's recording and capture."""
        return self.takes.is_whole and self._housekeeper.is_whole

    def _close_inputs(self) -> None:
        for service in reversed(self._inputs):
            service.stop()

    def _end_playing(self) -> None:
        self._close_inputs()
        frame = self.player.frame_of()
        for player in self.players:
            player.end_notes(frame=frame)
        fade_ms = max(player.value("/playing/release") for player in self.players) + FADE_MS
        self._wait_for(frame + self.instrument.frames(fade_ms))
        self.output.end()

    def _wait_for(self, frame: int) -> None:
        """Wait until a frame is played; not where the clock stands, nor after `skip_fade_out`."""
        patience = time.monotonic() + 1.0 + (frame - self.instrument.frame) / self.instrument.rate
        while self.instrument.frame < frame and time.monotonic() < patience:
            if self._hurry.wait(0.005):
                return

    def status(self, group: str = FIRST) -> Mapping[str, float | str]:
        """The status values of a group of addresses, by name; any thread may call."""
        if group:
            return read_status(PART_STATUS, PartSources.of(self.players[part_of(group)]))
        return read_status(
            STATUS,
            StatusSources(
                parts=[PartSources.of(player) for player in self.players],
                ensemble=self.ensemble,
                delay=self.delay,
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
            ),
        )

    def _sound(self) -> dict[str, float | str | None]:
        """What pages show of the sound."""
        state = self.output.state
        delay_ms = 1e3 * self.player.delay / self.ensemble.rate
        return {"device": state.device, "latencyMs": state.latency_ms + delay_ms}
