"""``yehu-server render --plot``: a picture of what was rendered."""

from pathlib import Path

import numpy as np
import pytest
from midi_files import midi_file, notes

from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance
from yehu_server.rendering.plot_data import PlotData
from yehu_server.scores.smf.reader import read_score

DRY = ("--dry", "--tail", 0)  # in little time
RATE = 44100.0


@pytest.fixture
def tune(tmp_path) -> Path:
    return midi_file(tmp_path / "tune.mid", notes((0.0, 0.3, 67, 90), (0.3, 0.3, 72, 90)))


def watched(sound: np.ndarray, duration_s: float, size: int = 1000, voices: int = 1) -> PlotData:
    watch = PlotData(RATE, duration_s, voices)
    for at in range(0, len(sound), size):
        watch.take(sound[at : at + size], [69.0] * voices)
    return watch


def sine(hz: float, level: float, seconds: float) -> np.ndarray:
    return level * np.sin(2.0 * np.pi * hz * np.arange(round(seconds * RATE)) / RATE)


# ---------------------------------------------------------------- what is gathered


def test_level_peak_pitch_and_spectrum_of_a_sine():
    watch = watched(sine(440.0, 0.1, 1.0), 1.0)
    middle = slice(10, -10)
    assert watch.levels_db[middle] == pytest.approx(-20.0 - 3.01, abs=0.3)
    assert watch.peaks_db[middle] == pytest.approx(-20.0, abs=0.1)
    assert watch.pitches[middle] == pytest.approx(69.0, abs=0.02)
    column = watch.spectra_db[:, 50]
    assert column.argmax() * watch.row_hz == pytest.approx(440.0, abs=0.6 * watch.row_hz)
    assert column.max() == pytest.approx(-20.0, abs=1.5)


@pytest.mark.parametrize("size", [1, 64, 44100])
def test_the_pieces_do_not_matter(size):
    sound = np.random.default_rng(1).normal(0.0, 0.1, (4410, 2))
    one, other = watched(sound, 0.1), watched(sound, 0.1, size)
    assert np.array_equal(one.levels_db, other.levels_db)
    assert np.array_equal(one.spectra_db, other.spectra_db)


# ---------------------------------------------------------------- what is drawn

mpl = pytest.importorskip("matplotlib")


def test_a_picture_is_drawn_beside_the_sound_which_is_the_same_and_may_be_replaced(
    tune, command, tmp_path
):
    sound, picture = tmp_path / "a.wav", tmp_path / "a.png"
    words = ("render", tune, "-o", sound, *DRY)
    command(*words)
    alone = sound.read_bytes()
    assert command(*words, "--plot", picture)[::2] == (0, "")
    assert sound.read_bytes() == alone
    from matplotlib.image import imread

    pixels = imread(picture)
    assert pixels.shape[:2] == (990, 1540)
    some = pixels[::5, ::5].reshape(-1, pixels.shape[2])
    assert len(np.unique(some, axis=0)) > 100
    before = picture.read_bytes()
    picture.write_bytes(before + b"\0")
    with mpl.rc_context({"font.size": 20.0, "axes.facecolor": "red"}):
        assert command(*words, "--plot", picture)[0] == 0
    assert picture.read_bytes() == before


def test_the_pitches_of_the_picture_are_those_of_the_score(tune):
    options = Options(is_dry=True, is_mono=True, tail_s=0.0, block=512)
    performance = Performance([Part(read_score(tune))], options)
    watch = PlotData(RATE, 0.6, 1)
    for samples in performance.blocks():
        watch.take(samples, performance.target_pitches)
    times, asked = watch.asked
    for note, first, last in ((67.0, 0.02, 0.28), (72.0, 0.32, 0.58)):
        within = (times > first) & (times < last)
        assert asked[within, 0] == pytest.approx(note)
        heard = watch.pitches[(watch.times_s > last - 0.1) & (watch.times_s < last - 0.03)]
        assert np.nanmedian(heard) == pytest.approx(note, abs=0.3)


def test_each_part_of_an_ensemble_is_asked_for_its_own_pitch(tune):
    options = Options(is_dry=True, tail_s=0.0, block=512)
    performance = Performance([Part(read_score(tune)), Part(read_score(tune))], options)
    next(iter(performance.blocks()))
    assert performance.target_pitches == [67.0, 67.0]


def test_what_is_no_picture_of_ours_is_not_replaced_and_a_wrong_name_gets_one_line(
    tune, refused, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.png").write_bytes(b"\x89PNG of mine")
    for plot, wrong in (
        ("mine.png", "mine.png: exists; --overwrite"),
        ("a.jpg", "a picture is a .png file"),
        ("none/a.png", "does not exist"),
    ):
        assert wrong in refused("render", tune, "-o", "a.wav", "--plot", plot)
        assert not (tmp_path / "a.wav").exists()
