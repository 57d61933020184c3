"""Numbers in the documentation are those of the code: each phrase is made from its constants."""

from __future__ import annotations

import json
import tomllib
from typing import Any

import pytest
from fuzz import bounds, target
from pages import ROOT, page

from yehu_server.cli import _parser
from yehu_server.core.engine import mailbox, output, telemetry
from yehu_server.core.midi import channels, curves
from yehu_server.core.physics import grid, layout
from yehu_server.core.physics.quantities import FingerQuantities, read_body
from yehu_server.core.player import left_hand, right_hand
from yehu_server.core.stage.record import TAPE
from yehu_server.live.audio import recorder
from yehu_server.live.osc import (
    backlog,
    call_table,
    clients,
    context,
    learn_calls,
    listening,
    packets,
    part_calls,
    peers,
    schedule,
    sockets,
    subscriptions,
)
from yehu_server.live.web import server, web_sockets
from yehu_server.params.table import find
from yehu_server.playing import delay, learn, mapping_entries
from yehu_server.playing import preset_folders as presets
from yehu_server.playing.calibration_store import SHIPPED
from yehu_server.scores import capture, capture_format, gesture
from yehu_server.surfaces import layout as panel
from yehu_server.surfaces import max as max_patch
from yehu_server.surfaces import open_stage_control
from yehu_server.util import retry, wav
from yehu_server.util.files import MAX_LINE_BYTES

KB, MB, GB = 1 << 10, 1 << 20, 1 << 30
NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
TIMES = {60.0: "a minute", 3600.0: "an hour", 1.0 / 16.0: "a sixteenth"}
SERVED = _parser().parse_args(["serve"])
REPLAYED = _parser().parse_args(["replay", "take.jsonl", "-o", "take.wav"])
PYTHON = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["requires-python"]
SHIPPED_RATES = sorted(row["rate"] / 1e3 for row in json.loads(SHIPPED.read_text("utf-8")).values())


def words(number: float) -> str:
    """A small number in words."""
    return NUMBERS[round(number)]


def heard_after_ms(frames: int) -> float:
    """The delay of a message at 48 kHz, where the device asks for so many frames at once."""
    return frames / 48.0 + delay.HANDLING_MS


