"""``yehu-server render --ensemble``: each channel or track a yehu, and the stems of the mix."""

import json
from pathlib import Path
from types import SimpleNamespace

import mido
import numpy as np
import pytest
import soundfile
from fiddles import SLACK_TOML
from midi_files import midi_file, notes
from pitch import cents, hertz, pitch_of

from yehu_server.cli import _parser
from yehu_server.cli.ensemble_parts import players_of
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.stringing import notes_of
from yehu_server.rendering import cores
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance
from yehu_server.rendering.to_files import write_scaled
from yehu_server.scores.reading import ReadOptions, part_of, read_any
from yehu_server.scores.score import Score
from yehu_server.scores.smf.reader import read_score
from yehu_server.util.files import shipped_folder

QUIET = ("--gain-db", -20, "--tail", 0.5)  # the limiter does nothing
FLOAT = ("--subtype", "float")


def line(channel: int, first: int) -> list[tuple[float, mido.Message]]:
    """A few notes on a channel."""
    return notes(*((0.25 * n, 0.22, first + n, 70 + 9 * n) for n in range(4)), channel=channel)


def tracks_file(path: Path, *tracks: list[tuple[float, mido.Message]]) -> Path:
    """Write a file of several tracks."""
    file = mido.MidiFile(type=1, ticks_per_beat=500)
    for messages in tracks:
        track, now = file.add_track(), 0
        for time, message in sorted(messages, key=lambda pair: pair[0]):
            track.append(message.copy(time=round(1000 * time) - now))
            now = round(1000 * time)
    file.save(path)
    return path


@pytest.fixture
def trio(tmp_path) -> Path:
    messages = [*line(1, 67), *line(2, 72), *line(5, 76), *line(10, 66)]
    return midi_file(tmp_path / "trio.mid", messages)


@pytest.fixture
def play(command, tmp_path):
    """Render with `--json`; return the summary, the samples, and those of the stems."""

    def run(*words: object) -> tuple[dict, np.ndarray, list[np.ndarray]]:
        target = tmp_path / "out.wav"
        code, out, err = command("render", *words, "-o", target, *FLOAT, "--json")
        assert code == 0, err
        summary = json.loads(out)
        return summary, read(target), [read(Path(stem)) for stem in summary["stems"]]

    return run


def read(path: Path) -> np.ndarray:
    return soundfile.read(path, dtype="float32")[0]


def test_each_channel_but_percussion_is_a_yehu_with_a_place_and_chance_of_its_own(play, trio):
    summary, _, _ = play(trio, "--ensemble")
    parts = summary["parts"]
    assert [part["name"] for part in parts] == ["channel 1", "channel 2", "channel 5"]
    assert [part["channels"] for part in parts] == [{"1": 4}, {"2": 4}, {"5": 4}]
    assert [part["seed"] for part in parts] == [0, 1, 2]
    assert [part["gain_db"] for part in parts] == pytest.approx(3 * [-4.77], abs=0.01)
    pans = [part["pan"] for part in parts]
    assert pans[0] < 0.0 == pans[1] < pans[2]
    assert (summary["notes_played"], summary["percussion_notes"]) == (12, 4)
    assert summary["lost_states"] == 0


def test_tracks_that_sound_together_on_one_channel_are_a_yehu_each(play, tmp_path):
    drums = notes((0.0, 0.1, 36, 99), (0.5, 0.1, 38, 99), channel=10)
    shared = tracks_file(tmp_path / "shared.mid", line(1, 67), line(1, 72), drums)
    summary, _, _ = play(shared, "--ensemble", "--tail", 0)
    assert [part["channels"] for part in summary["parts"]] == [{"1": 4}, {"1": 4}]
    assert summary["percussion_notes"] == 2
    summary, _, _ = play(shared, "--ensemble", "--by", "track", "--channel", 10, "--tail", 0)
    assert [part["channels"] for part in summary["parts"]] == [{"10": 2}]
    turns = tracks_file(tmp_path / "turns.mid", line(1, 67), [(t + 2, m) for t, m in line(1, 72)])
    summary, _, _ = play(turns, "--ensemble", "--tail", 0)
    assert [part["channels"] for part in summary["parts"]] == [{"1": 8}]


