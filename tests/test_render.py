"""``yehu-server render``: MIDI files to sound files, read back.

Here the instrument is alone: one channel, no room. The stage is in test_render_stage.py.
"""

import json
import math
from pathlib import Path

import mido
import numpy as np
import pytest
import soundfile
from fiddles import SLACK, SLACK_RANGE, SLACK_TOML
from midi_files import midi_file, notes
from pitch import cents, hertz, pitch_of
from sound import rms

from yehu_server.core.engine.limiter import limit
from yehu_server.playing.options import PlayingOptions
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance
from yehu_server.rendering.summary import limited_db
from yehu_server.rendering.to_files import render
from yehu_server.scores.score import Score, concatenate
from yehu_server.scores.smf.reader import read_score
from yehu_server.util.loudness import IntegratedLoudness

ROOT = Path(__file__).resolve().parents[1]
TUNE = ROOT / "examples" / "shi_bei_jiu.mid"
STEP = {"16": 2.0**-15, "24": 2.0**-23, "float": 2.0**-23}
QUIET = 1e-4  # 80 dB under full scale

SCORE_S = 0.75
PHRASE = (  # start and length in s, note, velocity
    (0.0, 0.3, 66, 40),
    (0.25, 0.2, 69, 100),
    (0.5, 0.25, 76, 80),
)


def cc(time: float, control: int, value: int, channel: int = 1) -> tuple[float, mido.Message]:
    return time, mido.Message("control_change", control=control, value=value, channel=channel - 1)


@pytest.fixture
def midi(tmp_path):
    """Write messages at their times (s) to a MIDI file."""
    return lambda *messages, name="tune.mid": midi_file(tmp_path / name, messages)


@pytest.fixture
def phrase(midi) -> Path:
    bends = [(0.1 * n, mido.Message("pitchwheel", pitch=1000 * n)) for n in range(1, 7)]
    return midi(*notes(*PHRASE), *bends, cc(0.1, 1, 90), cc(0.2, 11, 100), cc(0.55, 64, 127))


@pytest.fixture
def play(command, tmp_path):
    """Render with `--json`, dry and mono; return the summary and the samples of the file."""

    def run(*words: object, target: str = "out.wav") -> tuple[dict, np.ndarray]:
        path = tmp_path / target
        code, out, err = command("render", *words, "-o", path, "--dry", "--mono", "--json")
        assert code == 0, err
        return json.loads(out), soundfile.read(path)[0]

    return run


def samples(path: Path, **options) -> np.ndarray:
    """The sound of a score, before it is written to a file."""
    own = {name: options.pop(name) for name in ("seed", "settings") if name in options}
    return played(read_score(path), PlayingOptions(**own), **options)


def played(score: Score, playing: PlayingOptions, **options) -> np.ndarray:
    how = Options(is_dry=True, is_mono=True, **options)
    return np.concatenate(list(Performance([Part(score, playing)], how).blocks()))


# ---------------------------------------------------------------- the tune that ships


def test_shi_bei_jiu_is_played_from_its_first_note_to_its_last(play):
    summary, sound = play(TUNE)
    assert summary["notes_played"] == 198
    assert summary["notes_out_of_range"] == 0
    assert summary["unconverged_solves"] == 0
    assert summary["lost_states"] == 0
    assert summary["channels"] == {"1": 198}
    assert 27.0 < summary["duration_s"] < 33.0
    assert rms(sound) > 0.01
    assert np.abs(sound).max() <= 1.0
    # No second of it is silent, before its tail.
    seconds = sound[: 27 * 44100].reshape(27, 44100)
    assert all(rms(second) > 0.003 for second in seconds)


# ---------------------------------------------------------------- the summary


MATRIX = [("wav", "16"), ("wav", "24"), ("wav", "float"), ("flac", "16"), ("flac", "24")]


