"""A section passes commands on to its players: notes one by one, as they begin, all else to all."""

from dataclasses import replace
from types import SimpleNamespace
from typing import NamedTuple

import mido
import numpy as np
import pytest
from hands import RATE, ideal
from together import Together

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.rig import RIG_BYTES
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi.interpret_events import interpret
from yehu_server.core.midi.record import CHANNELS_PER_PORT, MIDI, clear_held, prepare_midi
from yehu_server.core.midi.tables import TABLE_SLOTS, TABLES
from yehu_server.core.player import commands as kinds
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.params.table import TABLE, find
from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.playing.parts import section_specs
from yehu_server.playing.player import Player
from yehu_server.rendering.cores import Cores

BEAT = 24000  # frames
CHORD = (76, 72, 67)


class Posted(NamedTuple):
    """A command that an instrument was told; fields as in the record of its part."""

    kind: int
    frame: int
    index: int
    value: float
    other: float


class Kept:
    """An instrument of a part that only keeps what it is told.

    The first of the part leads it: what is posted there is interpreted at once, for all of them.
    """

    is_live, frame, rate, spec = False, 0, RATE, InstrumentSpec(44100.0)

    def __init__(self, number: int, part: "list[Kept]") -> None:
        self.address, self._part = number * RIG_BYTES, part
        self._midi, self.tables = np.zeros(1, MIDI), np.zeros(TABLE_SLOTS, TABLES)
        self.posted = 0
        self.all: list[Posted] = []
        self.sounding_pitch = np.nan

    def begin_part(self, tables, players: int = 1) -> None:
        defaults = {param.address: param.default for param in TABLE}
        is_mpe = bool(tables["mpe"][0])
        prepare_midi(self._midi, RATE, defaults, players=players, mpe=is_mpe)
        self.tables[0] = tables[0]

    def set_tables(self, tables) -> None:
        self.tables[0] = tables[0]
        self.midi["lower"] = CHANNELS_PER_PORT - 1 if tables["mpe"][0] else 0

    @property
    def midi(self):
        return self._midi[0]

    def post(self, kind, *, frame=None, index=0, value=0.0, other=0.0, **_) -> bool:
        m, at = self.midi, self.frame if frame is None else frame
        places = self._midi.ctypes.data, self.tables.ctypes.data
        interpret.call(*places, at, kind, index, value, other)
        for n in range(int(m["commands"])):
            command = (m[f"out_{what}"][n].item() for what in Posted.__annotations__)
            self._part[m["out_player"][n]].all.append(Posted(*command))
        self.posted += 1
        return True

    def interpret_events(self) -> None:
        pass

    def meters(self):
        return {"pitch": self.sounding_pitch, "drained": 0, "next_frame": 0}

    def of(self, *chosen: int) -> list[Posted]:
        """What it was told, of some kinds, in the order of application."""
        return sorted((w for w in self.all if w.kind in chosen), key=lambda command: command.frame)

    def begun(self) -> list[tuple[float, int]]:
        """Keys and frames of the notes begun."""
        return [(command.value, command.frame) for command in self.of(kinds.BEGIN)]

    def settled(self) -> list[float]:
        """The keys that it holds once all is applied."""
        held: dict[float, None] = {}
        for command in self.of(kinds.BEGIN, kinds.END):
            held.pop(command.value, None)
            if command.kind == kinds.BEGIN:
                held[command.value] = None
        return list(held)

    def value(self, address: str) -> float:
        """What it was last told of a parameter."""
        told = [w for w in self.of(*kinds_of_settings) if TABLE[w.index].address == address]
        return told[-1].value if told else find(address).default


kinds_of_settings = (kinds.WRITE, kinds.HOLD, kinds.EXPRESS)


def section(people: int, playing: PlayingOptions | None = None) -> SimpleNamespace:
    told: list[Kept] = []
    told += [Kept(number, told) for number in range(people)]
    return SimpleNamespace(told=told, commands=(playing or PlayingOptions()).player(told))


@pytest.fixture
def ten() -> SimpleNamespace:
    return section(10)


@pytest.fixture
def four() -> SimpleNamespace:
    return section(4)


def on(to, *keys, frame, values=None):
    for key in keys:
        to.commands.note_on(Key(0, key), values, frame=frame)


def off(to, *keys, frame):
    to.commands.notes_off([Key(0, key) for key in keys], frame=frame)


def test_players_of_a_section_lie_one_after_another():
    apart = section(3).told[::2]
    with pytest.raises(ValueError, match="one after another"):
        Player(apart)


