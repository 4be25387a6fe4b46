"""At small angles a reality without effects gives Z_n y_n: two planes, drives and media."""

from dataclasses import replace

import numpy as np
import pytest

from tests.sealed.closed_forms import HEAVE, RIG, Phasors, impedance, phasors, still
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.rig import Run

pytestmark = pytest.mark.slow  # the time loop takes 20 s to compile

LEVER = 0.5
SMALL_M = 3e-6  # angles whose squares are nothing


def _coupled(sign: float) -> FloatArray:
    p = still()
    p[P.AFT_SIGN] = p[P.INCIDENCE] = sign
    p[P.GRAVITY] = 9.81 if sign > 0.0 else 0.0
    p[P.CG_X], p[P.CG_Z] = -0.02, 0.03
    p[P.ADDED_01], p[P.ADDED_10] = 3.0, 2.0
    p[P.DAMPING_01], p[P.DAMPING_10] = -12.0, 8.0
    p[P.RESTORING_01] = p[P.RESTORING_10] = 300.0
    return p


def _expected(p: FloatArray, seen: Phasors, run: Run, order: int) -> tuple[complex, complex]:
    """Return force and moment about the midpoint for the displacements that were recorded."""
    sign, w = p[P.AFT_SIGN], order * 2.0 * np.pi * run.frequency_hz
    aft, fore = seen.of["displacement_aft"][order], seen.of["displacement_fore"][order]
    q = np.array([(aft + fore) / 2.0, sign * (aft - fore) / (2.0 * LEVER)])
    wet = run.medium == "water"
    at = [int(P.ADDED_00), int(P.DAMPING_00), int(P.RESTORING_00)]
    added, damping, restoring = (wet * p[i : i + 4].reshape(2, 2) for i in at)
    cross = -sign * p[P.MASS] * p[P.CG_X]
    body = np.array([[p[P.MASS], cross], [cross, p[P.INERTIA]]])
    weight = np.diag([0.0, p[P.MASS] * p[P.GRAVITY] * p[P.CG_Z]])
    through = np.array([[1j * w, sign * run.carriage_speed_m_s], [0.0, 1j * w]])
    load = (-(w**2) * body + weight + restoring) @ q
    load = load + (1j * w * added + damping) @ (through @ q)
    return complex(load[0]), complex(load[1])


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("rod", [0.0, 1.5])
@pytest.mark.parametrize("medium", ["water", "air"])
def test_loads_follow_the_recorded_displacements(sign: float, rod: float, medium: str) -> None:
    p = _coupled(sign)
    p[P.ROD] = rod
    run = replace(HEAVE, eccentricity_m=SMALL_M, strut_phase_rad=1.1, carriage_speed_m_s=1.2,
                  medium=medium)  # type: ignore[arg-type]  # fmt: skip
    seen = phasors(p, run)
    for order in (1, 2, 3):
        force, moment = _expected(p, seen, run, order)
        aft, fore = seen.of["force_aft"][order], seen.of["force_fore"][order]
        largest = abs(_expected(p, seen, run, 1)[0])
        assert abs(aft + fore - force) < 1e-3 * max(abs(force), 1e-3 * largest)
        turned = sign * (aft - fore) * LEVER
        assert abs(turned - moment) < 1e-3 * max(abs(moment), 1e-3 * largest)


def test_shaft_holds_its_speed_under_load() -> None:
    seen = phasors(still())
    assert abs(seen.of["displacement_aft"][1] - HEAVE.eccentricity_m) < 1e-4 * 0.02
    assert abs(seen.of["displacement_aft"][3]) < 1e-5 * 0.02
    assert abs(seen.of["force"][1] - impedance(1) * 0.02) < 1e-3 * abs(impedance(1)) * 0.02


def test_step_is_short_enough() -> None:
    """Halving every step changes no harmonic by 0.01 % of the first."""
    finer = replace(RIG, sample_rate_hz=2.0 * RIG.sample_rate_hz)
    coarse, fine = phasors(_coupled(1.0)), phasors(_coupled(1.0), rig=finer)
    first = abs(coarse.of["force"][1])
    assert np.abs(coarse.of["force"] - fine.of["force"]).max() < 1e-4 * first
