"""The state of a part: held keys, controllers, channels, and commands of the present event."""

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.midi.tables import KEY_COUNT, MAX_BINDS
from yehu_server.core.player.parameter_indices import INDEX, PARAMETER_COUNT
from yehu_server.core.player.record import MAX_HELD
from yehu_server.params.table import TABLE

PORT_COUNT, CHANNELS_PER_PORT = 16, 16
CHANNEL_COUNT = PORT_COUNT * CHANNELS_PER_PORT
MAX_PLAYERS = 16  # players of a section, at most
MAX_CHORD = 32  # notes that a section divides
MAX_ONSETS = 64  # that a section remembers
MAX_COMMANDS = 8192  # that one event produces
NONE = -1
SECTION = INDEX["/playing/section"]

MIDI = np.dtype(
    [
        ("tables", np.int64),  # number of those in use
        # Values asked for, by parameter index; and which are held.
        ("value", np.float64, PARAMETER_COUNT),
        ("is_held", np.int64, PARAMETER_COUNT),
        # Held keys, in the order pressed, and the one that sounds: its number, or NONE.
        ("held", np.int64),
        ("held_channel", np.int64, MAX_HELD),
        ("held_key", np.float64, MAX_HELD),
        ("held_velocity", np.float64, MAX_HELD),
        ("held_strike_number", np.int64, MAX_HELD),  # of the move that its velocity is; 0: none
        ("held_again", np.int64, MAX_HELD),  # frame at which it was struck while held, or NONE
        ("held_by", np.int64, MAX_HELD),  # channel of the pedal that holds it, or NONE
        ("held_since", np.int64, MAX_HELD),  # order in which pedals took keys
        ("sounding", np.int64),
        ("pedalled", np.int64),  # number of keys that pedals took
        # The key that sounds or sounded last.
        ("has_last", np.int64),
        ("last_channel", np.int64),
        ("last_key", np.float64),
        ("last_velocity", np.float64),
        ("last_strike_number", np.int64),
        # Keys that end together: their numbers among those held.
        ("listed", np.int64),
        ("list", np.int64, MAX_HELD),
        ("is_listed", np.int64, MAX_HELD),
        # Moves are numbered in their order, from 1, since the later of two counts; 0: none. Their
        # positions are 0 to 1. By channel and first bind of the source; `taken` are those that
        # soft binds acted on. A key that is struck moves velocity, a write sets a target.
        ("moves", np.int64),
        ("move_number", np.int64, (CHANNEL_COUNT, MAX_BINDS)),
        ("position", np.float64, (CHANNEL_COUNT, MAX_BINDS)),
        ("taken_number", np.int64, (CHANNEL_COUNT, MAX_BINDS)),
        ("taken_position", np.float64, (CHANNEL_COUNT, MAX_BINDS)),
        ("pressure_number", np.int64, (CHANNEL_COUNT, KEY_COUNT)),  # aftertouch of each key
        ("pressure", np.float64, (CHANNEL_COUNT, KEY_COUNT)),
        (
            "strike_number",
            np.int64,
            CHANNEL_COUNT + 1,
        ),  # last note of a channel; at last, of all others
        ("strike_velocity", np.float64, CHANNEL_COUNT + 1),
        ("strike_key", np.float64, CHANNEL_COUNT + 1),
        ("actives", np.int64),  # channels with moves
        ("active", np.int64, CHANNEL_COUNT),
        ("is_active", np.int64, CHANNEL_COUNT),
        # Named controls, by bind.
        ("has_control_position", np.int64, MAX_BINDS),
        ("control_position", np.float64, MAX_BINDS),
        ("control_wrote", np.float64, MAX_BINDS),  # value it last gave its target; NaN: none
        # Targets as set last, or as before their first move: indices in that order; the number of
        # that write.
        ("targets", np.int64),
        ("target", np.int64, PARAMETER_COUNT),
        ("is_target", np.int64, PARAMETER_COUNT),
        ("set_number", np.int64, PARAMETER_COUNT),
        ("set_to", np.float64, PARAMETER_COUNT),
        (
            "resolved_number",
            np.int64,
            PARAMETER_COUNT,
        ),  # of `values.resolve_values`: numbers and values
        ("resolved_value", np.float64, PARAMETER_COUNT),
        # Channels.
        ("bend_range", np.float64, CHANNEL_COUNT),  # semitones; NaN: RPN 0 has not set it
        ("coarse_tuning", np.float64, CHANNEL_COUNT),  # semitones, by RPN 2
        ("fine_tuning", np.float64, CHANNEL_COUNT),  # semitones, by RPN 1
        ("sustain", np.int64, CHANNEL_COUNT),
        ("is_registered", np.int64, CHANNEL_COUNT),  # whether a registered parameter is selected
        ("coarse", np.int64, CHANNEL_COUNT),  # halves of its number, or NONE
        ("fine", np.int64, CHANNEL_COUNT),
        ("bank", np.int64, CHANNEL_COUNT),
        ("bank_fine", np.int64, CHANNEL_COUNT),
        # Ports: sizes of MPE zones, and whether a note was played.
        ("lower", np.int64, PORT_COUNT),
        ("upper", np.int64, PORT_COUNT),
        ("is_keyboard", np.int64, PORT_COUNT),
        # Counts.
        ("messages", np.int64),
        ("malformed", np.int64),
        ("malformed_last", np.int64),  # as ``packing.packed``
        ("notes", np.int64),
        ("out_of_range", np.int64),
        ("percussion", np.int64),
        ("notes_of", np.int64, CHANNEL_COUNT + 1),
        ("unknown_program", np.int64, KEY_COUNT),
        # Who plays: instruments of the part, and how many of them play.
        ("rate", np.float64),
        ("players", np.int64),
        ("playing", np.int64),
        # Each player of a section: its held keys, its note of the last chord, its clock.
        ("holds", np.int64, MAX_PLAYERS),
        ("holds_channel", np.int64, (MAX_PLAYERS, MAX_HELD)),
        ("holds_key", np.float64, (MAX_PLAYERS, MAX_HELD)),
        ("holds_from", np.int64, (MAX_PLAYERS, MAX_HELD)),
        ("has_note", np.int64, MAX_PLAYERS),
        ("note_channel", np.int64, MAX_PLAYERS),
        ("note_key", np.float64, MAX_PLAYERS),
        ("requested", np.int64, MAX_PLAYERS),
        ("waits", np.int64, MAX_PLAYERS),
        # The last chord: its keys, their pitches, and the values of each.
        ("chord", np.int64),
        ("chord_at", np.int64),
        ("chord_channel", np.int64, MAX_CHORD),
        ("chord_key", np.float64, MAX_CHORD),
        ("chord_pitch", np.float64, MAX_CHORD),
        ("chord_values", np.int64, MAX_CHORD),
        ("chord_index", np.int64, (MAX_CHORD, PARAMETER_COUNT)),
        ("chord_value", np.float64, (MAX_CHORD, PARAMETER_COUNT)),
        ("is_divided", np.int64),
        ("assigned", np.int64),
        ("assigned_player", np.int64, MAX_PLAYERS),
        ("order", np.int64, MAX_CHORD),
        # Values for the note that begins next, or sounds again.
        ("values", np.int64),
        ("values_index", np.int64, PARAMETER_COUNT),
        ("values_value", np.float64, PARAMETER_COUNT),
        # Onsets: see ``section_players``.
        ("stream", np.int64),  # of random numbers; 0: not begun
        ("random_count", np.int64),
        ("share", np.float64, MAX_PLAYERS),
        ("error", np.float64, MAX_PLAYERS),
        ("onsets", np.int64),
        ("onset_at", np.int64, MAX_ONSETS),
        ("onset_late", np.int64, (MAX_ONSETS, MAX_PLAYERS)),
        ("late", np.int64, MAX_PLAYERS),
        ("before", np.float64, MAX_PLAYERS),
        # Commands that the event produces.
        ("commands", np.int64),
        ("lost", np.int64),  # of those that there was no room for
        ("out_frame", np.int64, MAX_COMMANDS),
        ("out_kind", np.int64, MAX_COMMANDS),
        ("out_index", np.int64, MAX_COMMANDS),
        ("out_value", np.float64, MAX_COMMANDS),
        ("out_other", np.float64, MAX_COMMANDS),
        ("out_player", np.int64, MAX_COMMANDS),
        # Where moves go while tables change.
        ("saved_move_number", np.int64, MAX_BINDS),
        ("saved_position", np.float64, MAX_BINDS),
        ("saved_taken_number", np.int64, MAX_BINDS),
        ("saved_taken_position", np.float64, MAX_BINDS),
    ],
    align=True,
)
Midi = Annotated[Any, MIDI]


