"""Follows a voice: a sound goes in, commands for the instrument come out. Compiled.

The callback of an audio input calls it, in whatever process that is; a page calls it as well.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import Int32, UInt64, compiled_with_aliasing, native
from yehu_server.compile.memory import carray
from yehu_server.core.engine.atomics import pointer, record_at
from yehu_server.core.engine.mailbox import SOUND_INPUT
from yehu_server.core.engine.native import post_to
from yehu_server.core.engine.processor import flush_denormals, monotonic_ns, restore_denormals
from yehu_server.core.midi.tables import KEY_COUNT
from yehu_server.core.voice.note_detection import FOLLOWER, end, prepare_follower, update_note
from yehu_server.core.voice.pitch_detection import push_sample

FOLLOWER_BYTES = FOLLOWER.itemsize
COMMAND_NUMBERS = 4  # numbers of a request for others: kind, index, value, other


@native
def voice_size() -> int:
    """Bytes that the follower of a voice takes."""
    return FOLLOWER_BYTES


@native
def voice_prepare(voice: Any, rate: float, transpose: float, correct: float) -> None:
    """Make a follower of a voice at a rate (Hz), in memory that is all 0.

    What is played is so many semitones above the voice; where that is NaN, by octaves, so that the
    first note is in the lower half of the range. It is moved to the twelve equal notes by `correct`
    of its distance, 0 to 1.
    """
    prepare_follower(record_at(voice, 0, FOLLOWER), rate, transpose, correct)


@native
def voice_tune(voice: Any, key: int, pitch: float) -> None:
    """Set the pitch of a key, 0 to 127, to which what is played is moved; NaN for none."""
    f = record_at(voice, 0, FOLLOWER)
    if 0 <= key < KEY_COUNT:
        f.tuning[key] = pitch


@native
def voice_pitch(voice: Any) -> float:
    """The pitch of the voice that is followed (fractional MIDI note); NaN for none."""
    f = record_at(voice, 0, FOLLOWER)
    return float(f.followed if f.is_sounding != 0 else np.nan)


@native
def follow_voice(voice: Any, sound: Any, frames: int, into: Any, most: int) -> int:
    """Follow float samples of a voice; return how many commands they come to, to be posted.

    Each is four numbers: kind, index, value, other. Of a voice that is followed no more, the note
    ends where no samples are given (frames 0).

    Real time: safe.
    """
    f = record_at(voice, 0, FOLLOWER)
    samples = carray(sound, (frames,), np.float32)
    commands = carray(into, (most, COMMAND_NUMBERS), np.float64)
    found = 0
    if frames == 0:
        f.commands = 0
        end(f)
        found = copy_commands(f, commands, 0)
    for i in range(frames):
        if push_sample(f.detector, samples[i]):
            update_note(f)
            found = copy_commands(f, commands, found)
    return found


@compiled_with_aliasing
def copy_commands(f: Any, commands: Any, found: int) -> int:
    """Add an estimate's commands to those found, as far as there is room; return their number."""
    count = min(f.commands, len(commands) - found)
    for n in range(count):
        command = commands[found + n]
        command[0], command[1], command[2], command[3] = (
            f.kind[n],
            f.index[n],
            f.value[n],
            f.other[n],
        )
    return int(found + count)


@native
def follow_input(
    sound: Any, _output: Any, frames: UInt64, _times: Any, _flags: UInt64, voice: Any
) -> Int32:
    """Follow float32 [shape=(frames,)] of an audio input, into a FOLLOWER (a PaStreamCallback).

    Its `rig` is the instrument's address. Real time: safe; no Python, no lock, no allocation, no
    exception.
    """
    mode = flush_denormals()
    now = monotonic_ns()
    f = record_at(voice, 0, FOLLOWER)
    rig = pointer(f.rig)
    samples = carray(sound, (np.int64(frames),), np.float32)
    for i in range(len(samples)):
        if push_sample(f.detector, samples[i]):
            update_note(f)
            for n in range(f.commands):
                post_to(rig, SOUND_INPUT, now, f.kind[n], f.index[n], f.value[n], f.other[n])
    restore_denormals(mode)
    return 0
