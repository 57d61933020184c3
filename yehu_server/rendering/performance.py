"""A performance: instruments on a stage play the events of their parts, block by block."""

import itertools
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import RIG
from yehu_server.core.player.commands import EXPRESS
from yehu_server.core.player.parameter_indices import INDEX, PLAYING
from yehu_server.params.table import find
from yehu_server.playing.parts import assemble, number_of_instruments
from yehu_server.rendering.cores import Cores, Sounded, computed_ahead, shared
from yehu_server.rendering.options import Options, Part
from yehu_server.scores.events import ScoreEvent, Setting

END: tuple[int, ScoreEvent | None] = (-1, None)  # after the last event
Samples = np.ndarray[Any, np.dtype[np.float32]]
ProgressCallback = Callable[[float, float], None]  # seconds done, and those of the score
QUIET = 1e-4  # 80 dB below full scale
QUIET_S = 0.2  # the tail ends after this time of quiet
LONGEST_TAIL_S = 5.0
MIN_AHEAD = 2048  # frames of a block for which another thread costs less than it saves


class PartPlayer:
    """Plays a part's score on an instrument or those of a section, by `player`."""

    def __init__(self, part: Part, instruments: Sequence[Instrument]) -> None:
        self.part, self.instruments = part, instruments
        playing = part.playing
        self.player = playing.mapped(playing.player(instruments))
        self.player.write("/playing/phrasing", playing.phrasing or 0.0)
        for address, value in playing.start:
            self.player.jump(address, value)
        gain = () if playing.gain_db is None else (("/output/gain", playing.gain_db),)
        for address, value in (*gain, *playing.settings):
            self.player.start_with(address, value)
        self._sound = self.player.sound()  # what settings of the score are put back to
        self._passing: set[str] = set()  # what is set until the next note
        self._lengths_s = {note.begins: note.length_s for note in part.score.notes}
        self._events = enumerate(part.score.events)
        self._next = next(self._events, END)

    def play_before(self, end: int) -> None:
        """Post what happens before a frame, except what was posted already."""
        number, event = self._next
        while event and (frame := self.instruments[0].frames(event.time_s * 1e3)) < end:
            self._receive(number, event, frame)
            number, event = next(self._events, END)
        self._next = number, event

    def finish(self, frame: int) -> None:
        """Post what is left, and end all notes, at the last frame of the score."""
        for number, event in itertools.chain([self._next], self._events):
            if event is not None:
                self._receive(number, event, frame)
        self._next = END
        self.player.end_all(frame=frame)

    def _receive(self, number: int, event: ScoreEvent, frame: int) -> None:
        if number in self._lengths_s:
            for address in self._passing:
                self.player.post(EXPRESS, frame, INDEX[address], self._usual(address))
            self._passing.clear()
            self.player.write("/playing/note_length", self._lengths_s[number], frame=frame)
        if isinstance(event.message, Setting):
            self._set(event.message, frame)
        else:
            self.player.receive(event.message, frame=frame)

    def _usual(self, address: str) -> float:
        """What a parameter is where the score does not set it."""
        return self._sound.get(address, find(address).default)

    def _set(self, setting: Setting, frame: int) -> None:
        """Set a parameter as a mark of the score asks, or put it back."""
        if not self.player.plays(setting.channel):
            return
        value = self._usual(setting.address)
        if setting.value is not None:  # a gain is beside that of the room
            value = setting.value + (value if find(setting.address).unit == "dB" else 0.0)
        if setting.is_passing:
            self._passing.add(setting.address)
            self.player.write(setting.address, value, frame=frame)
        else:
            self.player.set(setting.address, value, frame=frame)


