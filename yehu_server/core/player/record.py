"""The player's state: requested values, held keys, hands, ear, and calibration."""

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.layout import STRINGS
from yehu_server.core.player.bowing import (
    BOW_POSITIONS,
    BOWING_SIZE,
    DEFAULT_BOWING,
    default_bowing_table,
)
from yehu_server.core.player.bowing import NOTES as NOTES_BOWED
from yehu_server.core.player.drift import DRIFT_STATE
from yehu_server.core.player.ear import EAR, prepare_ear, reset_ear
from yehu_server.core.player.fingering import OPEN, OpenStrings
from yehu_server.core.player.gestures import GESTURE, RESTING
from yehu_server.core.player.note_range import NoteRange
from yehu_server.core.player.note_tables import GAINS, PITCHES, SPEEDS, NoteTables, wave_speed
from yehu_server.core.player.parameter_indices import (
    BOW,
    FINGER_COUNT,
    FINGER_PRESS,
    PARAMETER_COUNT,
    PLUCK,
    SLOT_OF,
)
from yehu_server.core.player.stroke_contours import CONTOURS
from yehu_server.core.player.sway import SWAY_STATE
from yehu_server.core.player.vibrato_table import STEPS, vibrato_table
from yehu_server.params.table import TABLE

# Bins of what is learnt: half semitones, quarter octaves of bow position, half octaves of speed.
LEARNT_PITCHES, LEARNT_POSITIONS, LEARNT_SPEEDS = 52, 11, 11
# Keys held at most. Beyond, the one held longest is let go: by the part (``midi.part_keys``), each
# player of a section (``midi.section``) and each instrument (``held_keys``) of its own list.
MAX_HELD = 256
NOTES = len(PITCHES[0])  # measured on each string

PLAYER = np.dtype(
    [
        ("rate", np.float64),  # Hz
        ("value", np.float64, PARAMETER_COUNT),  # of each parameter, as requested
        # Ownership, by parameter: see ``ownership``.
        ("taken", np.int64, PARAMETER_COUNT),
        ("is_held", np.int64, PARAMETER_COUNT),
        ("sent", np.float64, PARAMETER_COUNT),  # where the player last sent it; NaN: nowhere
        ("glide_ms", np.float64),  # the least time of each move
        # The held keys, in the order pressed.
        ("held", np.int64),  # their number
        ("held_channel", np.int64, MAX_HELD),
        ("held_key", np.float64, MAX_HELD),
        ("held_pitch", np.float64, MAX_HELD),  # fractional MIDI notes within range
        ("sounding", np.int64),  # number of the held key that sounds, SILENT or ENDING
        ("began", np.int64),  # the frame at which the stroke of the bow began
        ("note_began", np.int64),  # the frame at which the note did
        ("is_direct", np.int64),  # whether the bow is drawn directly, not by notes
        ("speed", np.float64),  # of a bow drawn directly (m/s)
        ("effort", np.float64),  # the same times its force, as a share of Schelleng's limit
        ("gesture", GESTURE),  # of the sounding note
        # The left hand.
        ("finger_pitch", np.float64),  # the pitch that a finger last stopped
        ("finger", np.int64),  # which was put down last
        ("pressing", np.float64),  # N
        ("is_shifting", np.int64),  # lightly, to where it will press so
        ("string", np.int64),  # of the fingering; -1: none yet
        ("position", np.float64),  # of the fingering (m), or OPEN
        # What it hears and corrects.
        ("ear", EAR),
        ("settled_at", np.int64),  # frame from which the string is heard
        ("jumps", np.int64),  # of the pitch over its place, in this note
        ("side_heard", np.int64),  # of its place: 1 where the finger was too low
        ("times_heard", np.int64),  # there
        ("sharper", np.float64),  # cents: correction of the sharpening of this note
        ("first_press", np.float64),  # N: requested as the note began
        ("first_error", np.float64),  # cents: heard first; NaN: nothing yet
        ("first_sharper", np.float64),  # the correction then
        ("learnt", np.float64, (STRINGS, LEARNT_PITCHES, LEARNT_POSITIONS, LEARNT_SPEEDS)),  # cents
        (
            "corrects_pressure",
            np.int64,
        ),  # 0 while the bowing table is searched: pitch is corrected, bow pressure is not
        ("pressure_factor", np.float64),  # factor on the bow's pressure
        ("nearer", np.float64),  # factor on the bow's place, until the string speaks
        # The fault in the last hop, and for how many hops; below 0: before a correction is judged.
        ("fault", np.int64),
        ("faults", np.int64),
        ("spoken", np.int64),  # hearings in which the string spoke, with its help
        ("eased_from", np.float64),  # the pressure factor before a trial with less; 0: none yet
        (
            "learnt_pressure_factor",
            np.float64,
            (STRINGS, LEARNT_PITCHES, LEARNT_POSITIONS, LEARNT_SPEEDS),
        ),
        # The right hand.
        ("direction", np.float64),  # of the stroke
        ("stroke_speed_factor", np.float64),  # factor on the bow's speed, so that its hair lasts
        ("side", np.float64),  # /bow/side; 0 where the bow is lifted
        ("bowing", np.float64, BOWING_SIZE),  # how the sounding pitch is bowed
        ("hurry", np.float64),  # of a stroke soon after another: 0 to 1
        # The bow pressure of a quick stroke until the bow has turned, and the usual one after.
        ("turning_pressure", np.float64),  # 0: no such stroke
        ("pressure_after_turning", np.float64),
        ("balance", np.float64),  # dB
        ("louder_by", np.float64),  # dB, by brilliance
        # The variation: deviates of this note.
        ("speed_variation", np.float64),  # factor on the bow's speed
        ("pressure_variation", np.float64),  # factor on the bow's pressure
        ("detuned", np.float64),  # semitones, at full variation
        ("player_number", np.int64),  # of a section, counted from 0
        ("seed", np.int64),
        ("random_count", np.int64),  # drawn so far
        ("drift_state", DRIFT_STATE),  # drift and tremor
        ("contours", CONTOURS),  # of the bow
        ("sway", SWAY_STATE),
        # The instrument.
        ("bridge_x", np.float64),  # m
        ("a4", np.float64),  # Hz
        ("wave_speed", np.float64, STRINGS),  # m/s
        ("open_note", np.float64, STRINGS),  # MIDI notes
        ("highest", np.float64, STRINGS),  # fractional MIDI notes
        ("sharpening", np.float64, (STRINGS, NOTES, len(SPEEDS))),  # cents
        ("levels", np.float64, (STRINGS, NOTES + 1, len(SPEEDS))),  # dB
        ("centroids", np.float64, (STRINGS, NOTES + 1, len(GAINS))),  # Hz
        ("louder", np.float64, (STRINGS, NOTES + 1, len(GAINS))),  # dB
        ("bowing_table", np.float64, (STRINGS, len(BOW_POSITIONS), NOTES_BOWED, BOWING_SIZE)),
        ("vibrato_table", np.float64, (STEPS, 2)),  # `vibrato_table`
        ("open_strings", np.int64),  # number of the OpenStrings
    ],
    align=True,
)
Player = Annotated[Any, PLAYER]

