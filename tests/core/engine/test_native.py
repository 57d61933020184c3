"""The machine code of the compiled calls, and the tape."""

import random
import re
import threading
from functools import cache

import compile_all
import llvmlite.binding as llvm
import numpy as np
import pytest
from sound import alone, bow

from yehu_server.core.engine import native
from yehu_server.core.engine import rig as memory
from yehu_server.core.engine.ensemble import TAPE_FRAMES, Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import WRITERS
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.engine.warming import all_functions, functions_beside
from yehu_server.core.physics.layout import F_HAMMER, F_N, F_PLUCK, FINGER_CONTROLS, MAX_FINGERS
from yehu_server.core.player.commands import BEGIN, DRAW, HOLD, SLIDE, WRITE
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.core.player.record import SILENT

RATE = 22050
FOR_STUDIES = [call for called in compile_all.MORE.values() for call in functions_beside(called)]
CALLS = {call.function.__name__: call for call in (*all_functions(), *FOR_STUDIES)}

# Everything that the audio thread may call: none of these waits or allocates.
REAL_TIME_SAFE = {
    *("clock_gettime", "memcpy", "memset", "memmove"),
    *("sqrt", "fabs", "floor", "ceil", "rint", "trunc"),  # LLVM's own: instructions
}


# ---------------------------------------------------------------- reading LLVM's code


@cache
def parts(name: str) -> dict[str, str]:
    """The optimised code of each function and global of a call, by name.

    It is what numba keeps beside the machine code, for callers that are compiled later; in a
    context of its own, as LLVM's global one is never freed.
    """
    kept = CALLS[name].compiled._library._get_module_for_linking()
    module = llvm.parse_bitcode(kept.as_bitcode(), llvm.create_context())
    return {part.name: str(part) for part in [*module.functions, *module.global_variables]}


def body(name: str) -> str:
    """The name of the call's own function, inside numba's wrapper."""
    function = CALLS[name].function
    path = [*function.__module__.split("."), name]
    is_mine = re.compile("_ZN" + "".join(f"{len(word)}{word}" for word in path) + "B")
    (mine,) = [part for part in parts(name) if is_mine.match(part)]
    return mine


@cache
def reached(name: str) -> dict[str, str]:
    """Everything that the call's own function refers to, directly or not."""
    known, found, ahead = parts(name), {}, [body(name)]
    while ahead:
        part = ahead.pop()
        if part in known and part not in found:
            found[part] = known[part]
            names = re.findall(r'@(?:"([^"]*)"|([-\w.$]+))', known[part])
            ahead += [quoted or plain for quoted, plain in names]
    return found


def inside(name: str) -> list[str]:
    """The names of the compiled functions that a call consists of, its own first."""
    is_defined = re.compile("^define ", re.MULTILINE).search
    return [part for part, code in reached(name).items() if is_defined(code)]


def lines(name: str) -> list[str]:
    return parts(name)[body(name)].splitlines()


def offsets(name: str) -> dict[str, int]:
    """The offset in the rig of each pointer of the call's own function."""
    step = re.compile(r"(%\S+) = getelementptr (?:inbounds |nuw )*i8, ptr %arg\.rigs?, i64 (\d+)$")
    found = (step.match(line.strip()) for line in lines(name))
    return {match[1]: int(match[2]) for match in found if match}


def atomics(name: str) -> list[list[str]]:
    """Loads, stores and fences between threads, and copies of whole records, by basic blocks."""
    at = {getattr(memory, f"{word}_AT"): word.lower() for word in WORDS}
    for writer in range(WRITERS):
        at[memory.POSTED_AT + writer * memory.CURSOR_BYTES] = "posted"
        at[memory.DRAINED_AT + writer * memory.CURSOR_BYTES] = "drained"
    where = offsets(name)
    blocks = [[]]
    for line in lines(name):
        word = re.search(r"(load|store) atomic i64.* ptr (%\S+) (\w+), align 8", line)
        if re.match(r"\S+:", line):
            blocks.append([])
        elif word:
            blocks[-1].append(f"{word[1]} {at[where[word[2]]]} {word[3]}")
        elif re.match(r"\s*fence", line):
            blocks[-1].append(line.strip())
        elif re.search(r"@llvm\.mem(cpy|move)\.", line):
            blocks[-1].append("copy")
    return [block for block in blocks if block]


