"""Captures: written as commands are applied, readable whatever ends them."""

import json
import random
from dataclasses import fields, replace

import numpy as np
import pytest
from sound import rms, run

from yehu_server.core.controls.slots import SILENCE
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import MAX_PARTS
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.player.bowing import default_bowing_table
from yehu_server.core.player.commands import (
    BEGIN,
    COMMAND,
    DRAW,
    END,
    EXPRESS,
    HOLD,
    KINDS,
    LIFT,
    RAMP,
    RELEASE,
    SLIDE,
    STOP,
    WRITE,
)
from yehu_server.core.player.fingering import OpenStrings
from yehu_server.core.player.note_tables import PITCHES, ROWS_OF_A_YEHU, SPEEDS, NoteTables
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.errors import OutputError, ScoreError, YehuError
from yehu_server.params.table import ENGINE, SLOT, TABLE, find
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.rendering.replay import blocks, replay
from yehu_server.scores.capture import read_capture
from yehu_server.scores.capture_format import build
from yehu_server.scores.capture_header import SessionStart, session_start_of
from yehu_server.scores.capture_writer import CaptureWriter, LiveCapture
from yehu_server.system.terminals import quoted

RATE = 48000.0
TENSIONS = (49.5, 64.1)
TUNED = override(Quantities(), {"string_1": {"T": TENSIONS[0]}, "string_2": {"T": TENSIONS[1]}})
SPEED, SIDE = SLOT["/bow/speed"], SLOT["/bow/side"]


@pytest.fixture(scope="module")
def plain() -> SessionStart:
    """An instrument without calibration, without a room."""
    return SessionStart((InstrumentSpec(RATE, TUNED, seed=3),), has_room=False)


@pytest.fixture
def write(plain):
    def write(path, commands=(), end=None, gaps=(), lost=0):
        writer = CaptureWriter(path, beginning=plain)
        writer.commands(np.array(list(commands), COMMAND))
        for frame in gaps:
            writer.note("rest", frame, since=frame)
        if lost:
            writer.note("lost", 5, events=lost)
        if end is not None:
            writer.close(end)
        writer._file.close()  # as a crash does
        return path

    return write


def first_version(path, ramps=(), values=None, end=None, gaps=()):
    """A file as the first version wrote it: of moves of bow and fingers."""
    defaults = {param.address: param.default for param in ENGINE}
    header = {"format": "yehu-server capture", "version": 1, "rate": RATE, "seed": 0}
    header |= {"tensions": list(TENSIONS), "build": build()}
    header["values"] = defaults if values is None else values
    lines = [header, *ramps, *({"rest": frame, "since": frame} for frame in gaps)]
    lines += [] if end is None else [{"end": end}]
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    return path


def replayed(path) -> np.ndarray:
    capture = read_capture(path)
    samples = np.concatenate(list(blocks(capture, capture.beginning.ensemble())))
    if not capture.beginning.has_room:
        assert (samples[:, 0] == samples[:, 1]).all()
    return samples[:, 0]


RAMPS = [
    (0, RAMP, SIDE, 1.0, 480.0),
    (7, RAMP, SPEED, 0.1 + 0.2, 960.0),
    (9000, RAMP, SILENCE, 0.0, 0.0),
]


def odd(param) -> float:
    """A value of a parameter that takes all digits to write."""
    return param.lo + (param.hi - param.lo) / 7.0