UP = -1.0  # the direction before the first stroke, which is a down-bow, v_b > 0
SILENT, ENDING = -1, -2  # ENDING: the key is released, and more of them follow


def prepare_player(
    quantities: Quantities,
    rate: float,
    values: Mapping[str, float],
    *,
    calibration: NoteTables | None = None,
    open_strings: OpenStrings = OpenStrings.ALWAYS,
    bowing: Any = None,
    seed: int = 0,
    player_number: int = 0,
) -> Any:
    """A PLAYER [shape=(1,)] who holds nothing, on an instrument as tuned, at a rate (Hz).

    `values` are of every parameter, by address. Without a calibration fingers stop where an ideal
    string is in tune, and no note is evened out. `seed`: of the variation between notes.
    `player_number`: which of a section; each but the first has a vibrato of their own.
    """
    player = np.zeros(1, PLAYER)
    p = player[0]
    p["rate"] = rate
    p["value"] = [values[param.address] for param in TABLE]
    p["sent"] = np.nan
    p["sounding"], p["began"] = SILENT, -1
    notes = NoteRange.of(quantities, calibration)
    p["open_note"], p["highest"] = notes.open_notes, notes.highest_notes
    p["finger_pitch"] = notes.lowest
    p["finger"] = FINGER_COUNT - 1  # so that the first finger comes first
    p["string"], p["position"] = -1, OPEN
    p["direction"] = UP
    p["bowing"] = DEFAULT_BOWING
    p["first_error"], p["pressure_factor"], p["corrects_pressure"] = np.nan, 1.0, 1
    p["nearer"] = 1.0
    prepare_ear(p["ear"], rate)
    p["gesture"] = RESTING
    p["speed_variation"] = p["pressure_variation"] = p["stroke_speed_factor"] = 1.0
    p["seed"], p["player_number"] = seed, player_number
    p["bridge_x"] = quantities.bridge_x
    p["wave_speed"] = [wave_speed(quantities, string) for string in range(STRINGS)]
    p["a4"] = 440.0
    if calibration is not None:
        p["a4"] = calibration.a4
        p["sharpening"] = calibration.sharpening
        if calibration.levels:
            p["levels"] = calibration.levels
        if calibration.centroids:
            p["centroids"], p["louder"] = calibration.centroids, calibration.louder
    centroids = calibration.centroids if calibration is not None else ()
    p["vibrato_table"] = vibrato_table(
        quantities.body, float(p["a4"]), tuple(notes.open_notes), centroids
    )
    p["bowing_table"] = default_bowing_table() if bowing is None else bowing
    p["open_strings"] = list(OpenStrings).index(open_strings)
    return player


def end_all(player: Any, controls: Any) -> None:
    """End all notes of a PLAYER without a release: bow and fingers leave the strings at once."""
    player["held"], player["sounding"], player["is_direct"] = 0, SILENT, 0
    player["side"], player["pressing"] = 0.0, 0.0
    player["string"], player["position"] = -1, OPEN
    player["taken"], player["sent"] = 0, np.nan
    reset_ear(player["ear"], int(controls["frame"]))  # a hop may be half done
    player["direction"], player["stroke_speed_factor"] = UP, 1.0
    player["gesture"] = RESTING
    player["drift_state"], player["contours"] = np.zeros((), DRIFT_STATE), np.zeros((), CONTOURS)
    player["sway"] = np.zeros((), SWAY_STATE)
    for index in (BOW.speed, BOW.side, PLUCK.force, *FINGER_PRESS):
        controls["target"][SLOT_OF[index]] = 0.0
