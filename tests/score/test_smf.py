"""The reader of MIDI files, on files built byte by byte."""

from __future__ import annotations

import os
import random
import struct
from pathlib import Path

import mido
import pytest

from yehu_server.errors import ScoreError
from yehu_server.score import smf
from yehu_server.score.smf import Score, ScoreEvent, concatenate, read_score

END = b"\x00\xff\x2f\x00"


def number(value: int) -> bytes:
    digits = [value & 0x7F]
    while value := value >> 7:
        digits.insert(0, value & 0x7F | 0x80)
    return bytes(digits)


def tempo(delta: int, microseconds: int) -> bytes:
    return number(delta) + b"\xff\x51\x03" + microseconds.to_bytes(3, "big")


def on(delta: int, note: int, velocity: int = 80, channel: int = 0) -> bytes:
    return number(delta) + bytes([0x90 | channel, note, velocity])


def off(delta: int, note: int, channel: int = 0) -> bytes:
    return number(delta) + bytes([0x80 | channel, note, 0])


def chunk(tag: bytes, body: bytes, length: int | None = None) -> bytes:
    return tag + struct.pack(">I", len(body) if length is None else length) + body


def midi(
    *tracks: bytes, kind: int = 1, division: int = 100, count: int | None = None, extra: bytes = b""
) -> bytes:
    head = struct.pack(">HHH", kind, len(tracks) if count is None else count, division) + extra
    return chunk(b"MThd", head) + b"".join(chunk(b"MTrk", track) for track in tracks)


@pytest.fixture
def read(tmp_path: Path):
    def from_bytes(data: bytes) -> Score:
        path = tmp_path / "tune.mid"
        path.write_bytes(data)
        return read_score(path)

    return from_bytes


def told(score: Score) -> list[tuple[float, list[int]]]:
    return [(event.time_s, event.message.bytes()) for event in score.events]


# ---------------------------------------------------------------- time


def test_a_quarter_note_lasts_half_a_second_unless_told(read):
    score = read(midi(on(0, 60) + off(100, 60) + END))
    assert told(score) == [(0.0, [0x90, 60, 80]), (0.5, [0x80, 60, 0])]
    assert (score.duration_s, score.name, score.warnings) == (0.5, "tune", ())


def test_a_tempo_change_in_another_track_moves_later_notes(read):
    conductor = tempo(50, 1_000_000) + tempo(100, 250_000) + END
    score = read(midi(conductor, on(0, 60) + off(50, 60) + on(50, 62) + off(100, 62) + END))
    # 50 ticks at 5 ms, then 100 at 10 ms, then 50 at 2.5 ms
    assert [event.time_s for event in score.events] == [0.0, 0.25, 0.75, 1.375]


def test_a_tempo_change_after_the_notes_in_file_order_still_moves_them(read):
    score = read(midi(on(0, 60) + off(100, 60) + END, tempo(0, 1_000_000) + END))
    assert score.duration_s == 1.0


def test_the_last_of_two_tempos_at_one_tick_holds(read):
    score = read(midi(tempo(0, 1) + tempo(0, 1_000_000) + on(100, 60) + END))
    assert score.events[0].time_s == 1.0


@pytest.mark.parametrize("damaged", [b"\x00\xff\x51\x03\0\0\0", b"\x00\xff\x51\x02\x01\x02"])
def test_an_impossible_tempo_is_ignored_and_told(read, damaged):
    score = read(midi(damaged + on(100, 60) + END))
    assert score.events[0].time_s == 0.5
    assert score.warnings == ("a tempo of zero or cut short ignored",)


def test_events_at_one_tick_keep_the_order_of_tracks_and_of_the_file(read):
    score = read(midi(on(10, 60) + on(0, 61) + END, on(0, 70) + on(10, 71) + END, on(10, 80) + END))
    assert [event.message.note for event in score.events] == [70, 60, 61, 71, 80]


def test_the_end_of_the_longest_track_is_the_duration(read):
    rest = b"\x83\x74\xff\x2f\x00"  # 500 ticks, then the end
    assert read(midi(on(0, 60) + off(10, 60) + END, rest)).duration_s == 2.5


