"""Scala tunings: known scales, keyboard maps, and the wording of errors."""

import math
from pathlib import Path

import pytest

from yehu_server import cli
from yehu_server.cli.config import parse
from yehu_server.cli.playing_options import playing_options_of
from yehu_server.errors import ParameterError
from yehu_server.playing.tuning import EQUAL, Tuning, read_tuning
from yehu_server.scores.reading import ReadOptions, read_any

TWELVE = [f"{100 * step}.0" for step in range(1, 12)] + ["2/1"]
MAJOR = ["9/8", "5/4", "4/3", "3/2", "5/3", "15/8", "2"]
WHITE = ["0", "x", "1", "x", "2", "3", "x", "4", "x", "5", "x", "6"]


def scl(*notes: str) -> str:
    return "\n".join(["! a comment", "A scale", f" {len(notes)} ", "!", *notes]) + "\n"


def kbm(
    *degrees: str, size=None, first=0, last=127, middle=60, reference=69, hz="440.0", octave=0
) -> str:
    size = len(degrees) if size is None else size
    return "\n".join(map(str, (size, first, last, middle, reference, hz, octave, *degrees)))


@pytest.fixture
def read(tmp_path):
    def from_text(scale: str | bytes, keyboard: str | bytes | None = None) -> Tuning:
        paths = [tmp_path / "mine.scl", tmp_path / "mine.kbm"]
        for path, text in zip(paths, (scale, keyboard), strict=True):
            if text is not None:
                path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_tuning(paths[0], None if keyboard is None else paths[1])

    return from_text


def cents(tuning: Tuning, low: int = 60, high: int = 72) -> list[float]:
    keys = range(low, high + 1)
    return [100 * (tuning.pitch(key, 440.0) - tuning.pitch(low, 440.0)) for key in keys]


# ---------------------------------------------------------------- scales


def test_twelve_equal_steps_are_equal_temperament_at_any_a4(read):
    tuning = read(scl(*TWELVE))
    for note in (0, 59, 60, 61.25, 69, 126.5, 127):
        assert EQUAL.pitch(note, 432.0) == note
        for a4 in (432.0, 440.0):
            assert tuning.pitch(note, a4) == pytest.approx(note, abs=1e-9)


def test_quarter_comma_meantone(read):
    below = "76.049 193.15686 310.26471 5/4 503.42157 579.47057"
    above = "696.57843 25/16 889.73529 1006.84314 1082.89214 2/1"
    tuning = read(scl(*below.split(), *above.split()))
    fifth = 1200 * math.log2(5**0.25)
    assert cents(tuning)[7] == pytest.approx(fifth, abs=1e-4)
    assert cents(tuning)[4] == pytest.approx(386.3137, abs=1e-4)
    assert cents(tuning)[9] == pytest.approx(3 * fifth - 1200, abs=1e-4)
    assert tuning.pitch(69, 440.0) == pytest.approx(68.8974, abs=1e-4)  # C keeps its place


def test_a_scale_repeats_at_its_last_note_octave_or_not(read):
    bohlen_pierce = "27/25 25/21 9/7 7/5 75/49 5/3 9/5 49/25 15/7 7/3 63/25 25/9 3/1"
    tuning = read(scl(*bohlen_pierce.split()))
    tritave = 12 * math.log2(3)
    assert tuning.pitch(73, 440.0) == pytest.approx(60 + tritave)
    assert tuning.pitch(47, 440.0) == pytest.approx(60 - tritave)
    assert tuning.pitch(46, 440.0) == pytest.approx(60 - tritave + 12 * math.log2(25 / 27))


def test_a_scale_of_other_than_twelve_notes_lies_on_keys_in_a_row_without_a_map(read):
    assert read(scl(*MAJOR)).is_in_a_row
    assert not read(scl(*TWELVE)).is_in_a_row
    assert not EQUAL.is_in_a_row
    assert not read(scl(*MAJOR), kbm(*WHITE, octave=7)).is_in_a_row


def test_between_keys_the_pitch_is_between_theirs(read):
    tuning = read(scl(*MAJOR))
    tone, third = 12 * math.log2(9 / 8), 12 * math.log2(5 / 4)
    assert tuning.pitch(61.25, 440.0) == pytest.approx(60 + 0.75 * tone + 0.25 * third)


def test_a_note_is_cents_or_a_ratio_and_what_follows_is_ignored(subtests, read):
    for line, expected in [
        ("81/64", 407.82),
        ("408.0", 408),
        ("408.", 408),
        (".5", 0.5),
        ("5", 2786.3137),
        ("-5.0", -5),
        ("10/20", -1200),
        ("100.0 cents", 100),
        ("100.0C#", 100),
        ("100.0 5", 100),
        ("\t5/4   E\\", 386.3137),
        ("3 / 2 a fifth", 701.955),
        ("2 / octave", 1200),
        ("3/2! fifth", 701.955),
        ("4294967296/2147483648", 1200),
        (f"{2**400}/{2**399}", 1200),
    ]:
        with subtests.test(line=line, expected=expected):
            assert cents(read(scl(line)), 60, 61)[1] == pytest.approx(expected, abs=1e-3)


