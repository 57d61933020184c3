"""The reader of MIDI files, on files built byte by byte."""

import random
from collections.abc import Callable
from pathlib import Path

import mido
import pytest
from midi_bytes import END, chunk, head, midi, off, on, tempo
from midi_reading import read_file, timed

from yehu_server.errors import ScoreError
from yehu_server.scores.score import Score
from yehu_server.scores.smf.reader import read_score


@pytest.fixture
def read(tmp_path: Path) -> Callable[[bytes], Score]:
    return lambda data: read_file(tmp_path, data)


# ---------------------------------------------------------------- time


def test_many_tempo_changes_do_not_drift(read):
    track = b"".join(tempo(1, 333_333) for _ in range(30_000)) + on(0, 60) + END
    score = read(midi(tempo(0, 333_333) + track, division=7))
    assert score.events[0].time_s == 30_000 * 333_333 / 7e6


def test_smpte_time_counts_frames_and_ignores_tempo(read):
    quick = 1000 * 1001 / 3_000_000  # 29.97 frames a second
    seconds = {(24, 4): 1000 / 96, (25, 40): 1.0, (29, 100): quick, (30, 80): 1000 / 2400}
    for (frames, ticks), expected_s in seconds.items():
        division = (256 - frames) << 8 | ticks
        score = read(midi(tempo(0, 1_000_000) + on(1000, 60) + END, division=division))
        assert score.events[0].time_s == pytest.approx(expected_s, rel=1e-15)


def test_no_score_lasts_longer_than_was_asked_for_nor_songs_of_one_file_together(tmp_path):
    path = tmp_path / "tune.mid"

    def read(*ticks: int, **options: float) -> float:  # one tick a second
        tracks = [tempo(0, 1_000_000) + on(0, 60) + off(each, 60) + END for each in ticks]
        path.write_bytes(midi(*tracks, kind=2, division=1))
        return read_score(path, **options).duration_s

    assert read(7200) == 7200
    with pytest.raises(ScoreError, match=r"tune\.mid: the score lasts 2 hours, more than 2: see "):
        read(7201)
    assert read(7201, max_duration_h=2.1) == 7201
    assert read(3_600_000, max_duration_h=1000.0) == 3_600_000
    with pytest.raises(ScoreError, match="more than 1000: see --max-duration"):
        read(3_601_000, max_duration_h=2000.0)
    with pytest.raises(ScoreError, match=r"tune\.mid: the score lasts 3 hours, more than 2: see "):
        read(3600, 3600, 3600)
    assert read(3600, 3600, 3600, max_duration_h=3.0) == 3 * 3600
    assert read(3600, 3600, 3600, song=3) == 3600


def test_ordinary_files_have_the_times_mido_gives_them(tmp_path):
    rng = random.Random(4)
    for number_of_tracks in (1, 2, 5):
        file = mido.MidiFile(ticks_per_beat=rng.randrange(24, 960), type=number_of_tracks > 1)
        for _ in range(number_of_tracks):
            track = mido.MidiTrack()
            for _ in range(200):
                time, channel = rng.randrange(200), rng.randrange(16)
                track.append(
                    rng.choice(
                        [
                            mido.MetaMessage("set_tempo", tempo=rng.randrange(1, 2**24), time=time),
                            mido.MetaMessage("text", text="la", time=time),
                            mido.Message("sysex", data=[1, 2, 3], time=time),
                            mido.Message("note_on", note=rng.randrange(128), time=time),
                            mido.Message("note_off", note=rng.randrange(128), time=time),
                            mido.Message("polytouch", note=9, value=8, time=time),
                            mido.Message("program_change", program=7, channel=channel, time=time),
                            mido.Message("pitchwheel", pitch=rng.randrange(-8192, 8192), time=time),
                            mido.Message("aftertouch", value=9, channel=channel, time=time),
                        ]
                    )
                )
            track.append(mido.Message("control_change", control=123))  # all notes end
            file.tracks.append(track)
        path = tmp_path / "ordinary.mid"
        file.save(path)

        now, expected = 0.0, []
        for message in mido.MidiFile(path):
            now += message.time
            if not message.is_meta and message.type != "sysex":
                expected.append((now, message.bytes()))
        score = read_score(path)
        assert [sound for _, sound in timed(score)] == [sound for _, sound in expected]
        times = [time for time, _ in expected]
        assert [event.time_s for event in score.events] == pytest.approx(times, rel=1e-12)
        assert score.duration_s == pytest.approx(now, rel=1e-12)
        assert score.warnings == ()


# ---------------------------------------------------------------- events


# ---------------------------------------------------------------- chunks


def test_a_track_of_any_length_whatever_hides_no_other(read):
    first, second = on(0, 60) + off(9, 60) + END, on(0, 62) + off(9, 62) + END
    expected, last = timed(read(midi(first, second))), chunk(b"MTrk", second)
    for junk in (b"", b"\0", b"\0MTr", b"    \xff\xff\xff\xff"):
        for length in (*range(24), 1000, 2**24, 2**32 - 1):
            score = read(head(1, 2, 100) + chunk(b"MTrk", first, length) + junk + last)
            assert timed(score) == expected, (junk, length)
            assert score.warnings or (length == len(first) and not junk), (junk, length)


