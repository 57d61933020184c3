"""Computes the samples of one instrument before the room: player, controls, model. Compiled."""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled, compiled_with_aliasing, native
from yehu_server.compile.memory import carray
from yehu_server.core.controls import ramps
from yehu_server.core.controls.kernel_controls import advance_phases, is_still, write_controls
from yehu_server.core.controls.record import CHUNK, CONTROLS
from yehu_server.core.controls.slots import LOSS, SLOTS, STAGE_INPUTS, TUNING
from yehu_server.core.engine.atomics import at, load_acquire, record_at, store_release
from yehu_server.core.engine.mailbox import (
    APPLIED_AT_ONCE,
    HEAP,
    MAIL,
    RING,
    WAITING,
    copy_command,
    is_ready,
    pop,
    spend,
)
from yehu_server.core.engine.output import (
    NOT_SILENCED,
    OUTPUT,
    SOUNDED,
    SOUNDED_BYTES,
    clear_filters,
    output_sample,
)
from yehu_server.core.engine.processor import flush_denormals, restore_denormals
from yehu_server.core.engine.rig import (
    CONTROLS_AT,
    EAR_BUFFER_AT,
    HEAP_AT,
    KERNEL_AT,
    MAIL_AT,
    METERS_AT,
    MODEL_AT,
    MODEL_CONTROLS_AT,
    OUTPUT_AT,
    PLAYER_AT,
    PROBES_AT,
    READ_AT,
    REFINED_AT,
    REPORTED_AT,
    REPORTS_AT,
    STATE_AT,
)
from yehu_server.core.engine.sleep import WINDOW, begin_window, watch
from yehu_server.core.engine.telemetry import METERS, add_to_level, close_window
from yehu_server.core.physics import kernel, refined
from yehu_server.core.physics.elementary import exp2
from yehu_server.core.physics.layout import MODEL, REFINED, RELATIVE_VELOCITY, STATE, STRINGS
from yehu_server.core.physics.time_loop import advance_by
from yehu_server.core.player.commands import COMMAND, apply, cost
from yehu_server.core.player.ear import EAR_SAMPLES, remember
from yehu_server.core.player.listening import update_player
from yehu_server.core.player.record import PLAYER

Array = Any


@compiled_with_aliasing
def apply_due(rig: Any, mail: Any, p: Any, c: Any) -> None:
    """Apply the commands that are due at this frame, and report them."""
    heap = carray(at(rig, HEAP_AT), (HEAP,), WAITING)
    for _ in range(APPLIED_AT_ONCE):
        if mail.waiting == 0 or heap[0].command.frame > c.frame:
            return
        if not is_ready(mail.applying, mail.at_once, c.frame):
            return
        command = heap[0].command
        spend(mail.applying, c.frame, cost(command.kind, command.index, command.other))
        apply(p, c, c.frame, command.kind, command.index, command.value, command.other)
        if mail.reporting != 0:
            report(rig, mail, c.frame, command)
        mail.applied += 1
        pop(heap, mail.waiting)
        mail.waiting -= 1


@compiled_with_aliasing
def report(rig: Any, mail: Any, frame: int, command: Any) -> None:
    """Report a applied request for captures, with the frame that it was applied at."""
    reported = mail.reported[0]
    if reported - load_acquire(rig, READ_AT) >= RING:
        mail.unreported += 1
        return
    entry = carray(at(rig, REPORTS_AT), (RING,), COMMAND)[reported & (RING - 1)]
    copy_command(command, entry)
    entry.frame = frame
    store_release(rig, REPORTED_AT, reported + 1)


@compiled
def retune(model: Array, state: Array, c: Any) -> None:
    """Give the model's strings the tuning and loss of this frame."""
    for i in range(STRINGS):
        cents, loss = c.value[TUNING[i]], c.value[LOSS[i]]
        if cents != c.tuning[i] or loss != c.loss[i]:
            c.tuning[i], c.loss[i] = cents, loss
            # The frequency is proportional to the square root of the tension.
            T = c.tension[i] * exp2(cents / 600.0)
            kernel.retune(model, state, i, T, c.sigma_0[i] * loss, c.sigma_1[i] * loss)


@compiled_with_aliasing
def write_row(c: Any, o: Any, n: int) -> bool:
    """Write row `n` of controls and gains; return whether the sound is faded out by then."""
    ramps.advance_ramps(c)
    write_controls(c, o.controls[n])
    gain, silenced = ramps.level(c), False
    if c.silence_in > 0:
        c.silence_in -= 1
        gain *= c.silence_in / c.fade
        silenced = c.silence_in == 0
    o.gain[n] = gain
    o.body[n] = ramps.amplitude(c, ramps.TO_BODY, c.value[SLOTS.body_gain])
    o.blend[n] = c.value[SLOTS.body_blend]
    o.turned[n, 0], o.turned[n, 1] = c.turned[0], c.turned[1]
    o.brilliance[n] = c.value[SLOTS.body_brilliance]
    o.brilliance_frequency[n] = c.value[SLOTS.body_brilliance_frequency]
    return silenced


@compiled_with_aliasing
def write_stage_inputs(c: Any, sounded: Any, begin: int, end: int) -> None:
    """Write what the stage needs of some rows, in which the controls stand still."""
    soft = ramps.amplitude(c, ramps.TO_LIMITER, c.value[SLOTS.output_limiter])
    for n in range(begin, end):
        sounded.soft[n] = soft
        for k in range(len(STAGE_INPUTS)):
            sounded.stage_inputs[n, k] = c.value[STAGE_INPUTS[k]]


