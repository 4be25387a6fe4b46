"""SIMMAN's deliverables of a PMM run, out and in.

The workshops ask for ASCII, SI units, model scale: one averaged cycle with t, X, Y, N, x, y, psi,
u, v, r and the accelerations, the Fourier coefficients, and a description. X, Y and N are those of
the water and of the model's inertia on the model: the opposite of what the struts exert, which is
what a dynamometer between them reads. The vertical plane delivers Z and M with z, theta, w and q in
the same layout. Files: :mod:`analysis.exchange.simman_files`.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.coefficients.body_cycle import LOADS, SURGE_FORCE, BodyCycle, at_order, labels
from analysis.coefficients.phasors import Phasors
from analysis.kinematics import body_frame
from analysis.kinematics.body_frame import CHANNELS
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane

SAMPLES: Final = 200  # of the averaged cycle
_ORDERS: Final = 6  # of a cycle that comes without its harmonics

# Of each plane: force, moment, displacements, velocities and accelerations.
NAMES: Final[Mapping[Plane, tuple[str, ...]]] = {
    Plane.HORIZONTAL: ("Y", "N", "y", "psi", "v", "r", "dv/dt", "dr/dt"),
    Plane.VERTICAL: ("Z", "M", "z", "theta", "w", "q", "dw/dt", "dq/dt"),
}
UNITS: Final = ("N", "N m", "m", "rad", "m/s", "rad/s", "m/s2", "rad/s2")
AHEAD: Final = ("x", "u", "du/dt")
AHEAD_UNITS: Final = ("m", "m/s", "m/s2")
AHEAD_CHANNEL: Final = CHANNELS[2]


@dataclass(frozen=True)
class SimmanDescription:
    """Description that goes with the deliverables; ``None`` where a value is not known.

    Attributes
    ----------
    scale
        Ship over model.
    inertia_kg_m2, cg_x_m
        About and ahead of the origin, the midpoint between the struts.
    logging_rate_hz, periods
        Of the recording, and how many of its periods were averaged.
    """

    run: str
    campaign: str = ""
    scale: float | None = None
    length_m: float | None = None
    mass_kg: float | None = None
    inertia_kg_m2: float | None = None
    cg_x_m: float | None = None
    water_temperature_deg_c: float | None = None
    density_kg_m3: float | None = None
    logging_rate_hz: float | None = None
    periods: int | None = None


@dataclass(frozen=True, eq=False)
class Deliverables:
    """Deliverables of one run in SIMMAN's form.

    Attributes
    ----------
    speed_m_s, drift_rad
        Of the carriage, and steady.
    columns
        The averaged cycle by name, each of :data:`SAMPLES`; ``t`` in seconds.
    mean, sine, cosine
        Fourier coefficients by name: ``A0``, and ``S_n``, ``C_n`` of n = 1 to N, of
        ``A0 + sum S_n sin(n theta) + C_n cos(n theta)``.
    """

    plane: Plane
    frequency_hz: float
    speed_m_s: float
    drift_rad: float
    description: SimmanDescription
    columns: Mapping[str, FloatArray]
    mean: Mapping[str, float]
    sine: Mapping[str, FloatArray]
    cosine: Mapping[str, FloatArray]


def deliverables_of(
    cycle: BodyCycle, description: SimmanDescription, samples: int = SAMPLES
) -> Deliverables:
    """Return a run's averaged cycle and Fourier coefficients.

    Raises
    ------
    DataError
        If the run does not oscillate.
    """
    if not cycle.frequency_hz > 0.0:
        raise DataError(f"{cycle.name}: a run that does not oscillate has no cycle to average")
    phasors = _all_phasors(cycle)
    angle = 2.0 * math.pi * np.arange(samples) / samples
    columns = {"t": angle / (2.0 * math.pi * cycle.frequency_hz)}
    columns |= {name: _wave(phasor, samples) for name, phasor in phasors.items()}
    columns |= _surge_columns(cycle, columns)
    return Deliverables(
        cycle.plane,
        cycle.frequency_hz,
        cycle.speed_m_s,
        cycle.drift_rad,
        description,
        columns,
        {name: float(phasor[0].real) for name, phasor in phasors.items()},
        {name: phasor[1:].real.copy() for name, phasor in phasors.items()},
        {name: phasor[1:].imag.copy() for name, phasor in phasors.items()},
    )


def _all_phasors(cycle: BodyCycle) -> dict[str, ComplexArray]:
    """Loads, motion, velocities through the water and accelerations by name, order 0 real."""
    rows = {name: _rows(cycle, name) for name in cycle.channels}
    rate = 2j * math.pi * cycle.frequency_hz * np.arange(cycle.orders + 1)
    turning = rate * rows["rotation"]
    values = (-rows["force"], -rows["moment"], rows["translation"], rows["rotation"],
              rows["across"], turning, rate * rows["across"], rate * turning)  # fmt: skip
    phasors = dict(zip(NAMES[cycle.plane], values, strict=True))
    if cycle.has_surge:
        phasors = {"X": -_rows(cycle, SURGE_FORCE), **phasors}
    return phasors


def _rows(cycle: BodyCycle, name: str) -> ComplexArray:
    places = [cycle.phasors.index(at_order(name, n)) for n in range(cycle.orders + 1)]
    return np.array(cycle.phasors.values[places])


def _surge_columns(cycle: BodyCycle, columns: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Return x, u and du/dt: x of the carriage, the others along the model's own axis."""
    rate = 2j * math.pi * cycle.frequency_hz * np.arange(cycle.orders + 1)
    ahead, samples = _rows(cycle, AHEAD_CHANNEL), len(columns["t"])
    return {
        "x": cycle.speed_m_s * columns["t"],
        "u": _wave(ahead, samples),
        "du/dt": _wave(rate * ahead, samples),
    }