WORDS = ["POSTED", "DRAINED", "REPORTED", "READ", "VERSION", "TAPED"]

# ---------------------------------------------------------------- what it may call


def test_no_call_reaches_python_an_allocation_or_a_lock():
    assert len(CALLS) == len({*all_functions(), *FOR_STUDIES})  # each has its own name
    found = {}
    is_inside = re.compile("^define |constant ", re.MULTILINE).search
    for name, call in CALLS.items():
        parts_of = reached(name).items()
        foreign = {part for part, code in parts_of if not is_inside(code)} - REAL_TIME_SAFE
        apart = {each.name for each in call.calls}  # that are compiled by themselves
        found[name] = {part for part in foreign if not part.startswith("llvm.")} ^ apart
    assert not any(found.values()), found


def own_statuses(code: str) -> set[str]:
    """What a function of numba's may return, apart from what one that it calls has returned."""
    made = dict(re.findall(r"^\s*(%\S+) = (.*)$", code, re.MULTILINE))
    ahead, known, found = re.findall(r"^\s*ret \w+ (\S+)", code, re.MULTILINE), set(), set()
    while ahead:
        status = ahead.pop()
        step = made.get(status, "")
        if status in known or re.match(r"(tail )?call .*?\bi32 @", step):
            continue
        known.add(status)
        if step.startswith("phi"):
            ahead += re.findall(r"\[ (\S+), ", step)
        else:
            found.add(status)
    return found


def test_no_call_raises_anything():
    # Where the status is not 0, numba's wrapper takes the GIL to report it to Python.
    for name in CALLS:
        for part in inside(name):
            assert "ret i32 " in parts(name)[part], part
            assert own_statuses(parts(name)[part]) <= {"0"}, part  # none: it returns another's


def test_no_call_calls_anybody_by_address_or_waits_for_anybody():
    by_address = re.compile(r"\b(call|invoke)\b[^@(\n]*%[\w.]+\(|\b(cmpxchg|atomicrmw)\b")
    # The kernel of an instrument with torsion or wide hair, which is one of CALLS here.
    refined = re.compile(r"call void %[\w.]+\((ptr [^(),]+, ){5}i64 [^(),]+, i64 [^(),]+\)")
    choosing = [body(name) for name in ("sound", "advance_with_ledger", "bow_stroke")]
    for name in CALLS:
        for part, code in reached(name).items():
            others = refined.sub("", code, count=1) if part in choosing else code
            assert not by_address.search(others), (name, part)


# ---------------------------------------------------------------- memory between threads


def test_the_callback_reads_and_writes_the_cursors_atomically_and_in_order():
    assert atomics("publish") == [
        [
            "load version acquire",
            "store version release",
            "fence release",
            "copy",
            "store version release",
        ]
    ]
    assert atomics("callback") == [["store taped release"]]
    assert atomics("sound") == [["load read acquire"], ["store reported release"]]
    # Cursors of several rings have places that are computed.
    found = [
        re.search(r"(load|store) atomic i64.* (\w+), align 8", a) for a in lines("interpret_events")
    ]
    assert {match.groups() for match in found if match} == {
        ("load", "acquire"),
        ("store", "release"),
    }


