"""Transcribe notes that were played, a MIDI file or a capture, to a written score.

Each beat is divided as simply as its onsets allow; a note that is let go a little before the next
one begins is written up to that. Notes that overlap are slurred, as they are played. Loudness
becomes dynamics and accents where it is shaped at all.
"""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import groupby, pairwise
from pathlib import Path

import numpy as np

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.core.physics.elementary import log2
from yehu_server.core.player.commands import BEGIN, END, EXPRESS, STOP
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.errors import ScoreError
from yehu_server.playing.sources import RESERVED
from yehu_server.scores.capture import Capture, read_capture
from yehu_server.scores.chosen_parts import MELODIC, finder_of, tune_of
from yehu_server.scores.events import ScoreEvent
from yehu_server.scores.key_switches import with_low_keys_told
from yehu_server.scores.phrasing import FEW_VELOCITIES, MARKED_SPAN
from yehu_server.scores.reading import is_capture, is_written, read_written
from yehu_server.scores.score import (
    COMMON_TIME,
    KeySignature,
    Metre,
    Score,
    ScorePart,
    errors_name,
    says_mpe,
)
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.smf.tunings import transposed_keys
from yehu_server.scores.written import notated
from yehu_server.scores.written.notated import Mark, Note, Part, Sign, Span, Tempo, Written

# Parts of a beat, and the cost of each (quarters), added to the distance of its onsets.
DIVISIONS = {1: 0.0, 2: 0.004, 4: 0.008, 3: 0.012, 8: 0.016, 6: 0.02, 5: 0.03, 12: 0.03, 16: 0.03,
             7: 0.04}  # fmt: skip
# Onsets within so many quarters of such parts were written by a program.
EXACT, PROGRAMS = 0.002, (48, 20, 28)
EARLY = 0.02  # quarters; an onset so much before a beat belongs to it
HAND = 4.0  # factor on costs, where it was played by hand
SHARE = 0.65  # of the time to the next note, from which a note is written up to it
OVERLAP = 0.002  # quarters that notes sound together, from which they are slurred
STEP, ACCENT = 10.0, 12.0  # of velocity: to another dynamic, and of a single note
TEMPI = range(60, 181)  # quarters a minute, candidates for the tempo of a capture
# Costs of a tempo (semiquavers): of a quaver off the beat, half that of others; and of an octave.
OFF_BEAT, UNUSUAL = 0.03, 0.02
SAME_TEMPO = 0.01  # share
LEFT_OUT = {"pitchwheel": "pitch bends", "aftertouch": "pressure", "polytouch": "pressure"}
CHORDS, PERCUSSION = UNPLAYED = "lower notes of chords", "notes of percussion"
SELECTING = {0, 32, *RESERVED}  # of banks, parameters, modes


@dataclass(frozen=True)
class PlayedNote:
    """A note that was played; times in seconds or quarters."""

    begin: float
    end: float
    pitch: float
    velocity: int = 0


def read_as_written(
    path: Path, song: int | None = None, tempo: float | None = None
) -> tuple[Written, dict[str, int]]:
    """Read a score, MIDI file or capture as written, and what is left out; raises ScoreError."""
    if is_capture(path):
        with errors_name(path):
            return written_of_capture(read_capture(path), tempo)
    if is_written(path):
        return read_written(path, song), {}
    score = read_score(path, song=song)
    with errors_name(path):
        written, lost = written_of_midi(score, tempo)
    # Chords are single lines here, and may look like a tune.
    tune = tune_of(score) if len(score.parts) == len(written.parts) else None
    remarks = with_low_keys_told(score, MELODIC).remarks
    return replace(written, warnings=score.warnings, remarks=remarks, tune=tune), lost


def written_of_midi(score: Score, tempo: float | None = None) -> tuple[Written, dict[str, int]]:
    """A MIDI file as written, and counts of what is left out; `tempo` where it has only frames."""
    notes = score.notes
    higher = transposed_keys(score)
    by_frames = any(math.isnan(note.beat) for note in notes)
    is_mpe = says_mpe(score)
    names = (ScorePart(""),) if is_mpe or not score.parts else score.parts
    voices: list[tuple[str, list[PlayedNote]]] = [(part.name, []) for part in names]
    percussion = 0
    find = finder_of(names)
    for note in notes:
        if note.channel == PERCUSSION_CHANNEL and not is_mpe:
            percussion += 1
            continue
        at = find(note.channel, note.track)
        if at is not None:
            end = score.events[note.ends].beat if note.ends >= 0 else note.beat + 1.0
            begin, end = (note.start_s, note.end_s) if by_frames else (note.beat, end)
            pitch = note.key + higher.get(note.begins, 0.0)
            voices[at][1].append(PlayedNote(begin, end, pitch, note.velocity))
    lost = Counter(filter(None, map(_left_out, score.events)))
    lost[PERCUSSION] += percussion
    if by_frames:
        written, more = written_of_seconds(voices, tempo)
        return replace(written, title=score.name), {**+lost, **more}
    whole, chords = _written(voices, _tempi(score), score.metres, score.keys)
    lost[CHORDS] += chords
    return replace(whole, title=score.name), dict(+lost)