TAPE_S = words(TAPE // 48000)
WINDOW_S = telemetry.AHEAD_WINDOW_S
FINGER = FingerQuantities()

# By page, phrases that stand in it, and the numbers that are filled in.
PHRASES: dict[str, dict[str, tuple[Any, ...]]] = {
    "README.md": {
        "needs Python {} or newer": (PYTHON.removeprefix(">="),),
        "by OSC at {}:": (SERVED.osc,),
        "OSCQuery at http://{} tells": (SERVED.http,),
        "its {} measured modes": (len(read_body().frequency_hz),),
        "up to {} soft fingers": (words(layout.MAX_FINGERS),),
        "{:g}, {:g} and {:g} kHz are ready": (*SHIPPED_RATES,),
    },
    "SECURITY.md": {
        "only (127.0.0.1): OSC on port {1}, OSCQuery on port {3}": (
            *SERVED.osc.split(":"),
            *SERVED.http.split(":"),
        ),
    },
    "docs/live.md": {
        "last {} seconds of sound": (TAPE_S,),
        "after half a second to {} seconds": (words(retry.AGAIN_AFTER_AT_MOST_S),),
        "at most {} events are drained for each {} frames, and {} are applied on one frame": (
            mailbox.LIVE_BUDGET,
            output.CHUNK,
            mailbox.APPLIED_AT_ONCE,
        ),
        "heard one block and {:g} ms later": (delay.HANDLING_MS,),
        "{:.1f} ms at 64 frames and {:.1f} ms at 128": (heard_after_ms(64), heard_after_ms(128)),
        "here {:.1f} ms": (heard_after_ms(1024),),
        "what {} tenths of a second agree on": (words(20 * WINDOW_S),),
        "given up after {} seconds": (words(delay.HELD_WINDOWS * WINDOW_S),),
        "are decided on {:g} ms ahead": (1e3 * schedule.AHEAD_S,),
    },
    "docs/osc.md": {
        "listens at {}, by UDP": (SERVED.osc,),
        "every change, at most {:g} times a second": (1.0 / clients.FLUSH_S,),
        "Lasts {:g} s by default": (part_calls.SUBSCRIBED_S,),
        "by default and {} at most": (TIMES[call_table.LONGEST_SUBSCRIPTION_S],),
        "VALUE`, at most {:g} times a second": (1.0 / subscriptions.STATUS_S,),
        "Listens for {}": (TIMES[learn_calls.PATIENCE_S],),
        "REASON`, at most {:g} times": (clients.ERRORS_A_SECOND,),
        "{} presets can be saved at once and then {} a second": (
            words(context.SAVES_AT_ONCE).title(),
            words(context.SAVES_A_SECOND),
        ),
        "room for {} of your own": (presets.MOST_OWN,),
        "one block and {:g} ms after": (delay.HANDLING_MS,),
        "a buffer of {} MB": (listening.BUFFER_BYTES // MB,),
        "{} kB in a datagram": (listening.DATAGRAM_BYTES // KB,),
        "{} kB in a stream or a WebSocket": (web_sockets.FRAME_BYTES // KB,),
        "{} arguments a message": (packets.MOST_ARGUMENTS,),
        "datagrams that wait | {} MB": (backlog.MOST_BYTES // MB,),
        "{} kB at once and {} kB a second": (
            peers.ANSWERED_AT_ONCE_BYTES // KB,
            peers.ANSWERED_BYTES_A_SECOND // KB,
        ),
        "does not read | {} kB": (peers.MOST_UNSENT_BYTES // KB,),
        "{} messages at a time, {:g} times": (subscriptions.MOST_SENT, 1.0 / clients.FLUSH_S),
        "| subscribers | {}, {} of one host |": (
            clients.MOST_SUBSCRIBERS,
            clients.MOST_OF_A_HOST,
        ),
        "| TCP connections | {}, {} of one host |": (
            sockets.MOST_CONNECTIONS,
            sockets.MOST_OF_A_HOST,
        ),
        "silent for {}, or for its first {} seconds": (
            TIMES[sockets.QUIET_S],
            words(sockets.SPEAKS_WITHIN_S),
        ),
    },
    "docs/oscquery.md": {
        "answers at http://{} by": (SERVED.http,),
        "at most {:g} times a second, status values {:g} times": (
            1.0 / clients.FLUSH_S,
            1.0 / subscriptions.STATUS_S,
        ),
        "not fit in {} kB": (peers.MOST_UNSENT_BYTES // KB,),
        "At most {} WebSockets are open": (server.MOST_WEB_SOCKETS,),
        "frames are {} kB at most": (web_sockets.FRAME_BYTES // KB,),
    },
    "docs/capture.md": {
        '"version": {},': (capture.VERSION,),
        "fades within {:g} ms": (1e3 * output.FADE_S,),
        "above 2^{}": (capture_format.MOST_FRAMES.bit_length() - 1,),
        "longer than {} KiB": (MAX_LINE_BYTES // KB,),
        "may last {:g} hours": (REPLAYED.max_duration,),
    },
    "docs/recording.md": {
        "write, {:g} times a second": (1.0 / recorder.EVERY_S,),
        "WAV has 32-bit {}s, FLAC {} bits": (recorder.SUBTYPES["wav"], recorder.SUBTYPES["flac"]),
        "({:.0f} GiB: {:.0f} hours at 48 kHz)": (
            wav.WAV_LIMIT / GB,
            wav.WAV_LIMIT / (recorder.CHANNELS * 4 * 48000 * 3600),
        ),
        "no room for {} second of sound": (words(recorder.ROOM_S),),
        "the last {} seconds are kept": (TAPE_S,),
    },
    "docs/fuzzing.md": {
        "and {:g} MB for {} kB of input": (
            bounds.MOST_MEMORY_BYTES / 1e6,
            target.MOST_BYTES // KB,
        ),
    },
    "docs/simulate.md": {
        "| {:g} to {:.0f} Hz |": (grid.LOWEST_RATE, grid.HIGHEST_RATE),
        "finger to {:g} mm above": (1e3 * FINGER.rest_height,),
    },
    "docs/physics.md": {
        "at most {}) and `radiation`": (layout.MAX_MODES,),
        "at most {} sections)": (layout.MAX_SECTIONS,),
        "slower than {:g} Hz": (output.BLOCKED_HZ,),
        "peaks above \N{MINUS SIGN}{:g} dBFS": (-find("/output/limiter").default,),
        "tuned up by {:g} cents only": (find("/string/inner/tuning").hi,),
        "parameter, {} times the measured one": (words(find("/string/inner/loss").hi),),
    },
    "docs/decisions/0004-lifting-the-finger.md": {"with ω = {:g} rad/s": (FINGER.omega_lift,)},
    "docs/decisions/0005-one-record-for-model-and-state.md": {
        "at most {} fingers, {} modes, {} sections and {} grid intervals": (
            words(layout.MAX_FINGERS),
            layout.MAX_MODES,
            layout.MAX_SECTIONS,
            layout.MAX_INTERVALS,
        ),
    },
    "docs/decisions/0008-time-of-what-comes-in.md": {
        "one block and {:g} ms later": (delay.HANDLING_MS,),
        "tagged messages {:g} ms ahead": (1e3 * schedule.AHEAD_S,),
    },
    "docs/decisions/0011-four-fingers.md": {
        "next one down, in {:g} ms": (left_hand.LANDING_MS,),
        "then lifts in {:g} ms": (left_hand.LIFTING_MS,),
    },
    "docs/playing.md": {
        "from {:.0f} % to all of `speed`": (100.0 * right_hand.SOFTEST,),
        "four fingers in {:g} ms": (left_hand.LANDING_MS,),
    },
    "docs/surfaces.md": {
        "send to {},": (SERVED.osc,),
        "listens at port {}.": (max_patch.PORT,),
        "at velocity {};": (panel.VELOCITY,),
        "upwards, to {:g} N": (panel.HARDEST_N,),
        "Open Stage Control {},": (open_stage_control.FORMAT.rpartition(".")[0],),
    },
    "mappings/README.md": {
        "up to {:g}: what": (mapping_entries.LONGEST_SMOOTHING_MS,),
        "within a {:g}th of": (1.0 / curves.PICKUP_WINDOW,),
        "by {} of its": (TIMES[learn.DISTANCE],),
        "one zone of {} member channels": (channels.MOST_MEMBERS,),
        "±{:g} semitones a note, ±{:g} on the master": (channels.MEMBER_BEND, channels.MASTER_BEND),
    },
    "presets/README.md": {
        "Up to {} of your own": (presets.MOST_OWN,),
        "of {} kB at most each": (presets.MOST_BYTES // KB,),
    },
}


@pytest.mark.parametrize(
    ("name", "phrase", "numbers"),
    [(name, *row) for name, phrases in PHRASES.items() for row in phrases.items()],
)
def test_a_number_in_the_documentation_is_the_codes(name, phrase, numbers):
    assert phrase.format(*numbers) in page(name).flat


@pytest.mark.parametrize("control", gesture.CONTROLS)
def test_the_table_of_gesture_files_has_each_default(control):
    rows = page("docs/simulate.md").text.splitlines()
    (row,) = (row for row in rows if row.startswith(f"| `{control}` | ") and row.count("|") == 4)
    assert float(row.split("|")[3]) == gesture.CONTROLS[control].default