@compiled_with_aliasing
def sleep(rig: Any, p: Any, c: Any, sounded: Any, begin: int, end: int) -> int:
    """Pass silent frames, up to one that wakes the instrument; return its row, or `end`."""
    mail, o = record_at(rig, MAIL_AT, MAIL), record_at(rig, OUTPUT_AT, OUTPUT)
    heap = carray(at(rig, HEAP_AT), (HEAP,), WAITING)
    done = begin
    while done < end:
        until = c.frame + end - done
        if mail.waiting > 0:
            until = min(until, heap[0].command.frame)
        if until > c.frame == p.ear.next:
            update_player(p, c, at(rig, EAR_BUFFER_AT))
        if until <= c.frame or not is_still(c):
            o.sleep.is_asleep = 0
            break
        if p.ear.next > c.frame:
            until = min(until, p.ear.next)
        done += until - c.frame
        advance_phases(c, until - c.frame)
    write_stage_inputs(c, sounded, begin, done)
    sounded.dry[begin:done] = 0.0
    t = record_at(rig, METERS_AT, METERS)
    t.window_frames += done - begin
    t.slept += done - begin
    o.last = 0.0
    return done


@native
def sound(rig: Any, wanted: int, into: Any) -> None:
    """Compute at most CHUNK next frames of an instrument into a SOUNDED, however many at a time.

    Real time: safe; no allocation, no exception, every sample finite.
    """
    model = carray(at(rig, MODEL_AT), (1,), MODEL)
    state = carray(at(rig, STATE_AT), (1,), STATE)
    c = record_at(rig, CONTROLS_AT, CONTROLS)
    o = record_at(rig, OUTPUT_AT, OUTPUT)
    sounded = carray(into, (1,), SOUNDED)[0]
    mail = record_at(rig, MAIL_AT, MAIL)
    t = record_at(rig, METERS_AT, METERS)
    p = record_at(rig, PLAYER_AT, PLAYER)
    wanted, which = min(wanted, CHUNK), carray(at(rig, KERNEL_AT), (1,), np.int64)[0]
    sounded.silenced_at = NOT_SILENCED
    done = 0
    while done < wanted:
        if o.sleep.is_asleep == 0 and c.frame & (WINDOW - 1) == 0:
            begin_window(o.sleep, is_still(c))
        if o.sleep.is_asleep != 0:
            done = sleep(rig, p, c, sounded, done, wanted)
            close_window(t, model[0], state[0].motion)
            if done == wanted:
                return
        first, start = c.frame, done
        silenced, retuned, ends = False, False, False
        while done < wanted and not (silenced or retuned or ends):
            apply_due(rig, mail, p, c)
            if c.frame == p.ear.next:
                update_player(p, c, at(rig, EAR_BUFFER_AT))
            silenced = write_row(c, o, done)
            write_stage_inputs(c, sounded, done, done + 1)
            retuned = ramps.has_new_strings(c)
            c.frame += 1
            done += 1
            ends = c.frame & (WINDOW - 1) == 0
        # Strings are retuned at the very sample.
        begin, end = start, done - 1 if retuned else done
        while begin < done:
            if begin == end:
                retune(model, state, c)
                end = done
            advance_by(
                which, at(rig, MODEL_AT), at(rig, STATE_AT), at(rig, REFINED_AT),
                at(rig, MODEL_CONTROLS_AT), at(rig, PROBES_AT), begin, end,
            )  # fmt: skip
            begin = end
        write_output(rig, sounded.dry, first, start, done)
        if silenced:
            come_to_rest(rig, model, state)
            sounded.silenced_at = done - 1
        close_window(t, model[0], state[0].motion)


@compiled_with_aliasing
def come_to_rest(rig: Any, model: Array, state: Array) -> None:
    """Put the model to rest, and what filters its sound."""
    kernel.come_to_rest(model[0], state[0])
    refined.come_to_rest(record_at(rig, REFINED_AT, REFINED))
    clear_filters(record_at(rig, OUTPUT_AT, OUTPUT))


@compiled_with_aliasing
def write_output(rig: Any, dry: Array, first: int, start: int, end: int) -> None:
    """Make samples of some rows of the probes, the first of frame `first`; the ear has them too."""
    o = record_at(rig, OUTPUT_AT, OUTPUT)
    t = record_at(rig, METERS_AT, METERS)
    heard = carray(at(rig, EAR_BUFFER_AT), (2 * EAR_SAMPLES,), np.float64)
    for n in range(start, end):
        remember(heard, first + n - start, o.probes[n, RELATIVE_VELOCITY])
        dry[n] = output_sample(o, n)
        add_to_level(t, dry[n])
        if o.sleep.is_watched != 0:
            watch(o.sleep, o.probes[n], abs(o.dc_free) + abs(o.fading))


@native
def sound_block(rig: Any, frames: int, sounded: Any) -> None:
    """Compute the next frames of one instrument, to be mixed later: a SOUNDED for each CHUNK."""
    mode = flush_denormals()
    done, chunk = 0, 0
    while done < frames:
        sound(rig, frames - done, at(sounded, chunk * SOUNDED_BYTES))
        done += CHUNK
        chunk += 1
    restore_denormals(mode)
