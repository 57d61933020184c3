"""Read the music of one voice of ABC into bars."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache

from yehu_server.errors import ScoreError, one_line
from yehu_server.scores.abc import fields, keywords
from yehu_server.scores.abc.keys import key_of, properties_of
from yehu_server.scores.abc.tokens import TOKENS, NoteToken, multiple_of, notes_in, token_of
from yehu_server.scores.score import nearest_key
from yehu_server.scores.written.layout import LETTERS, SEMITONES
from yehu_server.scores.written.notated import DYNAMICS, FORCED, MAX_NOTES, Mark
from yehu_server.scores.written.ornaments import HALF, WAYS, WHOLE, Around, around_letter
from yehu_server.scores.written.repeats import MAX_BARS, MAX_TIMES, BarLines
from yehu_server.scores.written.swing import Swing, begin_of_beats, swing_notes
from yehu_server.scores.written.ticks import TICKS, Ticks, bounded, scaled, ticks_of
from yehu_server.scores.written.voices import RawBar, RawDirection, RawNote
from yehu_server.scores.written.words import meaning_of

MIDDLE_C = 60.0
LONGEST = 64  # quarters of a note
MAX_BARS_REST = 1000
ENDS_OVERLAY, TIED = {"bar", "ending"}, frozenset({"start"})
ONE, GRACE = Fraction(1), TICKS // 4
VOICE = "1", "1"
MARKS = {name: Mark(*found) for name, found in keywords.DECORATIONS.items()}
WHOLE_AND_HALF = WHOLE, HALF


class VoiceReader:
    """Reads the music of a voice, line by line, into `bars`.

    `shortcuts` are letters that stand for decorations; a field of the tune may change them.
    """

    def __init__(
        self, unknown: Counter[str], warnings: Counter[str], shortcuts: Mapping[str, str]
    ) -> None:
        self.bars: list[RawBar] = []
        self.unit = Fraction(1, 2)
        self._unknown, self._warnings, self._shortcuts = unknown, warnings, shortcuts
        self._alters = dict.fromkeys(LETTERS, 0.0)
        self._fifths = 0
        self._properties = {"clef": 0, "octave": 0, "transpose": 0}
        self._middle_c = MIDDLE_C  # as it sounds
        self._spread = keywords.SPREADS[0]
        self._ratio = (3, 1)  # of broken rhythm
        self.is_hornpipe = False
        self._before: Ticks = 0  # the length of the last bar
        self._swing_unit: Fraction | None = keywords.SWUNG["C"]
        self._metre: Ticks | None = 4 * TICKS
        self._odd_times = 2  # of tuplets of 5, 7 and 9: 3 in compound time
        self._place = ("C", 0, 0.0)  # of the last note: letter, octave, accidental
        self._in_bar: dict[str | tuple[str, int], float] = {}  # accidentals, by what they reach
        self._tied: dict[tuple[str, int], float] = {}
        self._bar = RawBar("1", BarLines())
        self._at: Ticks = 0
        self._ending: frozenset[int] = frozenset()
        self._marks: list[Mark] = []
        self._slurs: list[str] = []
        self._starts: list[tuple[str, str, str]] = []  # slurs that begin with the next note
        self._slur_count = 0
        self._last: list[RawNote] = []
        self._last_begin: Ticks = 0
        self._next_factor = ONE
        self._lengths: dict[str, Ticks] = {}  # by how they are written
        self._tuplet: list[Fraction] = []  # factors of the next notes
        self._count = 0
        self._in_overlay = False
        self._ways: dict[str, Callable[..., None]] = {
            "note": self._note, "bar": self._bar_line, "ending": self._begin_ending,
            "chord": self._chord, "rest": self._rest, "bars": self._rest_of_bars,
            "tuplet": self._begin_tuplet, "slur": self._slur, "tie": self._tie,
            "broken": self._break, "grace": self._graces, "text": self._text, "sign": self._sign,
            "short": self._short, "over": self._overlay, "other": self._other,
        }  # fmt: skip

    def label(self) -> int:
        """The number of the bar that comes next, once what is open has ended."""
        self._end_bar()
        self._ending = frozenset()
        return len(self.bars)

    def set_properties(self, found: Mapping[str, int]) -> None:
        """Take what a field says of where notes sound; it holds from here on."""
        self._properties |= found
        octaves = self._properties["clef"] + self._properties["octave"]
        self._middle_c = MIDDLE_C + 12.0 * octaves + self._properties["transpose"]
        fifths = self._fifths + 7 * self._properties["transpose"]
        self._bar.fifths = nearest_key(fifths) if self._properties["transpose"] else fifths

    def field(self, letter: str, value: str) -> None:
        """Take a field that holds from here on."""
        if letter == "K":
            found, _, words = properties_of(value, self._unknown)
            if (words or not found) and (key := key_of(words, self._unknown)) is not None:
                self._fifths, self._alters = key
            self.set_properties(found)
        elif letter == "M":
            metre = fields.metre_of(value)
            self._metre = self._bar.metre = None if metre is None else ticks_of(metre)
            self._odd_times = 3 if value.strip() in ("6/8", "9/8", "12/8") else 2
            self._swing_unit = keywords.SWUNG.get(value.strip())
        elif letter == "L":
            self.unit, self._lengths = fields.length_of(value) or self.unit, {}
        elif letter == "R":
            self.is_hornpipe = value.lower().startswith("hornpipe")
            self._ratio = (2, 1) if self.is_hornpipe else (3, 1)
        elif letter == "propagate-accidentals":
            self._spread = value if value in keywords.SPREADS else self._spread
        elif letter == "ratio" and keywords.VALUES["ratio"].fullmatch(value):
            long, short = value.split()
            self._ratio = int(long), int(short)
        elif letter == "Q":
            if (tempo := fields.tempo_of(value, self.unit)) is not None:
                self._direct("tempo", "figures", tempo)
            elif value.strip():
                self._words(value.strip(' "'))

    def _direct(self, kind: str, name: str = "", value: float | None = None) -> None:
        self._bar.directions.append(RawDirection(self._at, kind, name, value))

    def line(self, text: str, inline: Callable[[str, str], VoiceReader]) -> None:
        """Read a line of music; `inline` takes fields within it and returns who reads on."""
        reader = self
        for kind, values in map(token_of, TOKENS.findall(text)):
            if kind == "field":
                reader = inline(*values)
            elif kind and (kind in ENDS_OVERLAY or not reader._in_overlay):  # noqa: SLF001
                reader._ways[kind](*values)  # noqa: SLF001 - of the same class

    def _overlay(self) -> None:
        self._warnings["second voices over a bar (&) are not played"] += 1
        self._in_overlay = True

    def _other(self, sign: str) -> None:
        self._unknown[one_line(sign)] += 1

    # -- notes -------------------------------------------------------------------------------

    def _pitch(self, sign: str, name: str, octave: int) -> float:
        """The pitch of a note, whose accidental holds from here on."""
        reached = self._reached(name, octave)
        if sign:
            alter = keywords.ALTERS[sign]
            if self._spread != "not":
                self._in_bar[reached] = alter
        elif self._tied and (name, octave) in self._tied and reached not in self._in_bar:
            alter = self._tied[name, octave]
        else:
            alter = self._in_bar.get(reached, self._alters[name])
        self._place = name, octave, alter
        pitch = self._middle_c + SEMITONES[name] + alter + 12.0 * octave
        return min(max(pitch, 0.0), 127.0)

    def _around(self) -> Around:
        """The intervals to the neighbours of the last note, for its ornaments."""
        for mark in self._marks:
            if mark.name in WAYS:
                return around_letter(*self._place, self._alter_of)
        return WHOLE_AND_HALF

    def _reached(self, name: str, octave: int) -> str | tuple[str, int]:
        """What an accidental reaches in its bar."""
        return name if self._spread == "pitch" else (name, octave)

    def _alter_of(self, name: str, octave: int) -> float:
        return self._in_bar.get(self._reached(name, octave), self._alters[name])

    def _length(self, text: str) -> Ticks:
        length = self._lengths.get(text)
        if length is None:
            length = self._lengths[text] = ticks_of(multiple_of(text) * self.unit)
        return length

    def _note(self, sign: str, name: str, octave: int, length: str, tie: str) -> None:
        pitch = self._pitch(sign, name, octave)
        self._add(self._length(length), pitch, self._around(), tie)

    def _rest(self, length: str) -> None:
        self._add(self._length(length), None)

    def _add(
        self, length: Ticks, pitch: float | None, around: Around = WHOLE_AND_HALF, tie: str = ""
    ) -> None:
        """Put a note, or a rest, where the music is."""
        self._count_note()
        if self._tuplet:
            length = scaled(length, self._tuplet.pop())
        if self._next_factor is not ONE:
            length, self._next_factor = scaled(length, self._next_factor), ONE
        length = min(length, LONGEST * TICKS)
        at = self._at
        self._last, self._last_begin, self._at = [], at, bounded(at + length)
        if pitch is None:
            return
        note = RawNote(at, length, pitch, VOICE, self._marks, around, ends=self._starts)
        self._marks, self._starts, self._tied = [], [], {}
        self._last = [note]
        if length:
            self._bar.notes.append(note)
        if tie:
            self._tie()

    def _count_note(self) -> None:
        self._count += 1
        if self._count > MAX_NOTES:
            raise ScoreError(f"has more than {MAX_NOTES} notes")

    def _chord(self, notes: str, factor: str, tie: str) -> None:
        if not (inner := self._inner(notes)):
            return
        pitched = []
        for sign, name, octave, text, _ in inner:
            pitch = self._pitch(sign, name, octave)
            pitched.append((pitch, self._length(text), self._around()))
        pitch, _, around = max(pitched)
        if len(pitched) > 1:
            self._warnings["lower notes of chords are not played"] += len(pitched) - 1
        length = scaled(pitched[0][1], multiple_of(factor))
        self._add(length, pitch, around, tie or next((each[4] for each in inner if each[4]), ""))

    def _inner(self, text: str) -> Sequence[NoteToken]:
        """The notes in brackets; what else is in them is told."""
        found, other = notes_in(text)
        if other or not found:
            self._unknown[one_line(f"{other[:40]} in {text[0]}{text[-1]}".strip())] += 1
        return found

    def _graces(self, text: str) -> None:
        for sign, name, octave, *_ in self._inner(text):
            self._count_note()
            pitch = self._pitch(sign, name, octave)
            self._bar.notes.append(RawNote(self._at, GRACE, pitch, VOICE, [], is_grace=True))

    def _break(self, signs: str) -> None:
        """Broken rhythm: one of two notes is longer by what the other loses."""
        if self._at <= self._last_begin:  # nothing before it in this bar
            return
        short = Fraction(1, 2 ** min(len(signs), 4))
        if len(signs) == 1:
            short = Fraction(2 * self._ratio[1], sum(self._ratio))
        first, self._next_factor = (2 - short, short) if signs[0] == ">" else (short, 2 - short)
        length = scaled(self._at - self._last_begin, first)
        for note in self._last:
            note.length = length
        self._at = self._last_begin + length

    def _begin_tuplet(self, count: int, ratio: str) -> None:
        given = [*(int(each or 0) for each in ratio.split(":")[1:]), 0, 0]
        times = given[0] or keywords.TIMES.get(count, self._odd_times)
        notes = given[1] or count
        if count and times and notes < 64:
            self._tuplet = [_factor(times, count)] * notes

    def _tie(self) -> None:
        for note in self._last:
            note.ties = TIED
            self._tied[self._place[:2]] = self._place[2]

    def _slur(self, sign: str) -> None:
        if sign == "(":
            self._slur_count += 1
            self._slurs.append(str(self._slur_count))
            self._starts.append(("slur", "start", self._slurs[-1]))
        elif self._slurs and self._last:
            self._last[-1].ends.append(("slur", "stop", self._slurs.pop()))

    # -- marks -------------------------------------------------------------------------------

    def _short(self, letter: str) -> None:
        self._sign(self._shortcuts.get(letter, letter))

    def _sign(self, name: str) -> None:
        if name in keywords.DECORATIONS:
            self._marks.append(MARKS[name])
        elif name in DYNAMICS or name in FORCED:
            self._direct("sign", name)
        elif name in keywords.WEDGES:
            self._direct("wedge", keywords.WEDGES[name])
        elif name.lower() in keywords.JUMPS:
            self._bar.lines.jumps.add(keywords.JUMPS[name.lower()])
        elif name not in keywords.IGNORED:
            self._unknown[one_line(name[:40])] += 1

    def _text(self, text: str) -> None:
        if text[:1] in ("^", "_", "<", ">", "@"):
            self._words(text[1:])
        elif (meaning := meaning_of(text)) and meaning.kind == "jump":
            self._bar.lines.jumps.add(meaning.name)
        else:
            self._warnings["chord symbols are not played"] += 1

    def _words(self, text: str) -> None:
        meaning = meaning_of(text)
        if meaning is None:
            self._unknown[f'words "{one_line(text[:40])}"'] += 1
        elif meaning.kind == "jump":
            self._bar.lines.jumps.add(meaning.name)
        else:
            name = "words" if meaning.kind == "tempo" else meaning.name
            self._direct(meaning.kind, name, meaning.value)

    # -- bars --------------------------------------------------------------------------------

    def _bar_line(self, sign: str, number: str) -> None:
        sign = ":|:" if sign == "::" else sign
        before = len(sign) - len(sign.lstrip(":"))
        after = len(sign) - len(sign.rstrip(":"))
        self._end_bar(min(before + 1, MAX_TIMES) if before else 0)
        if before or after or len(sign) > 1:
            self._ending = self._bar.lines.endings = frozenset()
        if after:
            self._bar.lines.forward = True
        elif not before and len(sign) > 1:  # from which a repeat without a beginning goes back
            self._bar.lines.double = True
        if number:
            self._begin_ending(number)

    def _rest_of_bars(self, count: str) -> None:
        self._end_bar()
        for _ in range(min(int(count[:5] or 1), MAX_BARS_REST)):
            self._at = self._metre or 4 * TICKS
            self._end_bar()

    def _end_bar(self, times: int = 0) -> None:
        self._in_overlay = False
        bar = self._bar
        if self._at > 0 or bar.notes:
            bar.length = self._at
            if self.is_hornpipe and self._swing_unit and self._metre:
                begin = begin_of_beats(bar.length, self._before, self._metre)
                swing = Swing(ticks_of(self._swing_unit), *self._ratio, True)
                swing_notes(bar.notes, swing, begin)
            self._before = bar.length
            bar.number = str(len(self.bars) + 1)
            self.bars.append(bar)
            if len(self.bars) > MAX_BARS:
                raise ScoreError(f"has more than {MAX_BARS} bars")
            self._bar = RawBar("", BarLines(endings=self._ending))
            self._at = self._last_begin = 0
            self._in_bar = {}
        if times and self.bars:
            self.bars[-1].lines.times = times

    def _begin_ending(self, text: str) -> None:
        if self._at > 0:  # an ending that begins within a bar
            self._end_bar()
        numbers: set[int] = set()
        for each in text.split(","):
            first, _, last = each.partition("-")
            if first.isdecimal():
                end = int(last[:3]) if last.isdecimal() else int(first[:3])
                numbers |= {*range(int(first[:3]), min(end, MAX_TIMES) + 1)}
        self._ending = frozenset(numbers) or frozenset({1})
        self._bar.lines.endings, self._bar.lines.opens = self._ending, True

    def end(self) -> None:
        """End the last bar."""
        self._end_bar()
        codas = [bar for bar in self.bars if "coda" in bar.lines.jumps]
        if len(codas) > 1 and not any("tocoda" in bar.lines.jumps for bar in self.bars):
            codas[0].lines.jumps ^= {"coda", "tocoda"}


@lru_cache
def _factor(times: int, count: int) -> Fraction:
    return Fraction(times, count)
