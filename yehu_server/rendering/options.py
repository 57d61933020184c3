"""How to render: what each player plays, and the sound that is made of all."""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.core.stage.room_geometry import EARS
from yehu_server.errors import ScoreError
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import section_size
from yehu_server.scores.chords import without_lower_notes
from yehu_server.scores.chosen_parts import MELODIC
from yehu_server.scores.phrasing import is_fingered, phrased
from yehu_server.scores.score import Score, concatenate, says_mpe

BEND_RANGE = "/playing/bend_range"
DATA, RPN = 6, (101, 100)  # controllers: RPN 0 is the bend range
BLOCK = 1 << 14  # frames; the sound does not depend on it


@dataclass(frozen=True)
class Part:
    """A player on the stage, or a section of them: what they play, and how."""

    score: Score  # shaped already (``scores.phrasing``)
    playing: PlayingOptions = field(default_factory=PlayingOptions)
    name: str = ""
    lower_notes: int = 0  # of chords, which the score was without
    is_rubato: bool = False  # whether onsets are others than those of a MIDI file

    @classmethod
    def shaped(cls, scores: Sequence[Score], playing: PlayingOptions, name: str = "") -> Part:
        """The part of a player who plays scores one after another, and shapes them.

        Of a chord one player has the highest note; a section shares its notes.
        """
        lower = 0
        if section_size(playing) == 1:
            single = [without_lower_notes(each, _channels(each, playing)) for each in scores]
            scores, lower = [score for score, _ in single], sum(left for _, left in single)
        score = concatenate([phrased(each, playing) for each in scores])
        if is_fingered(score, playing):
            still = ("/playing/left_hand", 0.0)
            playing = replace(playing, start=(*playing.start, still))
        amount = playing.phrasing if playing.rubato is None else playing.rubato
        is_rubato = bool(amount) and any(
            not each.is_written and any(delay for _, delay in each.delays) for each in scores
        )
        return cls(score, playing, name or score.name, lower, is_rubato)

    def check_is_heard(self) -> None:
        """Check that one of the score's notes is played; raises ScoreError where it has some."""
        found = sorted({note.channel for note in self.score.notes})
        chosen = MELODIC if self.playing.channels is None else self.playing.channels
        is_mpe = self.playing.channels is None and self.playing.mapping.mpe  # a member may be 10
        if not found or is_mpe or not chosen.isdisjoint(found):
            return
        if found == [PERCUSSION_CHANNEL]:
            raise ScoreError(
                f"{self.score.name}: all its notes are of channel 10, percussion, which is played "
                "only if it is chosen, as --channel 10 does"
            )
        raise ScoreError(f"{self.score.name}: {unheard_line(chosen, found)}")


def bends_without_range(part: Part) -> bool:
    """Whether a part has bends, and neither its score nor its options say how far they go."""
    playing, score = part.playing, part.score
    sets = {address for address, _ in (*playing.mapping.start, *playing.start, *playing.settings)}
    if score.is_written or BEND_RANGE in sets or playing.mapping.mpe or says_mpe(score):
        return False
    channels = {note.channel for note in score.notes}.intersection(_channels(score, playing))
    bent: set[int] = set()
    selected: dict[int, dict[int, int]] = defaultdict(dict)  # by channel: controllers
    for message in (event.message for event in score.events):
        if message.type == "pitchwheel" and message.pitch:
            bent.add(message.channel)
        elif message.type == "control_change":
            selected[message.channel][message.control] = message.value
            if message.control == DATA and all(
                selected[message.channel].get(each) == 0 for each in RPN
            ):
                channels.discard(message.channel)
    return not bent.isdisjoint(channels)


def _channels(score: Score, playing: PlayingOptions) -> Collection[int]:
    """The channels of a score that a player plays."""
    if playing.channels is not None:
        return playing.channels
    return range(16) if playing.mapping.mpe or says_mpe(score) else MELODIC


def unheard_line(chosen: Collection[int], found: Sequence[int]) -> str:
    """A line that names chosen channels, counted from 0, that are not among those with notes."""
    asked, has = (
        ", ".join(str(each + 1) for each in of)
        for of in (sorted({*chosen}.difference(found)), found)
    )
    return f"no note is of channel {asked}, but of {has}" if asked and has else ""


NORMALIZED_PEAK = 0.8912509381337456  # a true peak of -1 dB


@dataclass(frozen=True)
class Options:
    """The sound to render; see ``yehu-server render --help``."""

    rate: int = 44100
    format_name: str = "wav"
    subtype: str = "24"
    tail_s: float | None = None  # None: until it is quiet
    normalize: bool = False  # scaled to a true peak of NORMALIZED_PEAK
    loudness_lufs: float | None = None  # integrated loudness that it is scaled to, below that peak
    block: int = BLOCK
    is_dry: bool = False  # without a room, and with a body that sounds alike to both sides
    is_mono: bool = False
    jobs: int | None = None  # number of cores; None: all

    @property
    def is_scaled(self) -> bool:
        """Whether the sound is scaled, once all of it is known."""
        return self.normalize or self.loudness_lufs is not None

    def factor(self, true_peak: float, lufs: float | None) -> float:
        """The factor by which a sound of such a peak and loudness is scaled; 1 for silence."""
        if true_peak <= 0.0 or not self.is_scaled:
            return 1.0
        highest = NORMALIZED_PEAK / true_peak
        if self.loudness_lufs is None:
            return highest
        return 1.0 if lufs is None else min(highest, 10.0 ** ((self.loudness_lufs - lufs) / 20.0))

    @property
    def sound_channels(self) -> int:
        """Channels of the sound: left and right, or one."""
        return 1 if self.is_mono else EARS

    @property
    def cores(self) -> int:
        """Number of cores to use."""
        return self.jobs or os.cpu_count() or 1