def test_many_tempo_changes_do_not_drift(read):
    track = b"".join(tempo(1, 333_333) for _ in range(30_000)) + on(0, 60) + END
    score = read(midi(tempo(0, 333_333) + track, division=7))
    assert score.events[0].time_s == 30_000 * 333_333 / 7e6


@pytest.mark.parametrize(
    ("frames", "ticks", "expected_s"),
    [(24, 4, 1000 / 96), (25, 40, 1.0), (29, 100, 1000 * 1001 / 3_000_000), (30, 80, 1000 / 2400)],
)
def test_smpte_time_counts_frames_and_ignores_tempo(read, frames, ticks, expected_s):
    division = (256 - frames) << 8 | ticks
    score = read(midi(tempo(0, 1_000_000) + on(1000, 60) + END, division=division))
    assert score.events[0].time_s == pytest.approx(expected_s, rel=1e-15)


@pytest.mark.parametrize("division", [0, 0xE700])
def test_a_division_of_zero_is_refused(read, division):
    with pytest.raises(ScoreError, match=r"tune\.mid: has a time division of zero"):
        read(midi(on(0, 60) + END, division=division))


def test_a_day_is_long_enough(read):
    def file(ticks: int) -> bytes:  # one tick a second
        return midi(tempo(0, 1_000_000) + on(0, 60) + off(ticks, 60) + END, division=1)

    assert read(file(86_400)).duration_s == 86_400
    with pytest.raises(ScoreError, match=r"tune\.mid: the score lasts 24 hours, more than 24"):
        read(file(86_401))


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
                            mido.Message("program_change", program=7, channel=channel, time=time),
                            mido.Message("pitchwheel", pitch=rng.randrange(-8192, 8192), time=time),
                            mido.Message("aftertouch", value=9, channel=channel, time=time),
                        ]
                    )
                )
            file.tracks.append(track)
        path = tmp_path / "ordinary.mid"
        file.save(path)

        now, expected = 0.0, []
        for message in mido.MidiFile(path):
            now += message.time
            if not message.is_meta and message.type != "sysex":
                expected.append((now, message.bytes()))
        score = read_score(path)
        assert [sound for _, sound in told(score)] == [sound for _, sound in expected]
        times = [time for time, _ in expected]
        assert [event.time_s for event in score.events] == pytest.approx(times, rel=1e-12)
        assert score.duration_s == pytest.approx(now, rel=1e-12)
        assert score.warnings == ()


# ---------------------------------------------------------------- events


@pytest.mark.parametrize(
    "between",
    [
        b"",
        b"\x00\xff\x01\x02la",
        b"\x00\xf0\x03\x01\x02\xf7",
        b"\x00\xf7\x03\x90\x05\x05",
        b"\x00\xff\x59\x02\x63\x07",  # a key signature of 99 sharps
    ],
)
def test_running_status_goes_on_after_anything(read, between):
    score = read(midi(on(0, 60) + between + b"\x64\x3e\x50" + END))
    assert told(score) == [(0.0, [0x90, 60, 80]), (0.5, [0x90, 62, 80])]
    assert score.warnings == ()


def test_every_kind_of_channel_message_is_read(read):
    sounds = [
        [0x83, 60, 5],
        [0x94, 60, 5],
        [0xA5, 60, 5],
        [0xB6, 1, 5],
        [0xC7, 5],
        [0xD8, 5],
        [0xEF, 0, 64],
    ]
    score = read(midi(b"".join(b"\x00" + bytes(sound) for sound in sounds) + END))
    assert [sound for _, sound in told(score)] == sounds


def test_a_velocity_above_127_costs_one_note_and_no_more(read):
    score = read(midi(on(0, 60, 200) + on(100, 62) + END))
    assert told(score) == [(0.5, [0x90, 62, 80])]
    assert score.warnings == ("a damaged message dropped",)


def test_data_without_a_status_byte_is_skipped(read):
    score = read(midi(b"\x00\x3c\x50" + bytes([0x90, 62, 80]) + on(100, 64) + END))
    assert told(score) == [(0.0, [0x90, 62, 80]), (0.5, [0x90, 64, 80])]
    assert score.warnings == ("data without a status byte skipped",)


