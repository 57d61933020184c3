"""Repeat bars and beats that a sign stands for, where the file leaves them empty.

MusicXML asks that the notes stand under the sign, too (`measure-repeat` and `beat-repeat` of its
schema); some programs write rests there.
"""

from dataclasses import replace
from fractions import Fraction
from xml.etree.ElementTree import Element

from yehu_server.scores.musicxml.marks import VALUES, number
from yehu_server.scores.written.ticks import Ticks, ticks_of
from yehu_server.scores.written.voices import RawBar, RawNote

MAX_REPEATED = 8  # bars that a sign repeats


class RepeatSigns:
    """The signs of a part that hold, by staff; "" is for all staves."""

    def __init__(self) -> None:
        self._bars: dict[str, int] = {}  # how many bars each of these repeats
        self._beats: dict[str, Ticks] = {}  # the length of the beat
        self._spans: list[tuple[str, Ticks, Ticks, Ticks]] = []  # and where, in this bar
        self._begun: dict[str, Ticks] = {}
        self._before: list[RawBar] = []  # the last bars

    def read(self, style: Element, at: Ticks, beat: Ticks) -> None:
        """Read a <measure-style> at a place of its bar, in a metre of such beats."""
        staff = style.get("number", "")[:8]
        for sign in style.iterfind("measure-repeat"):
            self._bars.pop(staff, None)
            count = int(number(sign.text, 1.0))
            if sign.get("type") == "start" and 0 < count <= MAX_REPEATED:
                self._bars[staff] = count
        for sign in style.iterfind("beat-repeat"):
            self._end(staff, at)
            if sign.get("type") == "start":
                value = VALUES.get((sign.findtext("slash-type") or "").strip())
                dots = len(sign.findall("slash-dot")[:3])
                self._begun[staff] = at
                dotted = ticks_of((value or 0) * (2 - Fraction(1, 2**dots)))
                self._beats[staff] = beat if value is None else dotted

    def _end(self, staff: str, at: Ticks) -> None:
        if staff in self._begun:
            self._spans.append((staff, self._begun.pop(staff), at, self._beats[staff]))

    def fill(self, bar: RawBar) -> int:
        """Fill a bar that is read, and return how many notes came to it."""
        before = len(bar.notes)
        for staff, count in self._bars.items():
            if count > len(self._before) or _of_staff(bar, staff):
                continue
            source = self._before[-count]
            bar.notes += [_copy(note, 0) for note in _of_staff(source, staff)]
            bar.length = max(bar.length, source.length)
        going = [*self._begun]
        for staff in going:
            self._end(staff, bar.length)
        for staff, begin, end, beat in self._spans:
            self._fill_beats(bar, staff, begin, end, beat)
        self._spans = []
        self._begun = dict.fromkeys(going, 0)
        self._before = [*self._before[1 - MAX_REPEATED :], bar]
        return len(bar.notes) - before

    def _fill_beats(self, bar: RawBar, staff: str, begin: Ticks, end: Ticks, beat: Ticks) -> None:
        own = _of_staff(bar, staff)
        last = self._before[-1] if self._before else bar
        beats = int(max(end - begin, 0) // beat)
        source = [n for n in own if begin - beat <= n.at < begin]
        moved = beat
        if begin < beat:  # the beat before is in the bar before
            source = [n for n in _of_staff(last, staff) if n.at >= last.length - beat + begin]
            moved = beat - last.length
        if any(n.at < end and n.at + n.length > begin for n in own):
            return
        for count in range(beats):
            bar.notes += [_copy(note, moved + count * beat) for note in source]


def _of_staff(bar: RawBar, staff: str) -> list[RawNote]:
    return [note for note in bar.notes if staff in ("", note.voice[0])]


def _copy(note: RawNote, later: Ticks) -> RawNote:
    return replace(note, at=note.at + later, marks=[*note.marks], ends=[*note.ends])
