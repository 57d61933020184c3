"""The instrument for Python: post commands, read meters; alone, compute samples without a room."""

import secrets
from ctypes import addressof, c_float
from typing import Any

import numpy as np

from yehu_server.core.controls.record import jump_to_targets, prepare_controls
from yehu_server.core.controls.slots import SILENCE
from yehu_server.core.engine import mailbox, native
from yehu_server.core.engine.event_dispatch import index_notes, interpret_events
from yehu_server.core.engine.output import prepare_output, rest_output
from yehu_server.core.engine.rig import RIG, RIG_BYTES, memory_bytes
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.engine.telemetry import METERS
from yehu_server.core.midi.record import CHANNELS_PER_PORT, clear_held, prepare_midi
from yehu_server.core.midi.tables import plain_tables
from yehu_server.core.physics import kernel, refined
from yehu_server.core.physics.bow import friction_bound
from yehu_server.core.physics.grid import check_rate
from yehu_server.core.physics.layout import MAX_FINGERS, REFINED, new_record
from yehu_server.core.physics.time_loop import kernel_of
from yehu_server.core.player.commands import COMMAND, RAMP
from yehu_server.core.player.record import end_all, prepare_player
from yehu_server.core.stage.record import STAGE, clear_stage, prepare_stage
from yehu_server.core.stage.seat import clear_seat, prepare_seat
from yehu_server.errors import ParameterError
from yehu_server.params.table import SLOT, TABLE, find

Array = Any