def test_system_messages_are_stepped_over(read):
    score = read(midi(b"\x00\xf2\x01\x02\x00\xf3\x01\x00\xfe\x00\xf8" + on(100, 60) + END))
    assert told(score) == [(0.5, [0x90, 60, 80])]
    assert score.warnings == ("a system message, which no file should hold, skipped (4 times)",)


def test_nothing_is_read_after_the_end_of_a_track(read):
    assert len(read(midi(on(0, 60) + END + on(5, 62))).events) == 1


# ---------------------------------------------------------------- chunks


def test_a_missing_end_of_track_is_fine(read):
    score = read(midi(on(0, 60) + off(100, 60)))
    assert (score.duration_s, score.warnings) == (0.5, ())


def test_a_long_header_and_unknown_chunks_are_fine(read):
    whole = midi(extra=b"more to come", count=1)
    whole += chunk(b"XFIH", b"\xff\x00") + chunk(b"MTrk", on(0, 60) + END) + chunk(b"abcd", b"")
    score = read(whole)
    assert (len(score.events), score.warnings) == (1, ())


@pytest.mark.parametrize("count", [0, 1, 7, 65535])
def test_a_wrong_count_of_tracks_is_told_and_otherwise_ignored(read, count):
    score = read(midi(on(0, 60) + END, on(0, 62) + END, count=count))
    assert len(score.events) == 2
    assert score.warnings == (f"{count} tracks announced, 2 found",)


def test_a_file_cut_short_plays_as_far_as_it_goes(read):
    whole = midi(on(0, 60) + off(100, 60) + on(0, 62) + off(100, 62) + END)
    score = read(whole[:-7])  # the last note-off lost its velocity
    assert [time for time, _ in told(score)] == [0.0, 0.5, 0.5]
    assert score.duration_s == 0.5
    assert score.warnings == ("the file is cut short", "a track ends in the middle of an event")


def test_a_track_with_a_wrong_length_does_not_hide_the_next(read):
    first, second = on(0, 60) + END, on(0, 62) + END
    for length in (len(first) - 3, len(first)):
        data = midi(count=2) + chunk(b"MTrk", first, length) + b"\x00" + chunk(b"MTrk", second)
        score = read(data)
        assert [event.message.note for event in score.events] == [60, 62]
        assert "bytes outside any chunk skipped" in score.warnings


def test_a_riff_wrapper_is_taken_off(read):
    inner = midi(on(0, 60) + off(100, 60) + END)
    info = b"LIST" + struct.pack("<I", 3) + b"abc" + b"\x00"  # padded to an even length
    body = b"RMID" + info + b"data" + struct.pack("<I", len(inner)) + inner
    score = read(b"RIFF" + struct.pack("<I", len(body)) + body)
    assert (len(score.events), score.duration_s, score.warnings) == (2, 0.5, ())


def test_a_type_2_file_plays_its_tracks_in_turn_each_with_its_own_tempo(read):
    slow = tempo(0, 1_000_000) + on(0, 60) + off(100, 60) + END
    plain = on(0, 62) + b"\x64\xff\x2f\x00"  # left sounding
    score = read(midi(slow, plain, plain, kind=2))
    assert told(score) == [
        (0.0, [0x90, 60, 80]),
        (1.0, [0x80, 60, 0]),
        (1.0, [0xFF]),  # a system reset: notes left sounding end with it
        (1.0, [0x90, 62, 80]),
        (1.5, [0xFF]),
        (1.5, [0x90, 62, 80]),
    ]
    assert (score.duration_s, score.name) == (2.0, "tune")


def test_an_unknown_format_is_read_as_simultaneous_tracks(read):
    score = read(midi(on(0, 60) + END, on(0, 62) + END, kind=9))
    assert [event.time_s for event in score.events] == [0.0, 0.0]
    assert score.warnings == ("unknown format 9, read as format 1",)