def test_a_new_stroke_and_a_slur_stay_one_in_every_player(four):
    timing, beats = Together(4, RATE, seed=0), range(60)
    expected = [timing.onset(beat * BEAT) for beat in beats]
    for beat in beats:
        on(four, 67, frame=beat * BEAT)
        off(four, 67, frame=(beat + 1) * BEAT)
    for number, told in enumerate(four.told):
        acts = told.of(kinds.BEGIN, kinds.END)
        assert [command.kind for command in acts] == [kinds.BEGIN, kinds.END] * 60
        late = [w.frame - BEAT * beat for beat, w in enumerate(acts[::2])]
        assert late == [each[number] for each in expected]
        gaps = [b.frame - a.frame for a, b in zip(acts[1::2], acts[2::2], strict=False)]
        assert gaps == [0] * 59  # no player stops between the notes
    four = section(4)
    for beat in beats:
        on(four, 67 + beat % 2, frame=beat * BEAT)
        off(four, 68 - beat % 2, frame=beat * BEAT + 100)
    for told in four.told:
        acts = told.of(kinds.BEGIN, kinds.END)[1:]
        assert [command.kind for command in acts[:20]] == [kinds.BEGIN, kinds.END] * 10


def test_a_note_ends_after_it_began_though_a_later_one_was_asked_for_before(four):
    for beat in range(0, 80, 2):
        on(four, 67, frame=beat * BEAT)
        on(four, 69, frame=(beat + 1) * BEAT)
        off(four, 67, frame=beat * BEAT + 48)
        off(four, 69, frame=(beat + 2) * BEAT - 4800)
    for told in four.told:
        acts = [w.kind for w in told.of(kinds.BEGIN, kinds.END) if w.value == 67]
        assert acts == [kinds.BEGIN, kinds.END] * 40


def test_a_chord_is_divided_from_the_top_each_player_in_one_stroke():
    for apart in (0, 500):  # frames; keys struck within a moment
        ten = section(10)
        for at, key in enumerate(CHORD):
            on(ten, key, frame=BEAT + apart * at)
        assert [told.settled() for told in ten.told] == [[76]] * 4 + [[72]] * 3 + [[67]] * 3
        for told in ten.told:  # the notes of one stroke begin at one frame
            assert len({command.frame for command in told.of(kinds.BEGIN, kinds.END)}) == 1 or apart


def test_keys_thirty_milliseconds_apart_are_a_line():
    for apart_ms, together in ((29.0, 2), (31.0, 4), (40.0, 4)):
        four = section(4)
        on(four, 67, frame=BEAT)
        on(four, 72, frame=BEAT + round(1e-3 * apart_ms * RATE))
        assert [told.settled()[-1] for told in four.told].count(72) == together


def test_keys_that_overlap_or_follow_one_that_has_ended_are_no_chord_but_a_line(four):
    on(four, 67, frame=0)
    on(four, 69, frame=BEAT)
    assert all(told.settled() == [67, 69] for told in four.told)
    off(four, 69, frame=2 * BEAT)  # back to the key that is still held
    assert all(told.settled() == [67] for told in four.told)
    off(four, 67, frame=3 * BEAT)
    on(four, 67, frame=4 * BEAT)
    off(four, 67, frame=4 * BEAT + 480)
    on(four, 72, frame=4 * BEAT + 960)
    assert all(told.settled() == [72] for told in four.told)


def test_players_whose_note_ends_rest_and_the_others_play_on(ten):
    on(ten, *CHORD, frame=0)
    off(ten, 76, frame=BEAT)
    assert [told.settled() for told in ten.told] == [[]] * 4 + [[72]] * 3 + [[67]] * 3
    off(ten, 72, 67, frame=2 * BEAT)
    for told in ten.told:
        assert told.of(kinds.END)[-1].other == 0.0  # or its player would wait for another end
        assert told.settled() == []


def test_a_key_that_sounds_again_has_its_expression_again(four):
    address = "/playing/pressure"
    on(four, 67, frame=0, values={address: 0.6})
    on(four, 69, frame=BEAT, values={address: 0.2})
    four.commands.post(kinds.EXPRESS, 2 * BEAT, INDEX[address], 0.6)
    off(four, 69, frame=2 * BEAT)
    for told in four.told:
        express, end = [w for w in told.all if w.kind in (kinds.EXPRESS, kinds.END)][-2:]
        assert (express.value, end.kind, end.frame) == (0.6, kinds.END, express.frame)


