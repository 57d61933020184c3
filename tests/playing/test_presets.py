"""Folders of presets, and loading one while the player plays."""

import itertools
import os
from pathlib import Path

import mido
import numpy as np
import pytest
from midi_input import receive
from pitch import cents, hertz, pitch_of
from sound import run

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.errors import OutputError, PresetError
from yehu_server.params.preset_file import NOT_SAVED, POSSIBLE, SAVED
from yehu_server.params.table import TABLE
from yehu_server.playing import preset_folders as folders
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import player_of
from yehu_server.playing.player import Player
from yehu_server.playing.preset_folders import MAX_NAMED, MAX_OWN, Presets

HEAD = "version = 1\n"
RATE = 44100.0
SHIPPED = Presets(Path(os.devnull)).names()
DEFAULTS = {param.address: param.default for param in TABLE}
NAMES = [
    "", ".", "..", "../x", "..\\x", "a/b", "a\\b", "C:\\x", "/etc/passwd", "a\0b", ".hidden",
    "-x", " x", "x" * 101, "x\n", "a\tb", "a\u0308", "a:b", "*", "~/x", "$(x)",
    "\u202ex", "胡" * 67, "\uff0c",
]  # fmt: skip


@pytest.fixture
def presets(tmp_path) -> Presets:
    return Presets(tmp_path / "own")


@pytest.fixture
def put(presets):
    """Write a file into the user's own folder."""

    def write(name: str, text: str) -> Path:
        presets.own.mkdir(exist_ok=True)
        path = presets.own / f"{name}.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


# ---------------------------------------------------------------- folders


def test_every_shipped_preset_says_what_it_is_and_has_a_program_of_its_own(presets):
    found, errors = presets.all()
    assert errors == []
    assert [preset.name for preset in found] == SHIPPED
    assert all(preset.about and not preset.unknown for preset in found)
    programs = [preset.program for preset in found]
    assert sorted(programs) == list(range(1, len(found) + 1))
    # All name the same parameters, so that each undoes another.
    assert len({frozenset(preset.values) for preset in found}) == 2  # bows and rooms
    # Where a seat is belongs to a room.
    assert all(NOT_SAVED & set(preset.values) <= {"/room/distance"} for preset in found)


def test_every_value_saved_is_loaded_again(presets):
    for end in ("lo", "hi", "default"):
        values = {param.address: getattr(param, end) for param in TABLE}
        presets.save("mine", values)
        loaded = presets.load("mine")
        assert loaded.values == {address: values[address] for address in SAVED}
        assert loaded.unknown == ()
    assert presets.names() == sorted([*SHIPPED, "mine"])
    presets.save("mine", DEFAULTS | {"/playing/speed": float(np.float32(0.1))})
    assert presets.load("mine").values["/playing/speed"] == 0.1  # as it was meant


def test_saving_over_a_file_keeps_what_else_it_says(presets, put):
    path = put(
        "mine",
        '# my own\nversion = 1\nprogram = 40\nabout = "wild" # yes\n\n[values]\n'
        '"/playing/bend" = 1\n"/playing/vibrato" = 10 # cents\n"/playing/new" = 3\n'
        '"/playing/attack" = 40 # ms\n',
    )
    presets.save("mine", DEFAULTS | {"/playing/vibrato": 20.0})
    text = path.read_text(encoding="utf-8")
    for line in (
        "# my own",
        'about = "wild" # yes',
        "= 20.0 # cents",
        '"/playing/attack" = 40 # ms',
    ):
        assert line in text
    preset = presets.load("mine")
    assert (preset.program, preset.about, preset.unknown) == (40, "wild", ("/playing/new",))
    assert preset.values["/playing/bend"] == 1.0


def test_a_file_that_cannot_be_read_is_not_written_over(presets, put):
    for text in ("version = 2\n", "version = 1\n[values\n", "version = 1\nx = 1\n"):
        path = put("mine", text)
        with pytest.raises(PresetError, match="mine:"):
            presets.save("mine", DEFAULTS)
        assert path.read_text(encoding="utf-8") == text


@pytest.mark.parametrize(("of", "failing"), [(os, "fsync"), (Path, "replace")])
def test_a_file_is_whole_when_writing_fails(presets, monkeypatch, of, failing):
    presets.save("mine", DEFAULTS)
    before = (presets.own / "mine.toml").read_bytes()

    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(of, failing, fail)
    with pytest.raises(OutputError, match="no space left"):
        presets.save("mine", DEFAULTS | {"/playing/vibrato": 20.0})
    assert [file.name for file in presets.own.iterdir()] == ["mine.toml"]
    assert (presets.own / "mine.toml").read_bytes() == before