@pytest.mark.parametrize(("kind", "subtype"), MATRIX)
def test_the_summary_says_what_the_file_holds_which_is_the_same_the_next_time(
    play, tmp_path, phrase, kind, subtype
):
    words = (phrase, "--tail", 0, "--format", kind, "--subtype", subtype, "--rate", 48000)
    summary, sound = play(*words, target="once")
    info = soundfile.info(tmp_path / "once")
    assert info.format == kind.upper()
    assert info.subtype == {"16": "PCM_16", "24": "PCM_24", "float": "FLOAT"}[subtype]
    assert (info.samplerate, info.channels) == (48000, 1)
    assert summary["duration_s"] == info.frames / 48000
    assert summary["peak"] == pytest.approx(np.abs(sound).max(), abs=STEP[subtype])
    assert summary["rms"] == pytest.approx(rms(sound), abs=STEP[subtype])
    assert summary["rms"] > 0.01
    assert summary["real_time_factor"] > 0.0
    counts = ("notes_played", "notes_out_of_range", "unconverged_solves", "lost_states")
    assert [summary[name] for name in counts] == [3, 0, 0, 0]
    np.testing.assert_array_equal(play(*words, target="twice")[1], sound)
    if subtype != "float":  # such a header holds a time stamp
        assert (tmp_path / "once").read_bytes() == (tmp_path / "twice").read_bytes()


def test_the_format_is_asked_for_or_goes_by_the_ending(play, tmp_path, midi):
    tune = midi(*notes((0, 0.1, 70, 64)))
    for target, words, kind in [
        ("a.wav", (), "WAV"),
        ("a.FLAC", (), "FLAC"),
        ("a", (), "WAV"),
        ("a.flac", ("--format", "wav"), "WAV"),
        ("b.wav", ("--format", "flac"), "FLAC"),
    ]:
        play(tune, "--tail", 0, *words, target=target)
        info = soundfile.info(tmp_path / target)
        assert (info.format, info.subtype, info.samplerate) == (kind, "PCM_24", 44100), target


# ---------------------------------------------------------------- what is heard, and what is not


def test_the_seed_changes_the_performance_and_only_by_its_chance(play, phrase):
    _, usual = play(phrase)
    np.testing.assert_array_equal(play(phrase, "--seed", 0)[1], usual)
    assert not np.array_equal(play(phrase, "--seed", 1)[1][:10_000], usual[:10_000])
    still = ("--set", "/playing/variation=0")
    one, other = (play(phrase, *still, "--seed", seed)[1] for seed in (0, 1))
    np.testing.assert_array_equal(one, other)


# ---------------------------------------------------------------- levels


@pytest.mark.parametrize(("subtype", "gain_db"), [("float", 24), ("16", -30)])
def test_normalize_puts_the_true_peak_at_minus_1_dbfs(play, phrase, subtype, gain_db):
    words = ("--tail", 0, "--normalize", "--subtype", subtype, "--gain-db", gain_db)
    summary, sound = play(phrase, *words)
    # An interpolation of our own, by a spectrum without what is above half the rate.
    between = 8.0 * np.fft.irfft(np.fft.rfft(sound), 8 * len(sound))
    assert 20.0 * math.log10(np.abs(between).max()) == pytest.approx(-1.0, abs=0.15)
    assert summary["peak"] == pytest.approx(np.abs(sound).max(), abs=STEP[subtype])
    assert summary["rms"] == pytest.approx(rms(sound), abs=STEP[subtype])


def test_a_loudness_is_reached_as_far_as_the_true_peak_allows_and_the_rest_is_said(
    command, play, phrase, tmp_path
):
    words = ("--tail", 0, "--subtype", "float")
    _, sound = play(phrase, *words, "--loudness", -33, "--gain-db", 3)
    meter = IntegratedLoudness(44100)
    meter.add(sound)
    assert meter.lufs() == pytest.approx(-33.0, abs=0.01)
    normal, highest = play(phrase, *words, "--normalize")
    found, sound = play(phrase, *words, "--loudness", -2)
    np.testing.assert_array_equal(sound, highest)
    assert found["asked_lufs"] == -2.0
    render_words = ("render", phrase, "-o", tmp_path / "a.wav", "--dry", "--mono", *words)
    said = f"{-2.0 - normal['loudness_lufs']:.1f} LU quieter than asked for"
    assert said in command(*render_words, "--loudness", -2)[1]
    assert "quieter" not in command(*render_words, "--loudness", -33)[1]
    code, _, error = command(*render_words, "--loudness", -16, "--normalize")
    assert code == 2
    assert "--loudness" in error


