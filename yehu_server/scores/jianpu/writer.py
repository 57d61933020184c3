"""Write a score, repeats unfolded, as a jianpu text that `reader` reads as the same score."""

from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Iterator, Sequence
from fractions import Fraction

from yehu_server.scores.jianpu import figures
from yehu_server.scores.jianpu.mark_words import COMMANDS, FINGERING
from yehu_server.scores.score import DO_BY_FIFTHS, nearest_key
from yehu_server.scores.written import layout, notated
from yehu_server.scores.written.layout import PageBar, Piece
from yehu_server.scores.written.notated import Grace, Mark, Part, Span, Tempo, Written
from yehu_server.scores.written.ornaments import around_in, filled
from yehu_server.scores.written.words import WRITTEN_CHANGES, words_of_sign

BARS_A_LINE = 4
GRACES = {Fraction(1, 2): "q", Fraction(1, 4): "s", Fraction(1, 8): "d", Fraction(1, 16): "h"}
HAIRPINS = {"crescendo": "\\<", "diminuendo": "\\>"}
TEMPO_UNITS = (("4", Fraction(1)), ("8", Fraction(1, 2)), ("4.", Fraction(3, 2)),
               ("16", Fraction(1, 4)), ("2", Fraction(2)))  # fmt: skip


def _words() -> dict[Mark, str]:
    """Words of marks, the first of those that are read alike."""
    found: dict[Mark, str] = {}
    for words, prefix in ((COMMANDS, "\\"), (FINGERING, "Fr=")):
        for word, action in words.items():
            if action.kind == "mark":
                mark = Mark(action.name, action.value)
                bare = "" if word in ("up", "down", "tilde", "harmonic") else prefix
                found.setdefault(mark, f"{bare}{word}")
    return found


MARK_WORDS = _words()
SIGN_WORDS = {name: f"\\{name}" for name in (*notated.DYNAMICS, *notated.FORCED)}


def jianpu_of(written: Written) -> tuple[str, dict[str, int]]:
    """Return a score as a jianpu text, and what that cannot say: names, with counts."""
    lost: Counter[str] = Counter()
    written, moved = layout.rounded(written, figures.FINEST)
    lost["beats finer than 1/16 of a quarter"] += moved
    bars = layout.page_bars(written)
    texts = []
    for number, part in enumerate(written.parts):
        lines = [f"title={written.title}"] if written.title and number == 0 else []
        if part.name:
            lines.append(f"instrument={part.name}")
        tempi = written.tempi if number == 0 else ()
        lines += _PartWriter(written, part, bars, tempi, lost).lines()
        texts.append("\n".join(lines))
    return "\n\nNextPart\n".join(texts) + "\n", dict(+lost)