def _wave(phasors: ComplexArray, samples: int) -> FloatArray:
    """Return one cycle of a quantity from its phasors, of which the first is the mean."""
    angle = 2.0 * math.pi * np.arange(samples) / samples
    turns = np.exp(1j * np.arange(1, len(phasors))[:, None] * angle)
    return np.asarray((phasors[1:, None] * turns).imag.sum(axis=0) + phasors[0].real)


def fourier(
    columns: Mapping[str, FloatArray],
) -> tuple[dict[str, float], dict[str, FloatArray], dict[str, FloatArray]]:
    """Return mean, sines and cosines of an evenly sampled cycle that does not repeat its start."""
    count = len(columns["t"])
    angle = 2.0 * math.pi * np.arange(count) / count
    highest = min(_ORDERS, (count - 1) // 2)
    turns = 2.0 / count * np.exp(-1j * np.arange(1, highest + 1)[:, None] * angle)
    mean, sine, cosine = {}, {}, {}
    for name, values in columns.items():
        if name in ("t", *AHEAD):
            continue
        coefficients = turns @ values  # C_n - i S_n
        mean[name], sine[name], cosine[name] = (
            float(values.mean()),
            -coefficients.imag,
            coefficients.real,
        )
    return mean, sine, cosine


def _harmonics(values: FloatArray, orders: int) -> ComplexArray:
    """Return the phasors of an evenly sampled cycle, the first its mean."""
    spectrum = np.fft.rfft(values)[: orders + 1] / len(values)
    return np.concatenate((spectrum[:1], 2j * spectrum[1:]))


def _phasor(deliverables: Deliverables, name: str, order: int) -> complex:
    if order == 0:
        return complex(deliverables.mean[name])
    return complex(deliverables.sine[name][order - 1], deliverables.cosine[name][order - 1])


def cycle_of(deliverables: Deliverables, half_spacing_m: float = 0.5) -> BodyCycle:
    """Return deliverables as a cycle, so that another tank's runs give coefficients too.

    Parameters
    ----------
    half_spacing_m
        A length that makes rotations comparable with translations; any of the model's size does.

    Raises
    ------
    DataError
        If one of force, moment, displacement, angle, velocity across and ``u`` is missing.
    """
    names = NAMES[deliverables.plane]
    force, moment, place, angle, across = names[:5]
    sources = {"translation": place, "rotation": angle, "across": across, "force": force,
               "moment": moment}  # fmt: skip
    if "X" in deliverables.mean:
        sources[SURGE_FORCE] = "X"
    there = deliverables.mean.keys() | ({"u"} & deliverables.columns.keys())
    missing = [name for name in (*names[:5], "u") if name not in there]
    if missing:
        raise DataError(
            f"{deliverables.description.run}: {', '.join(missing)} is not among the deliverables; "
            "a cycle needs loads, motion and the velocities through the water"
        )
    orders = len(deliverables.sine[force])
    rows: dict[str, ComplexArray] = {
        channel: complex(-1.0 if channel in (*LOADS, SURGE_FORCE) else 1.0)
        * np.array([_phasor(deliverables, name, n) for n in range(orders + 1)], dtype=np.complex128)
        for channel, name in sources.items()
    }
    rows[AHEAD_CHANNEL] = _harmonics(deliverables.columns["u"], orders)
    channels = CHANNELS if SURGE_FORCE in rows else CHANNELS[:-1]
    values = np.stack([rows[channel] for channel in channels], axis=-1).ravel()
    units = body_frame.UNITS[: len(channels)] * (orders + 1)
    phasors = Phasors.of(labels(channels, orders), units, values)
    return BodyCycle(
        deliverables.description.run,
        deliverables.plane,
        half_spacing_m,
        deliverables.frequency_hz,
        deliverables.speed_m_s,
        phasors,
        orders,
        drift_rad=deliverables.drift_rad,
        mean_known=True,
    )