def _left_out(event: ScoreEvent) -> str:
    """The name of a message that notation has no sign for; empty where it has one."""
    message = event.message
    if message.type == "control_change":
        return "" if message.control in SELECTING else f"CC {message.control}"
    return LEFT_OUT.get(message.type, "")


def written_of_capture(
    capture: Capture, tempo: float | None = None
) -> tuple[Written, dict[str, int]]:
    """Return what the players of a capture played as a written score, and what is left out."""
    voices: list[tuple[str, list[PlayedNote]]] = []
    lost: Counter[str] = Counter()
    players = len(capture.beginning.players)
    for player in range(players):
        own = capture.commands[capture.players == player]
        until_end = [*own.tolist(), (capture.frames, STOP, 0, 0.0, 0.0)]
        heard = _of_commands(until_end, capture.rate)
        voices.append((f"player {player + 1}" if players > 1 else "", heard))
        notes = np.isin(own["kind"], (BEGIN, END, EXPRESS, STOP))
        lost["moves of bow and fingers"] += int(np.sum(~notes))
    written, more = written_of_seconds(voices, tempo)
    return written, {**+lost, **more}


def _of_commands(
    commands: Sequence[tuple[int, int, int, float, float]], rate: float
) -> list[PlayedNote]:
    heard: list[PlayedNote] = []
    held: dict[tuple[int, float], tuple[float, float, int]] = {}
    velocity = 0
    for frame, kind, index, value, other in commands:
        now, key = frame / rate, (index, value)
        if kind == EXPRESS and index == PLAYING.velocity:
            velocity = round(127.0 * value)
        for ended in list(held) if kind == STOP else [key] if kind in (BEGIN, END) else []:
            begin, pitch, loud = held.pop(ended, (now, 0.0, 0))
            if now > begin:
                heard.append(PlayedNote(begin, now, pitch, loud))
        if kind == BEGIN:
            held[key] = now, other, velocity
    return sorted(heard, key=lambda each: each.begin)


def written_of_seconds(
    voices: Sequence[tuple[str, Sequence[PlayedNote]]], tempo: float | None = None
) -> tuple[Written, dict[str, int]]:
    """Return a score of notes in seconds; without a tempo, at that which fits their onsets."""
    begins = sorted(note.begin for _, heard in voices for note in heard)
    if not begins:
        raise ScoreError("has no note")
    quarters = _tempo_of(begins) if tempo is None else tempo
    rate, first = quarters / 60.0, begins[0]
    changed = [
        (name, [replace(n, begin=(n.begin - first) * rate, end=(n.end - first) * rate)
                for n in heard])
        for name, heard in voices
    ]  # fmt: skip
    written, chords = _written(changed, (Tempo(Fraction(0), float(quarters)),), (COMMON_TIME,))
    return written, {CHORDS: chords} if chords else {}


def _tempo_of(begins: Sequence[float]) -> float:
    """The tempo at which onsets lie nearest to semiquavers.

    Of those alike, that at which more of them are beats and quavers, and the nearest to
    DEFAULT_TEMPO.
    """

    def cost(tempo: int) -> float:
        places = [(begin - begins[0]) * tempo / 15.0 for begin in begins]
        near = [round(place) for place in places]
        off = sum(abs(place - at) for place, at in zip(places, near, strict=True))
        odd = sum((at % 2 > 0) + (at % 4 > 0) for at in near)
        distance = abs(log2(tempo / notated.DEFAULT_TEMPO))
        return (off + OFF_BEAT * odd) / len(places) + UNUSUAL * distance

    return float(min(TEMPI, key=cost))


# -- time ---------------------------------------------------------------------------------------


def _written(
    voices: Sequence[tuple[str, Sequence[PlayedNote]]],
    tempi: Sequence[Tempo],
    metres: Sequence[Metre],
    signatures: Sequence[KeySignature] = (),
) -> tuple[Written, int]:
    """A score of notes in quarters, and how many lower notes of chords it leaves out.

    The keys are the `signatures` of the file; where there are none but C, which sequencers write
    unasked, the one that the notes fit.
    """
    begins = sorted({note.begin for _, heard in voices for note in heard})
    if not begins:
        raise ScoreError("has no note")
    if max(note.end for _, heard in voices for note in heard) > notated.MAX_BEATS:
        raise ScoreError(f"is longer than {notated.MAX_BEATS} quarters")
    grid = _Grid(begins)
    parts = []
    chords = 0
    for name, heard in voices:
        if heard:
            part, more = _part(name, heard, grid)
            chords += more
            parts.append(part)
    signs = {each.beat.limit_denominator(960): each.fifths for each in signatures}
    if not any(signs.values()):
        signs = {Fraction(0): _fifths_of(parts)}
    keys = tuple(KeySignature(*each) for each in ({Fraction(0): 0} | signs).items())
    return Written(tuple(parts), tuple(tempi), tuple(metres), keys=keys), chords


