"""Units and names of signals, and where they came from: for labelled data sets."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any, NamedTuple

import numpy as np

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.scores.gesture import CONTROLS

OF_TIME, OF_FINGER = ("time",), ("time", "finger")


class Label(NamedTuple):
    """The unit of a quantity, as UDUNITS writes it, and what it is."""

    unit: str
    what: str

    @property
    def attributes(self) -> dict[str, str]:
        """The attributes of a variable, by the names of the CF conventions."""
        return {"units": self.unit, "long_name": self.what}


# fmt: off
SIGNALS = {
    "time": Label("s", "time"),
    "sound": Label("1", "sound, of full scale"),
    "bridge_force": Label("N", "force of the bridge on both strings"),
    "bridge_force_1": Label("N", "force of the bridge on string 1"),
    "bridge_force_2": Label("N", "force of the bridge on string 2"),
    "bridge_velocity": Label("m s-1", "velocity of the bridge"),
    "pressure": Label("Pa", "radiated sound pressure"),
    "finger_displacement": Label("m", "height of the finger"),
    "contact_force": Label("N", "force of the finger on a string"),
    "friction_force": Label("N", "force of the hair on the bowed string"),
    "relative_velocity": Label("m s-1", "velocity of the string on the hair"),
    "iterations": Label("1", "evaluations of the friction law; -1 where the state was lost"),
    "energy": Label("J", "stored energy"),
    "power_in": Label("W", "power given by bow, finger and hammer"),
    "loss_strings": Label("W", "power lost in the strings"),
    "loss_bridge": Label("W", "power lost in the body"),
    "loss_finger": Label("W", "power lost in the fingers"),
    "loss_hair": Label("W", "power lost in the hair"),
    "loss_friction": Label("W", "power lost by friction"),
    "loss_bow_lift": Label("W", "power given up as the bow leaves"),
    "loss_contact_reset": Label("W", "power given up as a contact ends"),
    "energy_error": Label("W", "power that is missing"),
    "v_r_residual": Label("m s-1", "relative velocity of the solver less that of the grid"),
    "constraint_residual": Label("m", "strings less bridge"),
    "friction_residual": Label("W", "power lost by friction less that of its law"),
    "strings_time": Label("s", "time of the strings' shapes"),
    "string_1": Label("m", "displacement of string 1"),
    "string_2": Label("m", "displacement of string 2"),
    "string_1_normal": Label("m", "displacement of string 1, normal to the bow"),
    "string_2_normal": Label("m", "displacement of string 2, normal to the bow"),
    "x_1": Label("m", "place on string 1, from the loop"),
    "x_2": Label("m", "place on string 2, from the loop"),
}
# fmt: on


def label_of(name: str) -> Label:
    """The label of a signal, a control, or an entry of the instrument."""
    if name in CONTROLS:
        return Label(CONTROLS[name].unit.replace("m/s", "m s-1"), name.replace("_", " "))
    return SIGNALS.get(name) or Label(_unit_of_quantity(name), name)


def _unit_of_quantity(path: str) -> str:
    """The unit of an entry of the instrument, such as ``instrument.bow.mu_S``."""
    place: Any = Quantities()
    _, *names = path.split(".")
    unit = ""
    for name in names:
        found = {each.name: each for each in fields(place)} if hasattr(place, name) else {}
        unit = str(found[name].metadata.get("unit", "")) if name in found else ""
        place = getattr(place, name, None)
    return unit


def dimensions(name: str, values: Any) -> tuple[str, ...]:
    """The dimensions of a signal, by its name."""
    if name.startswith(("string_1", "string_2")):
        return ("strings_time", f"x_{name[len('string_')]}")
    if name in ("strings_time", "x_1", "x_2"):
        return (name,)
    if name == "contact_force":
        return ("time", *("finger",) * (values.ndim - 2), "string")
    if name == "sound":
        return ("time", "channel")[: values.ndim]
    return OF_TIME if values.ndim == 1 else OF_FINGER


def as_data(quantities: Quantities) -> dict[str, Any]:
    """All quantities of an instrument, as a JSON file has them."""
    found: dict[str, Any] = json.loads(json.dumps(asdict(quantities)))
    return found


def as_json(data: Any) -> str:
    """Data as one line of JSON: what every format of labelled data can hold."""
    return json.dumps(data, default=str)


def hash_of(arrays: Mapping[str, Any]) -> str:
    """SHA-256 of the names, shapes and values of arrays."""
    found = hashlib.sha256()
    for name in sorted(arrays):
        values = np.ascontiguousarray(arrays[name])
        found.update(f"{name} {values.dtype.str} {values.shape}".encode())
        found.update(values.tobytes())
    return found.hexdigest()