def test_the_report_has_a_line_for_each_part(command, trio, tmp_path):
    code, out, _ = command("render", trio, "-o", tmp_path / "out.wav", "--ensemble")
    assert code == 0
    lines = out.splitlines()
    assert lines[2] == "channel 2: 4 notes, middle, 3.5 m"
    assert lines[3].startswith("channel 5: 4 notes, ")
    assert lines[4] == "channel 10 is percussion: 4 notes not played; --channel 10 plays them"


@pytest.mark.parametrize("words", [("--normalize", "--mono"), ("--dry",), ("--loudness", -28)])
def test_the_mix_is_the_sum_of_its_stems(play, trio, tmp_path, words):
    summary, mix, stems = play(
        trio, "--ensemble", "--stems", tmp_path / "stems", "--tail", 0, *words
    )
    assert len(stems) == 3 + ("--dry" not in words)
    assert np.abs(mix).max() > 0.1
    np.testing.assert_allclose(np.sum(stems, axis=0), mix, atol=1e-6)
    if "--normalize" in words:
        # The true peak is at -1 dB: samples are no higher.
        assert np.abs(mix).max() == pytest.approx(10.0 ** (-1.0 / 20.0), abs=0.01)
    if "--loudness" in words:
        assert summary["loudness_lufs"] == pytest.approx(-28.0, abs=0.05)
    names = [Path(stem).name for stem in summary["stems"]]
    assert names[1] == "02-channel-2.wav"


def test_a_stem_that_is_louder_than_the_mix_is_not_clipped(tmp_path):
    written = [[], []]
    files = [SimpleNamespace(write=each.append) for each in written]
    takes = [[np.full(64, 0.2, np.float32), np.full(64, 1.5, np.float32)]]
    factor = write_scaled(
        takes, files, tmp_path, lambda peak: Options(normalize=True).factor(peak, None)
    )
    mix, room = map(np.concatenate, written)
    assert 0.75 < room.max() < 0.9
    assert mix.max() == pytest.approx(0.2 * factor)


def test_a_part_sounds_as_it_does_alone_with_its_seed(play, trio, tmp_path):
    (tmp_path / "middle.toml").write_text(
        "[[part]]\nchannel = 1\n[[part]]\nchannel = 2\npan = 0.0\nseed = 7\n", encoding="utf-8"
    )
    ensemble = ("--ensemble", tmp_path / "middle.toml", "--stems", tmp_path / "stems")
    _, _, stems = play(trio, *ensemble, *QUIET, "--dry", "--tail", 0.5)
    _, alone, _ = play(trio, "--channel", 2, "--seed", 7, *QUIET, "--dry", "--tail", 0.5)
    assert np.abs(alone).max() > 0.005
    np.testing.assert_array_equal(stems[1], alone)


@pytest.fixture
def parts(trio) -> list[Part]:
    score = read_score(trio)
    return [
        Part(part_of(score, channel), playing=PlayingOptions(seed=channel)) for channel in (0, 1, 4)
    ]


def test_any_number_of_cores_and_any_block_give_the_samples_of_the_callback(parts):
    def sound(**how: object) -> np.ndarray:
        return np.concatenate([*Performance(parts, Options(tail_s=0.3, **how)).blocks()])

    in_callback = sound(jobs=1)
    by_cores = [sound(jobs=1, block=500), sound(jobs=2), sound(jobs=3, block=2500)]
    assert np.abs(in_callback).max() > 0.1
    for samples in by_cores:
        np.testing.assert_array_equal(samples, in_callback)