def test_a_new_file_is_whole_or_not_there_when_the_process_is_killed(presets):
    presets.own.mkdir(parents=True)
    if (process := os.fork()) == 0:
        Path.replace = lambda *_: os._exit(0)
        Path.unlink = lambda *_, **__: os._exit(0)
        presets.save("mine", DEFAULTS)
    os.waitpid(process, 0)
    assert presets.all()[1] == []


def test_a_preset_may_have_a_name_in_any_script(presets):
    for name in ("二胡 独奏", "ä", "椰胡_2", "Ёлка"):
        presets.save(name, DEFAULTS)
        assert name in presets.names()
        assert presets.load(name).values.keys() == set(SAVED)
        presets.delete(name)
    assert not list(presets.own.iterdir())


def test_no_name_leads_out_of_the_folder(subtests, presets, tmp_path):
    before = sorted(tmp_path.rglob("*"))
    for name in NAMES:
        for call in (presets.load, presets.delete, lambda name: presets.save(name, DEFAULTS)):
            with subtests.test(name), pytest.raises(PresetError, match="is not a plain name"):
                call(name)
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize("is_there", [True, False])
def test_no_link_leads_out_of_the_folder(presets, put, tmp_path, is_there):
    secret = tmp_path / "secret.toml"
    text = HEAD + '[values]\n"/playing/vibrato" = 10\n'
    if is_there:
        secret.write_text(text)
    put("good", HEAD)
    (presets.own / "mine.toml").symlink_to(secret)
    for call in (presets.load, presets.delete, lambda name: presets.save(name, DEFAULTS)):
        with pytest.raises(PresetError, match=r"mine\.toml is a link that leads out of"):
            call("mine")
    found, errors = presets.all()
    assert "mine" not in [preset.name for preset in found]
    assert ["is a link that leads out of" in str(error) for error in errors] == [True]
    assert secret.exists() == is_there
    assert not is_there or secret.read_text() == text
    assert (presets.own / "mine.toml").is_symlink()


def test_a_link_within_the_folder_and_a_folder_that_is_a_link_are_followed_but_no_ring(
    presets, put, tmp_path
):
    put("good", HEAD + '[values]\n"/playing/vibrato" = 10\n')
    (presets.own / "same.toml").symlink_to("good.toml")
    (tmp_path / "elsewhere").symlink_to(presets.own)
    for folder in (presets, Presets(tmp_path / "elsewhere")):
        assert folder.load("same").values == {"/playing/vibrato": 10.0}
        folder.save("same", DEFAULTS)
        put("good", HEAD + '[values]\n"/playing/vibrato" = 10\n')
    (presets.own / "a.toml").symlink_to("b.toml")
    (presets.own / "b.toml").symlink_to("a.toml")
    with pytest.raises(PresetError, match="a: "):
        presets.load("a")
    presets.save("a", DEFAULTS)  # which ends the ring
    presets.load("b")


def test_a_folder_holds_so_many_presets_and_of_more_the_first_are_listed(presets, put):
    for number in range(MAX_OWN):
        put(f"mine {number:03}", HEAD)
    with pytest.raises(PresetError, match=f"there are {MAX_OWN} presets of your own; delete one"):
        presets.save("one more", DEFAULTS)
    assert not (presets.own / "one more.toml").exists()
    presets.save("mine 007", DEFAULTS)  # an existing one
    presets.delete("mine 008")
    presets.save("mine 008", DEFAULTS)
    for number in range(MAX_OWN, MAX_OWN + 3):
        put(f"mine {number}", HEAD)
    found, errors = presets.all()
    assert len(found) == MAX_OWN + len(SHIPPED)
    assert [str(error) for error in errors] == [f"{presets.own}: 3 more than {MAX_OWN}, left out"]
    assert presets.load(f"mine {MAX_OWN + 2}").name == f"mine {MAX_OWN + 2}"
    with pytest.raises(PresetError) as refused:
        presets.load("x")
    assert str(refused.value).endswith(f" and {MAX_OWN + len(SHIPPED) - MAX_NAMED} more)")