def test_any_line_ends_and_lines_after_the_last_note_or_an_end_mark(read):
    text = scl("3/2", "2/1") + "whatever follows\n"
    for end in ("\n", "\r\n", "\r"):
        found = cents(read(text.replace("\n", end)), 60, 62)
        assert found == pytest.approx([0, 701.955, 1200])
    assert read(scl("2/1") + "\x1a").pitch(61, 440.0) == pytest.approx(72)
    with pytest.raises(ParameterError, match="ends before note 2"):
        read("A scale\n2\n3/2\n\x1a2/1")


# ---------------------------------------------------------------- keyboard maps


def test_a_reference_frequency_is_in_hz_wherever_a4_is(read):
    tuning = read(scl(*TWELVE), kbm(reference=69, hz=432))
    assert tuning.pitch(69, 432.0) == pytest.approx(69)
    assert tuning.pitch(69, 440.0) == pytest.approx(69 + 12 * math.log2(432 / 440))
    assert tuning.pitch(57, 216.0) == pytest.approx(69)


def test_the_reference_key_sounds_its_frequency_whatever_the_scale(read):
    tuning = read(scl(*MAJOR), kbm(*WHITE, octave=7))
    assert tuning.pitch(69, 440.0) == pytest.approx(69)
    assert tuning.pitch(60, 440.0) == pytest.approx(69 - 12 * math.log2(5 / 3))


def test_white_keys_play_a_seven_note_scale_and_black_ones_nothing(read):
    tuning = read(scl(*MAJOR), kbm(*WHITE, "12", size=12, octave=7, reference=60, hz=264))
    just = [1, 9 / 8, 5 / 4, 4 / 3, 3 / 2, 5 / 3, 15 / 8, 2]
    for key, ratio in zip((60, 62, 64, 65, 67, 69, 71, 72), just, strict=True):
        assert tuning.pitch(key, 264.0) == pytest.approx(69 + 12 * math.log2(ratio))
        assert tuning.pitch(key - 24, 264.0) == pytest.approx(45 + 12 * math.log2(ratio))
    silent = {key for key in range(60, 72) if tuning.pitch(key, 440.0) is None}
    assert silent == {61, 63, 66, 68, 70}


def test_the_map_repeats_at_its_octave_degree_or_at_the_end_of_the_scale(read):
    for octave, interval in ((0, 24), (1, 12), (3, 36)):
        tuning = read(scl("2/1", "4/1"), kbm("0", "x", octave=octave, reference=60))
        assert tuning.pitch(62, 440.0) - tuning.pitch(60, 440.0) == pytest.approx(interval)


def test_a_linear_map_starts_the_scale_on_the_middle_key(read):
    tuning = read(scl("3/2", "2/1"), kbm(middle=62, reference=62, hz=440, octave=2))
    assert tuning.pitch(63, 440.0) == pytest.approx(69 + 12 * math.log2(3 / 2))
    assert tuning.pitch(60, 440.0) == pytest.approx(57)


def test_keys_left_out_at_the_end_of_a_map_are_unmapped(read):
    tuning = read(scl(*TWELVE), kbm("0", "13", size=3, octave=12, reference=60, hz=440))
    assert tuning.pitch(61, 440.0) == pytest.approx(69 + 13)  # on into the next octave
    assert tuning.pitch(62, 440.0) is None
    assert tuning.pitch(63, 440.0) == pytest.approx(69 + 12)


# ---------------------------------------------------------------- errors


NO_NOTES = [
    *("3/2/1", "3/2.5", "3 / 2.5", "701,955", "7.0e2", "1.2.3", "nan", "inf", ".", "٣/٢"),
    "9" * 5000,
]


def test_a_malformed_scale_is_refused_by_line(subtests, read):
    for text, line, says in [
        ("", 1, "ends before the number of notes"),
        ("! only\n! comments", 2, "ends before the description"),
        ("A scale", 1, "ends before the number of notes"),
        ("A scale\nmany", 2, "expected the number of notes, got 'many'"),
        ("A scale\n-1", 2, "-1 is not within 0 to 1024"),
        ("A scale\n1025\n", 2, "1025 is not within"),
        ("A scale\n2.0\n3/2\n2/1", 2, "expected the number"),
        ("A scale\n2\n3/2\n", 4, "ends before note 2 of 2"),
        ("A scale\n!\n1\nfifth", 4, "expected cents or a ratio, got 'fifth'"),
        (scl("2/1", "0"), 6, "above zero"),
        *((scl(note), 5, "above zero") for note in ("-3/2", "3/-2", "1/0")),
        *((scl(note), 5, "expected cents or a ratio") for note in NO_NOTES),
        *((scl(note), 5, "too far") for note in ("9" * 400 + ".", "9" * 1000)),
    ]:
        with (
            subtests.test(text=text, line=line, says=says),
            pytest.raises(ParameterError, match=rf"mine\.scl: line {line}: .*{says}"),
        ):
            read(text)