def test_silence_has_no_loudness_to_reach(play, midi):
    found, sound = play(midi(*notes((0, 0.1, 70, 64))), "--tail", 0, "--loudness", -16)
    assert found["loudness_lufs"] is None  # 0.4 s at most
    assert 0.0 < np.abs(sound).max() < 0.8


def test_a_peak_that_the_limiter_lowers_is_said(command, midi, tmp_path):
    assert limited_db(limit(1.5, 0.7), 20.0 * math.log10(0.7)) == pytest.approx(
        20.0 * math.log10(1.5 / limit(1.5, 0.7)), abs=1e-6
    )
    assert limited_db(0.7, -3.0) == 0.0
    words = ("render", midi(*notes((0, 0.1, 70, 110))), "-o", tmp_path / "a.wav", "--tail", 0)
    assert "limiter lowered" not in command(*words)[1]
    told = command(*words, "--gain-db", 24)[1]
    assert "limiter lowered the highest peak by" in told
    assert "a lower --gain-db keeps it" in told


def test_a_part_is_named_and_its_ornaments_are_no_notes(command, midi, tmp_path):
    target = ("-o", tmp_path / "a.wav", "--tail", 0, "--overwrite")
    named = (0.0, mido.MetaMessage("track_name", name="Right hand"))
    assert (
        "\nRight hand: 1 note\n"
        in command("render", midi(named, *notes((0, 0.1, 70, 64))), *target)[1]
    )
    tune, two = tmp_path / "tune.abc", tmp_path / "two.abc"
    tune.write_text("X:1\nL:1/16\nK:D\nV:1 nm=A\n{c}d2 ~e2\nV:2 nm=B\nd4\n", "utf-8")
    two.write_text(tune.read_text("utf-8"), "utf-8")
    for words, lines in (
        ((tune,), ["A: 2 notes (5 with ornaments)"]),
        ((tune, "--part", "A", "--part", "B"), ["A, B: 3 notes (6 with ornaments)"]),
        ((tune, "--ensemble"), ["A: 2 notes (5 with ornaments), ", "B: 1 note, "]),
        ((tune, two), ["A: 10 notes"]),
    ):
        told = command("render", *words, *target)[1]
        assert all(f"\n{line}" in told for line in lines), told


def test_a_file_whose_expression_stays_at_0_is_said_to_be_silent(command, midi, tmp_path):
    said = "channel 1: CC 7 or 11 stays at 0: no note is heard"
    tune, target = notes((0, 0.1, 70, 64)), ("-o", tmp_path / "a.wav", "--tail", 0)
    assert said in command("render", midi(cc(0.0, 11, 0), *tune), *target)[1]
    assert said not in command("render", midi(cc(0.0, 11, 0), *tune, cc(0.05, 11, 9)), *target)[1]
    assert said in command("render", midi(cc(0.0, 7, 0), *tune), *target)[1]
    assert said not in command("render", midi(*tune), *target)[1]


def test_a_wheel_that_rests_under_most_notes_is_said_to_make_them_soft(command, midi, tmp_path):
    said = "channel 1: CC 1 is at 0 under most notes, which makes them soft; --mapping keyboard-vib"
    tune, target = notes((0, 0.4, 70, 64)), ("-o", tmp_path / "a.wav", "--tail", 0, "--overwrite")
    for moves, more, is_said in (
        ((cc(0.0, 1, 0), cc(0.3, 1, 64)), (), True),
        ((cc(0.0, 1, 0), cc(0.3, 1, 64)), ("--mapping", "keyboard-vibrato-wheel"), False),
        ((cc(0.0, 1, 0), cc(0.1, 1, 64)), (), False),
        ((cc(0.3, 1, 64),), (), False),
    ):
        assert (said in command("render", midi(*moves, *tune), *target, *more)[1]) == is_said


# ---------------------------------------------------------------- the tail