def test_a_seed_begins_the_onsets_anew_and_without_variation_all_begin_at_once(four):
    for begin in (0, 20 * BEAT):
        four.commands.write("/engine/seed", 5.0, frame=begin)
        for beat in range(10):
            on(four, 67, frame=begin + beat * BEAT)
            off(four, 67, frame=begin + beat * BEAT + BEAT // 2)
    frames = np.array([[frame for _, frame in told.begun()] for told in four.told])
    assert np.array_equal(frames[:, 10:] - 20 * BEAT, frames[:, :10])
    four = section(4)
    four.commands.write("/playing/variation", 0.0)
    on(four, 67, frame=BEAT)
    assert [told.begun() for told in four.told] == [[(67, BEAT)]] * 4


MPE = Mapping("mpe", (Bind("bend", "/playing/bend"), Bind("cc 1", "/playing/vibrato")), mpe=True)


def test_a_chord_is_bent_as_a_whole_and_in_mpe_each_note_by_itself(four):
    midi = four.commands.mapped(MPE)
    for channel, note in ((1, 76), (2, 67)):
        midi.receive(mido.Message("note_on", note=note, channel=channel), frame=0)
    for number, (channel, pitch, bends) in enumerate([(1, 8191, (48, 0)), (2, -8192, (48, -48))]):
        midi.receive(mido.Message("pitchwheel", pitch=pitch, channel=channel), frame=BEAT + number)
        assert [told.value("/playing/bend") for told in four.told] == [
            *bends[:1] * 2,
            *bends[1:] * 2,
        ]
    midi.receive(mido.Message("control_change", control=1, value=127), frame=BEAT + 20)
    assert all(told.value("/playing/vibrato") == 100.0 for told in four.told)
    four = section(4)
    midi = four.commands.mapped(replace(MPE, mpe=False))
    for note in CHORD:
        midi.receive(mido.Message("note_on", note=note), frame=0)
    midi.receive(mido.Message("pitchwheel", pitch=8191), frame=BEAT)
    assert all(told.value("/playing/bend") == 2.0 for told in four.told)


def test_what_is_set_during_a_note_is_not_undone_as_a_late_player_begins(four):
    address = "/playing/dynamics"
    for beat in range(20):
        on(four, 67, frame=beat * BEAT, values={address: 0.5})
        four.commands.write(address, 0.9, frame=beat * BEAT + 10)
        off(four, 67, frame=beat * BEAT + BEAT // 2)
        assert all(told.value(address) == 0.9 for told in four.told)


def test_settings_reach_all_with_what_is_a_players_own(four):
    four.commands.write("/playing/vibrato", 30.0)
    assert all(told.value("/playing/vibrato") == 30.0 for told in four.told)
    four.commands.write("/output/gain", -3.0)
    assert four.commands.value("/output/gain") == -3.0
    assert four.told[2].value("/output/gain") == pytest.approx(-3.0 - 10.0 * np.log10(4.0))
    four.commands.write("/room/pan", 0.1)
    assert np.mean([told.value("/room/pan") for told in four.told]) == pytest.approx(0.1)
    four.commands.write("/engine/seed", 5.0)
    assert len({told.value("/engine/seed") for told in four.told}) == 4


def test_fewer_and_more_may_play_but_not_more_than_there_are(four):
    assert four.commands.value("/playing/section") == 4.0
    on(four, 67, frame=0)
    assert four.commands.write("/playing/section", 2.0, frame=BEAT) == 2.0
    assert [told.settled() for told in four.told] == [[67]] * 2 + [[]] * 2
    assert four.told[0].value("/output/gain") == pytest.approx(-10.0 * np.log10(2.0))
    on(four, 69, frame=2 * BEAT)
    assert [told.settled() for told in four.told] == [[67, 69]] * 2 + [[]] * 2
    off(four, 67, 69, frame=3 * BEAT)
    assert four.commands.write("/playing/section", 16.0, frame=4 * BEAT) == 4.0
    on(four, 72, frame=5 * BEAT)
    assert all(told.settled() == [72] for told in four.told)
    assert section(1).commands.write("/playing/section", 16.0) == 1.0


def test_notes_that_ended_with_the_audio_process_are_forgotten(four):
    on(four, *CHORD, frame=0)
    clear_held(four.told[0].midi)
    before = [len(told.of(kinds.END)) for told in four.told]
    off(four, *CHORD, frame=BEAT)
    assert [len(told.of(kinds.END)) for told in four.told] == before


def test_a_panic_comes_after_the_notes_that_were_requested_before_it(four):
    for beat in range(20):
        on(four, 67, frame=beat * BEAT)
        four.commands.notes_off([Key(0, 67)], frame=beat * BEAT + 5)
        four.commands.stop_sound(frame=beat * BEAT + 5, is_panic=True)
        for told in four.told:
            assert told.of(kinds.BEGIN, kinds.END, kinds.STOP)[-1].kind == kinds.STOP


def played(playing: PlayingOptions, people: int, block: int, seconds: float = 1.5) -> np.ndarray:
    """The sound of each player of a chord and a line."""
    stage = Ensemble(section_specs(playing, RATE, ideal(), players=people), has_room=False)
    cores = Cores(stage, map, has_stems=True)
    midi = playing.mapped(playing.player(stage.instruments))
    events = [(0.1, "note_on", 67), (0.1, "note_on", 74), (0.6, "note_off", 67)]
    events += [(0.6, "note_off", 74), (0.6, "note_on", 70), (1.1, "note_off", 70)]
    frames = round(seconds * RATE)
    sounds = np.zeros((people, frames), np.float32)
    for begin in range(0, frames, block):
        while events and events[0][0] * RATE < begin + block:
            at, kind, note = events.pop(0)
            midi.receive(mido.Message(kind, note=note, velocity=80), frame=round(at * RATE))
        cores.mix(cores.sound(min(block, frames - begin)))
        sounds[:, begin : begin + block] = cores.stems[:, :people].mean(axis=2).T
    return sounds


def test_the_same_commands_give_the_same_samples_in_blocks_of_any_size():
    playing = replace(PlayingOptions(seed=9), start=(("/playing/section", 2.0),))
    sounds = played(playing, 2, 4096)
    assert np.array_equal(sounds, played(playing, 2, 100))
    level = np.sqrt((sounds[:, round(0.3 * RATE) : round(0.5 * RATE)] ** 2).mean(axis=1))
    assert level.min() > 1e-3  # both play their notes of the chord
    assert not np.array_equal(sounds[0], sounds[1])
    assert np.abs(sounds[:, round(1.4 * RATE) :]).max() < 0.05 * np.abs(sounds).max()


@pytest.mark.parametrize("seed", range(8))
def test_no_note_hangs_whatever_is_played(seed):
    random = np.random.default_rng(seed)
    people = int(random.integers(2, 7))
    playing = replace(PlayingOptions(), start=(("/playing/section", float(people)),))
    part = section(people, playing)
    told, commands = part.told, part.commands
    midi = playing.mapped(commands)
    frame = 0
    for number in range(400):
        frame += int(random.choice([0, 0, 100, 1500, 6000, 20000]))
        kind = random.choice(["note_on", "note_on", "note_off", "control_change"])
        channel, note = int(random.integers(2)), int(random.integers(65, 72))
        if kind == "control_change":
            control = int(random.choice([1, 11, 64, 64, 120, 123]))
            fields = {"control": control, "value": int(random.choice([0, 60, 127]))}
        else:
            fields = {"note": note, "velocity": int(random.integers(0, 127))}
        midi.receive(mido.Message(str(kind), channel=channel, **fields), frame=frame)
        if number % 50 == 49:
            commands.write("/playing/section", float(random.integers(1, 7)), frame=frame)
        if number % 10 == 9:
            held = {key.note for key in commands.held()}
            assert all(set(each.settled()) <= held for each in told)
    midi.end_all(frame=frame)
    assert not any(each.settled() for each in told)


def power(sound: np.ndarray) -> np.ndarray:
    """The power of a chord and of a line at each frequency (4 Hz apart), while they are steady."""
    frames = round(0.25 * RATE)
    steady = np.stack([sound[..., round(at * RATE) :][..., :frames] for at in (0.3, 0.8)])
    return np.abs(np.fft.rfft(steady * np.hanning(frames))) ** 2


def test_players_add_up_as_people_do_and_not_as_copies_of_one():
    """At a single frequency they are by chance anything up to copies: phases are random."""
    sounds = played(replace(PlayingOptions(), start=(("/playing/section", 4.0),)), 4, 4096, 1.06)
    apart = power(sounds).sum(axis=1)
    sounding = apart > 1e-3 * apart.max(axis=1, keepdims=True)
    assert sounding.sum() > 20
    assert 0.5 < np.mean((power(sounds.sum(axis=0)) / apart)[sounding]) < 2.0  # copies: 4


def test_a_reset_lets_all_play_that_played_at_the_start():
    playing = replace(PlayingOptions(), start=(("/playing/section", 4.0),))
    part = section(4, playing)
    told, commands = part.told, part.commands
    playing.mapped(commands)
    commands.write("/playing/section", 1.0, frame=10)
    commands.reset(frame=20)
    assert commands.value("/playing/section") == 4.0
    commands.note_on(Key(0, 67), frame=BEAT)
    assert all(each.settled() == [67] for each in told)
