"""What a rendering was: its length and level, its notes, and what became of them."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import mido
import numpy as np

from yehu_server.core.engine.limiter import CEILING
from yehu_server.playing.stringing import range_text
from yehu_server.playing.tuning import RangePolicy
from yehu_server.rendering.performance import PartPlayer, Performance
from yehu_server.scores.events import CONTROL

FATE = {
    RangePolicy.TRANSPOSE: "moved by octaves",
    RangePolicy.CLAMP: "played as the nearest note",
    RangePolicy.SKIP: "left out",
}

WHEEL, VOLUME, EXPRESSION, RESET = 1, 7, 11, 121  # controllers
LEAST = 2  # of CC 7 and 11: below, the bow leaves the string, or nothing is heard
NOTABLE_DB, MOST_TOLD_DB = 1.0, 7.0  # of the limiter


def counted(number: int, thing: str) -> str:
    """A number of things, with a plural."""
    return f"{number} {thing}" + ("" if number == 1 else "s")


@dataclass(frozen=True)
class PartSummary:
    """What one part played, and from where."""

    name: str
    heard: str  # the names of the score's parts that it plays, as far as they are known
    people: int  # that play it: several in a section
    notes_written: int  # without small notes and ornaments; 0: not known
    notes_played: int
    notes_out_of_range: int
    notes_by_channel: dict[int, int]
    seed: int
    gain_db: float  # at last, as the next two
    pan: float  # -1 left to 1 right
    distance_m: float
    mapping: str
    preset: str | None
    unconverged_solves: int
    lost_states: int


@dataclass(frozen=True)
class Summary:
    """The result of a rendering, of all parts together; levels are relative to full scale."""

    duration_s: float
    real_time_factor: float
    peak: float  # of samples: between them it may be higher
    rms: float
    loudness_lufs: float | None  # integrated; None for silence
    notes_played: int
    notes_out_of_range: int
    range: str  # lowest and highest note
    policy: RangePolicy
    unconverged_solves: int
    lost_states: int
    friction_bound: float  # the largest
    notes_by_channel: dict[int, int]
    percussion_notes: int  # of channel 10, not played
    unknown_programs: tuple[int, ...]  # 1 to 128
    parts: tuple[PartSummary, ...] = ()
    lower_notes: int = 0  # of chords, not played
    timing_shaped: bool = False  # whether rubato moved onsets of a MIDI file
    limited_db: float = 0.0  # by how much the limiter lowered the highest peak
    clipped: tuple[str, ...] = ()  # stems above full scale, in a format that ends there
    asked_lufs: float | None = None  # that it was scaled to, as far as its true peak allows
    unheard_channels: tuple[int, ...] = ()  # 1 to 16: whose CC 7 or 11 stays at 0
    resting_wheels: tuple[int, ...] = ()  # 1 to 16: whose CC 1 makes most of their notes soft

    def remarks(self, drum_hint: str = "") -> list[str]:
        """What was not played as it is written, and hints at what to do about some of it."""
        percussion, moved = (
            counted(notes, "note") for notes in (self.percussion_notes, self.notes_out_of_range)
        )
        programs = ", ".join(map(str, self.unknown_programs))
        more = self.limited_db >= MOST_TOLD_DB
        decibels = f"{MOST_TOLD_DB:g} dB or more" if more else f"{self.limited_db:.1f} dB"
        channels, resting = (
            ", ".join(map(str, of)) for of in (self.unheard_channels, self.resting_wheels)
        )
        clipped = ", ".join(self.clipped)
        lower = counted(self.lower_notes, "lower note")
        solves = counted(self.unconverged_solves, "friction solve")
        lost = counted(self.lost_states, "time")
        reached, asked = self.loudness_lufs, self.asked_lufs
        quieter = 0.0 if reached is None or asked is None else asked - reached
        lines = {
            f"{quieter:.1f} LU quieter than asked for: the true peak is -1 dBFS": quieter > 0.05,
            f"channel 10 is percussion: {percussion} not played{drum_hint}": self.percussion_notes,
            f"{moved} outside {self.range}, {FATE[self.policy]}": self.notes_out_of_range,
            f"{lower} of chords are not played": self.lower_notes,
            f"no preset for the programs {programs}: ignored": programs,
            f"channel {channels}: CC 7 or 11 stays at 0: no note is heard": channels,
            f"channel {resting}: CC 1 is at 0 under most notes, which makes them soft; "
            "--mapping keyboard-vibrato-wheel plays it as vibrato": resting,
            f"the limiter lowered the highest peak by {decibels}; a lower --gain-db "
            "keeps it": self.limited_db >= NOTABLE_DB,
            f"clipped: {clipped}; float samples, or a lower --gain-db, keep it": clipped,
            f"{solves} did not converge": self.unconverged_solves,
            f"the state was lost and set to rest: {lost}": self.lost_states,
        }
        return [line for line, is_so in lines.items() if is_so]


def summary_of(
    performance: Performance,
    duration_s: float,
    elapsed_s: float,
    peak: float,
    rms: float,
    loudness_lufs: float | None,
    *,
    asked_lufs: float | None = None,
    factor: float = 1.0,
    clipped: Sequence[str] = (),
) -> Summary:
    """Sum up a performance that has been played.

    `factor`: by which `peak` was scaled after the limiter; `clipped`: as of `Summary`.
    """
    players, instruments = performance.players, performance.ensemble.instruments
    parts = tuple(map(_part_summary, players))
    channels: Counter[int] = Counter()
    for part in parts:
        channels.update(part.notes_by_channel)
    return Summary(
        duration_s=duration_s,
        real_time_factor=duration_s / elapsed_s,
        peak=peak,
        rms=rms,
        loudness_lufs=loudness_lufs,
        notes_played=sum(part.notes_played for part in parts),
        notes_out_of_range=sum(part.notes_out_of_range for part in parts),
        range=range_text(players[0].player.notes),
        policy=players[0].part.playing.policy,
        unconverged_solves=sum(each.unconverged_solves for each in instruments),
        lost_states=performance.ensemble.lost_states,
        friction_bound=max(each.friction_bound for each in instruments),
        notes_by_channel=dict(sorted(channels.items())),
        percussion_notes=sum(one.player.percussion_notes for one in players),
        unknown_programs=tuple(
            sorted({each for one in players for each in one.player.unknown_programs})
        ),
        parts=parts,
        timing_shaped=any(one.part.is_rubato for one in players),
        lower_notes=sum(one.part.lower_notes for one in players),
        limited_db=limited_db(peak / factor, players[0].player.value("/output/limiter")),
        clipped=tuple(clipped),
        asked_lufs=asked_lufs,
        unheard_channels=tuple(sorted({each for one in players for each in _unheard(one)})),
        resting_wheels=tuple(sorted({each for one in players for each in _resting_wheels(one)})),
    )


def limited_db(peak: float, limiter_db: float) -> float:
    """By how much the limiter, which bends above a level, lowered a peak: the inverse of `limit`.

    Beyond MOST_TOLD_DB the ceiling does not tell.
    """
    soft = 10.0 ** (limiter_db / 20.0)
    room = CEILING - soft
    if peak <= soft or room <= 0.0:
        return 0.0
    share = min((peak - soft) / room, 1.0 - 1e-6)
    return 20.0 * math.log10((soft + room * math.atanh(share)) / peak)


def _unheard(one: PartPlayer) -> set[int]:
    """The channels, from 1, with notes that CC 7 or 11 silences from the first to the last."""
    moves = one.part.playing.mapping.of
    highest: dict[int, dict[int, int]] = {
        control: {} for control in (VOLUME, EXPRESSION) if moves(f"cc {control}")
    }
    for message in (event.message for event in one.part.score.events):
        if isinstance(message, mido.Message) and message.type == "control_change":
            if message.control in highest:
                of_channel = highest[message.control]
                of_channel[message.channel] = max(message.value, of_channel.get(message.channel, 0))
            elif message.control == RESET and EXPRESSION in highest:
                highest[EXPRESSION][message.channel] = 127
    return {
        channel + 1
        for channel in one.player.notes_by_channel
        if any(of_channel.get(channel, 127) < LEAST for of_channel in highest.values())
    }


def _resting_wheels(one: PartPlayer) -> set[int]:
    """The channels, from 1, whose CC 1 moves the bow, and is at 0 for most of the notes' time."""
    binds, score = one.part.playing.mapping.of(f"cc {WHEEL}"), one.part.score
    if all(bind.target != "/playing/intensity" for bind in binds):
        return set()
    events, notes = score.events, score.note_columns
    is_wheel = (events.kind == CONTROL) & (events.first == WHEEL)
    found = set()
    for channel in one.player.notes_by_channel:
        moves = events.where(is_wheel & (events.code >> 16 & 15 == channel))
        sounding = notes.where(notes.channel == channel)
        times = np.append(moves.time_s, score.duration_s)
        rested_s = np.append(0.0, np.cumsum(np.diff(times) * (moves.second == 0)))
        at_0 = (np.interp(each, times, rested_s) for each in (sounding.end_s, sounding.start_s))
        if 2.0 * np.subtract(*at_0).sum() > (sounding.end_s - sounding.start_s).sum():
            found.add(channel + 1)
    return found


def _part_summary(one: PartPlayer) -> PartSummary:
    part, player = one.part, one.player
    channels = {None, *player.notes_by_channel}
    heard = [each for each in part.score.parts if each.channel in channels]
    is_known = len(heard) == 1 or None not in {each.channel for each in heard}
    return PartSummary(
        name=part.name,
        heard=", ".join(each.name for each in heard) if is_known else "",
        people=len(one.instruments),
        notes_written=sum(each.notes for each in heard),
        notes_played=player.notes_played,
        notes_out_of_range=player.notes_out_of_range,
        notes_by_channel=dict(sorted(player.notes_by_channel.items())),
        seed=part.playing.seed,
        gain_db=player.value("/output/gain"),
        pan=player.value("/room/pan"),
        distance_m=player.value("/room/distance"),
        mapping=part.playing.mapping.name,
        preset=None if part.playing.preset is None else str(part.playing.preset),
        unconverged_solves=sum(each.unconverged_solves for each in one.instruments),
        lost_states=sum(each.lost_states for each in one.instruments),
    )