EACH_KIND = {
    "ramp": [
        *((0, RAMP, SLOT[param.address], odd(param), 2.0**53) for param in ENGINE),
        *((1, RAMP, SLOT[param.address], param.lo, 0.0) for param in ENGINE),
        (2, RAMP, SILENCE, 0.0, 0.0),
    ],
    "write": [(0, WRITE, index, odd(param), 100.0 / 7.0) for index, param in enumerate(TABLE)],
    "hold": [(0, HOLD, index, odd(param), 0.0) for index, param in enumerate(TABLE)],
    "express": [(0, EXPRESS, index, odd(param), 0.0) for index, param in enumerate(TABLE)],
    "begin": [(0, BEGIN, -1, 200.0 / 3.0, 617.0 / 9.0), (0, BEGIN, 1 << 20, 127.0, 0.0)],
    "end": [(5, END, -1, 200.0 / 3.0, 1.0), (5, END, 3, 0.0, 0.0)],
    "slide": [(5, SLIDE, 0, 617.0 / 9.0, 0.0)],
    "draw": [(5, DRAW, 0, -0.1 / 3.0, 1.0 / 3.0), (6, DRAW, 0, 0.0, 0.0)],
    "lift": [(5, LIFT, 0, 0.0, 0.0)],
    "stop": [(5, STOP, 0, 0.0, 0.0), (5, STOP, 0, 1.0, 0.0)],
    "release": [(5, RELEASE, 0, 0.0, 0.0)],
}


def test_each_kind_of_command_is_read_to_the_bit(tmp_path, write):
    assert EACH_KIND.keys() == set(KINDS)
    for kind, commands in EACH_KIND.items():
        path = write(tmp_path / kind, commands, end=9)
        assert {json.loads(line)[2] for line in path.read_text().splitlines()[1:-1]} == {kind}
        capture = read_capture(path)
        assert capture.commands.dtype == COMMAND
        assert capture.commands.tolist() == commands, kind
        header = (capture.version, capture.rate, capture.frames, capture.warnings)
        assert header == (3, RATE, 9, [])


def measured(seed: int = 1) -> NoteTables:
    """A calibration that might have been measured; its values take all digits to write."""
    chance = random.Random(seed)
    sharpening, levels = (
        tuple(
            tuple(tuple(chance.uniform(*within) for _ in SPEEDS) for _ in (*pitches, *more))
            for pitches in PITCHES
        )
        for within, more in [((-30.0, 60.0), ()), ((-40.0, -20.0), (None,))]
    )
    return NoteTables(440.0, (50.4 + chance.random(), 64.0 + chance.random()), sharpening, levels)


def test_an_instrument_is_read_as_it_began(tmp_path):
    """With strings, hair and body of its own, such as those of a section."""
    bowing = default_bowing_table() * 1.01
    calibration, usual = measured(), Quantities()
    body = replace(usual.body, mass=tuple(1.01 * mass for mass in usual.body.mass))
    own = replace(usual, body=body, bow=replace(usual.bow, hair=7.0, xi=(0.6, 0.5)))
    spec = InstrumentSpec(
        44100.0,
        calibration.tuned(own),
        calibration=calibration,
        open_strings=OpenStrings.NEVER,
        seed=17,
        bowing=bowing,
        start_values={"/output/gain": -7.0 / 3.0, "/playing/speed": 0.3, "/engine/seed": 5.0},
    )
    began = Instrument(spec)
    expected = began._rig.copy()
    run(began, 100)
    began.post(BEGIN, value=69.0, other=69.0)  # what happens afterwards is no beginning
    run(began, 100)
    beginning = session_start_of([began], has_room=False)
    CaptureWriter(tmp_path / "c", beginning=beginning).close(0)
    again = read_capture(tmp_path / "c").beginning.ensemble().first
    for part in ("model", "state", "controls", "player"):
        for name in expected[part].dtype.names:
            np.testing.assert_array_equal(again._rig[part][name], expected[part][name], name)
    assert (again.spec.calibration, again.spec.quantities) == (calibration, spec.quantities)


def test_a_session_that_crashed_can_be_read_with_a_warning_of_what_it_lost(tmp_path, write):
    path = write(tmp_path / "c", RAMPS)
    path.write_text(path.read_text()[:-9])  # in the middle of the last line
    capture = read_capture(path)
    assert len(capture.commands) == 2
    assert capture.frames == 8 + 48000
    assert "did not end properly" in capture.warnings[0]
    path = write(tmp_path / "d", RAMPS, end=9001, lost=4)
    path.write_text(path.read_text().replace(build()["sources"], "0" * 16))
    warnings = " ".join(read_capture(path).warnings)
    assert "4 events" in warnings
    assert "another build (sources)" in warnings


