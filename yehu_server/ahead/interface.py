"""The functions of an instrument that needs no Python. Compiled.

A C program, or a page, gives the memory of an instrument (`size` bytes, aligned to 64), prepares
it, posts events, and computes blocks; nothing is allocated. `post` may run beside `process`, on
one other thread, and on that one `midi`, `control` and `use_tables`, which post too; so may
`frame`, `value`, `pitch`, `snapshot` and `lost`, which only read.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from yehu_server.ahead.table_checks import check_binds, check_curves, check_fields, check_values
from yehu_server.compile.jit import Native, native
from yehu_server.compile.memory import WORD, carray
from yehu_server.core.controls.record import CONTROLS
from yehu_server.core.engine import native as engine
from yehu_server.core.engine import rig as memory
from yehu_server.core.engine import voice_callback
from yehu_server.core.engine.atomics import at, load_acquire, record_at
from yehu_server.core.engine.mailbox import SERVER
from yehu_server.core.engine.native import post_to
from yehu_server.core.engine.output import OUTPUT
from yehu_server.core.engine.snapshot import snapshot
from yehu_server.core.midi.events import CONTROL, MESSAGE, TABLES_TO
from yehu_server.core.midi.packing import BYTE_BITS, LENGTH_SHIFT
from yehu_server.core.midi.record import MIDI, NONE
from yehu_server.core.midi.tables import TABLE_SLOTS, TABLES
from yehu_server.core.midi.values import NO_KEY, resolve_values
from yehu_server.core.physics.layout import STATE
from yehu_server.core.player.commands import COMMAND, HOLD, RAMP, WRITE
from yehu_server.core.player.notes import sounding_pitch
from yehu_server.core.player.parameter_indices import (
    IS_ENGINES,
    IS_PLAYER_CONTROLLED,
    PARAMETER_COUNT,
    SLOT_OF,
)
from yehu_server.core.player.record import MAX_HELD, PLAYER
from yehu_server.core.stage.delay_lines import LINES
from yehu_server.core.stage.record import STAGE, TAPE_AT

Array = Any

BYTES = memory.RIG_BYTES + TAPE_AT  # without a tape
TABLES_BYTES = TABLES.itemsize
# Numbers of the tables in use, and of those that `use_tables` posted last: the latter lies beside
# the cursor of the thread that posts, in the same cache line.
_midi_fields: Any = MIDI.fields
IN_USE_AT = memory.MIDI_AT + _midi_fields["tables"][1]
LAST_AT = memory.POSTED_AT + SERVER * memory.CURSOR_BYTES + WORD
STATUS, SYSTEM, REAL_TIME, SYSTEM_RESET = 0x80, 0xF0, 0xF8, 0xFF


@native
def size() -> int:
    """Bytes that an instrument takes."""
    return BYTES


@native
def process(rig: Any, out: Any, frames: int) -> None:
    """Compute the next frames, of float samples in full scale, channels interleaved.

    Real time: safe; no allocation, no lock, every sample finite.
    """
    engine.callback(rig, out, np.uint64(frames), rig, np.uint64(0), rig)


@native
def frame(rig: Any) -> int:
    """Number of the next frame."""
    return int(record_at(rig, memory.CONTROLS_AT, CONTROLS).frame)


@native
def value(rig: Any, parameter: int) -> float:
    """The value that a parameter has, or moves to; NaN for none."""
    if not 0 <= parameter < PARAMETER_COUNT:
        return np.nan
    if SLOT_OF[parameter] >= 0:
        controls = record_at(rig, memory.CONTROLS_AT, CONTROLS)
        return float(controls.target[SLOT_OF[parameter]])
    return float(record_at(rig, memory.PLAYER_AT, PLAYER).value[parameter])


@native
def pitch(rig: Any) -> float:
    """The pitch that sounds (fractional MIDI note), or NaN in silence."""
    return sounding_pitch(record_at(rig, memory.PLAYER_AT, PLAYER))


@native
def lost(rig: Any) -> int:
    """How often the state was lost, and put back to rest; it should stay 0."""
    state = record_at(rig, memory.STATE_AT, STATE)
    output = record_at(rig, memory.OUTPUT_AT, OUTPUT)
    mix = record_at(rig, memory.RIG_BYTES, STAGE)
    return int(state.lost + output.invalid_samples + mix.invalid_samples)


@native
def midi(rig: Any, frame: int, data: Any, n: int) -> int:
    """Play MIDI messages, n bytes in all, on port 0 from a frame on; return how many were posted.

    Each has its status byte: what follows a whole message without one is skipped, as hosts fill
    short messages up. So are system messages but for a reset, and what is cut off. Fewer are
    posted than are there where the ring is full.
    """
    if n <= 0:
        return 0
    read = carray(data, (n,), np.uint8)
    index, have, wanted, posted = 0, 0, 0, 0
    for i in range(n):
        byte: Any = np.int64(read[i])
        if byte >= REAL_TIME:  # these come between the bytes of others, too
            if byte == SYSTEM_RESET:
                reset = SYSTEM_RESET | 1 << LENGTH_SHIFT
                posted += post_to(rig, SERVER, frame, MESSAGE, reset, 0.0, 0.0)
        elif byte >= SYSTEM:
            wanted = 0
        elif byte >= STATUS:
            index, have = byte, 1
            wanted = 2 if 0xC0 <= byte < 0xE0 else 3
        elif wanted > 0:
            index |= byte << BYTE_BITS * have
            have += 1
            if have == wanted:
                message = index | have << LENGTH_SHIFT
                posted += post_to(rig, SERVER, frame, MESSAGE, message, 0.0, 0.0)
                wanted = 0
    return posted


@native
def control(rig: Any, frame: int, number: int, argument: float) -> int:
    """Move a named control of the mapping, by its number; return 0 where the ring is full."""
    if number < 0:
        return 0
    return post_to(rig, SERVER, frame, CONTROL, number, argument, 0.0)


@native
def use_tables(rig: Any, frame: int, tables: Any, size: int) -> int:
    """Use other tables (struct yehu_tables, of some bytes) from a frame on; return 1.

    They are copied. Returns 0 where those given before are not in use yet, or the ring is full: try
    again later. Returns -1 where they are wrong, which changes nothing.
    """
    if size != TABLES_BYTES or check_fields(tables) == 0:
        return -1
    t = carray(tables, (1,), TABLES)[0]
    if min(check_values(t), check_binds(t), check_curves(t)) == 0:
        return -1
    last = carray(at(rig, LAST_AT), (1,), np.int64)
    if load_acquire(rig, IN_USE_AT) != last[0]:
        return 0
    # Nothing else is posted. Of three slots the next is neither in use nor the one before, which
    # the callback still reads while it changes.
    slot = (last[0] + 1) % TABLE_SLOTS
    given = carray(tables, (TABLES_BYTES // WORD,), np.float64)
    free = carray(at(rig, memory.TABLES_AT + slot * TABLES_BYTES), given.shape, np.float64)
    for i in range(len(given)):
        free[i] = given[i]
    if post_to(rig, SERVER, frame, TABLES_TO, slot, 0.0, 0.0) == 0:
        return 0
    last[0] = slot
    return 1


# What is written before it is read. Pages that nothing writes take no memory.
UNCLEARED = ("midi_ring", "page_ring", "sound_ring", "events", "heap", "reports")


def _cleared() -> Array:
    """First words of what `put` clears, and the words after them: [shape=(n, 2), dtype=int64].

    The lines of the room are not in it. First come the record of the part and its tables.
    """
    rig: Any = memory.RIG.fields
    ends = {name: (at, at + kind.itemsize) for name, (kind, at, *_) in rig.items()}
    ring = int(memory.RINGS_AT[SERVER])
    ends["ring"] = (ring, ring + COMMAND.itemsize)  # the one event that an image has
    ends["tables"] = (memory.TABLES_AT, memory.TABLES_AT + TABLES_BYTES)  # the first of its slots
    stage: Any = STAGE.fields
    line = memory.RIG_BYTES + stage["room"][1] + stage["room"][0].fields["line"][1]
    others = [name for name in ends if name not in {"midi", "tables", *UNCLEARED}]
    ordered = [*(ends[name] for name in ("midi", "tables", *others)), (memory.RIG_BYTES, line)]
    return np.array(ordered) // WORD


CLEARED, OF_PART = _cleared(), 2
PART, AFTER_PART = memory.MIDI_AT // WORD, memory.HEAP_AT // WORD  # words


@native
def put(rig: Any, rate: float, channels: int, kept: int) -> int:
    """Stand for what `putting` makes, where its name and signature are asked for."""
    raise NotImplementedError


def putting(rates: Sequence[float], images: Sequence[Array]) -> Native:
    """Make the function `put`, which puts one of some images into memory.

    `images` (sequence of ndarray [dtype=int64]): for each of `rates` (Hz); see
    `memory_images.image`.
    """
    known = np.array(rates)
    ends = np.cumsum([len(image) for image in images])
    words = np.concatenate(images)

    def put(rig: Any, rate: float, channels: int, kept: int) -> int:
        """Make an instrument; the part's record and tables stay where they are `kept`."""
        words_of = carray(rig, (BYTES // WORD,), np.int64)
        start = 0
        for i in range(len(known)):
            if known[i] == rate:
                for place in range(OF_PART if kept != 0 else 0, len(CLEARED)):
                    for word in range(CLEARED[place, 0], CLEARED[place, 1]):
                        words_of[word] = 0
                while start < ends[i]:
                    first, count = words[start], words[start + 1]
                    if kept == 0 or not PART <= first < AFTER_PART:
                        for word in range(count):
                            words_of[first + word] = words[start + 2 + word]
                    start += 2 + count
                stage = record_at(rig, memory.RIG_BYTES, STAGE)
                stage.channels = channels
                for line in range(LINES):
                    for place in range(stage.room.mask + 1):
                        stage.room.line[line, place] = 0.0
                return 1
            start = ends[i]
        return 0

    return native(put)


def prepare(rig: Any, rate: float, channels: int) -> int:
    """Make an instrument at a rate (Hz), at rest, with 1 or 2 channels.

    Returns 0 where there is none for that, and then leaves the memory as it is.
    """
    return int(put(rig, rate, channels, 0)) if channels in (1, 2) else 0


def reset(rig: Any) -> None:
    """Begin anew at frame 0: no key is held, nothing sounds, and all chance is as at first.

    Parameters, positions of controllers, pedals and tables stay. For the thread of process, while
    nothing is posted.
    """
    m = record_at(rig, memory.MIDI_AT, MIDI)
    t = record_at(rig, memory.TABLES_AT + m.tables * TABLES_BYTES, TABLES)
    stage = record_at(rig, memory.RIG_BYTES, STAGE)
    last = carray(at(rig, LAST_AT), (1,), np.int64)
    tables = last[0]
    if put(rig, m.rate, stage.channels, 1) == 0:
        return
    m.held, m.sounding, m.listed = 0, NONE, 0
    for n in range(MAX_HELD):
        m.is_listed[n] = 0
    if m.has_last != 0:  # values as they are for no note, without its velocity
        resolve_values(m, t, m.last_channel, NO_KEY)
        for n in range(m.targets):
            index = m.target[n]
            if m.is_held[index] == 0:
                m.value[index] = m.resolved_value[index]
    # The image has an event, for start values, which are not wanted here.
    carray(at(rig, memory.POSTED_AT), (1,), np.int64)[0] = 0
    last[0] = tables
    if tables != m.tables:
        post_to(rig, SERVER, 0, TABLES_TO, tables, 0.0, 0.0)
    p = record_at(rig, memory.PLAYER_AT, PLAYER)
    for index in range(PARAMETER_COUNT):
        requested, is_held = m.value[index], m.is_held[index] != 0
        if is_held:
            post_to(rig, SERVER, 0, HOLD, index, requested, 0.0)
        elif not IS_PLAYER_CONTROLLED[index] and requested != p.value[index]:
            if IS_ENGINES[index]:  # at once
                post_to(rig, SERVER, 0, RAMP, SLOT_OF[index], requested, 0.0)
            post_to(rig, SERVER, 0, WRITE, index, requested, 0.0)


def sources_function(sources: str) -> Native:
    """Make the function `sources`, which returns a hash of 16 hex digits as a number."""
    number = np.uint64(int(sources, 16)).astype(np.int64)

    def sources_number() -> int:
        """Return what it was made from: YEHU_SOURCES, as a number."""
        return int(number)

    made = native(sources_number)
    made.name = "yehu_sources"
    return made


FOLLOWING = [
    voice_callback.voice_size,
    voice_callback.voice_prepare,
    voice_callback.voice_tune,
    voice_callback.follow_voice,
    voice_callback.voice_pitch,
]


def functions(rates: Sequence[float], images: Sequence[Array], sources: str) -> list[Native]:
    """List all functions of the interface, for the images and the hash of sources given."""
    put, made_from = putting(rates, images), sources_function(sources)
    beginning = [Native(prepare, calls=[put]), Native(reset, calls=[put, resolve_values])]
    posting = [engine.post, midi, control, use_tables]
    reading = [frame, value, pitch, snapshot, lost]
    return [made_from, size, *beginning, *posting, process, *reading, *FOLLOWING]
