"""Settings told by commands against sines whose gain, lag and frequency are known."""

import math
from collections.abc import Iterator

import numpy as np
import pytest

from analysis.gap.forward.commanded import Commanded, commanded
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import GapRun, Observation
from analysis.gap.observe.following import following
from analysis.recording import Recording
from hardware.description.channels import COMMANDS, DISPLACEMENTS, Channel
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.k3_eccentricity_error import EccentricityError
from sim.rig import SimulatedRig, vertical_rig

RATE_HZ = 100.0
POINTS = (SetPoint(0.5, 0.02), SetPoint(0.8, 0.02), SetPoint(0.8, 0.01), SetPoint(1.1, 0.02, 0.4))
GAINS, ADDED_M = (0.985, 1.004), (1e-4, -5e-5)
BEHIND_RAD = (0.12, 0.09)  # each strut, whatever the frequency
FASTER = -3e-4  # the real over the commanded frequency, less 1
NOISE_M = 5e-6
USUAL = Tolerances()


def recorded(point: SetPoint, seed: int = 0) -> Recording:
    """Return commands that are exact, and struts that follow them in closed form."""
    time_s, rng = np.arange(0.0, 20.0, 1.0 / RATE_HZ), np.random.default_rng(seed)
    omega, rows = 2.0 * math.pi * point.frequency_hz, []
    for strut in range(2):
        ahead = point.strut_phase_rad * strut
        rows.append(point.eccentricity_m * np.sin(omega * time_s + ahead))
        real_m = GAINS[strut] * point.eccentricity_m + ADDED_M[strut]
        # The shaft loses what it is slower by; in the middle of the record it is behind as stated.
        late_s = -FASTER * (time_s - 10.0)
        wave = np.sin(omega * (time_s - late_s) + ahead - BEHIND_RAD[strut])
        rows.append(real_m * wave + rng.normal(0.0, NOISE_M, len(time_s)))
    names = (COMMANDS[0], DISPLACEMENTS[0], COMMANDS[1], DISPLACEMENTS[1])
    channels = tuple(Channel(name, "m") for name in names)
    return Recording("made", channels, np.array(rows), RATE_HZ, set_point=point)


def runs(points: tuple[SetPoint, ...] = POINTS) -> Iterator[GapRun]:
    nothing = Observation((), np.zeros(0), np.zeros(0))
    for number, point in enumerate(points):
        found, said = following(recorded(point, number))
        assert said == ""
        place = CampaignRun(number, 400.0 * number, 0.0, None)
        yield GapRun(f"{number}", point, place, nothing, 8, RATE_HZ, following=found)


@pytest.fixture(scope="module")
def seen() -> tuple[GapRun, ...]:
    return tuple(runs())


@pytest.fixture(scope="module")
def rig() -> SimulatedRig:
    return vertical_rig()


@pytest.fixture(scope="module")
def told(rig: SimulatedRig, seen: tuple[GapRun, ...]) -> Commanded:
    return commanded(rig, seen, USUAL, reference=COMMANDS[0])


def test_the_simulated_rig_gets_the_settings_that_were_made(told: Commanded) -> None:
    links = (told.rig.linkage_aft, told.rig.linkage_fore)
    for link, gain, added_m in zip(links, GAINS, ADDED_M, strict=True):
        for set_m in (0.01, 0.02):
            assert link.eccentricity_m(set_m) == pytest.approx(gain * set_m + added_m, abs=2e-6)
    ahead_rad = BEHIND_RAD[0] - BEHIND_RAD[1]
    assert told.rig.linkage_fore.phase_error_rad == pytest.approx(ahead_rad, abs=1e-4)
    assert told.rig.drive.speed_error == pytest.approx(FASTER, abs=1e-5)
    assert told.rig.photocell is not None
    assert told.rig.photocell.mark_angle_rad == pytest.approx(-BEHIND_RAD[0], abs=1e-4)


