"""The body workshop, for ``yehu.body``: bodies as they are measured, fitted, drawn and played.

`load` gives the measured yehu's body, or that of a file; `read` and `fit` make one of taps or
responses (docs/body.md). It needs the extra ``yehu-server[body]``, and ``[plots]`` for pictures.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from yehu_lab.body import Curve, Modes, Tap, made_taps
from yehu_lab.body.body_file import Fit, bare_fit, read_fit
from yehu_lab.body.fitting_process import fit_in_process
from yehu_lab.body.measurement import Measurement, average, read
from yehu_server.api.checks import PathLike, number, path_of, whole
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.layout import MAX_MODES, MAX_SECTIONS, USUAL_SECTIONS
from yehu_server.errors import ParameterError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "Body",
    "Curve",
    "Measurement",
    "Modes",
    "Tap",
    "average",
    "fit",
    "load",
    "made_taps",
    "read",
]

HIGHEST_HZ = 200e3


@dataclass(frozen=True, repr=False)
class Body(Fit):
    """A body: its bridge modes and radiation, what was measured of it, and how well it fits.

    Everything that plays takes it: ``yehu.render(notes, instrument=found)``.

    Attributes
    ----------
    body : core.physics.default_quantities.Body
        What the model plays: ``Quantities(body=found.body)``.
    modes : Modes
        The bridge modes: arrays ``frequency_hz``, ``damping``, ``mass`` (kg), ``resistance``.
    measurement : Measurement
        Over the band of the fit; its curves are None where nothing was measured.
    band_hz : tuple of float
        The band of the fit.
    admittance_db, radiation_db : Differences, optional
        How far the fit is off, where that was measured: ``rms``, ``most``, ``scatter``.
    warnings : tuple of str
        Of the measurement and of the fit.
    """

    def __repr__(self) -> str:
        modes, sections = len(self.body.mass), len(self.body.sections)
        return f"<yehu_server.body.Body of {modes} modes and {sections} sections>"

    def plot(self, figure: Figure | None = None) -> Figure:
        """Draw measured and fitted curves, what remains, and the table of modes.

        Parameters
        ----------
        figure : Figure, optional
            By default a new one.

        Raises
        ------
        ParameterError
            Where matplotlib is missing.

        Examples
        --------
        >>> import yehu_server as yehu
        >>> len(yehu.body.load().plot().axes)
        5
        """
        from yehu_lab.plot.body import draw

        return draw(self, figure)


def load(source: PathLike | Quantities | None = None) -> Body:
    """Return a body, with what was measured of it where the file has that.

    Parameters
    ----------
    source : path or Quantities, optional
        A body file, an instrument file, or the quantities of an instrument; by default the
        measured yehu.

    Raises
    ------
    YehuError
        Where it cannot be read.

    Examples
    --------
    >>> import numpy as np, yehu_server as yehu
    >>> body = yehu.body.load()
    >>> body, body.modes.frequency_hz.round()[0]
    (<yehu_server.body.Body of 11 modes and 25 sections>, np.float64(439.0))
    >>> float(np.abs(body.admittance(439.0)).round(2))
    0.69
    """
    if isinstance(source, Quantities) or source is None:
        return _with_methods(bare_fit((source or Quantities()).body))
    return _with_methods(read_fit(path_of(source, "source")))


def fit(
    measurement: Measurement,
    *,
    band_hz: tuple[float, float] | None = None,
    modes: int | None = None,
    sections: int = USUAL_SECTIONS,
) -> Body:
    """Fit a body: bridge modes to the admittance, sections to the radiation.

    What was not measured is kept of the measured yehu. A process of its own does it, which keeps
    one core busy.

    Parameters
    ----------
    measurement : Measurement
        Of `read` or `average`.
    band_hz : tuple of float, optional
        Lowest and highest frequency to be met; by default from 100 Hz to where the hammer stops
        to excite, at most 8 kHz.
    modes : int, optional
        Number of bridge modes; by default as many as the measurement shows.
    sections : int
        Highest number of sections of the radiation.

    Raises
    ------
    YehuError
        Where nothing was measured, or too little in the band; where scipy is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> measured = yehu.body.average(yehu.body.made_taps(count=2, seconds=0.3))
    >>> found = yehu.body.fit(measured, band_hz=(250.0, 2000.0), sections=8)
    >>> found.admittance_db is not None and found.admittance_db.rms < 0.5
    True
    """
    if not isinstance(measurement, Measurement):
        kind = type(measurement).__name__
        raise ParameterError(f"measurement: expected that of `read` or `average`, got {kind}")
    if band_hz is not None:
        lo, hi = (number(hz, "band_hz", 0.0, HIGHEST_HZ) for hz in band_hz)
        band_hz = lo, hi
    count = None if modes is None else whole(modes, "modes", 1, MAX_MODES)
    most = whole(sections, "sections", 1, MAX_SECTIONS)
    return _with_methods(fit_in_process(measurement, band_hz=band_hz, modes=count, sections=most))


def _with_methods(found: Fit) -> Body:
    return Body(**{each.name: getattr(found, each.name) for each in fields(found)})