def test_a_preset_of_ones_own_hides_a_shipped_one_until_it_is_deleted(presets, put):
    with pytest.raises(PresetError, match="save under another name"):
        presets.save("tremolo", DEFAULTS)
    with pytest.raises(PresetError, match="comes with the program"):
        presets.delete("tremolo")
    put("tremolo", HEAD + '[values]\n"/playing/tremolo" = 7\n')
    assert presets.load("tremolo").values == {"/playing/tremolo": 7.0}
    assert presets.names() == SHIPPED
    presets.save("tremolo", DEFAULTS)
    assert presets.load("tremolo").values["/playing/tremolo"] == 0.0
    presets.delete("tremolo")
    assert presets.load("tremolo").values["/playing/tremolo"] > 7.0
    assert presets.shipped.joinpath("tremolo.toml").exists()


def test_a_file_is_read_once_whether_it_is_right_or_not_and_again_when_it_has_changed(
    presets, put, monkeypatch
):
    path = put("mine", HEAD + '[values]\n"/playing/vibrato" = 10\n')
    put("bad", "version = 3\n")
    before, first = presets.all(), presets.load("mine")
    with monkeypatch.context() as patch:
        patch.setattr(folders, "read_text", None)
        again = presets.all()
        assert presets.load("mine") is first
    assert again[0] == before[0]
    assert [str(error) for error in again[1]] == [str(error) for error in before[1]]
    path.write_text(HEAD + '[values]\n"/playing/vibrato" = 20\n', encoding="utf-8")
    os.utime(path, ns=(1, 1))  # the clock of a file system may be coarse
    assert presets.load("mine").values == {"/playing/vibrato": 20.0}


def test_a_program_is_the_players_own_before_a_shipped_one(presets, put):
    assert presets.programs()[3].name == "flautando"
    assert 100 not in presets.programs()
    put("z mine", HEAD + "program = 3\n")
    put("zz mine", HEAD + "program = 3\n")
    assert presets.programs()[3].name == "z mine"


# ---------------------------------------------------------------- the player


@pytest.fixture
def instrument() -> Instrument:
    instrument = Instrument(InstrumentSpec(RATE))
    instrument.report_commands()
    return instrument


def live_player(instrument: Instrument, **playing) -> Player:
    return player_of(0, PlayingOptions(**playing), [instrument], delay_ms=3.0)


def test_a_load_sets_what_it_names_and_leaves_the_rest_and_what_is_held(instrument):
    live = live_player(instrument)
    live.set("/playing/variation", 0.7, frame=0)
    live.hold("/body/gain", 3.0)
    live.hold("/playing/tremolo", 20.0)
    loaded = {"/playing/vibrato": 20.0, "/output/gain": -6.0}
    live.load({**loaded, "/body/gain": -3.0, "/playing/tremolo": 5.0}, frame=0)
    kept = {"/playing/variation": 0.7, "/body/gain": 3.0, "/playing/tremolo": 20.0}
    assert {address: live.value(address) for address in POSSIBLE} == {
        address: param.default for address, param in POSSIBLE.items()
    } | kept | loaded


def test_all_of_a_load_is_heard_at_one_frame(instrument):
    live = live_player(instrument)
    live.key_on(74.0, 90.0, frame=0)
    run(instrument, 22050)
    instrument.applied_commands()
    moved = ("/bow/speed", "/bow/position", "/output/gain")
    before = [instrument.target(address) for address in moved]
    far = {p.address: p.from_unit(0.3) for p in POSSIBLE.values() if p.address != "/playing/bend"}
    live.load(far, frame=23000)
    run(instrument, 4410)
    commands = instrument.applied_commands()
    assert {int(command["frame"]) for command in commands} == {23000}
    assert len(commands) == len(far)
    after = [instrument.target(address) for address in moved]
    assert all(now != then for now, then in zip(after, before, strict=True))


def test_loading_while_a_note_sounds_makes_no_click(instrument):
    """No jump between samples is larger than those of either sound by itself."""
    presets = Presets(Path(os.devnull))
    live = live_player(instrument)
    live.set("/playing/variation", 0.0, frame=0)
    live.key_on(77.0, 64.0, frame=0)
    sounds = []
    for name in ("ordinary", "flautando", "sul-ponticello", "sul-tasto", "vibrato", "ordinary"):
        live.load(presets.load(name).values, frame=instrument.frame)
        sounds.append(np.abs(np.diff(run(instrument, 22050))))
    for before, after in itertools.pairwise(sounds):
        steady = max(before[11025:].max(), after[11025:].max())
        assert after[:4410].max() < 1.5 * steady