def test_what_is_no_capture_is_refused(tmp_path):
    path = tmp_path / "c"
    for data, reason in [
        (b"", "not a capture"),
        (b"{}", "not a capture"),
        (b"[1]", "expected a table"),
        (b"RIFF\xff\xfe", r"not a capture \(a capture is text, .jsonl\)"),
        (b'{"format": "yehu-server capture", "version": 99}', "version 99"),
    ]:
        path.write_bytes(data)
        with pytest.raises(ScoreError, match=reason):
            read_capture(path)


def test_what_cannot_be_read_or_written_is_an_error_in_one_line(tmp_path, plain, write):
    out_of_order = write(tmp_path / "c", [(5, LIFT, 0, 0, 0), (4, LIFT, 0, 0, 0)], end=10)
    rests = write(tmp_path / "d", RAMPS, gaps=range(9000, 11000))
    for path, reason in (
        (out_of_order, "order"),
        (rests, "too many"),
        (tmp_path / "none", "no such file"),
    ):
        with pytest.raises(ScoreError, match=reason):
            read_capture(path)
    with pytest.raises(OutputError, match="does not exist"):
        CaptureWriter(tmp_path / "none" / "c", beginning=plain)


# ---------------------------------------------------------------- replays


ADDRESSES = [
    *("/playing/dynamics", "/playing/speed", "/playing/bend", "/playing/vibrato"),
    *("/playing/pressure", "/playing/tremolo", "/playing/string", "/playing/portamento"),
    *("/playing/pizzicato", "/playing/variation", "/playing/press", "/body/evenness"),
    *("/bow/speed", "/bow/force", "/finger/2/press", "/string/outer/tuning", "/engine/seed"),
]


def command_something(instrument, commands, chance) -> None:
    """Ask a player for anything, mostly for notes: now, soon, or for a frame that has passed."""
    frame = instrument.frame + chance.choice([-500, 0, 0, 1, 30, 700])
    what = chance.randrange(12)
    key = Key(chance.choice([-1, 0, 5]), chance.choice([65, 66.25, 69, 72, 74, 77.5, 88, 40]))
    if what < 4:
        values = {"/playing/dynamics": chance.random(), "/playing/attack": 20.0 * chance.random()}
        commands.note_on(key, values, frame=frame)
    elif what < 6:
        ending = commands.held()[: chance.randrange(1, 3)]
        if ending:
            commands.post(EXPRESS, frame, INDEX["/playing/speed"], 0.2)
        commands.notes_off(ending, frame=frame)
    elif what < 9:
        param = find(chance.choice(ADDRESSES))
        value = chance.uniform(param.lo, param.hi)
        glide_ms, hold = chance.choice([0.0, 33.3]), chance.random() < 0.1
        commands.write(param.address, value, frame=frame, hold=hold, glide_ms=glide_ms)
    elif what == 9:
        commands.slide(60.0 + 30.0 * chance.random(), frame=frame)
        commands.draw(chance.uniform(-0.3, 0.3), chance.random(), frame=frame)
    elif what == 10:
        commands.lift(frame=frame)
        commands.notes_off(commands.held(), frame=frame)
        commands.stop_sound(frame=frame)
    elif chance.random() < 0.3:
        commands.release(frame=frame)


