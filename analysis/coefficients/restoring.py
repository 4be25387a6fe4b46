"""Quasi-static restoring: force and moment over a displacement, from a very slow oscillation."""

import math
from dataclasses import dataclass, replace

import numpy as np

from analysis.coefficients.body_cycle import LOADS, MOTIONS, BodyCycle, at_order
from analysis.coefficients.phasors import Phasors
from analysis.ideal_rig import mass_matrix, weight_matrix
from hardware.description.arrays import FloatArray
from hardware.description.body import Body
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane

_LEVEL = 0.95
_PURE = 0.02  # of the larger motion, at the struts: as much of the other one may be in it
_POINTS = 400
_CHANNELS = (*MOTIONS, *LOADS)


@dataclass(frozen=True)
class Restoring:
    """Stiffness of one motion.

    Attributes
    ----------
    motion
        ``"heave"``, ``"pitch"``, ``"sway"`` or ``"yaw"``.
    frequency_hz
        Of the slow turn.
    force, moment
        Stiffness: N/m and N for a translation, N and N m for a rotation; positive for a load that
        the struts have to exert. What inertia and believed added mass take at this frequency is
        taken off.
    force_half_width, moment_half_width
        At 95 %, from the scatter of the periods.
    force_inertia, moment_inertia
        What was taken off, ``-omega^2 (m + a)``.
    hydrostatic_force, hydrostatic_moment
        What hydrostatics (``[hull]`` restoring) and the model's weight say; ``None`` where the
        campaign file has none.
    higher
        Largest second or third harmonic of the force (moment for a rotation) over the first: a
        line has none.
    loop
        Quadrature over in phase of the same: damping and friction open the line to a loop.
    """

    run: str
    motion: str
    frequency_hz: float
    force: float
    force_half_width: float
    moment: float
    moment_half_width: float
    force_inertia: float
    moment_inertia: float
    hydrostatic_force: float | None
    hydrostatic_moment: float | None
    higher: float
    loop: float

    @property
    def rotates(self) -> bool:
        """Whether it is a rotation: pitch or yaw."""
        return self.motion in _ROTATIONS

    @property
    def units(self) -> tuple[str, str]:
        """Units of force and moment for the motion."""
        return ("N/rad", "N m/rad") if self.rotates else ("N/m", "N m/m")


@dataclass(frozen=True, eq=False)
class Track:
    """Force and moment over the displacement, over one turn.

    Attributes
    ----------
    displacement
        m or rad, from the harmonics, as are force (N) and moment (N m); shape ``(points,)``.
    """

    displacement: FloatArray
    force: FloatArray
    moment: FloatArray


_ROTATIONS = ("pitch", "yaw")
_NAMES = {Plane.VERTICAL: ("heave", "pitch"), Plane.HORIZONTAL: ("sway", "yaw")}


def restoring_of(
    cycle: BodyCycle, body: Body | None, added_mass: FloatArray, hydrostatic: FloatArray
) -> Restoring:
    """Return the stiffness that a slow turn shows.

    Parameters
    ----------
    body
        The model, with its weight; ``None`` where nobody said.
    added_mass, hydrostatic
        What is believed of the water, about the midpoint, shape ``(2, 2)``; zero hydrostatics are
        none given.

    Raises
    ------
    DataError
        If translation and rotation move together: one run cannot tell their stiffness apart.
    """
    column = _motion_index(cycle)
    motion = ("translation", "rotation")[column]
    first = _first(cycle).referred_to(motion)
    values, widths = _stiffness(first, motion)
    square = (2.0 * math.pi * cycle.frequency_hz) ** 2
    inertia = -square * (_mass(body, cycle.plane) + added_mass)[:, column]
    expected = _expected_restoring(body, hydrostatic, cycle)
    load = ("force", "moment")[column]
    ratio = first[load]
    return Restoring(
        cycle.name,
        _NAMES[cycle.plane][column],
        cycle.frequency_hz,
        float(values[0] - inertia[0]),
        float(widths[0]),
        float(values[1] - inertia[1]),
        float(widths[1]),
        float(inertia[0]),
        float(inertia[1]),
        None if expected is None else float(expected[0, column]),
        None if expected is None else float(expected[1, column]),
        max(abs(cycle.phasors[at_order(load, n)]) for n in (2, 3)) / abs(ratio),
        ratio.imag / ratio.real if ratio.real else math.inf,
    )


def track_of(restoring: Restoring, cycle: BodyCycle) -> Track:
    """Return force and moment over the displacement, as the harmonics 1 to 3 draw them."""
    theta = np.linspace(0.0, 2.0 * math.pi, _POINTS)

    def waveform(name: str) -> FloatArray:
        return np.asarray(
            sum(
                np.imag(cycle.phasors[at_order(name, n)] * np.exp(1j * n * theta))
                for n in range(1, cycle.orders + 1)
            )
        )

    return Track(waveform("rotation" if restoring.rotates else "translation"), waveform("force"),
                 waveform("moment"))  # fmt: skip


def _first(cycle: BodyCycle) -> Phasors:
    chosen = cycle.phasors.select([at_order(name, 1) for name in _CHANNELS])
    return replace(chosen, names=_CHANNELS)


def _motion_index(cycle: BodyCycle) -> int:
    """Return which motion it is: 0 for the translation, 1 for the rotation."""
    first = _first(cycle)
    sizes = np.array([abs(first["translation"]), cycle.half_spacing_m * abs(first["rotation"])])
    if sizes.min() > _PURE * sizes.max():
        raise DataError(
            f"{cycle.name}: translation ({1e3 * sizes[0]:.3g} mm) and rotation "
            f"({1e3 * sizes[1]:.3g} mm at the struts) move together (limit {100.0 * _PURE:g} % of "
            "the larger); their stiffness needs a run of each alone"
        )
    return int(np.argmax(sizes))


def _stiffness(first: Phasors, motion: str) -> tuple[FloatArray, FloatArray]:
    """Return the in-phase part of both loads over the motion, and their half-widths."""
    amplitude = first[motion].real
    at = 2 * first.index(motion)
    values, widths = np.zeros(2), np.zeros(2)
    for k, load in enumerate(("force", "moment")):
        values[k] = first[load].real / amplitude
        slope = np.zeros(2 * len(first.names))
        slope[2 * first.index(load)] = 1.0 / amplitude
        slope[at] -= values[k] / amplitude
        widths[k] = float(first.real.mapped(slope[None]).half_width(_LEVEL)[0])
    return values, widths


def _mass(body: Body | None, plane: Plane) -> FloatArray:
    return np.zeros((2, 2)) if body is None else mass_matrix(body, plane)


def _expected_restoring(
    body: Body | None, hydrostatic: FloatArray, cycle: BodyCycle
) -> FloatArray | None:
    """Return what the struts feel of hydrostatics and weight; ``None`` where nothing is given."""
    below_surface = body is not None and body.displaced_kg is not None
    if not (hydrostatic.any() or below_surface):
        return None
    if body is None:
        return hydrostatic
    return hydrostatic + weight_matrix(body, cycle.plane, cycle.medium)