# ---------------------------------------------------------------- refusals


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "is empty"),
        (b"Dear player, here is the tune: la la la.\n", "is not a MIDI file"),
        (b"\x00" + midi(on(0, 60) + END), "is not a MIDI file"),
        (b"RIFF\x24\0\0\0WAVEfmt \x10\0\0\0", "is not a MIDI file"),
        (b"RIFF\x24\0\0\0RMIDLIST\x00\0\0\0", "is not a MIDI file"),
        (b"MThd", "has a damaged header"),
        (b"MThd\x00\x00\x00\x02\x00\x01", "has a damaged header"),
        (midi(), "has no playable track"),
        (midi(tempo(0, 500_000) + END), "has no playable track"),
        (midi(b""), "has no playable track"),
    ],
)
def test_what_is_not_a_tune_is_refused_in_one_line(read, tmp_path, data, reason):
    with pytest.raises(ScoreError) as refusal:
        read(data)
    assert str(refusal.value) == f"{tmp_path / 'tune.mid'}: {reason}"


def test_a_missing_file_and_a_folder_are_refused_by_name(tmp_path):
    with pytest.raises(ScoreError, match=r"gone\.mid: cannot be read \(no such file"):
        read_score(tmp_path / "gone.mid")
    with pytest.raises(ScoreError, match=r"cannot be read \(is a directory\)"):
        read_score(str(tmp_path))


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_one_may_not_read_is_refused(tmp_path):
    path = tmp_path / "secret.mid"
    path.write_bytes(midi(on(0, 60) + END))
    path.chmod(0)
    with pytest.raises(ScoreError, match=r"secret\.mid: cannot be read \(permission denied\)"):
        read_score(path)


@pytest.mark.parametrize("name", ["two\nlines.mid", "stray\udcff.mid", "nul\0.mid"])
def test_an_odd_name_still_makes_one_printable_line(name):
    with pytest.raises(ScoreError) as refusal:
        read_score(name)
    assert str(refusal.value).isprintable()


def test_a_huge_file_is_refused_unread(tmp_path):
    path = tmp_path / "huge.mid"
    with path.open("wb") as file:
        file.truncate(64 * 2**20 + 1)
    with pytest.raises(ScoreError, match=r"huge\.mid: larger than 64 MiB"):
        read_score(path)


def test_more_messages_than_memory_should_hold_are_refused(read, monkeypatch):
    monkeypatch.setattr(smf, "MAX_EVENTS", 3)
    assert len(read(midi(on(0, 60) + on(0, 61) + END, on(0, 62) + END)).events) == 3
    with pytest.raises(ScoreError, match="has more than 3 events"):
        read(midi(on(0, 60) + on(0, 61) + END, tempo(0, 9) + on(0, 63) + END))


def test_more_tracks_than_a_header_can_count_are_refused(read):
    with pytest.raises(ScoreError, match="has more than 65535 tracks"):
        read(midi(on(0, 60), kind=2) + chunk(b"MTrk", b"") * 65_535)


# ---------------------------------------------------------------- damage at random


def damaged(rng: random.Random, data: bytes) -> bytes:
    out = bytearray(data)
    for _ in range(rng.randrange(1, 6)):
        at = rng.randrange(len(out) + 1)
        match rng.randrange(4):
            case 0:
                out[at : at + 1] = bytes([rng.randrange(256)])
            case 1:
                del out[at : at + rng.randrange(1, 9)]
            case 2:
                out[at:at] = rng.randbytes(rng.randrange(1, 9))
            case _:
                out[at : at + 2] = rng.choice([b"\xff\xff", b"\x00\x00", b"\x80\x80", b"\xf7\xf0"])
    return bytes(out)


def test_no_bytes_whatever_raise_anything_but_a_score_error(read):
    rng = random.Random(20)
    track = tempo(0, 400_000) + on(0, 60) + b"\x60\x3c\x00" + b"\x00\xf0\x02\x01\xf7" + END
    inner = midi(track, on(3, 62, channel=9) + off(200, 62, channel=9) + END)
    wrapped = b"RIFF\0\0\0\0RMIDdata" + struct.pack("<I", len(inner)) + inner
    seeds = [inner, wrapped, midi(track, track, kind=2), midi(track, division=0xE728)]
    played, refusals = 0, set()
    for turn in range(4000):
        if turn % 4:
            data = damaged(rng, rng.choice(seeds))
        else:
            data = midi(rng.randbytes(rng.randrange(200)), division=rng.randrange(2**16))
        try:
            score = read(data)
        except ScoreError as refusal:
            refusals.add(str(refusal))
            continue
        played += 1
        times = [event.time_s for event in score.events]
        assert times == sorted(times)
        assert 0.0 <= times[0] <= times[-1] <= score.duration_s
        assert not any(event.message.is_meta for event in score.events)
        first_bytes = {event.message.bytes()[0] for event in score.events}
        assert all(0x80 <= byte < 0xF0 or byte == 0xFF for byte in first_bytes)
    assert played > 2000
    assert all(refusal.isprintable() for refusal in refusals)


