"""The state of instruments and players ("rigs"), in a row in shared memory, and their stage's."""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_with_aliasing
from yehu_server.compile.memory import carray
from yehu_server.core.controls.record import CONTROLS
from yehu_server.core.engine.atomics import at
from yehu_server.core.engine.mailbox import HEAP, LINE, MAIL, QUEUE_SIZES, RING, SMALL_RING, WAITING
from yehu_server.core.engine.note_index import NOTES, SLOTS_PER_EVENT
from yehu_server.core.engine.output import OUTPUT
from yehu_server.core.engine.telemetry import METERS
from yehu_server.core.midi.record import MIDI
from yehu_server.core.midi.tables import TABLE_SLOTS, TABLES
from yehu_server.core.physics.layout import MODEL, REFINED, STATE, lined_up
from yehu_server.core.player.commands import COMMAND
from yehu_server.core.player.ear import EAR_SAMPLES
from yehu_server.core.player.record import PLAYER
from yehu_server.core.stage.record import STAGE
from yehu_server.core.stage.seat import SEAT

MAX_PARTS = 16

RIG = lined_up(
    [
        ("parts", np.int64, LINE),  # number of rigs that play together, in the first of them
        ("model", MODEL),
        ("state", STATE),
        ("controls", CONTROLS),
        ("player", PLAYER),
        ("ear_buffer", np.float64, 2 * EAR_SAMPLES),
        ("output", OUTPUT),
        ("mail", MAIL),
        ("meters", METERS),
        ("version", np.int64, LINE),
        ("published", METERS),
        ("taped", np.int64, LINE),
        # Of the first instrument of a part: what the part is sent, by writer; what is to come;
        # the record of the part, and its tables.
        ("midi_ring", COMMAND, SMALL_RING),
        ("ring", COMMAND, RING),
        ("sound_ring", COMMAND, SMALL_RING),
        ("page_ring", COMMAND, SMALL_RING),
        ("events", WAITING, QUEUE_SIZES.sum()),
        ("notes", NOTES, SLOTS_PER_EVENT * QUEUE_SIZES.sum()),
        ("midi", MIDI),
        ("tables", TABLES, TABLE_SLOTS),
        ("heap", WAITING, HEAP),  # commands to come
        ("reports", COMMAND, RING),
        ("seat", SEAT),
        ("kernel", np.int64, LINE),  # the address of the kernel, 0 for the plain one (time_loop.py)
        ("refined", REFINED),
    ]
)
RIG_BYTES = RIG.itemsize
STAGE_BYTES = STAGE.itemsize


def _offset(field: str, inside: str = "") -> int:
    fields: Any = RIG.fields
    kind, start = fields[field][:2]
    return int(start + (kind.fields[inside][1] if inside else 0))


def memory_bytes(parts: int) -> int:
    """Bytes that some instruments and their stage take."""
    return parts * RIG_BYTES + STAGE_BYTES


PARTS_AT = _offset("parts")
MODEL_AT, STATE_AT, CONTROLS_AT = _offset("model"), _offset("state"), _offset("controls")
PLAYER_AT, EAR_BUFFER_AT = _offset("player"), _offset("ear_buffer")
OUTPUT_AT, MAIL_AT, METERS_AT = _offset("output"), _offset("mail"), _offset("meters")
MODEL_CONTROLS_AT, PROBES_AT = _offset("output", "controls"), _offset("output", "probes")
SOUNDED_AT = _offset("output", "sounded")
VERSION_AT, PUBLISHED_AT, TAPED_AT = _offset("version"), _offset("published"), _offset("taped")
RINGS_AT = np.array([_offset(f"{of}ring") for of in ("midi_", "", "sound_", "page_")])  # by writer
RING_SIZES = np.array([SMALL_RING, RING, SMALL_RING, SMALL_RING])
EVENTS_AT, MIDI_AT, TABLES_AT = _offset("events"), _offset("midi"), _offset("tables")
NOTES_AT = _offset("notes")
HEAP_AT, REPORTS_AT = _offset("heap"), _offset("reports")
SEAT_AT = _offset("seat")
KERNEL_AT, REFINED_AT = _offset("kernel"), _offset("refined")
POSTED_AT, DRAINED_AT = _offset("mail", "posted"), _offset("mail", "drained")
CURSOR_BYTES = 8 * LINE  # from one writer's to the next
REPORTED_AT, READ_AT = _offset("mail", "reported"), _offset("mail", "read")


@compiled_with_aliasing
def count_parts(rigs: Any) -> int:
    """The number of rigs that play together, as the first of them has it."""
    return int(carray(at(rigs, PARTS_AT), (1,), np.int64)[0])


def ring_place(writer: int, rig: int) -> dict[str, int]:
    """Where a writer's ring of an instrument lies in the memory of all: bytes, but for its size.

    For writers that load no compiled code: entries of dtype COMMAND; cursors, each 8 bytes.
    """
    mail: Any = MAIL.fields
    start = rig * RIG_BYTES
    dropped = MAIL_AT + mail["dropped"][1]
    cursors = {"posted": POSTED_AT, "drained": DRAINED_AT, "dropped": dropped}
    places = {name: start + at + writer * CURSOR_BYTES for name, at in cursors.items()}
    return places | {"entries": start + int(RINGS_AT[writer]), "size": int(RING_SIZES[writer])}
