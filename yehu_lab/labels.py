"""Units and names of what sweeps vary and find, beside those of signals."""

from yehu_server.simulation import labels
from yehu_server.simulation.labels import Label

ACCELERATION = "bow_acceleration"  # from rest to the largest bow_velocity of the gesture

# fmt: off
AXES = {
    ACCELERATION: Label("m s-2", "acceleration of the bow"),
    "string": Label("1", "number of the string"),
    "note": Label("1", "MIDI note"),
    "force": Label("N", "bow force"),
    "position": Label("1", "bow position, a share of the sounding length"),
    "speed": Label("m s-1", "bow speed"),
    "acceleration": Label("m s-2", "acceleration of the bow"),
    "press": Label("N", "finger force"),
    "place": Label("cents", "place of the finger above the note"),
    "tension": Label("1", "tension of the string, a factor"),
    "noise": Label("1", "noise of the hair"),
    "seed": Label("1", "number of the bow's hair"),
}
FINDINGS = {
    "regime": Label("1", "regime of the string's motion"),
    "slips": Label("1", "slips in a period"),
    "certainty": Label("1", "likeness to the motion a period before"),
    "first_slip_s": Label("s", "time of the first slip"),
    "helmholtz_s": Label("s", "time from which Helmholtz motion lasts"),
    "pitch_hz": Label("Hz", "pitch at the end"),
    "level_db": Label("dB", "level of the pressure at the end, re 1 Pa"),
    "brightness_hz": Label("Hz", "centroid of the spectrum"),
    "faults": Label("1", "samples without a solution of the friction, and lost states"),
    "computed": Label("1", "whether the point was computed"),
}
# fmt: on


def label_of(name: str) -> Label:
    """The label of the axis of a sweep, of a finding, or of what a simulation has."""
    return AXES.get(name) or FINDINGS.get(name) or labels.label_of(name)