@pytest.mark.parametrize(("tail", "rate"), [(0, 44100), (1.25, 48000)])
def test_a_tail_asked_for_is_exactly_as_long(play, midi, tail, rate):
    summary, sound = play(midi(*notes((0, 0.4, 70, 64))), "--tail", tail, "--rate", rate)
    assert len(sound) == round((0.4 + tail) * rate)
    assert summary["duration_s"] == len(sound) / rate


@pytest.mark.parametrize("rate", [22050, 44100, 96000])
def test_the_usual_tail_ends_when_the_sound_has(play, midi, rate):
    _, sound = play(midi(*notes((0, 0.4, 72, 64))), "--rate", rate, "--subtype", "float")
    tail = sound[round(0.4 * rate) :]
    assert len(tail) < 5 * rate
    assert np.abs(tail[-round(0.19 * rate) :]).max() < QUIET
    loud = np.flatnonzero(np.abs(tail) >= QUIET)
    assert len(tail) - loud[-1] < 0.25 * rate  # and no later
    assert np.abs(tail[: rate // 10]).max() > 100 * QUIET  # it does ring on


def test_a_sound_that_does_not_end_is_left_after_five_seconds(play, midi):
    words = ("--set", "/bow/side=1", "--set", "/bow/speed=0.2")
    summary, sound = play(midi(*notes((0, 0.1, 65, 64))), *words)
    assert summary["duration_s"] == pytest.approx(5.1, abs=0.02)
    assert np.abs(sound[-4410:]).max() > 100 * QUIET


def test_a_note_the_score_does_not_end_ends_with_it(play, midi):
    held = midi(notes((0, 0.5, 70, 64))[0], cc(0.5, 64, 127), cc(0.5, 20, 0))
    summary, _ = play(held)
    assert summary["duration_s"] < 5.0


# ---------------------------------------------------------------- channels


@pytest.fixture
def duet(midi) -> Path:
    first = notes((0.0, 0.2, 66, 64), (0.4, 0.2, 70, 64), channel=1)
    third = notes((0.2, 0.2, 77, 64), channel=3)
    drums = notes((0.0, 0.6, 84, 127), (0.1, 0.1, 84, 127), (0.3, 0.1, 84, 127), channel=10)
    return midi(*first, *third, *drums)


def test_all_channels_but_the_tenth_play_unless_some_are_chosen(play, duet):
    for words, channels, percussion in [
        ((), {"1": 2, "3": 1}, 3),
        (("--channel", 3), {"3": 1}, 0),
        (("--channel", 3, "--channel", 1), {"1": 2, "3": 1}, 0),
        (("--channel", 10), {"10": 3}, 0),
    ]:
        summary, sound = play(duet, *words)
        assert (summary["channels"], summary["percussion_notes"]) == (channels, percussion)
        assert summary["notes_played"] == sum(channels.values())
        assert sound.any()


def test_where_no_note_would_be_played_nothing_is_written(duet, midi, tmp_path, command):
    drums = midi(*notes((0.0, 0.1, 70, 64), channel=10), name="drums.mid")
    for words, reason in [
        ((duet, "--channel", 16), "no note is of channel 16, but of 1, 3, 10"),
        ((duet, "--ensemble", "--channel", 5), "no note is of channel 5, but of 1, 3, 10"),
        ((drums,), "all its notes are of channel 10, percussion"),
    ]:
        code, _, err = command("render", *words, "-o", tmp_path / "x.wav")
        assert code == 2, words
        assert reason in err
        assert not (tmp_path / "x.wav").exists()


def test_a_chosen_channel_without_notes_beside_others_is_named(duet, tmp_path, command):
    for words in ((), ("--ensemble",)):
        chosen = ("--channel", 3, "--channel", 5, "--overwrite", "--tail", 0)
        code, _, err = command("render", duet, *words, *chosen, "-o", tmp_path / "x.wav")
        assert code == 0
        assert "no note is of channel 5, but of 1, 3, 10" in err


# ---------------------------------------------------------------- settings, mapping, instrument


def test_a_setting_is_held_whatever_notes_and_controllers_say(play, midi):
    held = ("pressure=0.45", "speed=0.2", "velocity=0.63")
    settings = [word for setting in held for word in ("--set", f"/playing/{setting}")]
    firm = midi(cc(0, 16, 127), *notes((0, 0.4, 70, 127)), name="firm.mid")
    faint = midi(cc(0, 16, 0), *notes((0, 0.4, 70, 1)), name="faint.mid")
    assert not np.array_equal(samples(firm), samples(faint))
    np.testing.assert_array_equal(play(firm, *settings)[1], play(faint, *settings)[1])


def test_a_mapping_file_says_what_controllers_do(play, midi, tmp_path):
    mapping = tmp_path / "mine.toml"
    mapping.write_text('[[bind]]\nsource = "cc 4"\ntarget = "/playing/volume"\nspan = [1.0, 0.0]\n')
    tune = midi(cc(0, 4, 127), cc(0, 7, 0), *notes((0, 0.4, 70, 64)))
    assert not play(tune, "--tail", 1)[1][2000:].any()  # CC7
    assert not play(tune, "--tail", 1, "--mapping", mapping)[1][2000:].any()  # CC4, inverted
    tune = midi(cc(0, 4, 0), cc(0, 7, 0), *notes((0, 0.4, 70, 64)))
    assert rms(play(tune, "--tail", 1, "--mapping", mapping)[1]) > 0.001


def test_an_instrument_file_changes_the_instrument(play, midi, tmp_path):
    (tmp_path / "slack.toml").write_text(SLACK_TOML)
    (tmp_path / "slack.json").write_text(json.dumps(SLACK))
    tune = midi(*notes((0, 1.0, 65, 64)))
    _, usual = play(tune, "--tail", 0)
    summary, slack = play(tune, "--tail", 0, "--instrument", tmp_path / "slack.toml")
    assert summary["range"] == SLACK_RANGE  # by its strings: the slack one is stopped for F4 now
    off = cents(pitch_of(slack[22050:], 44100), pitch_of(usual[22050:], 44100))
    assert off == pytest.approx(0.0, abs=25.0)
    assert not np.array_equal(slack, usual)
    of_json = play(tune, "--tail", 0, "--instrument", tmp_path / "slack.json")[1]
    np.testing.assert_array_equal(of_json, slack)


# ---------------------------------------------------------------- range


def test_a_note_out_of_range_sounds_where_the_policy_puts_it(play, midi):
    for policy, note, fitted, alone in (
        ("transpose", 127, 79, 0),  # as a whole part
        ("clamp", 20, 65, 1),
        ("clamp", 70, 70, 0),
    ):
        words = ("--range", policy, "--tail", 0.2)
        summary, sound = play(midi(*notes((0, 0.3, note, 64))), *words)
        assert summary["notes_out_of_range"] == alone
        _, expected = play(midi(*notes((0, 0.3, fitted, 64))), "--tail", 0.2)
        np.testing.assert_array_equal(sound, expected)


# ---------------------------------------------------------------- several files, other rates


def test_several_files_play_one_after_another(play, midi):
    first = midi(*notes((0, 0.6, 77, 64)), name="1.mid")
    second = midi(*notes((0, 0.6, 80, 64)), name="2.mid")
    summary, sound = play(first, second, first, "--tail", 0.1)
    assert len(sound) == round(1.9 * 44100)
    assert summary["notes_played"] == 3
    for start, note in ((0.0, 77), (0.6, 80), (1.2, 77)):
        part = sound[round((start + 0.25) * 44100) : round((start + 0.55) * 44100)]
        assert abs(cents(pitch_of(part, 44100), hertz(note))) < 35.0


def test_a_pedal_or_fade_at_the_end_of_one_file_does_not_reach_the_next(midi):
    plain = midi(*notes((0, 0.4, 77, 64)), name="plain.mid")
    bent = mido.Message("pitchwheel", pitch=8191)
    ends = [cc(0.4, 64, 127), cc(0.4, 11, 0), cc(0.4, 1, 127), (0.4, bent)]
    moved = midi(*notes((0, 0.4, 77, 64)), *ends, name="moved.mid")

    def second_half(path: Path) -> np.ndarray:
        score = concatenate([read_score(path), read_score(plain)])
        sound = played(score, PlayingOptions())
        return sound[round(0.6 * 44100) : round(0.75 * 44100)]

    expected, heard = second_half(plain), second_half(moved)
    assert abs(cents(pitch_of(heard, 44100), pitch_of(expected, 44100))) < 10.0
    assert rms(heard) == pytest.approx(rms(expected), rel=0.2)


@pytest.mark.parametrize(
    "rate",
    [22050, 48000, *(pytest.param(rate, marks=pytest.mark.slow) for rate in (96000, 192000))],
)
def test_other_rates_play_the_same_tune(play, tmp_path, midi, rate):
    tune = midi(*notes((0, 0.6, 74, 64)))
    summary, sound = play(tune, "--rate", rate, "--tail", 0.1)
    assert soundfile.info(tmp_path / "out.wav").samplerate == rate
    assert len(sound) == round(0.7 * rate)
    assert summary["lost_states"] == 0
    part = sound[round(0.25 * rate) : round(0.55 * rate)]
    assert abs(cents(pitch_of(part, rate), hertz(74))) < 35.0
    _, usual = play(tune, "--tail", 0.1)
    assert rms(part) == pytest.approx(rms(usual[11025:24255]), rel=0.2)


# ---------------------------------------------------------------- progress


def test_progress_is_reported_in_seconds_up_to_the_end(phrase, tmp_path):
    told = []
    summary = render(
        [Part(read_score(phrase))],
        tmp_path / "out.wav",
        Options(tail_s=0.5),
        lambda done, total: told.append((done, total)),
    )
    assert {total for _, total in told} == {SCORE_S}
    done = [value for value, _ in told]
    assert done == sorted(done)
    assert done[-1] == pytest.approx(summary.duration_s)


# ---------------------------------------------------------------- tunings, MPE

MEANTONE = "76.05 193.16 310.26 5/4 503.42 579.47 696.58 25/16 889.74 1006.84 1082.89 2/1"


def test_a_scala_scale_tunes_the_notes(play, midi, tmp_path):
    """E5 is a pure third above C5: 14 cents below equal temperament."""
    scale = tmp_path / "meantone.scl"
    scale.write_text("quarter-comma meantone\n12\n" + "\n".join(MEANTONE.split()))
    score = midi(*notes((0, 1.0, 76, 80)))
    still = ("--set", "/playing/variation=0", "--tail", 0.1)
    pitches = [
        pitch_of(play(score, *still, *words)[1][13000:35000], 44100.0)
        for words in ((), ("--tuning", scale))
    ]
    assert cents(pitches[1], pitches[0]) == pytest.approx(-13.7, abs=5.0)


PLAIN = [(0.2 * n, 0.2, 67 + n % 4, 80) for n in range(12)] + [(2.4, 1.2, 74, 80)]


def test_plain_notes_are_shaped_and_may_be_left_as_they_are(midi, play):
    tune = midi(*notes(*PLAIN))
    still = ("--set", "/playing/variation=0", "--set", "/bow/noise=0")
    shaped, alive = play(tune, *still)
    exact, plain = play(tune, *still, "--phrasing", 0, target="plain.wav")
    full, strong = play(tune, *still, "--phrasing", 1, target="strong.wav")
    assert [told["phrasing"] for told in (shaped, exact, full)] == [0.5, 0.0, 1.0]
    assert shaped["notes_played"] == exact["notes_played"] == len(PLAIN)

    def levels_db(sound: np.ndarray) -> np.ndarray:
        parts = [sound[int(44100 * (t + 0.1)) : int(44100 * (t + 0.18))] for t, *_ in PLAIN]
        return 20.0 * np.log10([rms(part) for part in parts])

    # Against the same notes as they are written.
    a_little, much = (np.std(levels_db(each) - levels_db(plain)) for each in (alive, strong))
    assert 0.3 < a_little < 0.8 * much

    def vibrato(sound: np.ndarray) -> float:
        starts = [int(44100 * (3.2 + 0.02 * n)) for n in range(18)]
        pitches = [cents(pitch_of(sound[at : at + 3000], 44100), hertz(74)) for at in starts]
        return float(np.ptp(pitches))

    assert vibrato(plain) < 5.0
    assert vibrato(alive) > 15.0