class _PartWriter:
    def __init__(
        self,
        written: Written,
        part: Part,
        bars: Sequence[PageBar],
        tempi: Sequence[Tempo],
        lost: Counter[str],
    ) -> None:
        self._part, self._bars, self._lost = part, bars, lost
        self._keys = list(written.keys)
        self._fifths = 0
        self._tempi = list(tempi)
        self._quarters: Fraction | None = None
        self._begins = [note.beat for note in part.notes]
        loud = [sign.beat for sign in part.signs if sign.name in SIGN_WORDS]
        self._cuts = sorted(loud + [each.begin for each in part.spans if each.name in HAIRPINS])
        self._nested = set(figures.nested_slurs(part.spans, set(self._begins)))
        self._spans = [span for span in part.spans if self._can_say(span, written)]
        self._after = self._words_after()[::-1]

    def lines(self) -> list[str]:
        """The music, some bars a line."""
        pieces = layout.pieces_of(self._part, self._bars)
        bars = [" ".join(words) for words in map(self._bar, self._bars, pieces)]
        rows = (bars[at : at + BARS_A_LINE] for at in range(0, len(bars), BARS_A_LINE))
        self._lost["signs after the last note"] += len(self._tempi) + len(self._after)
        return [" ".join(f"{bar} |" for bar in row) for row in rows]

    # -- what stands beside notes ------------------------------------------------------------

    def _can_say(self, span: Span, written: Written) -> bool:
        if span.name in WRITTEN_CHANGES:
            is_read = layout.ends_as_read(span, self._part, written, written.end)
            self._lost[f"how far a {span.name} goes"] += not is_read
            return True
        if span.name in HAIRPINS:
            at = bisect_right(self._cuts, span.begin)
            cut = at < len(self._cuts) and self._cuts[at] < span.end
            self._lost[f"how far a {span.name} goes"] += cut
            return True
        if span.name == "slur" and span in self._nested:
            return True
        if span.name == "glissando" and self._goes_on(span):
            return True
        self._lost[span.name] += 1
        return False

    def _goes_on(self, slide: Span) -> bool:
        """Whether a slide is from one note to the next."""
        at = bisect_left(self._begins, slide.begin)
        return self._begins[at : at + 2] == [slide.begin, slide.end]

    def _words_after(self) -> list[tuple[Fraction, int, str]]:
        found: list[tuple[Fraction, int, str]] = []
        for span in self._spans:
            if span.name == "slur":
                found.append((span.begin, 3, "("))
                found.append((span.end, 0, ")"))
            elif span.name == "glissando":
                found.append((span.begin, 3, "\\glissando"))
            elif span.name in HAIRPINS:
                found.append((span.begin, 2, HAIRPINS[span.name]))
                found.append((span.end, 0, "\\!"))
            else:
                found.append((span.begin, 2, f'^"{WRITTEN_CHANGES[span.name]}"'))
        for sign in self._part.signs:
            word, text = SIGN_WORDS.get(sign.name), words_of_sign(sign.name, sign.value)
            if word is None and text is not None:
                word = f'^"{text}"'
            rest = MARK_WORDS.get(Mark(sign.name, sign.value))
            if word is not None:
                found.append((sign.beat, 1, word))
            elif rest and sign.name in notated.SIGNS and not self._part.sounds_at(sign.beat):
                found.append((sign.beat, 1, rest))
            else:
                self._lost[sign.name] += 1
        # Of slurs that begin or end at one note the inner ones are nearer to it.
        return sorted(found, key=lambda each: each[:2])

    def _take_after(self, end: Fraction) -> Iterator[str]:
        """The words that belong to what ends at a beat."""
        while self._after and self._after[-1][0] < end:
            yield self._after.pop()[2]

    # -- bars --------------------------------------------------------------------------------

    def _bar(self, bar: PageBar, pieces: Sequence[Piece]) -> Iterator[str]:
        yield from self._key(bar)
        yield from self._metre(bar)
        left = list(pieces)
        while left:
            if layout.tuplet_of(left[0].end.denominator) == 1:
                yield from self._plain(left.pop(0), Fraction(1))
            else:
                yield from self._tuplet(left)

    def _key(self, bar: PageBar) -> Iterator[str]:
        changed = False
        while self._keys and self._keys[0].beat <= bar.begin:
            self._fifths = nearest_key(self._keys.pop(0).fifths)
            changed = True
        if changed:
            yield f"1={DO_BY_FIFTHS[self._fifths]}"

    def _metre(self, bar: PageBar) -> Iterator[str]:
        """The metre where it changes; that of a bar that is short or long is its own."""
        pickup, quarters = "", bar.length
        is_pickup = bar is self._bars[0] and bar.length < bar.quarters
        if is_pickup and bar.length in figures.PICKUPS and layout.signature(bar.quarters):
            pickup, quarters = f",{figures.PICKUPS[bar.length]}", bar.quarters
        metre = layout.signature(quarters)
        if metre is not None and quarters != self._quarters:
            self._quarters = quarters
            yield f"{metre[0]}/{metre[1]}{pickup}"

    def _tuplet(self, left: list[Piece]) -> Iterator[str]:
        """Take pieces until one ends on a beat of no tuplet, and write them in brackets."""
        group = []
        while left:
            group.append(left.pop(0))
            if layout.tuplet_of(group[-1].end.denominator) == 1:
                break
        counts = {layout.tuplet_of(piece.end.denominator) for piece in group} - {1}
        count = counts.pop() if len(counts) == 1 else None
        factor = Fraction(layout.TUPLETS[count], count) if count in layout.TUPLETS else None
        if factor is None or any(16 % (each.length / factor).denominator for each in group):
            self._lost["tuplets within tuplets"] += 1
            group, factor = figures.straightened(group), Fraction(1)
        if factor != 1:
            yield f"{count}["
        for piece in group:
            yield from self._plain(piece, factor)
        if factor != 1:
            yield "]"

    def _plain(self, piece: Piece, factor: Fraction) -> Iterator[str]:
        """A note or rest, with what stands at it."""
        yield from self._tempo(piece.begin)
        lengths = figures.notatable_lengths(piece.length / factor, piece)
        for cut in layout.split(piece, [factor * each for each in lengths]):
            yield from self._figured(cut, factor)

    def _figured(self, piece: Piece, factor: Fraction) -> Iterator[str]:
        length = piece.length / factor
        note = piece.note
        if note is not None and piece.is_first:
            for grace in note.before:
                yield f"g[{self._grace(grace)}]"
        beam, dots = figures.FIGURE_OF.get(length, ("", ""))
        figure = "0" if note is None else self._figure(note.pitch)
        is_tremolo = note is not None and piece.is_first and bool(note.marked("tremolo"))
        yield f"{beam}{figure}{dots}{'///' if is_tremolo else ''}"
        if note is not None:
            self._lost["pitches that move within a note"] += piece.is_first and bool(note.contour)
            yield from self._marks(note.pitch, note.marks_at(piece.begin))
        end = piece.begin + min(piece.length, factor)
        yield from self._take_after(piece.end if length < 2 else end)
        for _ in range(int(length) - 1 if length >= 2 else 0):
            end += factor
            yield "-"
            yield from self._take_after(end)
        if note is not None and not piece.is_last:
            yield "~"
        elif note is not None:
            for grace in note.after:
                yield f"[{self._grace(grace)}]g"

    def _tempo(self, beat: Fraction) -> Iterator[str]:
        while self._tempi and self._tempi[0].beat <= beat:
            tempo = self._tempi.pop(0)
            if tempo.beat != beat:
                self._lost["tempi that change within a note"] += 1
            for name, unit in TEMPO_UNITS:
                count = Fraction(tempo.quarters_per_minute).limit_denominator(1000) / unit
                if count.denominator == 1 and 0 < count < 10_000:
                    yield f"{name}={count}"
                    break
            else:
                self._lost["tempi, rounded"] += 1
                yield f"4={max(round(tempo.quarters_per_minute), 5)}"

    # -- notes -------------------------------------------------------------------------------

    def _marks(self, pitch: float, marks: Sequence[Mark]) -> Iterator[str]:
        for mark in marks:
            word = MARK_WORDS.get(mark)
            if word is None and mark.value is not None:  # nearly the same
                word = MARK_WORDS.get(Mark(mark.name))
                letter, alter, octave = layout.spelled(pitch, self._fifths)
                place = layout.LETTERS[letter], octave, alter
                read = filled(Mark(mark.name), around_in(place, {}, self._fifths))
                self._lost[f"{mark.name} {mark.value:g}"] += mark != read
            if mark.name == "tremolo" and word is None:  # three strokes are written at the figure
                self._lost[f"tremolo {mark.value or 0:g}"] += mark.value != 3.0
                continue
            if word is None:
                self._lost[mark.name] += 1
            else:
                yield word

    def _figure(self, pitch: float) -> str:
        """The figure of a pitch, with its accidental and octave."""
        if abs(pitch - round(pitch)) > 1e-6:
            self._lost["pitches between semitones"] += 1
        figure, octaves = figures.figure_of(pitch, self._fifths)
        return figure + ("'" * octaves if octaves > 0 else "," * -octaves)

    def _grace(self, grace: Grace) -> str:
        self._lost["marks of grace notes"] += len(grace.marks)
        return f"{GRACES.get(grace.length, 'q')}{self._figure(grace.pitch)}"