def test_each_is_within_its_uncertainty(told: Commanded) -> None:
    made = {
        "eccentricity aft": GAINS[0] - 1.0,
        "eccentricity fore": GAINS[1] - 1.0,
        "frequency": FASTER,
        "strut phase": BEHIND_RAD[0] - BEHIND_RAD[1],
        "phase reference": -BEHIND_RAD[0],
    }
    assert {one.name for one in told.known_settings} == {*made}
    for one in told.known_settings:
        assert abs(one.deviation.value - made[one.name]) < 4.0 * one.deviation.uncertainty + 1e-7
        assert one.runs == len(POINTS)


def test_a_tolerance_knows_of_what_no_comparison_sees(told: Commanded) -> None:
    """A displacement sensor's gain, 5e-4 of 20 mm, and the clock; angles have neither."""
    sensor_m = USUAL.displacement_gain_relative * 0.02
    assert sensor_m < told.tolerances.eccentricity_m < 1.3 * sensor_m
    assert told.tolerances.frequency_relative == pytest.approx(USUAL.frequency_relative, rel=0.01)
    assert 0.0 < told.tolerances.strut_phase_rad < 0.2 * USUAL.strut_phase_rad
    assert told.tolerances.gain_relative == USUAL.gain_relative


def test_one_eccentricity_tells_a_factor_alone(rig: SimulatedRig) -> None:
    found = commanded(rig, tuple(runs(POINTS[:2])), USUAL)
    own = found.rig.linkage_aft
    assert own.gain == pytest.approx(GAINS[0] + ADDED_M[0] / 0.02, abs=1e-4)
    assert own.eccentricity_error_m == 0.0


def test_lags_of_another_angle_at_each_frequency_widen_the_tolerance(rig: SimulatedRig) -> None:
    """A fore strut 3 ms behind in each run: 9 to 21 mrad, no one angle."""
    found = list(runs(POINTS[:3]))
    for run in found:
        lag = run.following[DISPLACEMENTS[1]].lag_s
        extra_s = 0.003 - lag.value + run.following[DISPLACEMENTS[0]].lag_s.value
        object.__setattr__(
            run.following[DISPLACEMENTS[1]], "lag_s", lag.following(lag.value + extra_s, 1.0)
        )
    told = commanded(rig, found, USUAL)
    middle_rad = -0.003 * 2.0 * math.pi * 0.7
    assert told.rig.linkage_fore.phase_error_rad == pytest.approx(middle_rad, abs=2e-3)
    assert told.tolerances.strut_phase_rad > 1e-3


def test_what_is_stated_or_known_stays(rig: SimulatedRig, seen: tuple[GapRun, ...]) -> None:
    held = commanded(rig, seen, USUAL, stated={"eccentricity_m", "strut_phase_rad"})
    assert held.rig.linkage_aft == rig.linkage_aft
    assert held.tolerances.eccentricity_m == USUAL.eccentricity_m
    assert [one.name for one in held.known_settings] == ["frequency"]
    on = commanded(rig, seen, USUAL, [EccentricityError(*ADDED_M)])
    for link in (on.rig.linkage_aft, on.rig.linkage_fore):
        assert link.eccentricity_error_m == pytest.approx(0.0, abs=2e-6)


def test_without_commands_all_stays(rig: SimulatedRig, seen: tuple[GapRun, ...]) -> None:
    bare = recorded(POINTS[0]).select(DISPLACEMENTS)
    assert following(bare) == ({}, "")
    found = commanded(rig, (), USUAL)
    assert (found.rig, found.tolerances, found.known_settings) == (rig, USUAL, ())


@pytest.mark.parametrize(
    ("factor", "said"),
    [(1000.0, "are units and sign"), (-1.0, "are units and sign"), (0.0, "does not move")],
)
def test_a_command_in_other_units_is_said_and_not_used(factor: float, said: str) -> None:
    record = recorded(POINTS[1])
    rows = np.array([record.values(name) for name in record.channel_names])
    rows[0] *= factor
    wrong = Recording("made", record.channels, rows, RATE_HZ, set_point=POINTS[1])
    found, why = following(wrong)
    assert [*found] == [DISPLACEMENTS[1]]
    assert said in why
    assert "displacement_aft" in why