@pytest.mark.parametrize(("seed", "players"), [(1, 1), (2, 3), (3, 2)])
def test_a_session_on_a_stage_is_replayed_to_the_bit(tmp_path, seed, players):
    """Of calibrated instruments, in a room; also where the process died in it."""
    chance, said = random.Random(seed), []
    per_part = [
        PlayingOptions(seed=seed + i, open_strings=list(OpenStrings)[seed % 3])
        for i in range(players)
    ]
    stage = Ensemble(
        [playing.spec(RATE, measured(seed), body=playing.seed) for playing in per_part]
    )
    asked = [playing.player(one) for playing, one in zip(per_part, stage.instruments, strict=True)]
    for one in stage.instruments:
        one.report_commands()
    capture = LiveCapture(stage, tmp_path / "c", said.append, has_room=True)
    played, frames = [], 0
    while frames < 2 * RATE:
        if chance.random() < 0.3:
            number = chance.randrange(players)
            command_something(stage.instruments[number], asked[number], chance)
        if chance.random() < 0.05:
            address = chance.choice(["/room/size", "/room/level", "/room/pan", "/room/decay"])
            stage.instruments[chance.randrange(players)].write(address, chance.uniform(0.2, 1.0))
        block = chance.choice([1, 64, 100, 512])
        played.append(np.zeros((block, 2), np.float32))
        stage.process(played[-1])
        frames += block
        if seed % 2 and frames > RATE and not stage.gaps:
            first = stage.first._rig
            first["meters"]["running"] = 1  # the process died before it had reported the block
            first["taped"] -= block
            stage.recover()
            assert stage.gaps == [(frames - block, frames)]
            played[-1][:] = 0.0
        if chance.random() < 0.2:
            capture.keep_up()
    capture.close()
    meters = [one.meters() for one in stage.instruments]
    assert sum(each["late_events"] for each in meters) > 5
    assert sum(commands.notes_played for commands in asked) > 20
    read = read_capture(tmp_path / "c")
    assert np.bincount(read.players).tolist() == [each["applied"] for each in meters]
    assert len(set(read.commands["kind"])) > 6
    assert bool(read.gaps) == bool(seed % 2)
    assert read.frames == frames
    (kept,) = said
    assert f"{len(read.commands)} events; `" in kept
    assert f" replay {quoted(str(tmp_path / 'c'))} -o OUT.wav` renders it" in kept
    expected = np.concatenate(played)
    assert rms(expected) > 0.001
    assert (expected[:, 0] != expected[:, 1]).any()
    again = np.concatenate(list(blocks(read, read.beginning.ensemble())))
    np.testing.assert_array_equal(again, expected)


def test_what_players_have_in_common_is_written_once(tmp_path):
    of, apart = measured(), range(MAX_PARTS - 2)
    players = [InstrumentSpec(RATE, calibration=of, seed=seed, body=seed) for seed in range(3)]
    players += [
        InstrumentSpec(
            RATE, calibration=measured(i), bowing=default_bowing_table() * (1.01 + i / 97.0)
        )
        for i in apart[1:]
    ]
    CaptureWriter(tmp_path / "c", beginning=SessionStart(tuple(players), has_room=True)).close(9)
    header = json.loads((tmp_path / "c").read_text().splitlines()[0])
    assert [player["calibration"] for player in header["players"][1:3]] == [1, 1]
    assert [player["bowing"] for player in header["players"][1:3]] == [1, 1]
    again = read_capture(tmp_path / "c").beginning.players
    assert [each.calibration for each in again] == [each.calibration for each in players]
    assert [each.body for each in again] == [each.body for each in players]
    np.testing.assert_array_equal([each.bowing for each in again], [e.bowing for e in players])


# ---------------------------------------------------------------- files of version 1

MOVES = [
    [0, "/bow/side", 1.0, 480],
    [7, "/bow/speed", 0.1 + 0.2, 960],
    [7, "/finger/1/position", 0.1, 0],
    [7, "/finger/1/press", 1.5, 240],
    [6000, "/bow/speed", -0.15, 100],
    [9000, "silence", 0.0, 0],
    [9500, "/output/level", 0.5, 1000],
]


def written(moves, gaps=(), **options) -> np.ndarray:
    """What an instrument plays whose parameters move so."""
    instrument = Instrument(InstrumentSpec(RATE, TUNED, **options))
    for frame, address, target, ramp in moves:
        if address == "silence":
            instrument.silence(frame=frame)
        else:
            instrument.write(address, target, frame=frame, ramp_ms=ramp * 1e3 / RATE)
    out = np.zeros(15000, np.float32)
    start = 0
    for stop in (*gaps, len(out)):
        instrument.process(out[start:stop])
        if stop < len(out):
            instrument.come_to_rest()
        start = stop
    return out