def test_what_velocity_moves_is_spread_around_what_was_put(player):
    midi = player.mapped(load("keyboard"))
    key = mido.Message("note_on", note=77, velocity=127)

    def pressed() -> float:
        midi.receive(key)
        midi.receive(key.copy(velocity=0))
        return player.value("/playing/pressure")

    usual = pressed()
    midi.load({"/playing/pressure": 0.2})
    assert pressed() == pytest.approx(0.5 * usual)
    assert midi.sound()["/playing/pressure"] == 0.2  # and so it is saved
    midi.load({"/playing/pressure": 0.4})
    assert pressed() == pytest.approx(usual)


def test_the_beginning_is_where_a_reset_leads_back_to(instrument):
    live = live_player(instrument, start=(("/playing/vibrato", 20.0),))
    assert live.value("/playing/vibrato") == 20.0
    live.set("/playing/vibrato", 5.0, frame=0)
    live.reset(frame=0)
    assert live.value("/playing/vibrato") == 20.0


# ---------------------------------------------------------------- program changes


def change(live: Player, program: int, channel: int = 1) -> None:
    message = mido.Message("program_change", program=program - 1, channel=channel - 1)
    receive(live, message, frame=0, port=0)


def test_a_program_that_is_written_while_it_plays_is_known_soon(instrument, presets, monkeypatch):
    live = live_player(instrument, presets=presets, programs=True)
    monkeypatch.setattr(live, "frame_of", lambda: 0)
    change(live, 100)
    assert live.value("/playing/tremolo") == 0.0
    presets.own.mkdir(parents=True, exist_ok=True)
    text = 'version = 1\nprogram = 100\n[values]\n"/playing/tremolo" = 7.0\n'
    (presets.own / "mine.toml").write_text(text)
    live.know_programs()  # as the server does once a second
    change(live, 100)
    assert live.value("/playing/tremolo") == 7.0


def test_a_program_change_selects_a_preset_where_it_may(instrument, presets):
    live = live_player(instrument, presets=presets)
    for program in range(1, 129):
        change(live, program)
    assert live.values() == DEFAULTS
    live = live_player(instrument, presets=presets, programs=True)
    change(live, 6)
    assert live.value("/playing/tremolo") > 0.0
    change(live, 1, channel=16)
    assert live.value("/playing/tremolo") == 0.0
    change(live, 6, channel=10)  # percussion
    assert live.value("/playing/tremolo") == 0.0


def test_other_banks_are_not_ours(instrument, presets):
    live = live_player(instrument, presets=presets, programs=True)
    for control in (0, 32):
        for value, is_ours in ((1, False), (0, True)):
            message = mido.Message("control_change", control=control, value=value)
            receive(live, message, frame=0, port=0)
            change(live, 6)
            assert (live.value("/playing/tremolo") > 0.0) == is_ours
            change(live, 2, channel=2)  # another channel, another bank
            assert live.value("/playing/vibrato") > 0.0
            live.reset(frame=0)


def test_an_unknown_program_is_ignored_and_counted(instrument, presets):
    live = live_player(instrument, presets=presets, programs=True)
    for _ in range(3):
        change(live, 41)
    assert (live.values(), live.unknown_programs) == (DEFAULTS, {41: 3})


# ---------------------------------------------------------------- how they sound


def heard(name: str, note: int, seconds: float = 0.5) -> np.ndarray:
    values = Presets(Path(os.devnull)).load(name).values | {"/playing/variation": 0.0}
    playing = PlayingOptions(start=tuple(values.items()))
    instrument = Instrument(playing.spec(RATE, calibration_for(RATE)))
    midi = playing.mapped(playing.player(instrument))
    midi.receive(mido.Message("note_on", note=note, velocity=64), frame=0)
    return run(instrument, round(RATE * seconds)).astype(np.float64)


@pytest.mark.parametrize("name", [name for name in SHIPPED if name != "scratch"])
def test_a_shipped_preset_speaks_in_tune(name):
    part = slice(2205, 11025) if name == "pizzicato" else slice(8820, None)
    for note in (74, 77, 84):
        sound = heard(name, note)
        pitch = pitch_of(sound[part], RATE, 0.4 * hertz(note))
        assert abs(cents(pitch, hertz(note))) < 12.0, note
        assert np.abs(sound).max() > 0.01, note