def test_a_command_is_written_before_the_cursor_tells_of_it():
    before, after = "\n".join(lines("post")).split("store atomic")
    assert "store" in re.split(r"^\S+:", before, flags=re.MULTILINE)[-1]  # in the same basic block
    assert "store" not in after.partition("\n\n")[0]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("post", ["load drained acquire", "store posted release"]),
        ("read_reports", ["load reported acquire", "store read release"]),
        ("taped", ["load taped acquire"]),
        ("read_meters", ["load version acquire", "copy", "fence acquire", "load version acquire"]),
    ],
)
def test_the_other_calls_do_so_too(name, expected):
    assert [step for block in atomics(name) for step in block] == expected


def test_a_frame_is_computed_from_what_was_read_between_two_reads_of_the_version():
    found = lines("frame_at")
    where = offsets("frame_at")
    published = range(memory.PUBLISHED_AT, memory.TAPED_AT)
    fences = [i for i, line in enumerate(found) if re.match(r"\s*fence acquire", line)]
    first = next(i for i, line in enumerate(found) if "load atomic" in line)
    reads = [
        i
        for i, line in enumerate(found)
        if (match := re.search(r"= load (?:i64|double), ptr (%[^\s,]+)", line))
        and where.get(match[1], 0) in published
    ]
    assert len(fences) == 1
    assert len(reads) == 4  # frame, due_ns, ns_per_frame, block
    assert all(first < read < fences[0] for read in reads)


def test_nobody_writes_a_cursor_but_atomically():
    cursors = {getattr(memory, f"{word}_AT") for word in WORDS}
    for name in CALLS:
        where = offsets(name)
        for line in lines(name):
            store = re.search(r"store (?!atomic).*, ptr (%[^\s,]+)", line)
            assert not store or where.get(store[1]) not in cursors, (name, line)


# ---------------------------------------------------------------- blocks of odd kinds


def bowed(**how: object) -> Ensemble:
    ensemble = alone(RATE, **how)
    bow(ensemble.first)
    return ensemble


def test_a_callback_of_no_frames_does_no_harm():
    instrument = Instrument(InstrumentSpec(RATE))
    out = np.zeros(64, np.float32)
    instrument.process(out)
    before = instrument.meters().copy()
    assert native.callback.call(None, out.ctypes.data, 0, None, 0, instrument.address) == 0
    after = instrument.meters().copy()
    assert instrument.frame == 64
    assert after["window"] == before["window"]
    assert np.isfinite(after["load"])
    assert after["loads"].sum() in {before["callbacks"], after["callbacks"]}


def test_what_a_process_left_that_died_while_it_played_is_mended():
    ensemble, out = bowed(), np.zeros(4096, np.float32)
    ensemble.process(out)
    instrument = ensemble.first
    rig = instrument._rig
    rig["version"][0, 0] += 1  # it died as it wrote the meters,
    rig["meters"]["running"] = 1  # or somewhere within a block: its frames are on no tape,
    rig["controls"]["frame"] += 64
    rig["state"]["motion"]["u"] = np.nan  # and the state is half a step ahead
    ensemble.recover()
    assert instrument.frame == 4160
    begin, samples = ensemble.taped(0)
    assert begin == 0
    np.testing.assert_array_equal(samples[:4096], np.stack([out, out], 1))
    assert len(samples) == 4160
    assert not samples[4096:].any()
    ensemble.process(out)
    assert np.isfinite(out).all()
    assert ensemble.lost_states == 0
    assert instrument.meters()["callbacks"] == 2
    assert instrument.meters()["running"] == 0
    assert instrument.meters()["frame"] == 4160


def drawn_by_hand(instrument: Instrument) -> None:
    instrument.post(SLIDE, value=69.0)
    instrument.post(DRAW, value=0.2, other=0.5)


def kept_while_notes_sound(instrument: Instrument) -> None:
    for address in ("/bow/speed", "/bow/side", "/finger/3/press"):
        instrument.post(HOLD, index=INDEX[address], value=0.4)
    play(instrument)


def play(instrument: Instrument, *keys: float) -> None:
    for key in keys or (69.0, 74.0):
        instrument.post(BEGIN, value=key, other=key)