def test_a_file_of_version_1_sounds_as_its_ramps_do_from_its_own_values(tmp_path):
    """The defaults of its day; what it does not know has today's. After a rest its notes go on."""
    own = {"/bow/position": 0.2, "/output/gain": -3.0, "/string/outer/tuning": 40.0}
    unknown = {"/bow/noise", "/bow/assist", "/output/limiter", "/string/inner/loss"}
    assert unknown < set(SLOT)
    values = {param.address: param.default for param in ENGINE if param.address not in unknown}
    path = first_version(tmp_path / "c", MOVES, values | own, end=15000, gaps=[5000])
    capture = read_capture(path)
    assert (capture.version, len(capture.commands), capture.warnings) == (1, len(MOVES), [])
    samples = replayed(path)
    np.testing.assert_array_equal(samples, written(MOVES, gaps=[5000], start_values=own))
    assert rms(samples[5500:9000]) > 0.001


# ---------------------------------------------------------------- files


def test_a_full_disk_leaves_whole_lines(tmp_path, plain):
    resource = pytest.importorskip("resource", reason="there is no such limit on Windows")
    path = tmp_path / "c"
    writer = CaptureWriter(path, beginning=plain)
    begun = path.read_bytes()
    first = json.dumps([1, 1, "ramp", "/bow/speed", 0.5, 0]) + "\n"
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(begun) + len(first) + 9, hard))
    try:
        with pytest.raises(OutputError, match="cannot write"):
            writer.commands(np.array([(frame, RAMP, SPEED, 0.5, 0.0) for frame in (1, 2)], COMMAND))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert path.read_bytes() == begun + first.encode()
    assert len(read_capture(path).commands) == 1


def test_an_older_capture_is_replaced_only_where_that_is_asked_for(tmp_path, write, plain):
    path = write(tmp_path / "c", RAMPS, end=12345)
    older = path.read_bytes()
    with pytest.raises(OutputError, match="exists"):
        CaptureWriter(path, beginning=plain)
    assert path.read_bytes() == older
    CaptureWriter(path, beginning=plain, overwrite=True).close(7)
    assert read_capture(path).frames == 7
    CaptureWriter(path, beginning=plain, overwrite=True).discard()  # of nothing
    assert list(tmp_path.iterdir()) == []


# ---------------------------------------------------------------- hostile files

HUGE = "9" * 400
DEEP = "[" * 20_000