class Performance:
    """Plays each part on an instrument of its own; a section has several.

    With `has_stems`, `stems` has what each part gives; with `reports` the instruments report the
    commands that they apply, for a capture. Raises ParameterError where the players are more than a
    stage has room for.
    """

    def __init__(
        self,
        parts: Sequence[Part],
        options: Options,
        *,
        has_stems: bool = False,
        reports: bool = False,
    ) -> None:
        self._options, self._has_stems = options, has_stems
        number_of_instruments([part.playing for part in parts])
        rate = float(options.rate)
        self.ensemble, by_part = assemble(
            [part.playing for part in parts],
            rate,
            [part.playing.calibration(rate) for part in parts],
            is_live=False,
            channels=options.sound_channels,
            has_room=not options.is_dry,
        )
        for instrument in self.ensemble.instruments if reports else ():
            instrument.report_commands()
        self.players = [PartPlayer(*each) for each in zip(parts, by_part, strict=True)]
        self.instrument, self.player = self.ensemble.first, self.players[0].player
        duration_s = max(part.score.duration_s for part in parts)
        self.score_frames = self.instrument.frames(duration_s * 1e3)
        # Of the last block: the sound of each part, then of the room; the pitch that each part is
        # asked for at its end (fractional MIDI note).
        self.stems: list[Samples] = []
        self.target_pitches: list[float | None] = []

    def blocks(self, progress: ProgressCallback | None = None) -> Iterator[Samples]:
        """Yield the samples of score and tail, relative to full scale.

        They have the shape (frames, 2), or (frames,) where `Options.is_mono`. `progress` is called
        after each with the seconds done and those of the score.
        """
        done = 0
        for samples in self._blocks():
            yield samples
            done += len(samples)
            if progress is not None:
                progress(done / self._options.rate, self.score_frames / self._options.rate)

    def _blocks(self) -> Iterator[Samples]:
        options = self._options
        is_ahead = options.cores > 1 and options.block >= MIN_AHEAD
        own = min(options.cores, len(self.ensemble.instruments))
        is_in_turn = own == 1 and not is_ahead and not self._has_stems
        with shared(own) as share:
            form = {"has_stems": self._has_stems, "is_in_turn": is_in_turn}
            cores = Cores(self.ensemble, share, **form)
            blocks = self._sounded(cores)
            if is_ahead:
                blocks = computed_ahead(blocks)
            for block, self.target_pitches in blocks:
                yield self._mixed(cores, block)
            yield from self._tail(cores)

    def _sounded(self, cores: Cores) -> Iterator[tuple[Sounded, list[float | None]]]:
        """Yield the blocks of the score before they are mixed, and the pitches at their ends."""
        position = 0
        while position < self.score_frames:
            end = min(position + self._options.block, self.score_frames)
            for player in self.players:
                player.play_before(end)
            block = cores.sound(end - position)
            position = end
            yield block, self._pitches()
        for player in self.players:
            player.finish(position)

    def _tail(self, cores: Cores) -> Iterator[Samples]:
        if self._options.tail_s is not None:
            left = self.instrument.frames(self._options.tail_s * 1e3)
            while left > 0:
                yield self._process(cores, min(self._options.block, left))
                left -= self._options.block
            return
        window = self.instrument.frames(10.0)
        quiet = 0.0
        for _ in range(round(LONGEST_TAIL_S / 0.01)):
            samples = self._process(cores, window)
            yield samples
            quiet = quiet + 0.01 if np.abs(samples).max() < QUIET else 0.0
            if quiet >= QUIET_S:
                return

    def _process(self, cores: Cores, frames: int) -> Samples:
        block = cores.sound(frames)
        self.target_pitches = self._pitches()
        return self._mixed(cores, block)

    def _mixed(self, cores: Cores, block: Sounded) -> Samples:
        """The samples of a block; sets `stems`."""
        out: Samples = cores.mix(block)
        is_mono = self._options.is_mono
        if self._has_stems:
            stems = cores.stems.mean(axis=2) if is_mono else cores.stems
            ends = np.cumsum([len(player.instruments) for player in self.players])
            own = [part.sum(axis=1) for part in np.split(stems, ends, axis=1)]  # the room is last
            self.stems = [stem.astype(np.float32) for stem in own]
        return out.reshape(-1) if is_mono else out

    def _pitches(self) -> list[float | None]:
        return [_target_pitch(player.instruments[0]) for player in self.players]


def _target_pitch(instrument: Instrument) -> float | None:
    """Return the pitch of the sounding key with its bend (fractional MIDI note), if one sounds.

    Meters have it too, but only those of an instrument that the callback plays.
    """
    player = np.frombuffer(instrument.memory, RIG, count=1)["player"][0]
    sounding = int(player["sounding"])
    if sounding < 0:
        return None
    return float(player["held_pitch"][sounding] + player["value"][PLAYING.bend])
