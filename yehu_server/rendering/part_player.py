"""Gives the instruments of a part the events of their score, as messages at their frames."""

from __future__ import annotations

from collections.abc import Sequence

from yehu_server.engine.instrument import Instrument
from yehu_server.params.table import find
from yehu_server.rendering.options import Part
from yehu_server.score.score import ScoreEvent
from yehu_server.score.score_notes import notes_of
from yehu_server.score.setting import Setting

END: tuple[int, ScoreEvent | None] = (-1, None)  # after the last event


class PartPlayer:
    """Plays a part on an instrument, or on those of a section.

    Attributes
    ----------
    part : Part
    instruments : sequence of Instrument
    wishes : Wishes
    midi : MidiPlayer
    """

    def __init__(self, part: Part, instruments: Sequence[Instrument]) -> None:
        self.part, self.instruments = part, instruments
        style = part.style
        self.wishes = style.wishes(instruments)
        self.midi = style.midi(self.wishes, None if part.channels is None else set(part.channels))
        self.wishes.write("/playing/phrasing", part.phrasing)
        for address, value in style.start:
            self.wishes.jump(address, value)
        gain = () if part.gain_db is None else (("/output/gain", part.gain_db),)
        for address, value in (*gain, *style.settings):
            self.wishes.start_with(address, value)
        self._sound = self.midi.sound()  # what settings of the score are put back to
        self._lengths_s = {note.begins: note.length_s for note in notes_of(part.score)}
        self._events = enumerate(part.score.events)
        self._next = next(self._events, END)

    def play_before(self, end: int) -> None:
        """Post what happens before a frame, except what was posted already."""
        number, event = self._next
        while event is not None:
            frame = self.instruments[0].frames(event.time_s * 1e3)
            if frame >= end:
                break
            self._receive(number, event, frame)
            number, event = next(self._events, END)
        self._next = number, event

    def finish(self, frame: int) -> None:
        """Post what is left, and end all notes, at the last frame of the score."""
        number, event = self._next
        while event is not None:
            self._receive(number, event, frame)
            number, event = next(self._events, END)
        self._next = END
        self.midi.end_all(frame=frame)

    def _receive(self, number: int, event: ScoreEvent, frame: int) -> None:
        if number in self._lengths_s:
            self.wishes.write("/playing/note_length", self._lengths_s[number], frame=frame)
        if isinstance(event.message, Setting):
            self._set(event.message, frame)
        else:
            self.midi.receive(event.message, frame=frame)

    def _set(self, setting: Setting, frame: int) -> None:
        """Set a parameter as a mark of the score asks, or put it back."""
        if not self.midi.plays(setting.channel):
            return
        value = setting.value
        if value is None:
            default = find(setting.address).default
            value = self._sound.get(setting.address, default)
        self.midi.write(setting.address, value, frame=frame)