def pluck(instrument: Instrument) -> None:
    instrument.post(WRITE, index=INDEX["/playing/pizzicato"], value=1.0)
    play(instrument)


def touched(instrument: Instrument) -> bool:
    """Whether the bow, a finger or the pluck touched a string at the last frame."""
    controls = instrument._rig["output"]["controls"][0, 0]
    fingers = controls[FINGER_CONTROLS:].reshape(MAX_FINGERS, -1)  # position and force of each
    return bool(controls[[F_N, F_HAMMER, F_PLUCK]].any() or fingers[:, 1].any())


@pytest.mark.parametrize("how", [bow, play, pluck, drawn_by_hand, kept_while_notes_sound])
def test_a_process_that_died_within_a_note_leaves_no_string_touched_and_no_key_held(how):
    ensemble = alone(RATE)
    instrument = ensemble.first
    how(instrument)
    out = np.zeros(64, np.float32)
    was_touched = False
    for _ in range(100):
        ensemble.process(out[:1])
        was_touched |= touched(instrument)
    assert was_touched
    instrument._rig["meters"]["running"] = 1
    ensemble.recover()
    player = instrument._rig["player"][0]
    assert (player["held"], player["sounding"], player["is_direct"]) == (0, SILENT, 0)
    for _ in range(RATE // 10):
        ensemble.process(out[:1])
        assert not touched(instrument)
        assert not out[0]
    assert np.isnan(instrument.meters()["pitch"])


# ---------------------------------------------------------------- the tape


def test_the_tape_holds_what_was_played_to_the_bit_across_its_end():
    ensemble = bowed(channels=2)
    chance = random.Random(1)
    played, taped = [], []
    frame = 0
    while frame < TAPE_FRAMES + TAPE_FRAMES // 4:
        out = np.zeros((chance.choice([1, 64, 500, 20_000]), 2), np.float32)
        ensemble.process(out)
        played.append(out)
        begin, samples = ensemble.taped(frame)
        assert begin == frame
        assert samples.dtype == np.float32
        taped.append(samples)
        frame += len(out)
    played = np.concatenate(played)
    assert np.abs(played[-RATE:]).max() > 0.01
    np.testing.assert_array_equal(np.concatenate(taped), played)
    # Who asks for frames in the middle gets these.
    begin, samples = ensemble.taped(frame - 70_000)
    assert begin == frame - 70_000
    np.testing.assert_array_equal(samples, played[-70_000:])


def test_who_comes_too_late_for_the_tape_gets_a_later_beginning():
    ensemble = bowed()
    played = np.zeros(TAPE_FRAMES + 100_000, np.float32)
    for start in range(0, len(played), 4096):
        ensemble.process(played[start : start + 4096])
    both = np.stack([played, played], 1)
    for late in (-1, 0, 50_000):
        begin, samples = ensemble.taped(late)
        assert begin > late
        assert begin + len(samples) == len(played)
        assert len(samples) > TAPE_FRAMES // 2
        np.testing.assert_array_equal(samples, both[begin:])
        # The oldest are left out, since they may be written over as they are read.
        assert len(samples) < TAPE_FRAMES - 4096


def test_another_thread_reads_only_what_has_been_played():
    ensemble = bowed()
    played = np.zeros(200_000, np.float32)  # less than the tape, so that none can be lost
    over = threading.Event()

    def play() -> None:
        for start in range(0, len(played), 400):
            ensemble.process(played[start : start + 400])
        over.set()

    player = threading.Thread(target=play)
    player.start()
    taped, read = [], 0
    while not over.is_set() or read < ensemble.frame:
        begin, samples = ensemble.taped(read)
        assert begin == read
        taped.append(samples)
        read += len(samples)
    player.join()
    assert len(taped) > 3
    np.testing.assert_array_equal(np.concatenate(taped), np.stack([played, played], 1))
