"""Runs of a body under a known force: its equation integrated by scipy, friction from stop to stop.

Nothing of the simulator is used: what a record shows is written down here.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from analysis.gap.pendulum.causes import tolerance
from analysis.gap.pendulum.driven import DrivenTrial, KnownForce
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.swings import KINDS, scatter
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from sim.acquisition.channels import Digitiser
from sim.pendulum.bench import PendulumBench
from sim.pendulum.coordinates import HEAVE
from sim.pendulum.driven import DrivenBody
from sim.pendulum.release import Release
from sim.pendulum.resistance import Resistance
from sim.pendulum.sensors import Sensor

MASS_KG, DAMPING, STIFFNESS = 70.0, 60.0, 1000.0
RATE_HZ, FROM_S, TO_S = 20.0, 25.0, 50.0
NOISE_N, NOISE_M = 0.01, 1e-5


@dataclass(frozen=True)
class Made:
    """What the body has that is not stated, and what its sensor does."""

    friction_n: float = 0.0
    quadratic: float = 0.0
    power: float = 0.0  # of |v|^1.4
    hardening: float = 0.0  # N/m3
    gain: float = 1.0
    delay_s: float = 0.0
    clock: float = 0.0
    damping: float = DAMPING
    stiffness: float = STIFFNESS

    def motion(self, frequency_hz: float, force_n: float, time_s: FloatArray) -> FloatArray:
        """Return the displacement from rest on, by the equation of motion."""
        omega, sign = 2.0 * math.pi * frequency_hz, 1.0

        def free(t: float, x: FloatArray) -> float:
            q, v = x
            pushed = force_n * math.cos(omega * t) - self.hardening * q**3
            resisted = self.damping * v + self.quadratic * abs(v) * v
            resisted += math.copysign(self.power * abs(v) ** 1.4, v)
            return float(pushed - resisted - self.stiffness * q)

        def rate(t: float, x: FloatArray) -> list[float]:
            return [x[1], (free(t, x) - sign * self.friction_n) / MASS_KG]

        def turned(t: float, x: FloatArray) -> float:
            return float(x[1]) if self.friction_n and t > begun + 1e-9 else sign

        turned.terminal = True  # type: ignore[attr-defined]
        end_s, state, out = float(time_s[-1]), np.zeros(2), np.zeros(time_s.size)
        begun = 0.0
        while begun < end_s:
            done = solve_ivp(
                rate,
                (begun, end_s),
                state,
                "DOP853",
                rtol=1e-9,
                atol=1e-12,
                events=turned,
                dense_output=True,
            )
            inside = (time_s >= begun) & (time_s <= done.t[-1])
            if inside.any():
                out[inside] = done.sol(time_s[inside])[0]
            begun, state = float(done.t[-1]), np.array([done.y[0, -1], 0.0])
            push = free(begun, state)
            assert abs(push) > self.friction_n or begun >= end_s, "the body sticks"
            sign = math.copysign(1.0, push)
        return out


def driven(
    made: Made, runs: Sequence[tuple[float, float]], seed: int, known: Mapping[str, float]
) -> PendulumProblem:
    """Return the problem of runs of (Hz, N) against a linear body."""
    noise, time_s = np.random.default_rng(seed), np.arange(0.0, TO_S + 3.0, 1.0 / RATE_HZ)
    kept = (time_s >= FROM_S) & (time_s < TO_S)
    stamps = time_s[kept]
    trials = []
    for frequency_hz, force_n in runs:
        true_s = (stamps - made.delay_s) / (1.0 + made.clock)
        moved = made.gain * made.motion(frequency_hz, force_n, np.append(0.0, true_s))[1:]
        pushed = force_n * np.cos(2.0 * math.pi * frequency_hz * stamps)
        pushed += noise.normal(0.0, NOISE_N, stamps.size)
        moved += noise.normal(0.0, NOISE_M, stamps.size)
        force = KnownForce.of("force", stamps, pushed, 1.0 / frequency_hz)
        body = DrivenBody(
            50.0, 20.0, STIFFNESS, Resistance(viscous=DAMPING), HEAVE, force.harmonics
        )
        sensor = Sensor(Channel("heave", "m"), ((HEAVE.displacement, 1.0),))
        bench = PendulumBench(body, Release((HEAVE,), (0.0,)), (sensor,), (Digitiser(),))
        found = force.response(stamps, moved)
        trials.append(
            DrivenTrial(
                f"{frequency_hz:g} Hz, {force_n:g} N",
                bench,
                "heave",
                force.windows,
                found,
                scatter(found),
                samples=round(RATE_HZ / frequency_hz),
                grows_rad_s=force.grows_rad_s,
            )
        )
    tolerances = tuple(tolerance(name, size) for name, size in known.items())
    return PendulumProblem(
        tuple(trials), tolerances, kinds=tuple(one for one in KINDS if one != "mean")
    )