class _Grid:
    """The division of each beat."""

    def __init__(self, begins: Sequence[float]) -> None:
        exact = sum(
            min(abs(begin - round(begin * each) / each) for each in PROGRAMS) <= EXACT
            for begin in begins
        )
        self._cost = 1.0 if exact > 0.9 * len(begins) else HAND
        self._divisions: dict[int, int] = {}
        for beat, own in groupby(begins, key=lambda begin: math.floor(begin + EARLY)):
            self._divisions[beat] = self._division([begin - beat for begin in own])

    def _division(self, places: Sequence[float]) -> int:
        def cost(division: int) -> float:
            off = [abs(place - round(place * division) / division) for place in places]
            together = len({round(place * division) for place in places}) < len(places)
            return max(off) + self._cost * DIVISIONS[division] + 0.05 * together

        return min(DIVISIONS, key=cost)

    def near(self, beat: float, least: int = 1) -> Fraction:
        """The nearest place that notes may begin at; of ends, at least so many to a beat."""
        whole = math.floor(beat + EARLY)
        division = self._divisions.get(whole, least)
        if division < least:
            division = division * least // math.gcd(division, least)
        return whole + Fraction(round((beat - whole) * division), division)


def _part(name: str, heard: Sequence[PlayedNote], grid: _Grid) -> tuple[Part, int]:
    by_beat: dict[Fraction, PlayedNote] = {}
    chords = 0
    for note in heard:
        at = grid.near(note.begin)
        chords += at in by_beat
        if at not in by_beat or note.pitch > by_beat[at].pitch:
            by_beat[at] = note
    places = sorted(by_beat)
    notes: list[Note] = []
    slurred: list[bool] = []  # each to the next one
    for at, after in zip(places, [*places[1:], None], strict=True):
        note = by_beat[at]
        length = note.end - note.begin
        finest = 1 if length > 1.5 else 2 if length > 0.75 else 4  # of those let go early
        end = max(grid.near(note.end, finest), at + Fraction(1, 16))
        if after is not None:
            to_next = by_beat[after].begin - note.begin
            slurred.append(note.end > by_beat[after].begin + OVERLAP)
            if end > after or length >= SHARE * to_next:
                end = after
        notes.append(Note(at, end - at, float(note.pitch)))
    loud = [by_beat[at].velocity for at in places]
    marked, signs = _loudness(notes, loud)
    return Part(name, tuple(marked), tuple(_slurs(notes, slurred)), tuple(signs)), chords


def _slurs(notes: Sequence[Note], slurred: Sequence[bool]) -> Iterator[Span]:
    at = 0
    for is_slurred, run in groupby(slurred):
        last = at + len(list(run))
        if is_slurred:
            yield Span("slur", notes[at].beat, notes[last].beat)
        at = last


def _loudness(notes: Sequence[Note], loud: Sequence[int]) -> tuple[list[Note], list[Sign]]:
    """Dynamics where the velocities are shaped; a single louder note has an accent."""
    values = set(loud)
    if len(values) <= FEW_VELOCITIES and max(loud) - min(loud) <= MARKED_SPAN:
        return list(notes), []
    marked = list(notes)
    signs: list[Sign] = []
    now = ""
    for at, velocity in enumerate(loud):
        around = [loud[near] for near in (at - 1, at + 1) if 0 <= near < len(loud)]
        if now and all(velocity >= each + ACCENT for each in around):
            marked[at] = marked[at]._replace(marks=(*marked[at].marks, Mark("accent")))
        elif not now or _stays_off(loud[at : at + 2], notated.DYNAMICS[now]):
            now = min(notated.DYNAMICS, key=lambda name: abs(notated.DYNAMICS[name] - velocity))
            signs.append(Sign(notes[at].beat, now))
    return marked, signs


def _stays_off(loud: Sequence[int], level: int) -> bool:
    steps = [velocity - level for velocity in loud]
    return min(steps) > STEP or max(steps) < -STEP


def _tempi(score: Score) -> tuple[Tempo, ...]:
    found: list[Tempo] = []
    for one, other in pairwise(score.events):
        if other.beat - one.beat > 1e-6 and other.time_s > one.time_s:
            tempo = 60.0 * (other.beat - one.beat) / (other.time_s - one.time_s)
            tempo = min(max(round(tempo, 2), notated.LOWEST_TEMPO), notated.HIGHEST_TEMPO)
            last = found[-1].quarters_per_minute if found else 0.0
            if abs(tempo - last) > SAME_TEMPO * tempo:
                beat = Fraction(round(16 * one.beat) if found else 0, 16)
                found.append(Tempo(beat, tempo))
    return tuple({tempo.beat: tempo for tempo in found}.values())


def _fifths_of(parts: Sequence[Part]) -> int:
    """The key signature that most of the notes fit; of those alike, with the last note as do."""
    counts: Counter[int] = Counter()
    for part in parts:
        for note in part.notes:
            counts[round(note.pitch) % 12] += 1
    last = round(parts[0].notes[-1].pitch) % 12

    def fit(fifths: int) -> tuple[int, bool, int]:
        own = {(7 * (fifths + place)) % 12 for place in range(-1, 6)}
        inside = sum(count for key, count in counts.items() if key in own)
        return inside, (7 * fifths) % 12 == last, -abs(fifths)

    return max(range(-5, 7), key=fit)