NO_FRAMES = [
    f'{{"end": {HUGE}}}',
    f'{{"end": {"9" * 5000}}}',
    '{"end": true}',
    '{"rest": 5, "since": 9}',
    '{"rest": 5}',
    '{"lost": 5, "events": -1}',
    '"end"',
    "17",
    DEEP,
    '{"a":' * 10_000,
    "\x00",
]
NO_RAMPS = [
    '[-1, "/bow/speed", 0.1, 0]',
    '[0, "/bow/speed", 9e18, 441]',
    f'[0, "/bow/speed", 0.1, {2**63}]',
    '[0, "silence", 1.0, 0]',
    '[0, ["/bow/speed"], 0.1, 0]',
    '[0, "begin", 0, 69.0, 69.0]',
]
NO_COMMANDS = [
    *("nonsense", "[]", "[0]", "[0, 1]", "[0, 1, 4]", '[0, 1, "jump"]', '[0, 1, ["lift"]]'),
    # Frames and players that there are not; as in version 2, and in version 1.
    *(
        f'[{at}, "lift"]'
        for at in (f"{2**63 - 1}, 1", "1e3, 1", "-1, 1", "0, 0", "0, 2", "0, true")
    ),
    *('[1, "ramp", "/bow/speed", 0.1, 0]', '[1, "/bow/speed", 0.1, 0]'),
    *(f'[0, 1, "ramp", "/bow/speed", {to}]' for to in ("0.1", "9e18, 441", "NaN, 0", f"{HUGE}, 0")),
    *(f'[0, 1, "ramp", "/bow/speed", 0.1, {frames}]' for frames in (2**63, -5)),
    *('[0, 1, "ramp", "silence", 1.0, 0]', '[0, 1, "ramp", ["/bow/speed"], 0.1, 0]'),
    # The player has this one.
    *(f'[0, 1, "ramp", "{address}", 0.1, 0]' for address in ("/no/such", "/playing/speed")),
    *(
        f'[0, 1, "write", "/playing/speed", {to}]'
        for to in ("0.1", "9e9, 0", "0.1, -1", "0.1, 1e9")
    ),
    *('[0, 1, "hold", "/no/such", 0.1, 0]', '[0, 1, "express", "/playing/speed", NaN]'),
    '[0, 1, "express", "/playing/speed", 0.1, 0]',
    *(f'[0, 1, "begin", {key}, 69, 69]' for key in (0.5, -2000000, 2**63)),
    *(f'[0, 1, "begin", 0, {how}]' for how in ("69", "NaN, 69", "69, 127.5", '69, "A4"')),
    *('[0, 1, "end", 0, 69, 2]', '[0, 1, "end", 0, 69]', '[0, 1, "lift", 0]'),
    *('[0, 1, "slide"]', '[0, 1, "slide", Infinity]', '[0, 1, "release", 2]'),
    *(f'[0, 1, "draw", {how}]' for how in ("0.1", "99, 0.1", "0.1, -1")),
    *('[0, 1, "stop"]', '[0, 1, "stop", 2]', '[0, 1, "stop", 0, 0]'),
]


def refuse_lines(path, lines) -> None:
    """Each of some lines, after two others, is refused by its number."""
    begun, taken = path.read_text(), []
    for line in lines:
        path.write_text(f'{begun}{line}\n{{"end": 100}}\n')
        if "line 3: not a line of a capture" not in refusal_of(path):
            taken.append(line[:60])
    assert taken == []


def refusal_of(path) -> str:
    """What is said of a capture that is refused in one line; nothing where it is read."""
    try:
        read_capture(path)
    except ScoreError as error:
        text = str(error)
        return text if text.startswith(f"{path}: ") and "\n" not in text and len(text) < 500 else ""
    return ""


def test_a_line_that_no_instrument_wrote_is_named_and_refused(tmp_path, write):
    refuse_lines(write(tmp_path / "c", RAMPS[:1]), [*NO_COMMANDS, *NO_FRAMES])
    refuse_lines(first_version(tmp_path / "first", MOVES[:1]), [*NO_RAMPS, *NO_FRAMES])


def test_a_capture_of_years_is_refused_unless_it_is_asked_for(tmp_path, write):
    for how in ({"end": 2**53}, {"end": 100, "gaps": [10**12]}):
        capture = read_capture(write(tmp_path / str(how), RAMPS, **how))
        assert capture.frames == max(how["end"], *how.get("gaps", [0]))
        with pytest.raises(ScoreError, match="--max-duration"):
            replay(capture, tmp_path / "x.wav", format_name="wav", subtype="16", max_duration_h=12)
        assert not (tmp_path / "x.wav").exists()


def test_a_long_session_is_read_whole(tmp_path, monkeypatch, write):
    commands = [(frame, RAMP, SPEED, 0.1, 0.0) for frame in range(10)]
    assert read_capture(write(tmp_path / "c", commands)).commands.tolist() == commands
    monkeypatch.setattr("yehu_server.scores.capture.MAX_COMMANDS", 8)
    with pytest.raises(ScoreError, match="more than 8 events"):
        read_capture(tmp_path / "c")


def with_header(path, **changes):
    """A capture whose first line has other values; None removes one."""
    first, *rest = path.read_text().splitlines(keepends=True)
    header = json.loads(first)
    own = header["players"][0].keys() & changes
    for part, names in ((header["players"][0], own), (header, changes.keys() - own)):
        part |= {name: changes[name] for name in names}
        for name in [name for name, value in part.items() if value is REMOVED]:
            del part[name]
    path.write_text(json.dumps(header) + "\n" + "".join(rest))
    return path


