"""From parameters and a run to what truly moves and pulls: the integration, set up and called."""

import math
from dataclasses import dataclass, replace

import numpy as np

from tests.sealed.generator.arranged import drifted
from tests.sealed.generator.integrate import integrate
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.rig import Rig, Run
from tests.sealed.generator.water import damped_wave, varied

# Longest step on rigid gauges, and on gauges, frames or clearances that give way.
RIGID_STEP_S, LOOSE_STEP_S = 5.1e-3, 0.7e-3
# Longest step by the crank's own oscillation on the gear, rad.
GEAR_STEP_RAD = 1.3
SETTLING_PERIODS = 3.0
# What the gauges' stiffness becomes where a clearance needs one, N/m.
CONTACT_N_M = 2e7
KERNEL_S = 5.0
# The water has forgotten the start after so many times of its memory.
FORGOTTEN = 6.0


@dataclass(frozen=True)
class Truth:
    """What happens, sensors apart: ``(6, samples)`` from ``before`` samples ahead of time 0."""

    samples: FloatArray
    edges_s: FloatArray
    before: int


def set_run(p: FloatArray, run: Run) -> FloatArray:
    """Return the parameters with those of the run put in."""
    q = p.copy()
    moving = run.turns
    q[P.OMEGA] = 2.0 * math.pi * run.frequency_hz if moving else 0.0
    q[P.ECCENTRICITY] = run.eccentricity_m if moving else 1e-9
    for place in (P.ECC_ERROR_AFT, P.ECC_ERROR_FORE):
        q[place] *= moving
    q[P.STRUT_PHASE], q[P.SPEED] = run.strut_phase_rad, run.carriage_speed_m_s
    q[P.WATER] = float(run.medium == "water")
    q[P.HOUR], q[P.WAITED], q[P.PRELOAD] = run.hour, run.waited_s, run.preload_n
    if q[P.KELVIN_SHAPE] > 0.0:
        q[P.HOUR] = 0.5 * (1.0 - math.exp(-2.0 * run.hour))
    varied(q, run)
    drifted(q, run.drift_rad, run.drift_by)
    if run.kind == "check-weight":
        q[P.CHECK_AFT if run.strut == "aft" else P.CHECK_FORE] = run.weight_n
    if run.kind == "injection":
        q[P.INJECTED] = run.force_n
    return q


def retardation(p: FloatArray, interval_s: float) -> FloatArray:
    """Return both retardation functions at the sample interval, ``(2, taps)``; one tap if none.

    The memory's is exponential or Gaussian, a damped cosine or one with a slow tail; echoes from
    the walls come back as widening bumps, or as a standing wave.
    """
    own = p[[P.KERNEL_0, P.KERNEL_1]]
    if p[P.MEMORY_0] == p[P.MEMORY_1] == p[P.ECHO] == 0.0 and not own.any():
        return np.zeros((2, 1))
    tau = np.arange(0.0, KERNEL_S, interval_s)
    scaled = p[P.MEMORY_RATE] * tau
    shape = np.exp(-scaled) if p[P.MEMORY_SHAPE] == 0.0 else np.exp(-np.pi / 4.0 * scaled**2)
    if p[P.MEMORY_SHAPE] == 2.0:
        shape = 1.0 / (1.0 + scaled) ** 2
    elif p[P.MEMORY_SHAPE] == 3.0:
        shape = np.exp(-0.5 * scaled) * np.cos(scaled)
    echo = np.zeros_like(tau)
    for bounce in range(1, 5):
        width = 0.06 * p[P.ECHO_DELAY] * (1.0 + 0.3 * bounce)
        bump = np.exp(-(((tau - bounce * p[P.ECHO_DELAY]) / width) ** 2))
        echo += p[P.ECHO_DECAY] ** (bounce - 1) * bump / (width * math.sqrt(math.pi))
    if p[P.ECHO_SHAPE] > 0.0:
        turn = 2.0 * math.pi / p[P.ECHO_DELAY]
        echo = turn * np.exp(-0.05 * turn * tau) * np.cos(turn * tau) / math.pi
    first = p[P.MEMORY_0] * shape + p[P.ECHO] * p[P.ADDED_00] * echo
    both = np.vstack([first, p[P.MEMORY_1] * shape + p[P.ECHO] * p[P.ADDED_11] * echo])
    if own.any():
        both += own[:, None] * damped_wave(p[P.KERNEL_RATE], p[P.KERNEL_OMEGA], tau)
    return both


def _is_loose(p: FloatArray) -> bool:
    gives = p[[P.GAUGE_STIFFNESS, P.FRAME_STIFFNESS, P.KNOCK, P.PLAY]]
    return bool(np.any(gives > 0.0))


def _gear_step_s(p: FloatArray) -> float:
    return float(GEAR_STEP_RAD * math.sqrt(p[P.CRANK_INERTIA] / p[P.GEAR_STIFFNESS]))


def happen(p: FloatArray, run: Run, rig: Rig, *, settling: float = SETTLING_PERIODS) -> Truth:
    """Return what happens in a run, from ``settling`` periods ahead of the record."""
    q = set_run(p, run)
    loose = _is_loose(q)
    if loose and q[P.GAUGE_STIFFNESS] == 0.0:
        q[P.GAUGE_STIFFNESS] = CONTACT_N_M
        q[P.GAUGE_DAMPING] = 2e4
    period = 1.0 / run.frequency_hz if run.turns else 1.0
    settled_s = settling * period
    if q[P.KERNEL_0] or q[P.KERNEL_1]:
        settled_s = max(settled_s, FORGOTTEN / float(q[P.KERNEL_RATE]))
    before, samples = (round(x * rig.sample_rate_hz) for x in (settled_s, run.duration_s))
    step = min(LOOSE_STEP_S if loose else RIGID_STEP_S, _gear_step_s(q))
    substeps = math.ceil(1.0 / (rig.sample_rate_hz * step))
    interval = 1.0 / rig.sample_rate_hz
    kernels = retardation(q, interval)
    out, edges = integrate(q, kernels, interval, substeps, before, samples)
    return Truth(out, edges, before)


def shortened(run: Run) -> Run:
    """Return the run with no more periods than a steady state needs."""
    return replace(run, periods=2) if run.turns else run