def test_a_file_cut_anywhere_keeps_a_beginning_of_the_whole(read):
    whole = midi(b"".join(on(10, note) for note in range(30, 90)) + END)
    full = told(read(whole))
    for length in range(len(whole)):
        try:
            part = told(read(whole[:length]))
        except ScoreError:
            assert length < 22 + 4  # headers and the first note
        else:
            assert part == full[: len(part)]
            assert len(part) == min((length - 22) // 4, 60)


# ---------------------------------------------------------------- one after another


def sound(time_s: float, *data: int) -> ScoreEvent:
    return ScoreEvent(time_s, mido.Message.from_bytes(data))


def test_scores_in_a_row_start_when_the_one_before_has_passed():
    first = Score((sound(0.0, 0x90, 60, 80), sound(1.0, 0x80, 60, 0)), 1.5, "one", ("odd",))
    second = Score((sound(0.25, 0x90, 62, 80), sound(0.5, 0x90, 62, 0)), 1.0, "two")
    both = concatenate([first, second])
    assert told(both) == [
        (0.0, [0x90, 60, 80]),
        (1.0, [0x80, 60, 0]),
        (1.5, [0xFF]),
        (1.75, [0x90, 62, 80]),
        (2.0, [0x90, 62, 0]),
    ]
    assert (both.duration_s, both.name, both.warnings) == (2.5, "one + two", ("one: odd",))


def test_a_long_silence_at_the_end_is_cut_with_a_warning(read):
    score = read(midi(on(0, 60) + off(100, 60) + b"\xff\xff\xff\x7f\xff\x2f\x00"))
    assert score.duration_s == pytest.approx(score.events[-1].time_s + 30.0)
    assert score.warnings == ("silence at the end cut to 30 s",)


def test_nothing_in_a_row_is_nothing():
    assert concatenate([]) == Score((), 0.0)


def test_scores_in_a_row_may_not_last_longer_than_a_day():
    half = Score((), 50_000.0)
    with pytest.raises(ScoreError, match=r"lasts 27\.8 hours"):
        concatenate([half, half])


HEAD = b"MThd" + bytes((0, 0, 0, 6, 0, 0, 0, 1, 1, 224))
NOTE = bytes((0, 0x90, 67, 90))


@pytest.mark.parametrize(
    "event",
    [
        bytes((0, 0x90, 0xFF, 0xFF)),
        bytes((0, 0xFF, 0x01, 0)),
        bytes((0, 0xF0, 0)),
        bytes((0, 0xF8)),
        bytes((0, 0xFF, 0x51, 3, 0, 0, 1)),
        NOTE,
    ],
    ids=["damaged", "text", "sysex", "system", "tempo", "note"],
)
def test_events_of_any_kind_are_bounded(tmp_path, monkeypatch, event):
    monkeypatch.setattr(smf, "MAX_EVENTS", 100)
    path = tmp_path / "x.mid"
    for count, is_read in ((99, True), (100, False)):
        track = NOTE + event * count
        path.write_bytes(HEAD + b"MTrk" + len(track).to_bytes(4, "big") + track)
        if is_read:
            assert read_score(path).events
        else:
            with pytest.raises(ScoreError, match="more than 100 events"):
                read_score(path)


def test_chunks_are_bounded(tmp_path, monkeypatch):
    monkeypatch.setattr(smf, "MAX_CHUNKS", 10)
    path = tmp_path / "x.mid"
    path.write_bytes(HEAD + b"MTrk\0\0\0\4" + NOTE + b"XXXX\0\0\0\0" * 9)
    assert read_score(path).events
    path.write_bytes(HEAD + b"MTrk\0\0\0\4" + NOTE + b"XXXX\0\0\0\0" * 10)
    with pytest.raises(ScoreError, match="more than 10 chunks"):
        read_score(path)