def prepare_midi(
    midi: Any, rate: float, values: Mapping[str, float], *, players: int = 1, mpe: bool = False
) -> None:
    """Prepare a MIDI record [shape=(1,)] in place, for a part that was sent nothing.

    `rate` (Hz), all values by address, the number of players, and whether ports start as MPE zones
    of all channels.
    """
    midi[:] = np.zeros(1, MIDI)
    m = midi[0]
    m["rate"] = rate
    m["value"] = [values[param.address] for param in TABLE]
    m["players"] = m["playing"] = players
    m["value"][SECTION] = players
    m["bend_range"] = np.nan
    m["lower"] = CHANNELS_PER_PORT - 1 if mpe else 0
    m["is_registered"] = 1
    m["coarse"] = m["fine"] = NONE
    m["control_wrote"] = np.nan
    clear_held(m)


def clear_held(m: Any) -> None:
    """Forget what is held, in place, where a part's sound was lost."""
    m["held"], m["sounding"], m["listed"], m["values"] = 0, NONE, 0, 0
    m["is_listed"] = 0
    m["holds"], m["has_note"], m["chord"], m["is_divided"] = 0, 0, 0, 0


@compiled_exactly
def emit(
    m: Any, player: int, frame: int, kind: int, index: int, value: float, other: float
) -> None:
    """Command something of one player at a frame (``player.commands``)."""
    if m.commands >= MAX_COMMANDS:
        m.lost += 1
        return
    n = m.commands
    m.out_player[n], m.out_frame[n], m.out_kind[n] = player, frame, kind
    m.out_index[n], m.out_value[n], m.out_other[n] = index, value, other
    m.commands += 1
