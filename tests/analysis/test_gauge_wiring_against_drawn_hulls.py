"""Gauges that are turned or exchanged are named for any hull: motions and loads written by hand.

Loads are those of a rigid body and its water about the midpoint, in velocities of the model and not
of its struts: mass, centre of gravity, added masses, damping with and without lift, restoring.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gauge_wiring import Wiring, likely_wiring
from analysis.run_harmonics import RunHarmonics
from hardware.description.body import Body
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint

GAUGES = ("force_aft", "force_fore")
WIRINGS = [
    Wiring(turned, exchanged)
    for turned in ((), ("force_aft",), ("force_fore",), GAUGES)
    for exchanged in (False, True)
]
FREQUENCIES_HZ = (0.25, 0.4)


@dataclass(frozen=True)
class Hull:
    """What resists, about the midpoint: force and moment by velocity and turning."""

    half_m: float
    body: Body
    added: np.ndarray
    damping: np.ndarray
    restoring: np.ndarray

    def run(
        self, frequency_hz: float, phase_rad: float, speed_m_s: float, gauges: np.ndarray
    ) -> RunHarmonics:
        """Return what gauges connected in some way read of a run."""
        told = SetPoint(frequency_hz, 0.05, phase_rad, speed_m_s)
        aft, fore = told.eccentricity_m * np.array([1.0, np.exp(1j * phase_rad)])
        across, heading = 0.5 * (aft + fore), 0.5 * (fore - aft) / self.half_m
        rate = 2j * math.pi * frequency_hz
        drifting, turning = rate * across - speed_m_s * heading, rate * heading
        body, motion = self.body, np.array([drifting, turning])
        turned = body.mass_kg * (rate * drifting + speed_m_s * turning)
        own = np.array(
            [
                turned + body.mass_kg * body.cg_x_m * rate * turning,
                body.inertia_kg_m2 * rate * turning + body.cg_x_m * turned,
            ]
        )
        water = (rate * self.added + self.damping) @ motion
        force, moment = own + water + self.restoring @ np.array([across, heading])
        read = gauges @ np.array([force - moment / self.half_m, force + moment / self.half_m]) / 2.0
        first = {"displacement_aft": aft, "displacement_fore": fore}
        first |= dict(zip(GAUGES, read, strict=True))
        return RunHarmonics(f"{frequency_hz:g}", told, frequency_hz, first)


def definite(sizes: tuple[float, float], shared: float) -> np.ndarray:
    """Return a symmetric matrix of these diagonals, its off-diagonal within what keeps it so."""
    off = 0.9 * shared * math.sqrt(sizes[0] * sizes[1])
    return np.array([[sizes[0], off], [off, sizes[1]]])


@st.composite
def hulls(draw: st.DrawFn) -> Hull:
    half_m, mass_kg = draw(st.floats(0.2, 1.0)), draw(st.floats(5.0, 200.0))
    cg_x_m = half_m * draw(st.floats(-0.2, 0.2))
    gyration = half_m * draw(st.floats(0.5, 2.0))
    body = Body(mass_kg, mass_kg * (gyration**2 + cg_x_m**2), cg_x_m)
    shares = [draw(st.floats(-0.5, 0.5)) for _ in range(4)]
    by_mass = [draw(st.floats(0.1, 2.5)) for _ in range(6)]
    units = (mass_kg, mass_kg * gyration**2)
    added, damping, restoring = (
        definite((a * units[0], b * units[1]), share)
        for a, b, share in zip(by_mass[::2], by_mass[1::2], shares[:3], strict=True)
    )
    lift = shares[3] * math.sqrt(damping[0, 0] * damping[1, 1])
    return Hull(half_m, body, added, damping + np.array([[0, lift], [-lift, 0]]), 5.0 * restoring)


def without_restoring(hull: Hull) -> Hull:
    return replace(hull, restoring=np.zeros((2, 2)))


def runs(
    hull: Hull,
    wiring: Wiring,
    speed_m_s: float,
    phases: tuple[str, ...],
    frequencies_hz: tuple[float, ...] = FREQUENCIES_HZ,
) -> list[RunHarmonics]:
    gauges = np.linalg.inv(wiring.matrix)
    return [
        hull.run(frequency_hz, phase_rad, speed_m_s, gauges)
        for frequency_hz in frequencies_hz
        for name in phases
        for phase_rad in [
            0.0
            if name == "across"
            else 2.0 * math.atan2(2.0 * math.pi * frequency_hz * hull.half_m, speed_m_s)
        ]
    ]


@pytest.mark.parametrize("wiring", WIRINGS)
@pytest.mark.parametrize("known", [True, False])
@given(hull=hulls(), speed_m_s=st.floats(0.0, 2.0))
def test_what_is_wrong_is_named_in_the_horizontal_plane(
    hull: Hull, speed_m_s: float, wiring: Wiring, known: bool
) -> None:
    made = runs(without_restoring(hull), wiring, speed_m_s, ("across", "turning"))
    body = hull.body if known else None
    assert likely_wiring(made, body, hull.half_m, Plane.HORIZONTAL) == wiring


@pytest.mark.parametrize("wiring", WIRINGS)
@given(hull=hulls(), speed_m_s=st.floats(0.0, 2.0))
def test_what_is_wrong_is_named_where_restoring_acts(
    hull: Hull, speed_m_s: float, wiring: Wiring
) -> None:
    made = runs(hull, wiring, speed_m_s, ("across", "turning"))
    assert likely_wiring(made, hull.body, hull.half_m, Plane.VERTICAL) == wiring


@pytest.mark.parametrize("wiring", WIRINGS)
@given(hull=hulls())
def test_runs_of_one_frequency_tell_it_by_their_damping(hull: Hull, wiring: Wiring) -> None:
    """Inertia and restoring are one there, and which is larger is not known."""
    even = replace(hull, damping=0.5 * (hull.damping + hull.damping.T))
    made = runs(even, wiring, 0.0, ("across", "turning"), FREQUENCIES_HZ[:1])
    assert likely_wiring(made, hull.body, hull.half_m, Plane.VERTICAL) == wiring


@given(hull=hulls(), speed_m_s=st.floats(0.0, 2.0))
def test_nothing_is_said_of_right_gauges_at_one_frequency(hull: Hull, speed_m_s: float) -> None:
    made = runs(hull, Wiring(), speed_m_s, ("across", "turning"), FREQUENCIES_HZ[:1])
    assert likely_wiring(made, hull.body, hull.half_m, Plane.VERTICAL) == Wiring()


@given(hull=hulls(), speed_m_s=st.floats(0.0, 2.0), only=st.sampled_from(["across", "turning"]))
def test_nothing_is_said_of_right_gauges_by_motions_of_one_kind(
    hull: Hull, speed_m_s: float, only: str
) -> None:
    made = runs(without_restoring(hull), Wiring(), speed_m_s, (only,))
    assert likely_wiring(made, hull.body, hull.half_m, Plane.HORIZONTAL) == Wiring()
    made = runs(hull, Wiring(), speed_m_s, (only,))
    assert likely_wiring(made, hull.body, hull.half_m, Plane.VERTICAL) == Wiring()


@given(hull=hulls())
def test_both_turned_are_seen_by_motions_across_alone(hull: Hull) -> None:
    """One motion tells that a sign is wrong, and not for sure which."""
    made = runs(without_restoring(hull), Wiring(GAUGES), 0.0, ("across",))
    assert likely_wiring(made, hull.body, hull.half_m, Plane.HORIZONTAL).turned


def test_forces_that_are_nothing_say_nothing() -> None:
    hull = Hull(0.5, Body(50.0, 10.0), *(np.zeros((2, 2)) for _ in range(3)))
    made = [hull.run(0.4, phase_rad, 0.0, np.zeros((2, 2))) for phase_rad in (0.0, math.pi)]
    assert likely_wiring(made, hull.body, 0.5, Plane.HORIZONTAL) == Wiring()
