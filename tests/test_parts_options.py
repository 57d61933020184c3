"""Options of serve for several parts."""

from yehu_server import cli
from yehu_server.cli.config import parse
from yehu_server.cli.part_options import MAX
from yehu_server.cli.serve_options import options_of
from yehu_server.core.engine.rig import MAX_PARTS
from yehu_server.live.midi.routes import Route
from yehu_server.playing import mapping_file
from yehu_server.playing.mapping import load, shipped_mappings
from yehu_server.playing.stringing import notes_of
from yehu_server.util.files import shipped_folder


def served(*words: str):
    return options_of(parse(["serve", *words], cli._parser()))


def test_there_are_as_many_parts_as_a_stage_has_room_for():
    assert MAX == mapping_file.MAX_PARTS == MAX_PARTS
    assert len(served("--parts", "16").parts) == 16


def test_by_default_one_plays_in_a_room():
    options = served()
    assert len(options.parts) == 1
    assert options.has_room
    assert options.midi.routes == []
    assert not served("--dry").has_room


def test_the_room_has_a_name_and_is_of_all_parts(refused):
    words = ("--room", "hall", "--parts", "2", "--part-preset", "2=flautando")
    first, second = (dict(part.playing.start) for part in served(*words).parts)
    assert first["/room/size"] == second["/room/size"] == 25.0
    assert second["/body/gain"] == 6.0
    assert "chamber, courtyard" in refused("serve", "--room", "church")
    assert "leave out --room" in refused("serve", "--room", "hall", "--dry")


def test_a_scale_on_keys_in_a_row_names_the_keyboard_map(capsys):
    served("--tuning", "chaozhou-seven-equal")
    assert "--keyboard-map says which key" in capsys.readouterr().err
    served("--tuning", "chaozhou-seven-equal", "--keyboard-map", "chaozhou-keys")
    assert capsys.readouterr().err == ""


def test_live_playing_begins_with_a_vibrato_unless_a_mapping_is_chosen():
    """Each mapping has its own way to a vibrato."""

    def vibrato(*words: str) -> float:
        playing = served(*words).parts[0].playing
        return {**dict(playing.mapping.start), **dict(playing.start)}.get("/playing/vibrato", 0.0)

    assert vibrato() > 20.0
    still = ("--mapping", "keyboard"), ("--mapping", "wind"), ("--mpe",), ("--preset", "ordinary")
    assert [vibrato(*words) for words in still] == [0.0] * 4
    for name in shipped_mappings():
        assert "/playing/vibrato" in {bind.target for bind in load(name).binds}, name


def test_each_part_has_its_own_mapping_preset_and_settings():
    options = served(
        *("--parts", "3", "--mapping", "wind", "--preset", "flautando"),
        *("--set", "/playing/volume=0.5", "--part-set", "3=/room/pan=-0.25"),
        *("--part-mapping", "2=mpe"),
    )
    first, second, third = (part.playing for part in options.parts)
    assert [playing.mapping.name for playing in (first, second, third)] == ["wind", "mpe", "wind"]
    assert second.mapping.mpe
    assert first.start == second.start == third.start != ()
    volume = ("/playing/volume", 0.5)
    assert first.settings == second.settings == (volume,)
    assert third.settings == (volume, ("/room/pan", -0.25))


def test_a_part_with_a_mapping_of_its_own_is_not_asked_for_mpe():
    options = served("--parts", "2", "--mpe", "--part-mapping", "2=wind")
    assert [part.playing.mapping.mpe for part in options.parts] == [True, False]


def test_each_part_has_its_own_instrument():
    erhu, ideal = (
        str(shipped_folder("examples") / f"{name}.toml") for name in ("erhu", "ideal_string")
    )
    parts = served("--parts", "3", "--instrument", erhu, "--part-instrument", "2=" + ideal).parts
    notes = [notes_of(part.playing.quantities).ends for part in parts]
    assert notes == [(62, 93), (65, 89), (62, 93)]
    assert [str(part.playing.instrument) for part in parts] == [erhu, ideal, erhu]


def test_a_file_has_the_parts_too(tmp_path):
    path = tmp_path / "serve.toml"
    path.write_text(
        "parts = 2\npart-mapping = { 2 = 'mpe' }\npart-set = ['2=/room/pan=0.5']\n"
        "[part]\n1 = 'keystep'\n2 = 'seaboard'\n"
    )
    options = served("--config", str(path))
    assert options.midi.routes == [Route(0, "keystep"), Route(1, "seaboard")]
    assert options.parts[1].playing.mapping.name == "mpe"
    assert options.parts[1].playing.settings == (("/room/pan", 0.5),)


def test_what_parts_cannot_have_is_one_line(subtests, refused):
    for words, reason in [
        (["--parts", "17"], "17 parts: a stage has 1 to 16"),
        (["--parts", "0"], "0 parts"),
        (["--parts", "many"], "many"),
        (["--part", "keystep"], "'keystep': expected N=..."),
        (["--part", "1="], "expected N=..."),
        (["--part", "x=keys"], "expected N=..."),
        (["--part", "2=keys"], "--part 2=keys: no part 2: there is only part 1"),
        (["--parts", "3", "--part", "4=keys"], "no part 4: there are parts 1 to 3"),
        (["--parts", "3", "--part", "0=keys"], "no part 0: there are parts 1 to 3"),
        (["--parts", "2", "--part", "1=keys:17"], "a MIDI channel is 1 to 16"),
        (["--parts", "2", "--part", "1=keys", "--part", "2=keys"], "named twice (1=keys)"),
        (["--parts", "2", "--part-mapping", "3=wind"], "--part-mapping 3=wind: no part 3"),
        (["--parts", "2", "--part-preset", "3=x"], "--part-preset 3=x: no part 3"),
        (["--parts", "2", "--part-instrument", "2=none.toml"], "none.toml: "),
        (["--parts", "2", "--part-set", "3=/room/pan=0"], "no part 3"),
        (["--parts", "2", "--part-mapping", "2=nothing"], "part 2: no mapping 'nothing'"),
        (["--parts", "2", "--part-preset", "2=nothing"], "part 2: no preset 'nothing'"),
        (["--parts", "2", "--part-set", "2=/room/size=9"], "one for all parts: /yehu/room/size"),
        (["--parts", "2", "--part-set", "2=/room/pan=9"], "9 is not within -1 to 1"),
        (["--parts", "2", *["--part-mapping", "2=wind"] * 2], "part 2 has two"),
        (
            ["--parts", "2", "--part-mapping", "2=mpe", "--part", "2=keys:3"],
            "--part 2=keys:3: MPE takes all channels",
        ),
        (["--parts", "9", "--set", "/playing/section=2"], "18 players"),
    ]:
        with subtests.test(reason):
            assert reason in refused("serve", *words)