REMOVED = "removed"  # compared by identity
NAN, INFINITY = float("nan"), float("inf")
CALIBRATION = {
    "a4": 440.0,
    "tensions": list(measured().tensions),
    "sharpening": measured().sharpening,
    "levels": measured().levels,
}
BOWING = default_bowing_table().tolist()
USUAL = Quantities().body


def bowing_with(value: object) -> list:
    """A table with something else in one place."""
    table = default_bowing_table().astype(object)
    table[-1, -1, -1, -1] = value
    return table.tolist()


BODY = {item.name: getattr(USUAL, item.name) for item in fields(USUAL)}
NO_BODIES = [  # more of their kind are in tests/core/physics/test_quantities.py
    *({name: value} for name in BODY if name != "radiation_rate" for value in (None, "x", NAN)),
    {"mass": [*USUAL.mass, 0.1]},
    {"damping": [-1e-9, *USUAL.damping[1:]]},
    {"sections": [[1.0, 1.0, 0.0, 1.1], *USUAL.sections[1:]]},
    {"sections": [*USUAL.sections] * 3},
]


def test_the_header_that_is_changed_below_is_one(tmp_path, write):
    """Of a time when both strings had one table, it counts for both."""
    for bowing in (BOWING, BOWING[0]):
        path = write(tmp_path / str(len(bowing)), end=5)
        path = with_header(path, calibration=CALIBRATION, bowing=bowing)
        (player,) = read_capture(path).beginning.players
        assert player.calibration == measured()
        assert player.bowing.tolist() == (BOWING if bowing is BOWING else [bowing] * 2)


def test_tables_of_a_time_when_they_had_fewer_high_notes_go_on_as_they_end(tmp_path, write):
    former = {
        name: [rows[: ROWS_OF_A_YEHU + more] for rows in CALIBRATION[name]]
        for name, more in (("sharpening", 0), ("levels", 1))
    }
    path = with_header(
        write(tmp_path / "c", end=5), calibration={**CALIBRATION, **former}, bowing=BOWING
    )
    found = read_capture(path).beginning.players[0].calibration
    for name, tables in former.items():
        for table, rows in zip(getattr(found, name), tables, strict=True):
            assert table == (*rows, *[rows[-1]] * (len(table) - len(rows)))
    assert {len(table) for table in found.sharpening} == {len(PITCHES[0])}


