"""Units and signs planted wrong in rigid bodies that oscillate are named; sound ones are not."""

import cmath
import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.plausibility import plausibility_flags
from analysis.run_harmonics import RunHarmonics
from hardware.description.body import Body
from hardware.description.setpoint import SetPoint

BODY = Body(70.0, 27.5)
SPACING_M = 0.5
FREQUENCIES_HZ = (0.6, 0.9, 1.2)
FACTORS = {"displacement_aft": 1.0, "displacement_fore": 1.0, "force_aft": 1.0, "force_fore": 1.0}


def run(
    frequency_hz: float, phase_rad: float, factors: dict[str, float], added: float, damping: float
) -> RunHarmonics:
    """One rigid body, added mass and damping as wholes of its own mass, symmetric fore and aft."""
    told = SetPoint(frequency_hz, 0.02, phase_rad)
    omega = 2.0 * math.pi * frequency_hz
    aft, fore = told.eccentricity_m, told.eccentricity_m * cmath.exp(1j * phase_rad)
    mass = 0.5 * BODY.mass_kg * (1.0 + added)
    turning = 0.5 * BODY.inertia_kg_m2 * (1.0 + added) / SPACING_M**2
    heave, pitch = 0.5 * (aft + fore), 0.5 * (aft - fore)
    law = -(omega**2) * complex(1.0, -damping)
    force = {
        "displacement_aft": complex(aft),
        "displacement_fore": fore,
        "force_aft": law * (mass * heave + turning * pitch),
        "force_fore": law * (mass * heave - turning * pitch),
    }
    first = {name: factors.get(name, 1.0) * value for name, value in force.items()}
    return RunHarmonics(f"{frequency_hz:g}", told, frequency_hz, first)


def flags(
    added: float = 1.0, damping: float = 0.3, **factors: float
) -> list[tuple[str, str | None]]:
    runs = [
        run(frequency_hz, phase_rad, factors, added, damping)
        for frequency_hz in FREQUENCIES_HZ
        for phase_rad in (0.0, math.pi)
    ]
    return [(one.code, one.channel) for one in plausibility_flags(runs, BODY, SPACING_M)]


@given(added=st.floats(0.0, 8.0), damping=st.floats(0.01, 2.0))
def test_nothing_is_said_of_a_sound_rig(added: float, damping: float) -> None:
    assert flags(added, damping) == []


@pytest.mark.parametrize("channel", ["force_aft", "force_fore"])
@given(added=st.floats(0.0, 8.0), damping=st.floats(0.01, 2.0))
def test_one_gauge_turned_round_is_named(channel: str, added: float, damping: float) -> None:
    assert flags(added, damping, **{channel: -1.0}) == [("sign_opposite", channel)]


def test_both_gauges_turned_round_are_named() -> None:
    turned = flags(force_aft=-1.0, force_fore=-1.0)
    assert turned == [("sign_opposite", "force_aft"), ("sign_opposite", "force_fore")]


@pytest.mark.parametrize("channel", ["force_aft", "force_fore"])
@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_a_force_in_another_unit_is_named(channel: str, factor: float) -> None:
    assert flags(**{channel: factor}) == [("units_implausible", channel)]


@pytest.mark.parametrize("factor", [1e3, 100.0, 1e-3])
def test_a_displacement_in_another_unit_is_named(factor: float) -> None:
    assert flags(displacement_fore=factor) == [("units_implausible", "displacement_fore")]


def test_a_strut_that_moves_the_other_way_is_named() -> None:
    assert flags(displacement_fore=-1.0) == [("sign_opposite", "displacement_fore")]


def test_kilogram_force_on_one_gauge_is_seen_without_a_model() -> None:
    runs = [run(f, 0.0, {"force_aft": 1 / 9.80665}, 1.0, 0.3) for f in FREQUENCIES_HZ]
    (flag,) = plausibility_flags(runs)
    assert (flag.code, flag.channel) == ("units_implausible", "force_aft")
    assert "kgf" in flag.message


def test_a_strut_phase_of_many_turns_is_taken_for_degrees() -> None:
    runs = [run(f, 180.0, {}, 1.0, 0.3) for f in FREQUENCIES_HZ]
    (flag,) = plausibility_flags(runs, BODY, SPACING_M)
    assert "strut_phase_deg" in flag.message


def test_a_single_run_says_nothing() -> None:
    assert plausibility_flags([run(0.9, 0.0, {"force_aft": -1e3}, 1.0, 0.3)], BODY) == ()


@pytest.mark.parametrize("channel", ["force_aft", "force_fore", "displacement_fore"])
def test_a_channel_that_is_nothing_throughout_breaks_nothing(channel: str) -> None:
    assert all(named == channel for _, named in flags(**{channel: 0.0}))


@pytest.mark.parametrize("eccentricity_m", [0.0, math.nan])
def test_a_set_point_that_moves_nothing_says_nothing(eccentricity_m: float) -> None:
    sound = [run(frequency_hz, 0.0, FACTORS, 1.0, 0.3) for frequency_hz in FREQUENCIES_HZ]
    still = replace(sound[0], set_point=replace(sound[0].set_point, eccentricity_m=eccentricity_m))
    assert plausibility_flags([*sound, still], BODY, SPACING_M) == ()
    assert plausibility_flags([still] * 3, BODY, SPACING_M) == ()
