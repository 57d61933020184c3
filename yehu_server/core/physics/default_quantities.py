"""The physical quantities of one yehu, each with its unit, bounds and source.

Nothing here is computed: derived coefficients live where they are used
(`grid`, `string`, `bridge`, `bow`, `finger`, `radiation`).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from yehu_server.core.physics.layout import MAX_POINTS
from yehu_server.errors import ParameterError
from yehu_server.util.documents import Document, Fields
from yehu_server.util.files import shipped_folder
from yehu_server.util.values import brief, number
from yehu_server.util.values import choice as chosen

MAX_BASES = 8
BODY_FILE = Path(__file__).with_name("body.json")


def quantity(
    default: float | tuple[float, float], unit: str, lo: float, hi: float, source: str
) -> Any:
    """A dataclass field for one physical quantity."""
    return field(default=default, metadata={"unit": unit, "lo": lo, "hi": hi, "source": source})


def count(default: float, lo: int, hi: int, source: str) -> Any:
    """A dataclass field for a whole number."""
    return field(
        default=default, metadata={"unit": "1", "lo": lo, "hi": hi, "source": source, "whole": True}
    )


def choice(default: str, *others: str, source: str) -> Any:
    """A dataclass field for a choice between words; the first is the default."""
    return field(default=default, metadata={"choices": (default, *others), "source": source})


TABLE_1 = "[Yehu] table 1"
DATA_SET = "[YehuData]"
SMITH = "chosen: see rosin_heat.py; [Smith]"
HAIR_NORMAL = "chosen: see press.py"
SKIN = "chosen: see skin.py"
OTHER_LAWS = "[Yehu]; see rosin_heat.py, friction_curve.py"


@dataclass(frozen=True)
class StringQuantities:
    """One silk string, from the restraining loop to the stub ([Yehu] eqs. (1)-(3))."""

    L: float = quantity(0.38, "m", 0.1, 1.0, TABLE_1)
    rho: float = quantity(1250.0, "kg/m^3", 100.0, 20e3, TABLE_1)
    r: float = quantity(0.55e-3, "m", 1e-5, 5e-3, TABLE_1)
    T: float = quantity(50.61, "N", 1.0, 500.0, TABLE_1)
    E: float = quantity(1e10, "Pa", 0.0, 1e12, TABLE_1)
    sigma_0: float = quantity(0.9754, "1/s", 0.0, 100.0, TABLE_1)
    sigma_1: float = quantity(0.0026, "m^2/s", 0.0, 1.0, TABLE_1)
    # Above, on a yehu's F string, notes jump and scratch: bowed at four speeds and three pressures,
    # F5 and G5 hold in at most a third of the cases, notes up to E5 in at least four fifths.
    reach: float = quantity(
        11.5, "semitones", 1.0, 24.0, "chosen: fingers stop it so far above its open note"
    )
    G: float = quantity(2.4e9, "Pa", 1e6, 1e12, "[Fibres], spider silk; this one's is unknown")
    Q_t: float = quantity(34.0, "1", 1.0, 1e6, "[Mansour], a cello string; silk's is unknown")

    @property
    def rho_A(self) -> float:
        """Mass per length (kg/m)."""
        return self.rho * math.pi * self.r * self.r

    @property
    def EA(self) -> float:
        """Stiffness against stretching (N)."""
        return self.E * math.pi * self.r * self.r

    @property
    def EI(self) -> float:
        """Bending stiffness of a round string (N m^2)."""
        return self.E * math.pi * self.r * self.r * self.r * self.r / 4.0


@dataclass(frozen=True)
class BowQuantities:
    """Hair and rosin ([Yehu] section 2.4); `xi` has one value a string."""

    epsilon_0: float = quantity(3.186e4, "N/m", 1.0, 1e8, DATA_SET)
    epsilon_1: float = quantity(0.0027, "kg/s", 1e-9, 10.0, DATA_SET)
    v_s: float = quantity(0.228, "m/s", 1e-3, 10.0, DATA_SET)
    mu_C: float = quantity(0.5071, "1", 1e-3, 10.0, DATA_SET)
    mu_S: float = quantity(1.0207, "1", 1e-3, 10.0, DATA_SET)
    # Strictly below 1: at xi = 1 and high speed eq. (20) is 0/0.
    xi: tuple[float, float] = quantity((0.7, 0.4), "1", 1e-3, 0.999, DATA_SET)
    M_h: float = quantity(4.5e-3, "kg", 1e-6, 1.0, DATA_SET)
    K_h: float = quantity(4.8297e4, "N/m", 0.0, 1e8, DATA_SET)
    R_h: float = quantity(5.7674, "kg/s", 0.0, 1e4, DATA_SET)
    lift_force: float = quantity(
        1e-3, "N", 1e-6, 1.0, "chosen: a bow force below this is a lifted bow"
    )
    grain: float = quantity(3e-4, "m", 1e-6, 0.1, "by ear: see docs/physics.md")
    hair: float = count(0.0, 0, 65535, "chosen: which of many alike")
    width: float = quantity(0.0, "m", 0.0, 0.03, "chosen: see decisions/0022")
    points: float = count(2.0, 2, MAX_POINTS, "chosen: that share a width above 0")
    friction: str = choice("elasto-plastic", "thermal", "hyperbolic", source=OTHER_LAWS)
    cooling_time: float = quantity(1e-4, "s", 1e-6, 1.0, SMITH)
    epsilon_2: float = quantity(0.0, "kg/s", 0.0, 100.0, "[Willemsen]: viscous; [Yehu]: none")
    # Of two directions: the bow as it presses.
    M_n: float = quantity(0.03, "kg", 1e-4, 1.0, HAIR_NORMAL)
    K_n: float = quantity(1.6e4, "N/m^alpha", 1.0, 1e9, HAIR_NORMAL)
    alpha_n: float = quantity(1.5, "1", 1.001, 5.0, HAIR_NORMAL)
    beta_n: float = quantity(2.5, "s/m", 0.0, 1e3, HAIR_NORMAL)


@dataclass(frozen=True)
class FingerQuantities:
    """The stopping finger ([Yehu] sections 2.2 and 5.2) and how it is lifted."""

    M_f: float = quantity(0.02, "kg", 1e-4, 1.0, DATA_SET)
    K_f: float = quantity(5e5, "N/m^alpha", 0.0, 1e9, "[Yehu] section 5.2")
    alpha: float = quantity(2.3, "1", 1.001, 5.0, "[Yehu] section 5.2")
    beta: float = quantity(20.0, "s/m", 0.0, 1e3, "[Yehu] section 5.2")
    rest_height: float = quantity(0.5e-3, "m", 1e-6, 0.05, DATA_SET)
    R_t: float = quantity(1.0, "kg/s", 0.0, 1e4, "chosen: see docs/physics.md")
    # Of two directions: the skin along the bow.
    K_s: float = quantity(600.0, "N/m", 1.0, 1e7, SKIN)
    R_s: float = quantity(10.0, "kg/s", 0.0, 1e4, SKIN)
    mu_s: float = quantity(1.0, "1", 1e-3, 100.0, SKIN)
    # Critically damped: from a 1 N press back within 2 % of the way in 24 ms.
    omega_lift: float = quantity(300.0, "rad/s", 1.0, 5e3, "chosen: see decisions/0004")


@dataclass(frozen=True)
class Body:
    """Measured bridge modes and radiation filter; the arrays of a body file."""

    frequency_hz: tuple[float, ...]
    mass: tuple[float, ...]
    damping: tuple[float, ...]
    radiation_rate: float
    sections: tuple[tuple[float, float, float, float], ...]
    direct_gain: float

    @property
    def omega(self) -> tuple[float, ...]:
        """Resonant frequencies (rad/s)."""
        return tuple(2.0 * math.pi * f for f in self.frequency_hz)


def read_body(path: Path = BODY_FILE) -> Body:
    """Read a body file (docs/physics.md, [YehuData]); raises ParameterError as `check_body`."""
    table = Document(path, "a body file").read(path).json()
    radiation = table.table("radiation")
    modes = table.tables("bridge_modes", 1)
    body = Body(
        frequency_hz=tuple(mode.need("frequency_hz", number) for mode in modes),
        mass=tuple(mode.need("mass_kg", number) for mode in modes),
        damping=tuple(mode.need("damping_kg_per_s", number) for mode in modes),
        radiation_rate=radiation.need("sample_rate_hz", number),
        sections=radiation.need("sections", _sections),
        direct_gain=radiation.need("direct_gain", number),
    )
    with table.at():
        check_body(body)
    return body


def _sections(value: Any) -> tuple[tuple[float, float, float, float], ...]:
    try:
        return tuple((number(b0), number(b1), number(a1), number(a2)) for b0, b1, a1, a2 in value)
    except (TypeError, ValueError):
        raise ParameterError(f"expected lists of [b0, b1, a1, a2], got {brief(value)}") from None


def check_body(body: Body) -> None:
    """Raise ParameterError for a body that is not passive or not stable."""
    figures = (
        *body.omega,
        *body.mass,
        *body.damping,
        body.radiation_rate,
        body.direct_gain,
        *(figure for section in body.sections for figure in section),
    )
    if not all(math.isfinite(figure) for figure in figures):
        raise ParameterError("holds a number that is not finite")
    if not body.mass or min(*body.mass, *body.frequency_hz, body.radiation_rate) <= 0.0:
        raise ParameterError("masses, frequencies and rate must be positive")
    if min(body.damping) < 0.0:
        raise ParameterError("a mode with negative damping is not passive")
    for _, _, a1, a2 in body.sections:
        if not (abs(a2) < 1.0 and abs(a1) < 1.0 + a2):
            raise ParameterError("a radiation section is unstable")
        if a1 * a1 >= 4.0 * a2:
            raise ParameterError("a radiation section has real poles")


@lru_cache(maxsize=1)
def measured_body() -> Body:
    """The body that ships with the package."""
    return read_body()


@dataclass(frozen=True)
class Quantities:
    """All quantities of one instrument.

    String 1 (F4) is ``string_1``; bow force above zero bows it. ``tension_headroom``
    is the highest factor that tuning or tension modulation may put on a tension:
    the grids are chosen for it ([Yehu] eq. (57)), so they stay stable up to there.
    """

    string_1: StringQuantities = StringQuantities()
    string_2: StringQuantities = StringQuantities(
        rho=1350.0, r=0.40e-3, T=64.29, E=9.5e9, sigma_0=1.5844, sigma_1=0.0032, reach=17.0
    )
    bow: BowQuantities = BowQuantities()
    finger: FingerQuantities = FingerQuantities()
    bridge_x: float = quantity(0.30, "m", 0.05, 1.0, DATA_SET)
    tension_headroom: float = quantity(
        1.06, "1", 1.0, 2.0, "chosen: 50 cents of tuning, or the 46 cents of a 3 N press"
    )
    tension_modulation: float = quantity(
        1.0, "1", 0.0, 1.0, "chosen: share of EA that tightens a stretched string; [Yehu]: 0"
    )
    felt_loss: float = quantity(
        300.0, "1/s", 0.0, 1e4, "chosen: felt under the strings behind the bridge; [Yehu]: 0"
    )
    torsion: str = choice("off", "on", source="chosen: see decisions/0022")
    scheme: str = choice("explicit", "modal", source="chosen: see modal_string.py")
    directions: str = choice("one", "two", source="chosen: see planes.py")
    rocking: float = quantity(0.5, "1", -10.0, 10.0, "assumed: see planes.py; one was measured")
    bounce: float = quantity(1.0, "1", 0.0, 10.0, "assumed: see planes.py; one was measured")
    body: Body = field(default_factory=measured_body)

    def __post_init__(self) -> None:
        for string in self.strings:
            if not 0.0 < self.bridge_x < string.L:
                raise ParameterError(f"bridge_x {self.bridge_x} m lies off the string")
        if self.bow.mu_S < self.bow.mu_C:
            raise ParameterError("bow mu_S must not be below mu_C")

    @property
    def strings(self) -> tuple[StringQuantities, StringQuantities]:
        """Both strings, F4 first."""
        return (self.string_1, self.string_2)


def override(
    base: Quantities, changes: Mapping[str, Any] | Fields, folder: Path = Path()
) -> Quantities:
    """Return `base` with some quantities replaced.

    Parameters
    ----------
    changes : mapping
        Nested by section, as in a gesture or instrument file:
        ``{"bow": {"epsilon_0": 3e4}, "string_1": {"T": 51.0}, "bridge_x": 0.3}``;
        ``body`` names a body file, ``base`` an instrument file, or a shipped one such as ``paper``,
        that takes the place of `base`.
    folder : Path
        Where relative files are searched for.

    Raises
    ------
    ParameterError
        For an unknown name, a wrong type, a value out of bounds.
    """
    return _override_all(base, Fields.of(changes, "instrument"), folder, 0)


def _override_all(base: Quantities, table: Fields, folder: Path, depth: int) -> Quantities:
    """As `override`, of a file on which `depth` others are based."""

    def read_base(name: Any) -> Quantities:
        if depth == MAX_BASES:
            raise ParameterError(f"{brief(name)}: more than {MAX_BASES} files are based on another")
        return _read_quantities(folder / str(name), depth + 1)

    with table.at():
        base = table.read("base", read_base, base)
        found: Quantities = _override(base, table, folder)
    return found


def _override(base: Any, table: Fields, folder: Path) -> Any:
    values: dict[str, Any] = {}
    for item in fields(base):
        name = item.name
        if name not in table.data:
            continue
        if name == "body":
            values[name] = table.read(name, lambda value: read_body(folder / str(value)), None)
        elif "choices" in item.metadata:
            values[name] = table.read(name, chosen, None, item.metadata["choices"])
        elif "unit" in item.metadata:
            values[name] = table.read(name, _checked, None, item)
        else:
            values[name] = _override(getattr(base, name), table.table(name), folder)
    table.refuse_others(*(item.name for item in fields(base)))
    return replace(base, **values)


def _checked(value: Any, item: Any) -> Any:
    lo, hi, unit = item.metadata["lo"], item.metadata["hi"], item.metadata["unit"]
    if not isinstance(item.default, tuple):
        found = number(value, lo, hi, unit)
        if "whole" in item.metadata and not found.is_integer():
            raise ParameterError(f"expected a whole number from {lo} to {hi}, got {brief(value)}")
        return found
    count = len(item.default)
    if not isinstance(value, list | tuple) or len(value) != count:
        raise ParameterError(f"expected {count} numbers, got {brief(value)}")
    return tuple(number(entry, lo, hi, unit) for entry in value)


def instrument_file(path: Path) -> Path:
    """The file that a path names: itself, or one that is shipped, such as ``paper``."""
    shipped = shipped_folder("examples") / f"{path.name}.toml"
    return shipped if not path.suffix and not path.is_file() and shipped.is_file() else path


def read_quantities(path: Path) -> Quantities:
    """Read an instrument file (TOML, or JSON by its ending); a ParameterError names it."""
    return _read_quantities(path, 0)


def _read_quantities(path: Path, depth: int) -> Quantities:
    path = instrument_file(path)
    document = Document(path, "an instrument file").read(path)
    table = document.json() if path.suffix == ".json" else document.toml()
    return _override_all(Quantities(), table, path.parent, depth)