def no_beginnings():
    """Changes of a header that make it none."""
    return [
        *({name: REMOVED} for name in ("version", "rate", "room", "seed", "open_strings")),
        *({name: REMOVED} for name in ("players", "quantities")),
        *({name: REMOVED} for name in ("calibration", "bowing", "build", "values")),
        *({"rate": rate} for rate in (0, -48000, 10**400, NAN, INFINITY, None, "48000")),
        *({"version": version} for version in (0, 4, 3.0, True, "3", None, [3], "3\n")),
        *({"seed": seed} for seed in (-1, 1.5, "3", None, True, 2**60, NAN)),
        *({"open_strings": when} for when in ("sometimes", 1, None, [], "a\nb")),
        *({"players": of} for of in (None, {}, [], [None], [{}], 3, [1] * 17)),
        *({"room": room} for room in (0, 1, None, "yes")),
        *({"body": body} for body in (-1, 0.5, "x", None, 2**60)),
        *({"quantities": of} for of in (None, [], 3, {"": 1}, {"string_1": 3}, {"body": 3})),
        {"quantities": {"string_1": {"T": 0}}},
        *({"quantities": {"body": {**BODY, **part}}} for part in NO_BODIES),
        *({"calibration": number} for number in (0, 1, 2, -1, 10**400)),
        *({"bowing": number} for number in (0, 1, 2, -1)),
        *({"build": build} for build in (None, 3, "x", [1])),
        *({"values": values} for values in (None, [], "x", ["/bow/speed"])),
        {"values": {"/no/such": 0.1}},
        {"values": {"/no/\nsuch": 0.1}},
        {"values": {"": 0.1}},
        *(
            {"values": {"/bow/speed": value}}
            for value in (9.0, -9.0, NAN, INFINITY, "0.1", "0\n1", None, [], {}, True, 10**400)
        ),
        *({"bowing": bowing} for bowing in (None, 1.0, [], BOWING[1:], [*BOWING, BOWING[0]], "x")),
        {"bowing": [[row[1:] for row in rows] for rows in BOWING]},
        {"bowing": [*BOWING[1:], [*BOWING[0][1:], BOWING[0][0][1:]]]},
        *({"bowing": bowing_with(value)} for value in (NAN, INFINITY, "a", None, 10**400)),
        {"bowing": BOWING[0][0]},  # of one place
        *({"calibration": calibration} for calibration in (0, [], {}, "x", True)),
        *({"calibration": {**CALIBRATION, "a4": a4}} for a4 in (0.0, -440.0, NAN, INFINITY, "x")),
        *(
            {"calibration": {**CALIBRATION, name: value}}
            for name in ("tensions", "sharpening", "levels")
            for value in (None, [], 1.0, [1.0], [[], []], "x", CALIBRATION["tensions"][:1])
        ),
        {"calibration": {**CALIBRATION, "tensions": [NAN, NAN]}},
        {"calibration": {**CALIBRATION, "tensions": [1e6, 64.0]}},
        {"calibration": {**CALIBRATION, "levels": CALIBRATION["sharpening"]}},
        {"calibration": {**CALIBRATION, "sharpening": [[[NAN] * 4] * 18, [[0.0] * 4] * 18]}},
    ]


def test_a_beginning_that_is_none_is_refused_in_one_line(tmp_path, write):
    path = write(tmp_path / "c", RAMPS, end=9001)
    text, taken = path.read_text(), []
    for changes in no_beginnings():
        path.write_text(text)
        if not refusal_of(with_header(path, **changes)):
            taken.append(str(changes)[:80])
    assert taken == []


# ---------------------------------------------------------------- files of version 2


def second_version(path, lines=(), **changes):
    """A file as the second version wrote it: of one player, without a room."""
    header = {"format": "yehu-server capture", "version": 2, "rate": RATE, "seed": 3}
    header |= {"open_strings": "always", "tensions": list(TENSIONS), "build": build()}
    header |= {"calibration": None, "bowing": default_bowing_table().tolist(), "values": {}}
    header |= changes
    path.write_text("".join(json.dumps(line) + "\n" for line in [header, *lines]))
    return path


NOTE = [[0, "begin", 0, 69.0, 69.0], [5000, "end", 0, 69.0, 0], {"end": 9600}]


def test_a_file_of_version_2_sounds_as_it_did_without_a_room(tmp_path):
    path = second_version(tmp_path / "c", NOTE)
    capture = read_capture(path)
    assert (capture.version, capture.beginning.has_room) == (2, False)
    instrument = Instrument(InstrumentSpec(RATE, TUNED, seed=3))
    instrument.post(BEGIN, frame=0, value=69.0, other=69.0)
    instrument.post(END, frame=5000, value=69.0)
    samples = replayed(path)
    assert rms(samples) > 0.001
    np.testing.assert_array_equal(samples, run(instrument, 9600))


def test_strings_that_no_model_can_hold_are_refused_before_anything_sounds(tmp_path):
    none = [50.0, [], [50.0], [50.0] * 3, ["a", "b"], [None, 1], {}]
    for tensions in [*none, [0, 64], [-50, 64], [50, 1e9], [50, 1e308], [NAN, 64]]:
        path = second_version(tmp_path / "c", NOTE, tensions=tensions)
        with pytest.raises(YehuError) as error:
            replay(read_capture(path), tmp_path / "x.wav", format_name="wav", subtype="16")
        assert len(str(error.value).splitlines()) == 1, tensions
        assert not (tmp_path / "x.wav").exists()