def test_a_malformed_map_is_refused_by_line(subtests, read):
    for text, line, says in [
        ("", 1, "ends before the size of the map"),
        ("0\n0\n127", 3, "ends before the middle key"),
        *((kbm(size=size), 1, f"size of the map: {size} is not within") for size in (-1, 1025)),
        (kbm(last=128), 3, "last key: 128 is not within"),
        (kbm(first=61, last=60), 3, "last key: 60 is not within 61 to 127"),
        (kbm(middle="x"), 4, "expected the middle key, got 'x'"),
        (kbm(reference=200), 5, "reference key: 200"),
        *(
            (kbm(hz=hz), 6, f"reference frequency: '{hz}' is not within")
            for hz in (0, -440, "1e999")
        ),
        *((kbm(hz=hz), 6, "expected the reference frequency") for hz in ("nan", "A440")),
        (kbm(octave=-1), 7, "degree of the octave: -1"),
        (kbm("0", "y"), 9, "expected a degree of the scale, or x, got 'y'"),
        (kbm("0 1 2", size=3), 8, "expected a degree"),
        (kbm("-1"), 8, "-1 is not within"),
        (kbm("0", "x", reference=61), 5, "reference key 61 is not mapped"),
    ]:
        with (
            subtests.test(text=text, line=line, says=says),
            pytest.raises(ParameterError, match=rf"mine\.kbm: line {line}: .*{says}"),
        ):
            read(scl(*TWELVE), text)
    with pytest.raises(ParameterError, match=r"mine\.kbm: maps no key"):
        read(scl(*TWELVE), kbm("0", "x", reference=60, first=61, last=61))


def test_what_is_no_text_and_pitches_no_number_can_hold_are_refused(read):
    for data in (bytes(100), b"\x89PNG\r\n\x1a\n\x00", "A\n1\n2".encode("utf-16")):
        with pytest.raises(ParameterError, match=r"mine\.scl: not a text file"):
            read(data)
    with pytest.raises(ParameterError, match=r"mine\.scl: key 0 would be"):
        read(scl("200000.0"))


def test_a_transposed_tuning_and_what_scores_are_fitted_to():
    tune = Path(__file__).parents[2] / "examples" / "tunes" / "twinkle.jianpu"
    words = ["render", str(tune), "-o", "a.wav", "--transpose=-5"]
    playing = playing_options_of(parse(words, cli._parser()))
    assert [playing.tuning.pitch(key, 440.0) for key in (70, 60.5)] == [65.0, 55.5]
    assert ReadOptions.by(playing, all_parts=False).within.ends == (70, 94)
    score = read_any(tune, ReadOptions.by(playing, all_parts=False))
    assert score.remarks == ("moved to fit F4 to F6: part 1 an octave up",)
    scale = playing_options_of(parse([*words, "--tuning=chaozhou-seven-equal"], cli._parser()))
    plain = read_tuning(Path("chaozhou-seven-equal"))
    assert scale.tuning.pitch(70, 440.0) == plain.pitch(70, 440.0) - 5.0


def test_a_file_that_cannot_be_read_is_named(tmp_path):
    for path, says in [
        (tmp_path / "none.scl", "no such file"),
        (tmp_path, "folder|denied"),
        (tmp_path / "a\0b", "no such file"),
    ]:
        with pytest.raises(ParameterError, match=says):
            read_tuning(path)


# ---------------------------------------------------------------- what ships


def test_the_chaozhou_table_has_seven_equal_steps_from_the_open_f_string():
    tuning = read_tuning(Path("chaozhou-seven-equal"), Path("chaozhou-keys"))
    steps = (65, 67, 69, 70, 72, 74, 76, 77)
    pitches = [tuning.pitch(key, 440.0) for key in steps]
    assert pitches == pytest.approx([65.0 + 12.0 * step / 7.0 for step in range(8)], abs=1e-4)
    assert tuning.pitch(71, 440.0) == tuning.pitch(70, 440.0)
    assert tuning.pitch(66, 440.0) is None
    with pytest.raises(ParameterError, match=r"'chaozou'.*chaozhou-seven-equal"):
        read_tuning(Path("chaozou"))
