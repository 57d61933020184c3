"""Write a performance as a MIDI file, by controllers of the mapping `keyboard`."""

import io
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

import mido

from yehu_server.core.player.gestures import STEPS_FRACTION
from yehu_server.params.articulations import ARTICULATIONS, NUMBER
from yehu_server.params.table import find
from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import DEFAULT, load
from yehu_server.scores.events import BEND, Setting
from yehu_server.scores.score import Score
from yehu_server.scores.written.layout import signature
from yehu_server.scores.written.mark_settings import ARTICULATION, SLIDES
from yehu_server.scores.written.notated import Written
from yehu_server.scores.written.tempo import WrittenClock

TICKS = 960  # a quarter note
BEND_RANGE = 24  # semitones
SLIDE_POINTS = 16  # of a written slide
SLOWEST = 0xFFFFFF  # microseconds a quarter, the most that a file can have


def midi_file(written: Written, score: Score) -> tuple[bytes, dict[str, int]]:
    """Return a MIDI file of format 1, and what it cannot say: settings by address, with counts.

    `score` is what `performed` made of the written one.
    """
    clock = WrittenClock(written)
    names = [part.name for part in written.parts if part.notes]
    return _file(_conductor(written, clock), score, clock.beat_at, names)


def midi_of_performance(score: Score, quarter_s: float) -> tuple[bytes, dict[str, int]]:
    """Return the same of a score that was played, not written: in quarters of one length (s)."""
    tempo = mido.MetaMessage("set_tempo", tempo=round(quarter_s * 1e6))
    return _file([(0, _title(score.name)), (0, tempo)], score, lambda time_s: time_s / quarter_s)


def _file(
    conductor: list[tuple[int, mido.MetaMessage]],
    score: Score,
    beat_at: Callable[[float], float],
    names: Sequence[str] = (),
) -> tuple[bytes, dict[str, int]]:
    file = mido.MidiFile(type=1, ticks_per_beat=TICKS)
    file.tracks.append(_track(conductor))
    lost: Counter[str] = Counter()
    channels = sorted(
        {event.message.channel for event in score.events if hasattr(event.message, "channel")}
    )
    translated = _Translation()
    by_channel: dict[int, list[tuple[int, mido.Message]]] = {each: [] for each in channels}
    lengths = {(note.channel, note.start_s): note.length_s for note in score.notes}
    for event in score.events:
        tick = _tick(beat_at(event.time_s))
        messages = by_channel[event.message.channel]
        if isinstance(event.message, Setting):
            found = list(translated.messages(event.message))
            messages += [(tick, message) for message in found]
            length_s = lengths.get((event.message.channel, event.time_s), 0.0)
            for later_s, message in translated.slide(event.message, length_s):
                found.append(message)
                messages.append((_tick(beat_at(event.time_s + later_s)), message))
            lost[event.message.address] += not found and event.message.value is not None
        else:
            messages.append((tick, event.message))
    for number, channel in enumerate(channels):
        title = _title(names[number] if number < len(names) else "")
        file.tracks.append(_track([(0, title), *by_channel[channel]]))
    data = io.BytesIO()
    file.save(file=data)
    return data.getvalue(), dict(+lost)


def _tick(beat: float) -> int:
    return max(round(beat * TICKS), 0)


def _track(messages: list[tuple[int, mido.Message]]) -> mido.MidiTrack:
    """A track of messages at ticks, in their order where ticks are the same."""
    track = mido.MidiTrack()
    last = 0
    for tick, message in sorted(messages, key=lambda each: each[0]):
        track.append(message.copy(time=tick - last))
        last = tick
    track.append(mido.MetaMessage("end_of_track", time=0))
    return track


def _title(name: str) -> mido.MetaMessage:
    encoded = name.encode().decode("latin-1")  # by which mido writes it, so that it is UTF-8
    return mido.MetaMessage("track_name", name=encoded)


def _conductor(written: Written, clock: WrittenClock) -> list[tuple[int, mido.MetaMessage]]:
    messages = [(0, _title(written.title))]
    last = None
    for beat, quarter_s in clock.tempi:
        tempo = min(max(round(quarter_s * 1e6), 1), SLOWEST)
        if tempo != last:
            messages.append((_tick(beat), mido.MetaMessage("set_tempo", tempo=tempo)))
            last = tempo
    for metre in written.metres:
        if figures := signature(Fraction(metre.quarters).limit_denominator(64)):
            count, unit = figures
            message = mido.MetaMessage("time_signature", numerator=count, denominator=unit)
            messages.append((_tick(metre.beat), message))
    return messages + [
        (_tick(float(sign.beat)), mido.MetaMessage("key_signature", key=sign.do))
        for sign in written.keys
    ]


_SLIDES = {float(NUMBER[name]) for name in SLIDES.values()}


class _Translation:
    """Settings as messages of the mapping `keyboard`."""

    def __init__(self) -> None:
        self._binds: dict[str, Bind] = {}
        for bind in load(DEFAULT).binds:
            if bind.source.startswith("cc "):
                self._binds.setdefault(bind.target, bind)
        self._bent: dict[int, float] = {}  # semitones, of channels whose bend range is set

    def messages(self, setting: Setting) -> Iterator[mido.Message]:
        """The messages of a setting; none where MIDI cannot say it."""
        channel, address = setting.channel, setting.address
        value = find(address).default if setting.value is None else setting.value
        if address == BEND:
            yield from self._range(channel)
            self._bent[channel] = value
            yield _wheel(channel, value)
        elif address in self._binds:
            bind = self._binds[address]
            position = min(max(bind.to_unit(value), 0.0), 1.0)
            yield _control(channel, int(bind.source.split()[1]), round(127 * position))

    def slide(self, setting: Setting, length_s: float) -> Iterator[tuple[float, mido.Message]]:
        """The bends of a written slide into a note of a length, and how much later each is (s)."""
        if setting.address != ARTICULATION or setting.value not in _SLIDES:
            return
        first, last = ARTICULATIONS[int(setting.value)].fingers
        channel, whole_s = setting.channel, 1e-3 * (last.at_ms + last.glide_ms)
        pace = min(STEPS_FRACTION * length_s / whole_s, 1.0)
        yield from ((0.0, message) for message in self._range(channel))
        for point in range(SLIDE_POINTS + 1):
            share = point / SLIDE_POINTS
            at_s = pace * 1e-3 * (last.at_ms + share * last.glide_ms)
            bend = self._bent[channel] + (1.0 - share) * first.semitones
            yield (at_s if point else 0.0), _wheel(channel, bend)

    def _range(self, channel: int) -> Iterator[mido.Message]:
        """Set the bend range of a channel, if it is not set yet."""
        if channel not in self._bent:
            self._bent[channel] = 0.0
            for control, number in ((101, 0), (100, 0), (6, BEND_RANGE), (38, 0)):
                yield _control(channel, control, number)


def _wheel(channel: int, semitones: float) -> mido.Message:
    pitch = round(8191 * min(max(semitones / BEND_RANGE, -1.0), 1.0))
    return mido.Message("pitchwheel", channel=channel, pitch=pitch)


def _control(channel: int, control: int, value: int) -> mido.Message:
    return mido.Message("control_change", channel=channel, control=control, value=value)
