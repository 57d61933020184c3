"""The picture of a written part as it will be bowed, in lines of jianpu: a player can follow it.

Over each figure stand the bow's direction, marks and dynamics; under it fingers and the string. A
brace joins the notes of one stroke; of a stroke that comes to the bow's end both directions stand
at its beginning.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.fingering import OPEN_WITHIN
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import ParameterError
from yehu_server.playing.pitch_and_level import note_name
from yehu_server.playing.stringing import notes_of as range_of
from yehu_server.plot import png
from yehu_server.plot.strokes import Stroke, strokes_of
from yehu_server.scores.jianpu.figures import FIGURE_OF, figure_of, notatable_lengths
from yehu_server.scores.score import nearest_key
from yehu_server.scores.written import layout
from yehu_server.scores.written.in_range import moved_part
from yehu_server.scores.written.layout import PageBar, Piece
from yehu_server.scores.written.mark_settings import DOWN, UP
from yehu_server.scores.written.notated import DYNAMICS, FORCED, HAIRPINS, Note, Part, Span, Written
from yehu_server.scores.written.words import WRITTEN_CHANGES, words_of_sign

BARS_A_LINE, MAX_LINES = 4, 60
LINE_INCHES, WIDTH = 1.55, 12.0
INK, BOW, STRING, LOUD = "#1c2733", "#b5402a", "#3b6ea8", "#5a4a6f"
SPAN_WORDS = {**WRITTEN_CHANGES, "glissando": "gliss.", "portamento": "port."}
BOWS = {DOWN: "\N{SQUARE CAP}", UP: "\N{LOGICAL OR}"}
MARK_SIGNS = {
    "staccato": "·", "staccatissimo": "▾", "tenuto": "\N{EN DASH}", "accent": ">", "marcato": "^",
    "trill": "tr", "mordent": "mord.", "inverted-mordent": "inv. mord.", "turn": "turn",
    "inverted-turn": "inv. turn", "caesura": "//", "soft-accent": "<>", "stress": "stress",
    "unstress": "unstress",
    "tremolo": "///", "fermata": "fermata", "pizzicato": "+", "snap-pizzicato": "+",
    "harmonic": "o", "vibrato": "~", "breath": ",", "slide-in-up": "↗", "slide-in-down": "↘",
    "slide-out-up": "↗", "slide-out-down": "↘", "spiccato": "▾", "portato": "\N{EN DASH}·",
}  # fmt: skip


def string_of(note: Note, within: NoteRange = YEHU) -> str:
    """How a note is reached where it does not follow another on the same string.

    The name of a string, such as F or C, and "open".
    """
    first, second = within.open_notes
    inner, outer = (note_name(open_note)[:-1] for open_note in within.open_notes)
    if note.marked("inner-string"):
        return inner
    if abs(note.pitch - second) < OPEN_WITHIN and not note.marked("finger"):
        return f"{outer} open"
    if note.pitch < first + OPEN_WITHIN:
        return f"{inner} open"
    return outer if note.pitch > second or note.marked("outer-string") else inner


def write_bowed_score(
    written: Written,
    number: int,
    target: Path,
    quantities: Quantities | None = None,
    *,
    overwrite: bool = False,
) -> None:
    """Draw a part, counted from 0, moved into range as it is played, and write it to a PNG file.

    The strokes are those with which the instrument of these `quantities` plays it. Raises
    ParameterError where it has no note; OutputError where it cannot be written.
    """
    quantities = quantities or Quantities()
    within = range_of(quantities)
    part, octaves = moved_part(written.parts[number], within)
    if not part.notes:
        raise ParameterError("the score has no note to draw")
    bars = layout.page_bars(written)
    rows = [range(at, min(at + BARS_A_LINE, len(bars))) for at in range(0, len(bars), BARS_A_LINE)]
    rows = [row for row in rows if bars[row.start].begin < part.notes[-1].end][:MAX_LINES]
    drawn = tuple(note for note in part.notes if note.beat < bars[rows[-1].stop - 1].end)
    part = replace(part, notes=drawn)
    parts = (*written.parts[:number], part, *written.parts[number + 1 :])
    strokes = strokes_of(replace(written, parts=parts), number, quantities)
    page = _Page(written, part, bars, within, strokes)

    def fill(figure: Any) -> None:
        panels = figure.subplots(len(rows), 1, squeeze=False)[:, 0]
        for axes, row in zip(panels, rows, strict=True):
            page.draw(axes, row)
        heading = [written.title, written.names[number], octaves.summary]
        title = png.plain(" - ".join(filter(None, heading)))
        panels[0].set_title(f"{title}\n{page.head}", loc="left", fontsize=12, color=INK)

    size = (WIDTH, 0.9 + LINE_INCHES * len(rows))
    png.write_picture(target, size, fill, overwrite=overwrite)


class _Page:
    def __init__(
        self,
        written: Written,
        part: Part,
        bars: Sequence[PageBar],
        within: NoteRange,
        strokes: Sequence[Stroke],
    ) -> None:
        self._within = within
        self._part, self._bars, self._written = part, bars, written
        self._pieces = layout.pieces_of(part, bars)
        self._strokes = strokes
        self._begins = [note.beat for note in part.notes]
        keys = [key for key in written.keys if key.beat <= self._begins[0]]
        self._key = keys[-1] if keys else None
        self._fifths = 0 if self._key is None else nearest_key(self._key.fifths)

    @property
    def head(self) -> str:
        """Key, metre and tempo of the beginning."""
        do = "C" if self._key is None else self._key.do
        tempo = self._written.tempi[0].quarters_per_minute if self._written.tempi else 100.0
        count, unit = layout.signature(self._bars[0].quarters) or (4, 4)
        bows = f"{BOWS[DOWN]} down-bow   {BOWS[UP]} up-bow"
        return f"1={do}   {count}/{unit}   \N{QUARTER NOTE}={tempo:g}   {bows}"

    def draw(self, axes: Any, row: range) -> None:
        """Draw a line of bars."""
        axes.set_axis_off()
        axes.set(xlim=(-0.02, BARS_A_LINE + 0.02), ylim=(-2.6, 3.4))
        places: dict[Fraction, float] = {}  # of beats, across
        for column, at in enumerate(row):
            self._bar(axes, column, at, places)
        begin, end = self._bars[row[0]].begin, self._bars[row[-1]].end
        places[end] = float(len(row))
        self._braces(axes, begin, end, places)
        self._words(axes, begin, end, places)
        for span in self._part.spans:
            if span.name in HAIRPINS and span.begin < end and span.end > begin:
                self._hairpin(axes, span, places)

    def _bar(self, axes: Any, column: int, at: int, places: dict[Fraction, float]) -> None:
        bar = self._bars[at]
        axes.text(column + 0.01, 2.9, bar.number, fontsize=7, color="0.5")
        axes.plot([column + 1.0] * 2, [-0.7, 1.0], color=INK, lw=0.9)
        cuts = [cut for each in self._pieces[at] for cut in layout.split(each, _lengths(each))]
        width = sum(map(_width, cuts))
        x = column + 0.06
        for cut in cuts:
            step = 0.9 * _width(cut) / width
            places[cut.begin] = x
            self._figure(axes, x, step, cut)
            x += step

    def _figure(self, axes: Any, x: float, step: float, cut: Piece) -> None:
        text, octave = "0", 0
        if cut.note is not None:
            text, octave = figure_of(cut.note.pitch, self._fifths)
        if cut.note is not None and not cut.is_first:
            text = f"({text})"
        axes.text(x, 0.0, text, fontsize=15, color=INK, ha="center", va="center")
        factor = cut.factor
        length = cut.length / factor
        beam, dots = FIGURE_OF.get(length, ("", ""))
        lines = " qsdh".index(beam) if beam else 0
        for line in range(lines):
            y = -0.55 - 0.16 * line
            axes.plot([x - 0.02, x + 0.02], [y, y], color=INK, lw=1.2)
        for dot in range(abs(octave)):
            y = 0.62 + 0.2 * dot if octave > 0 else -0.62 - 0.16 * lines - 0.2 * dot
            axes.plot([x], [y], "o", color=INK, ms=2.2)
        if dots:
            axes.text(x + 0.018, -0.05, "." * len(dots), fontsize=13, color=INK, va="center")
        if factor != 1:
            axes.text(x + 0.018, 0.55, str(factor.denominator), fontsize=6, color=INK)
        dashes = int(length) - 1 if length >= 2 and cut.note is not None else 0
        for dash in range(dashes):
            place = x + step * (dash + 1) / (dashes + 1)
            axes.text(place, 0.0, "-", fontsize=15, color=INK, ha="center", va="center")
        if cut.note is not None and cut.is_first:
            self._marks(axes, x, cut.note)

    def _marks(self, axes: Any, x: float, note: Note) -> None:
        at = bisect_right(self._begins, note.beat) - 1
        signs = " ".join(MARK_SIGNS[mark.name] for mark in note.marks if mark.name in MARK_SIGNS)
        axes.text(x, 1.25, signs, fontsize=9, color=INK, ha="center", va="center")
        if note.before:
            axes.text(x - 0.012, 0.75, f"{len(note.before)}", fontsize=6, color=INK, ha="right")
        stroke = next((each for each in self._strokes if each.first == at), None)
        if stroke is not None:
            sign = "".join(BOWS.get(each, "") for each in (stroke.direction, *stroke.turns))
            axes.text(x, 2.0, sign, fontsize=11, color=BOW, ha="center", va="center")
        own = string_of(note, self._within)
        before = string_of(self._part.notes[at - 1], self._within) if at else ""
        finger = note.marked("finger")
        labels = [f"{finger.value:g}" if finger is not None and finger.value else ""]
        labels.append(own if own != before else "")
        text = " ".join(filter(None, labels))
        axes.text(x, -1.2, text, fontsize=7, color=STRING, ha="center", va="center")
        name = layout.name_of(note.pitch, self._written.fifths_at(note.beat))
        axes.text(x, -2.55, name, fontsize=5.5, color="0.6", ha="center")

    def _braces(
        self, axes: Any, begin: Fraction, end: Fraction, places: dict[Fraction, float]
    ) -> None:
        """Join the notes of strokes; a brace that goes on in the next line is open."""
        for stroke in self._strokes:
            first, last = self._begins[stroke.first], self._begins[stroke.last]
            if first == last or last < begin or first >= end:
                continue
            xs, ys = [_at(places, first)] * 2, [1.5, 1.65]
            if first < begin:
                xs, ys = [-0.02], [1.65]
            xs, ys = [*xs, _at(places, last)], [*ys, 1.65]
            if last < end:
                xs, ys = [*xs, xs[-1]], [*ys, 1.5]
            axes.plot(xs, ys, color=BOW, lw=1)

    def _words(
        self, axes: Any, begin: Fraction, end: Fraction, places: dict[Fraction, float]
    ) -> None:
        """Write dynamics, other signs, slides and changes of tempo under the line."""
        words: dict[Fraction, list[str]] = {}
        for span in self._part.spans:
            if span.name in SPAN_WORDS and begin <= span.begin < end:
                words.setdefault(span.begin, []).append(SPAN_WORDS[span.name])
        for sign in self._part.signs:
            if begin <= sign.beat < end:
                is_loud = sign.name in DYNAMICS or sign.name in FORCED
                text = words_of_sign(sign.name, sign.value) or sign.name
                words.setdefault(sign.beat, []).append(text)
                if is_loud:
                    words[sign.beat].insert(0, words[sign.beat].pop())
        for beat, texts in words.items():
            x, text = _at(places, beat) - 0.02, ", ".join(texts)
            axes.text(x, -1.85, text, fontsize=8, color=LOUD, style="italic", va="center")

    def _hairpin(self, axes: Any, span: Span, places: dict[Fraction, float]) -> None:
        left, right = _at(places, span.begin), _at(places, span.end)
        room = right - left
        left, right = left + min(0.08, 0.4 * room), right - min(0.04, 0.2 * room)  # for dynamics
        narrow, wide = (left, right) if span.name == "crescendo" else (right, left)
        for y in (-2.0, -1.7):
            axes.plot([narrow, wide], [-1.85, y], color=LOUD, lw=0.9)


def _lengths(piece: Piece) -> list[Fraction]:
    return [piece.factor * each for each in notatable_lengths(piece.length / piece.factor, piece)]


def _width(piece: Piece) -> float:
    return 0.6 + 0.7 * float(piece.length)


def _at(places: dict[Fraction, float], beat: Fraction) -> float:
    """Where a beat is across the line, between those of which the places are known."""
    beats = sorted(places)
    return float(np.interp(float(beat), [float(at) for at in beats], [places[at] for at in beats]))
