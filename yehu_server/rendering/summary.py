"""What a rendering was: its length and level, its notes, and what became of them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from yehu_server.playing.stringing import range_text
from yehu_server.playing.tuning import RangePolicy
from yehu_server.rendering.performance import PartPlayer, Performance

FATE = {
    RangePolicy.TRANSPOSE: "moved by octaves",
    RangePolicy.CLAMP: "played as the nearest note",
    RangePolicy.SKIP: "left out",
}


def counted(number: int, thing: str) -> str:
    """A number of things, with a plural."""
    return f"{number} {thing}" + ("" if number == 1 else "s")


@dataclass(frozen=True)
class PartSummary:
    """What one part played, and from where."""

    name: str
    people: int  # that play it: several in a section
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
    peak: float
    rms: float
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

    def remarks(self, hint: str = "") -> list[str]:
        """What was not played as it is written; `hint` follows that of percussion."""
        percussion, moved = (
            counted(notes, "note") for notes in (self.percussion_notes, self.notes_out_of_range)
        )
        programs = ", ".join(map(str, self.unknown_programs))
        solves = counted(self.unconverged_solves, "friction solve")
        lost = counted(self.lost_states, "time")
        lines = {
            f"channel 10 is percussion: {percussion} not played{hint}": self.percussion_notes,
            f"{moved} outside {self.range}, {FATE[self.policy]}": self.notes_out_of_range,
            f"no preset for the programs {programs}: ignored": programs,
            f"{solves} did not converge": self.unconverged_solves,
            f"the state was lost and set to rest: {lost}": self.lost_states,
        }
        return [line for line, is_so in lines.items() if is_so]


def summary_of(
    performance: Performance, duration_s: float, elapsed_s: float, peak: float, rms: float
) -> Summary:
    """Sum up a performance that has been played."""
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
    )


def _part_summary(one: PartPlayer) -> PartSummary:
    part, player = one.part, one.player
    return PartSummary(
        name=part.name,
        people=len(one.instruments),
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