def test_a_block_whose_events_are_taken_in_piece_by_piece_gives_the_same_samples(
    parts, monkeypatch
):
    def sound() -> tuple[np.ndarray, np.ndarray]:
        performance = Performance(parts, Options(tail_s=0.0, jobs=2), has_stems=True)
        pairs = [(mix, performance.stems[0].copy()) for mix in performance.blocks()]
        mix, stem = map(np.concatenate, zip(*pairs, strict=True))
        return mix, stem

    whole = sound()
    at = [0]
    take_in = cores.interpret_events.call

    def some(address: int, end: int) -> int:
        """As where many events fall into a block."""
        at[0] = take_in(address, min(end, at[0] + 700))
        return at[0]

    monkeypatch.setattr(cores, "interpret_events", SimpleNamespace(call=some))
    for one, other in zip(whole, sound(), strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_section_is_one_part_with_one_stem(play, trio, tmp_path):
    (tmp_path / "two.toml").write_text(
        "[[part]]\nchannel = 1\nsection = 3\n[[part]]\nchannel = 2\n", encoding="utf-8"
    )
    words = ("--ensemble", tmp_path / "two.toml", "--stems", tmp_path / "stems", *QUIET)
    summary, mix, stems = play(trio, *words)
    assert [part["people"] for part in summary["parts"]] == [3, 1]
    assert [part["notes_played"] for part in summary["parts"]] == [4, 4]
    assert len(stems) == 3
    np.testing.assert_allclose(np.sum(stems, axis=0), mix, atol=1e-6)
    # It is not the sound of its first player, three times.
    _, _, (first, *_) = play(trio, "--channel", 1, *QUIET, "--stems", tmp_path / "one", "--tail", 1)
    assert not np.allclose(stems[0][:20000], first[:20000], atol=1e-3)


# ---------------------------------------------------------------- tracks


def test_by_track_each_track_with_notes_is_a_part_whatever_its_channel(play, tmp_path):
    score = tracks_file(tmp_path / "two.mid", [], line(1, 67), line(10, 40), line(1, 74))
    summary, _, _ = play(score, "--ensemble", "--by", "track")
    assert [part["name"] for part in summary["parts"]] == ["track 2", "track 4"]
    assert [part["notes_played"] for part in summary["parts"]] == [4, 4]
    assert len(play(score, "--ensemble", "--by", "channel")[0]["parts"]) == 1


def test_more_tracks_than_a_stage_has_room_for_are_refused(refused, tmp_path):
    many = tracks_file(tmp_path / "many.mid", *(line(1 + n % 9, 67) for n in range(17)))
    words = ("render", many, "-o", tmp_path / "out.wav", "--ensemble", "--by", "track")
    assert "17 tracks have notes: a stage has room for 16 parts" in refused(*words)


# ---------------------------------------------------------------- ensemble files

FILE = """\
[room]
size = 12.0
decay = 1.0

[[part]]
name = "low / inner"
channel = 2
pan = -0.25
distance = 3.0
gain = -3.0
seed = 5
preset = "pizzicato"
mapping = "wide.toml"
instrument = "slack.toml"
set = { "/playing/variation" = 0.0 }

[[part]]
channel = 5
"""


def test_an_ensemble_file_says_who_plays_what_where_and_on_which_instrument(play, trio, tmp_path):
    (tmp_path / "band.toml").write_text(FILE, encoding="utf-8")
    (tmp_path / "wide.toml").write_text('base = "wind"\nname = "wide"\n', encoding="utf-8")
    (tmp_path / "slack.toml").write_text(SLACK_TOML, encoding="utf-8")
    words = ("--ensemble", tmp_path / "band.toml", "--stems", tmp_path / "stems")
    summary, _, _ = play(trio, *words, "--gain-db", 0)
    low, other = summary["parts"]
    told = [low[name] for name in ("name", "pan", "distance_m", "gain_db", "seed", "mapping")]
    assert told == ["low / inner", -0.25, 3.0, -3.0, 5, "wide"]
    assert low["preset"].endswith("pizzicato.toml")
    assert (other["name"], other["seed"], other["distance_m"]) == ("channel 5", 1, 3.5)
    assert Path(summary["stems"][0]).name == "01-low---inner.wav"


def test_each_part_is_moved_into_the_range_of_its_own_instrument(tmp_path):
    tune = midi_file(tmp_path / "low.mid", [*line(1, 62), *line(2, 62)])
    band = tmp_path / "band.toml"
    erhu = shipped_folder("examples") / "erhu.toml"
    band.write_text(f'[[part]]\nchannel = 1\n[[part]]\nchannel = 2\ninstrument = "{erhu}"\n')
    words = ("render", tune, "-o", tmp_path / "out.wav", "--ensemble", band)
    arguments = _parser().parse_args([*map(str, words)])

    def scores_for(quantities: Quantities | None, _key_switches: int | None) -> list[Score]:
        is_moved, within = quantities is not None, notes_of(quantities or Quantities())
        return [read_any(tune, ReadOptions(all_parts=True, in_range=is_moved, within=within))]

    players = players_of(arguments, scores_for, PlayingOptions())
    keys = [
        [each.message.note for each in part.score.events if each.message.type == "note_on"]
        for part in players.parts
    ]
    assert keys == [[74, 75, 76, 77], [62, 63, 64, 65]]


def test_a_low_fiddle_plays_the_bass_of_a_quartet_where_it_is_written(command, tmp_path):
    """Its example has the cello on a low fiddle; the others are yehus, and move as a whole."""
    lines = {1: 72, 2: 67, 3: 55, 4: 40}
    score = midi_file(tmp_path / "q.mid", [note for each in lines.items() for note in line(*each)])
    band = shipped_folder("examples") / "quartet.toml"
    words = ("render", score, "-o", tmp_path / "out.wav", "--ensemble", band, "--tail", 0.5)
    code, _, err = command(*words, "--stems", tmp_path)
    assert code == 0, err
    moves = [each for each in err.splitlines() if "moved to fit" in each]
    assert moves == ["yehu-server: q: moved to fit F4 to F6: viola an octave up"]
    stem = read(next(tmp_path.glob("04-*.wav")))
    sound = stem[: round(0.22 * 44100)].sum(axis=1)[4410:]
    assert abs(cents(pitch_of(sound, 44100.0), hertz(40))) < 30.0
    code, _, err = command(*words[:4], "--ensemble", "--overwrite", "--tail", 0.5)
    assert code == 0
    assert "channel 4 three octaves up (a deeper fiddle for channel 4: docs/ensemble.md)" in err


def test_keys_are_switches_where_the_mapping_of_a_part_has_them(command, tmp_path):
    low = notes((0.1, 0.2, 64, 80), (0.3, 0.2, 62, 80), channel=2)
    score = [*line(1, 74), *notes((0.0, 0.05, 36, 80), channel=2), *low]
    tune = midi_file(tmp_path / "low.mid", score)
    (tmp_path / "band.toml").write_text(
        '[[part]]\nchannel = 1\n[[part]]\nchannel = 2\nmapping = "keyboard-articulations"\n'
    )
    sounds = []
    for words in ((tmp_path / "band.toml",), ("--mapping", "keyboard-articulations")):
        target = ("-o", tmp_path / "out.wav", "--overwrite", "--dry", "--tail", 0)
        code, out, err = command("render", tune, *target, "--ensemble", *words)
        assert code == 0, err
        assert "channel 2: 2 notes" in out
        assert err.endswith("low: moved to fit F4 to F6: channel 2 an octave up\n")
        sounds.append(read(tmp_path / "out.wav"))
    np.testing.assert_array_equal(*sounds)


def test_what_an_ensemble_file_names_must_be_there(refused, trio, tmp_path):
    for text, error in (
        ("[[part]]\nchannel = 3\n", "band.toml:1: channel 3 has no notes in the score"),
        ('[[part]]\nchannel = 1\n\n[[part]]\nchannel = 2\npreset = "no"\n', ":4: no preset 'no'"),
        ('[[part]]\nchannel = 1\nmapping = "no"\n', ":1: "),
        ('[[part]]\nchannel = 1\ninstrument = "no.toml"\n', ":1: "),
        (
            'room = "pizzicato"\n[[part]]\nchannel = 1\n',
            "band.toml:1: pizzicato: not a room (it sets ",
        ),
    ):
        (tmp_path / "band.toml").write_text(text, encoding="utf-8")
        words = ("render", trio, "-o", tmp_path / "out.wav", "--ensemble", tmp_path / "band.toml")
        assert error in refused(*words)
        assert not (tmp_path / "out.wav").exists()


def test_options_that_do_not_fit_are_refused(refused, trio, tmp_path):
    for words, error in (
        ("--by track", "--by track is for --ensemble"),
        ("--ensemble band.toml --by track", "names channels and tracks itself"),
        ("--ensemble other.mid", "name MIDI files before --ensemble"),
        ("--ensemble missing.toml", "missing.toml: no such file"),
        ("--ensemble --set /playing/section=6", "18 players, of all parts and sections: at most"),
    ):
        assert error in refused("render", trio, "-o", tmp_path / "out.wav", *words.split())


def test_stems_replace_no_file_that_was_not_rendered_and_not_the_mix(refused, trio, tmp_path):
    stems = tmp_path / "stems"
    stems.mkdir()
    (stems / "room.wav").write_bytes(b"something of mine")
    words = ("render", trio, "-o", tmp_path / "out.wav", "--ensemble", "--stems", stems)
    assert "room.wav: exists; --overwrite" in refused(*words)
    assert [each.name for each in stems.iterdir()] == ["room.wav"]
    words = ("render", trio, "-o", tmp_path / "room.wav", "--ensemble", "--stems", tmp_path)
    assert "-o and stem room.wav would write to the same file" in refused(*words)
