"""Water that varies with frequency and speed: its truth, and what a campaign believes of it.

The retardation functions are damped waves, K = k exp(-b t) (cos(w0 t) - b/w0 sin(w0 t)), so that
added mass and damping over frequency have closed forms: K(i w) = k i w / ((b + i w)^2 + w0^2). No
wave is radiated at frequency 0, and the damping is 0 there.
"""

from dataclasses import dataclass

import numpy as np

from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.priors import Prior
from tests.sealed.generator.rig import Run
from tests.sealed.generator.worlds import World

_DIAGONAL = ((P.ADDED_00, P.DAMPING_00, P.KERNEL_0), (P.ADDED_11, P.DAMPING_11, P.KERNEL_1))
_GRID = np.geomspace(0.3, 20.0, 60)  # rad/s, of a believed table
_LINES = 17


@dataclass(frozen=True)
class Believed:
    """A table of added mass and damping over frequency, ``(frequencies, 2)``: diagonals alone."""

    omega_rad_s: FloatArray
    added: FloatArray
    damping: FloatArray


def of_memory(rate: float, turn: float, omega: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return added mass and damping of a damped wave over frequency."""
    off = rate**2 + turn**2 - omega**2
    square = off**2 + (2.0 * rate * omega) ** 2
    return off / square, 2.0 * rate * omega**2 / square


def damped_wave(rate: float, turn: float, time_s: FloatArray) -> FloatArray:
    """Return ``exp(-rate t) (cos(turn t) - rate / turn sin(turn t))``."""
    turned = np.cos(turn * time_s) - rate / turn * np.sin(turn * time_s)
    return np.asarray(np.exp(-rate * time_s) * turned)


def coefficients(p: FloatArray, omega: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return added mass and damping as they are, ``(frequencies, 2)``: diagonals alone."""
    shape = of_memory(p[P.KERNEL_RATE], p[P.KERNEL_OMEGA], omega)
    added, damping = (
        np.column_stack([p[row[i]] + p[row[2]] * part for row in _DIAGONAL])
        for i, part in enumerate(shape)
    )
    return added, damping


def remembering(
    p: FloatArray, runs: tuple[Run, ...], world: World, rng: np.random.Generator
) -> FloatArray:
    """Return the parameters with a memory whose mean over the campaign's band they already have."""
    q, fast = p.copy(), [2.0 * np.pi * run.frequency_hz for run in runs]
    band = np.geomspace(min(fast), max(fast), _LINES)
    octaves = max(float(np.log2(band[-1] / band[0])), 0.5)
    q[P.KERNEL_RATE] = world.value("kernel_rate", rng)
    q[P.KERNEL_OMEGA] = float(np.sqrt(band[0] * band[-1])) * rng.uniform(0.7, 1.3)
    shapes = of_memory(q[P.KERNEL_RATE], q[P.KERNEL_OMEGA], band)
    for added, damping, kernel in _DIAGONAL:
        per_unit = max(
            float(np.ptp(shape)) / float(p[place]) / octaves
            for shape, place in zip(shapes, (added, damping), strict=True)
        )
        q[kernel] = world.value("memory_per_octave", rng) / per_unit
        for shape, place in zip(shapes, (added, damping), strict=True):
            q[place] -= q[kernel] * float(shape.mean())
    return q


def tolerated(world: World) -> tuple[Prior, ...]:
    """Return what coefficients may do with frequency and speed: slope, bend at half, speed."""
    places = (
        ("added_mass_per_octave", P.ADDED_SLOPE_0, 1.0),
        ("added_mass_per_octave", P.ADDED_SLOPE_1, 1.0),
        ("damping_per_octave", P.DAMPING_SLOPE_0, 1.0),
        ("damping_per_octave", P.DAMPING_SLOPE_1, 1.0),
        ("added_mass_per_octave", P.ADDED_BEND_0, 0.5),
        ("added_mass_per_octave", P.ADDED_BEND_1, 0.5),
        ("damping_per_octave", P.DAMPING_BEND_0, 0.5),
        ("damping_per_octave", P.DAMPING_BEND_1, 0.5),
        *_SPEED,
    )
    known = world.tolerances
    return tuple(Prior(place, part * known[name]) for name, place, part in places if name in known)


_SPEED = (
    ("added_mass_per_speed", P.ADDED_SPEED, 1.0),
    ("damping_per_speed", P.DAMPING_SPEED, 1.0),
)


def of_speed(world: World) -> tuple[Prior, ...]:
    """Return what coefficients may do with speed."""
    known = world.tolerances
    return tuple(Prior(place, part * known[name]) for name, place, part in _SPEED if name in known)


def varied(p: FloatArray, run: Run) -> None:
    """Put the change of the coefficients with this run's frequency and speed into them."""
    octaves = float(np.log2(run.frequency_hz / p[P.MIDDLE_HZ])) if run.turns else 0.0
    faster = run.carriage_speed_m_s / p[P.MIDDLE_SPEED] - 1.0 if run.carriage_speed_m_s else 0.0
    for first, slope, bend, speed in (
        (P.ADDED_00, P.ADDED_SLOPE_0, P.ADDED_BEND_0, P.ADDED_SPEED),
        (P.DAMPING_00, P.DAMPING_SLOPE_0, P.DAMPING_BEND_0, P.DAMPING_SPEED),
    ):
        for i in range(2):
            part = p[slope + i] * octaves + p[bend + i] * octaves**2 + p[speed] * faster
            if part != 0.0:
                p[first + 3 * i] *= 1.0 + part


def table_of(p: FloatArray, world: World, rng: np.random.Generator) -> Believed:
    """Return a table that is off in level and slope; the damping that no memory has is left out."""
    off = rng.uniform(-1.0, 1.0, (2, 2))
    octaves = 2.0 * np.tanh(0.5 * np.log2(_GRID / (2.0 * np.pi * p[P.MIDDLE_HZ])))
    level, slope = world.share("table_level"), world.share("table_slope")
    wrong = 1.0 + level * off[0] + slope * octaves[:, None] * off[1]
    added, damping = coefficients(p, _GRID)
    lasting = p[[P.DAMPING_00, P.DAMPING_11]]
    return Believed(_GRID, added * wrong, (damping - lasting) * wrong)


def table_text(found: Believed, plane: str) -> str:
    """Return a table as a file of the kind that ``[radiation]`` reads."""
    names = ("Heave", "Pitch") if plane == "vertical" else ("Sway", "Yaw")
    lines = ["body,omega_rad_s,radiating_dof,influenced_dof,added_mass_SI,damping_SI"]
    for n, omega in enumerate(found.omega_rad_s):
        for column, moved in enumerate(names):
            for row, felt in enumerate(names):
                own = float(row == column)
                values = own * found.added[n, row], own * found.damping[n, row]
                lines.append(f"model,{omega:.6g},{moved},{felt},{values[0]:.8g},{values[1]:.8g}")
    return "\n".join(lines) + "\n"