class Instrument:
    """A yehu and its player.

    One thread at a time may post commands (`post`, `write`, `silence`), and another may compute
    samples, also in another process that shares `memory`: `process` those of an instrument
    alone, without a room; ``ensemble.Ensemble`` those of one or more on a stage.

    Parameters
    ----------
    spec : InstrumentSpec
        What it is, and starts from.
    channels : int
        Number of channels that `process` writes.
    memory : buffer of RIG_BYTES, optional
        Holds all state of an instrument of an ensemble.
    is_live : bool
        Whether the number of commands that one block takes is limited.

    Raises
    ------
    ParameterError
        Where rate and quantities make no stable model.
    """

    def __init__(
        self, spec: InstrumentSpec, *, channels: int = 1, memory: Any = None, is_live: bool = False
    ) -> None:
        check_rate(spec.rate)
        self.spec, self.rate, self.seed = spec, spec.rate, spec.seed
        self.is_live = is_live
        self._stage = None
        if memory is None:
            memory = new_memory(1)
            self._stage = np.frombuffer(memory, STAGE, offset=RIG_BYTES, count=1)
        self.memory = memory  # the buffer that holds all its state
        self._rig = np.frombuffer(memory, RIG, count=1)
        # Of the rig: the `userdata` of ``engine.native.callback``.
        self.address = self._clock = int(self._rig.ctypes.data)
        self._rig["model"] = kernel.prepare(spec.quantities, spec.rate, MAX_FINGERS)
        self._rig["mail"]["intake"] = mailbox.LIVE_INTAKE if is_live else mailbox.RING
        self._rig["mail"]["at_once"] = mailbox.LIVE_BUDGET if is_live else mailbox.UNLIMITED
        self._rig["mail"]["secret"] = secrets.randbits(62) if is_live else 0
        if self._stage is not None:
            self._rig["parts"][0, 0] = 1
            prepare_stage(self._stage[0], spec.rate, channels, has_room=False)
        # The record of its part, of dtype ``midi.record.MIDI``, if it leads one.
        self.midi: Any = self._rig["midi"][0]
        self.reset()

    def reset(self) -> None:
        """Put all back to its start, drop all commands; nothing may post or compute meanwhile."""
        rig, spec, values = self._rig, self.spec, self.spec.values
        rig["state"] = kernel.at_rest(rig["model"])
        made = refined.prepare(spec.quantities, self.rate)
        if made is not None and self.is_live:  # the audio process has code at other addresses
            raise ParameterError(
                "torsion, wide hair, hyperbolic and viscous friction are not played live"
            )
        rig["kernel"][0, 0] = kernel_of(made)
        rig["refined"] = np.zeros(1, REFINED) if made is None else made
        rig["controls"] = prepare_controls(spec.quantities, self.rate, values)
        rig["player"] = prepare_player(
            spec.quantities,
            self.rate,
            values,
            calibration=spec.calibration,
            open_strings=spec.open_strings,
            bowing=spec.bowing,
            seed=spec.seed,
            player_number=spec.player_number,
        )
        rig["ear_buffer"] = 0.0
        prepare_output(rig["output"], self.rate)
        prepare_seat(rig["seat"][0], self.rate, spec.body)
        if self._stage is not None:
            clear_stage(self._stage[0])
        mail = rig["mail"]
        stays = ("intake", "at_once", "reporting", "delay", "secret")
        kept = {name: mail[name].copy() for name in stays}
        if mail["pending_events"]:
            rig["notes"] = 0
        mail[:] = np.zeros(1, mail.dtype)
        for name, number in kept.items():
            mail[name] = number
        self.begin_part(plain_tables())
        rig["meters"] = np.zeros(1, METERS)
        rig["meters"]["rate"], rig["meters"]["pitch"] = self.rate, np.nan
        rig["meters"]["loop"]["ns_per_frame"] = 1e9 / self.rate
        rig["published"] = rig["meters"]
        self._meters = rig["meters"].copy()  # the last consistent copy
        rig["taped"], rig["version"] = 0, 0
        self.gaps: list[tuple[int, int]] = []

    def begin_part(self, tables: Array, players: int = 1) -> None:
        """Begin a part anew, by TABLES, with so many of the next instruments as its players.

        Nothing may post or compute meanwhile. 0 players where another instrument is the first.
        """
        defaults = {param.address: param.default for param in TABLE}
        defaults["/engine/seed"] = find("/engine/seed").clamped(self.seed)
        is_mpe = bool(tables["mpe"][0])
        prepare_midi(self._rig["midi"], self.rate, defaults, players=players, mpe=is_mpe)
        self._rig["tables"][0, 0] = tables[0]

    def set_tables(self, tables: Array) -> None:
        """Use other tables from the beginning on; nothing may compute meanwhile."""
        midi = self._rig["midi"][0]
        self._rig["tables"][0, midi["tables"]] = tables[0]
        midi["lower"] = CHANNELS_PER_PORT - 1 if tables["mpe"][0] else 0

    @property
    def tables(self) -> Any:
        """The tables of its part: ndarray [shape=(SLOTS,), dtype=``midi.tables.TABLES``]."""
        return self._rig["tables"][0]

    @property
    def frame(self) -> int:
        """Frame number of the next sample."""
        return int(self._rig["controls"]["frame"][0])

    @property
    def friction_bound(self) -> float:
        """See ``physics.bow.friction_bound``."""
        return friction_bound(self._rig["model"][0], self._rig["refined"][0])

    @property
    def unconverged_solves(self) -> int:
        """Number of friction solves that did not converge, since the start."""
        return int(self._rig["state"]["unconverged"][0])

    @property
    def lost_states(self) -> int:
        """Number of times that the model's state was lost and put back to rest, since the start.

        Samples of output that were not numbers are counted too.
        """
        return int(self._rig["state"]["lost"][0] + self._rig["output"]["invalid_samples"][0])

    @property
    def dropped_events(self) -> int:
        """Number of events dropped, since the start: a ring was full, or a time too far ahead."""
        return int(self._rig["mail"]["dropped"][0, :, 0].sum())

    @property
    def late_midi(self) -> int:
        """Number of MIDI messages that came after their frame, since the start."""
        return int(self._rig["mail"]["late"][0, mailbox.MIDI_INPUTS])

    @property
    def delay(self) -> int:
        """Frames from the arrival of a MIDI message to its sound."""
        return int(self._rig["mail"]["delay"][0, 0])

    @delay.setter
    def delay(self, frames: int) -> None:
        self._rig["mail"]["delay"][0, 0] = frames

    def frames(self, ms: float) -> int:
        """Convert milliseconds to frames."""
        return round(ms * 1e-3 * self.rate)

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        """Move a parameter of the engine to a value, clamped to its range; return that value.

        It begins at a frame, by default now, and takes `ramp_ms`, by default the parameter's
        smoothing. Commands of one frame are applied in the order posted. Raises ParameterError
        where the address is none of the engine's, or the value is not finite.
        """
        param = find(address)
        accepted = param.clamped(value)
        slot = SLOT.get(address)
        if slot is None:
            raise ParameterError(f"{address} is not held by the engine")
        ramp = self.frames(param.smooth_ms if ramp_ms is None else ramp_ms)
        self.post(RAMP, frame=frame, index=slot, value=accepted, other=ramp)
        return accepted

    def silence(self, *, frame: int | None = None) -> None:
        """Fade the sound out within 5 ms, then put the model to rest."""
        self.post(RAMP, frame=frame, index=SILENCE)

    def post(
        self,
        kind: int,
        *,
        frame: int | None = None,
        index: int = 0,
        value: float = 0.0,
        other: float = 0.0,
        sender: int = 0,
    ) -> bool:
        """Post an event (``midi.events``), by default for now; return whether there was room.

        `sender`: whose queue it waits in, from 1 to SENDER_QUEUES, or 0 for the server's own.
        """
        frame = self.frame if frame is None else frame
        kind += sender << mailbox.KIND_BITS
        return bool(native.post.call(self.address, frame, kind, index, value, other))

    def waiting(self, sender: int) -> int:
        """Number of events that wait for their frame in the queue of a sender (see `post`)."""
        return int(self._rig["mail"]["pending"][0, mailbox.FIRST_SENDER + sender - 1])

    def interpret_events(self) -> None:
        """Interpret what is posted for now, so that the record of the part has it.

        Of live instruments the callback alone does.
        """
        if not self.is_live:
            interpret_events.call(self._clock, self.frame + 1)

    @property
    def posted(self) -> int:
        """Number of events posted since the start."""
        return int(self._rig["mail"]["posted"][0, mailbox.SERVER, 0])

    def target(self, address: str) -> float:
        """The value that a parameter of the engine has, or moves to."""
        return float(self._rig["controls"]["target"][0, SLOT[address]])

    def process(self, out: Array) -> None:
        """Compute the next samples (full scale is 1) of an instrument alone, without a room.

        `out` is contiguous float32 [shape=(frames,) or (frames, channels)]; else, or of one of an
        ensemble, raises TypeError.
        """
        if self._stage is None:
            raise TypeError("an instrument of an ensemble is played by the ensemble")
        if len(out):
            address = addressof(c_float.from_buffer(out))  # four times as fast as `out.ctypes`
            native.callback.call(None, address, len(out), None, 0, self.address)

    def come_to_rest(self) -> None:
        """Put the model to rest, parameters to their targets, at once."""
        rig = self._rig
        kernel.come_to_rest(rig["model"][0], rig["state"][0])
        refined.come_to_rest(rig["refined"][0])
        jump_to_targets(rig["controls"][0])
        rest_output(rig["output"])
        clear_seat(rig["seat"][0])
        if self._stage is not None:
            clear_stage(self._stage[0])

    def disable_pressure_correction(self) -> None:
        """Disable the pressure correction until the next reset."""
        self._rig["player"]["corrects_pressure"] = 0

    def heard(self) -> tuple[float, float, float]:
        """What the player last heard: certainty, slips in a period, error (cents)."""
        ear = self._rig["player"]["ear"][0]
        return float(ear["certainty"]), float(ear["slips"]), float(ear["error"])

    def end_all(self) -> None:
        """End all notes at once, then as `come_to_rest`."""
        end_all(self._rig["player"][0], self._rig["controls"][0])
        clear_held(self._rig["midi"][0])
        self.come_to_rest()

    def is_broken(self) -> bool:
        """Whether a process was killed while it computed a block with this instrument first."""
        return bool(self._rig["meters"]["running"][0])

    def repair(self) -> None:
        """Put meters and waiting commands in order again, after a process was killed."""
        self._rig["version"][0, 0] += self._rig["version"][0, 0] % 2
        self._rig["meters"]["running"] = 0
        mail = self._rig["mail"][0]
        mailbox.repair_queues(self._rig["events"][0], self._rig["notes"][0], mail)
        index_notes.call(self.address)
        mail["waiting"] = mailbox.repair(self._rig["heap"][0], int(mail["waiting"]))

    def skip_to(self, frame: int) -> None:
        """Go on at a later frame. Nothing may compute meanwhile."""
        self._rig["controls"]["frame"] = frame

    def tape_up_to(self, frame: int) -> int:
        """Set the frame up to which the output ring buffer is valid; return the previous one."""
        was = int(self._rig["taped"][0, 0])
        self._rig["taped"][0, 0] = frame
        return was

    def meters(self) -> Any:
        """The last published meters: a record of dtype ``telemetry.METERS``."""
        meters = np.zeros(1, METERS)
        for _ in range(native.TRIES):
            if native.read_meters.call(self.address, meters.ctypes.data):
                self._meters = meters
                break
        return self._meters[0]

    def frame_at(self, time_ns: int) -> float:
        """The frame that is played at a time of `clocks.monotonic_ns`."""
        return float(native.frame_at.call(self._clock, time_ns))

    def follow_clock(self, address: int) -> None:
        """Take the time of frames from the first instrument of an ensemble, at an address."""
        self._clock = address

    def report_commands(self) -> None:
        """Report applied commands from now on, for `applied_commands`."""
        self._rig["mail"]["reporting"] = 1

    def applied_commands(self) -> Array:
        """The commands applied since the last call: ndarray [shape=(commands,), dtype=COMMAND]."""
        commands = np.zeros(mailbox.RING, COMMAND)
        count = native.read_reports.call(self.address, commands.ctypes.data, mailbox.RING)
        return commands[:count].copy()


def new_memory(parts: int) -> Any:
    """Memory for some instruments and their stage, all zeros, at the beginning of a cache line."""
    return new_record(np.dtype((np.void, memory_bytes(parts)))).view(np.uint8)
