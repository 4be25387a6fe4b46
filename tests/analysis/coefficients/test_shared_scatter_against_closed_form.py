"""What several runs share, a zero run or a dry run, does not average out between them."""

import math

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import Request, campaign_coefficients
from analysis.coefficients.campaign_budget import budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.corrections import zero_reading
from analysis.coefficients.dry_run import without_dry
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.strut_cycle import measured_cycle, static_cycle
from analysis.readers.dataset import from_dataset
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from analysis.uncertainty.values import UncertainValues
from hardware.description.channels import FORCE_AFT, FORCE_FORE
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import Medium, SetPoint
from sim.rig import vertical_rig
from sim.run import simulate
from tests.analysis.coefficients.single_row import single_row

ANGLES_DEG = (-8.0, -4.0, 0.0, 4.0, 8.0)
CHANNELS = ("displacement_aft", "displacement_fore", "force_aft", "force_fore")
SPEED_M_S = 1.2


def at_rest(name: str, mean_n: tuple[float, float], noise_n: float) -> Phasors:
    """Ten blocks of both gauges, independent of each other."""
    generator = np.random.default_rng(len(name))
    samples = np.array(mean_n)[:, None] + noise_n * generator.standard_normal((2, 1000))
    return zero_reading(Recording(name, (FORCE_AFT, FORCE_FORE), samples, 100.0))


def drift_runs(zero: Phasors) -> list[BodyCycle]:
    """Five drift angles, nearly without noise, that one noisy zero run is taken off."""
    runs = []
    for k, angle in enumerate(np.radians(ANGLES_DEG)):
        force = 120.0 * SPEED_M_S * math.sin(angle)
        reading = at_rest(f"drift {k}", (force / 2.0, force / 2.0), 1e-6)
        point = SetPoint(0.0, 0.0, 0.0, SPEED_M_S, drift_rad=float(angle))
        struts = static_cycle(f"drift {k}", reading, HORIZONTAL_1963, point)
        runs.append(struts.without_zero(zero).model().without())
    return runs


@pytest.fixture(scope="module")
def drift() -> tuple[CampaignCoefficients, Phasors]:
    zero = at_rest("common", (0.0, 0.0), 0.5)
    return campaign_coefficients(drift_runs(zero), Request(trials=4000, seed=3)), zero


def test_a_zero_run_of_all_moves_the_constant_by_all_of_its_scatter(
    drift: tuple[CampaignCoefficients, Phasors],
) -> None:
    """Every force is off by the same ``e``: so is Y_0, and Y_v not at all."""
    found, zero = drift
    own = zero.real.covariance()[::2, ::2]
    half = HORIZONTAL_1963.half_spacing_m
    force, moment = (np.array(lever) @ own @ lever for lever in ((1.0, 1.0), (-half, half)))
    spread = dict(
        zip((e.name for e in found.entries), found.uncertain.standard_uncertainty, strict=True)
    )
    assert spread["Y_0"] == pytest.approx(math.sqrt(force), rel=1e-4)
    assert spread["N_0"] == pytest.approx(math.sqrt(moment), rel=1e-4)
    assert spread["Y_v"] < 1e-3 * spread["Y_0"]


def test_the_budget_and_the_trials_know_it_too(
    drift: tuple[CampaignCoefficients, Phasors],
) -> None:
    found, _ = drift
    for name in ("Y_0", "N_0"):
        row = single_row(found, name)
        one = budget(found, row)
        assert one.standard_uncertainty == pytest.approx(
            found.uncertain.standard_uncertainty[row], rel=1e-9
        )
        assert sum(line.share for line in one.lines) == pytest.approx(1.0, rel=1e-9)
        width = (found.trials.high[row] - found.trials.low[row]) / 2.0
        assert width == pytest.approx(found.half_widths[row], rel=0.06)


def measured(name: str, medium: Medium, seed: int) -> BodyCycle:
    rig, speed = vertical_rig(), 0.0 if medium is Medium.AIR else SPEED_M_S
    point = SetPoint(0.8, 0.02, 0.0, speed, medium)
    record = simulate(rig, point, periods=8, sample_rate_hz=100.0, seed=seed, name=name)
    analysis = analyse(from_dataset(record), settings=ResolverSettings(channels=CHANNELS))
    return measured_cycle(analysis, rig.oscillator, set_point=point).model()


def test_a_dry_run_of_two_repeats_does_not_average_out() -> None:
    rig, dry = vertical_rig(), measured("dry", Medium.AIR, 9)
    wet = [measured(f"wet {k}", Medium.WATER, k) for k in (1, 2)]
    restoring = np.array(rig.water.restoring)
    cycles = [without_dry(one, dry).without(restoring=restoring) for one in wet]
    both = [
        linear_fit(some, Form.SEAKEEPING, StatedUncertainties()).fit
        for some in (cycles[:1], cycles)
    ]
    of_dry = [of_source(fit.uncertain, "scatter of dry") for fit in both]
    np.testing.assert_allclose(of_dry[1], of_dry[0], rtol=0.01)
    table = campaign_coefficients(cycles, Request(Form.SEAKEEPING, nonlinear=False))
    row = single_row(table, "a33", method="linear")
    spread = of_source(table.uncertain, "scatter of dry")[row]
    assert spread == pytest.approx(of_dry[0][0], rel=0.01)


def of_source(found: UncertainValues, label: str) -> np.ndarray:
    """What one source adds, as standard uncertainties."""
    (part,) = (one for one in found.contributions if one.label == label)
    return np.asarray(np.linalg.norm(part.dense(len(found.values)), axis=1))