def test_a_header_is_found_in_the_first_64_kb(read):
    score = read(b"\xff" * 65_536 + midi(on(0, 60) + off(100, 60) + END))
    assert len(score.events) == 2
    assert score.warnings == ("65536 bytes before the header skipped, at byte 0",)


def test_an_archive_is_refused_though_a_file_lies_open_in_it(read):
    member = b"tune.mid".ljust(257, b"\0") + b"ustar\x0000".ljust(255, b"\0")
    with pytest.raises(ScoreError, match="it is a tar archive; unpack it first"):
        read(member + midi(on(0, 60) + END))


def test_a_type_2_file_plays_its_tracks_in_turn_each_with_its_own_tempo(read):
    slow = tempo(0, 1_000_000) + on(0, 60) + off(100, 60) + END
    plain = on(0, 62) + b"\x64\xff\x2f\x00"  # left sounding
    score = read(midi(slow, plain, plain, kind=2))
    assert timed(score) == [
        (0.0, [0x90, 60, 80]),
        (1.0, [0x80, 60, 0]),
        (1.0, [0xFF]),  # a system reset: notes left sounding end with it
        (1.0, [0x90, 62, 80]),
        (1.5, [0xFF]),
        (1.5, [0x90, 62, 80]),
    ]
    assert (score.duration_s, score.name) == (2.0, "tune")


@pytest.fixture
def songs(tmp_path) -> Path:
    slow = tempo(0, 1_000_000) + on(0, 60) + off(100, 60) + END
    path = tmp_path / "songs.mid"
    path.write_bytes(midi(slow, tempo(0, 9) + END, on(0, 62) + off(100, 62) + END, kind=2))
    return path


def test_one_song_of_several_is_chosen(songs):
    assert timed(read_score(songs, song=1)) == [(0.0, [0x90, 60, 80]), (1.0, [0x80, 60, 0])]
    assert timed(read_score(songs, song=3)) == [(0.0, [0x90, 62, 80]), (0.5, [0x80, 62, 0])]
    with pytest.raises(ScoreError, match=r"songs\.mid: song 2 has nothing to play"):
        read_score(songs, song=2)
    with pytest.raises(ScoreError, match=r"songs\.mid: has 3 songs: there is no song 4"):
        read_score(songs, song=4)


def test_of_many_notes_without_an_end_each_stops_at_the_next_of_its_channel(read):
    notes = on(0, 60) + on(0, 64) + on(0, 70, channel=1) + on(0, 35, channel=9)
    score = read(midi(notes + on(100, 62) + off(100, 62) + on(0, 36, channel=9) + END))
    assert timed(score)[4:7] == [
        (0.5, [0x80, 60, 64]),
        (0.5, [0x80, 64, 64]),
        (0.5, [0x90, 62, 80]),
    ]
    assert len(score.events) == 9
    assert score.warnings == (
        "a note without an end stopped at the next one, 2 times, first at byte 22",
    )


def test_kinds_of_faults_are_bounded(read):
    bodies = [midi(on(0, 60) + END, count=2 + each) for each in range(50)]
    score = read(b"".join(bodies))
    assert len(score.warnings) == 31
    assert score.warnings[-1].startswith("further faults of other kinds, 21 times, first at byte ")


def test_what_is_superseded_at_one_tick_is_left_out(tmp_path):
    bends = b"".join(b"\0\xe0" + bytes([at % 128, 64]) for at in range(1000))
    volumes = b"\0\xb0\x07\x10\0\xb0\x07\x20"
    pedals = b"\0\xb0\x40\x7f\0\xb0\x40\0"
    other = b"\0\xe1\x01\x40"  # of another channel
    track = bends + volumes + bends + pedals + other + on(0, 60) + bends + off(9, 60) + bends
    events = read_file(tmp_path, midi(track + END)).events
    kinds = [getattr(each.message, "control", each.message.type) for each in events]
    assert kinds == [
        7, "pitchwheel", 64, 64, "pitchwheel", "note_on", "pitchwheel", "note_off", "pitchwheel"
    ]  # fmt: skip
    last = 999 % 128 + 128 * 64 - 8192
    assert [each.message.pitch for each in events if each.message.type == "pitchwheel"] == [
        last, 1, last, last
    ]  # fmt: skip
    assert events[0].message.value == 0x20


def test_what_tracks_move_on_one_channel_stays_in_each(tmp_path):
    bend = b"\0\xe0\x00\x50"
    score = read_file(tmp_path, midi(bend + on(0, 60) + END, bend + off(9, 60) + END))
    assert [each.track for each in score.events if each.message.type == "pitchwheel"] == [1, 2]
