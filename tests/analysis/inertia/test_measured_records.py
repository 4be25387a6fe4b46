"""Records that nobody of this project made: rods on lines, a bicycle's parts, a rolling tanker."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import chi2

from analysis.inertia.amplitude import fit_power_decay, zero_amplitude_period
from analysis.inertia.bifilar import yaw_from_period
from analysis.inertia.compound_pendulum import (
    pendulum_gyradius,
    torsional_inertia,
    torsional_stiffness,
)
from analysis.inertia.damped_fit import fit_damped
from analysis.inertia.gates import passages, read_gate_events
from analysis.inertia.local_periods import local_periods
from analysis.inertia.passage_fit import fit_passages
from analysis.inertia.plane_inertia import plane_inertia
from analysis.inertia.repeats import single_run
from analysis.inertia.series import Series, UsablePart, usable_part
from analysis.inertia.spread import Spread, SuspensionGyradius, compare_geometries
from analysis.uncertainty.budget import linear_budget
from analysis.uncertainty.estimate import Estimate, within

SHARED = Path(__file__).parents[3].parent / "shared" / "data"
pytestmark = pytest.mark.skipif(not SHARED.exists(), reason="no shared measured data")


def rods() -> Spread:
    geometries = []
    for path in sorted((SHARED / "bifilar").glob("*.csv")):
        found = re.fullmatch(r"s([\d.]+)_l([\d.]+)\.csv", path.name)
        assert found is not None
        spacing, line = float(found[1]), float(found[2])
        fit = fit_passages(passages(read_gate_events(path)))
        assert fit.period.relative < 1e-3
        k = yaw_from_period(
            fit.period,
            within(spacing / 2.0, 5e-4, "m"),
            within(line, 5e-4, "m"),
            Estimate.of(9.81, 0.003, "m/s2"),
        )
        geometries.append(SuspensionGyradius(path.name, k.result, spacing / 2.0, line))
    return compare_geometries(geometries)


def test_four_geometries_of_one_rod() -> None:
    spread = rods()
    assert 0.338 < spread.gyradius.value < 0.348
    # the geometries disagree, and that is said, with the likeliest cause, which is not proven
    assert not spread.redundancy.agree
    assert spread.flags[0].code == "unexplained_spread"
    cause = spread.causes[0]
    assert chi2.sf(cause.chi_squared, cause.degrees_of_freedom) > 0.01
    assert 0.5 < cause.predicts < 0.8
    assert "the cause cannot be told; likeliest cause: the lines are longer than measured" in (
        spread.flags[0].message
    )
    low, high = spread.gyradius.interval()
    assert low < 0.339
    assert high > 0.346


def test_gates_repair_what_the_timer_lost() -> None:
    found = passages(read_gate_events(SHARED / "bifilar" / "s1.092_l1.26893.csv"))
    assert {flag.code for flag in found.flags} >= {"gate_repaired"}
    assert found.time_s.size > 490
    assert np.diff(found.number).min() >= 1


def table(name: str) -> dict[str, Estimate]:
    rows = {}
    for line in (SHARED / "compound_pendulum" / name).read_text().splitlines():
        key, _, text = line.partition("=")
        numbers = [float(part) for part in text.split("+/-")]
        rows[key.strip()] = Estimate.of(numbers[0], numbers[1] if len(numbers) > 1 else 0.0)
    return rows


def torsion(rows: dict[str, Estimate], period: str) -> Estimate:
    """Inertia from the torsion rod's, calibrated with a bar of known mass and size."""

    def inertia(m: float, length: float, d: float, tp: float, t: float) -> float:
        bar = m / 12.0 * (3.0 * (d / 2.0) ** 2 + length**2)
        return torsional_inertia(torsional_stiffness(bar, tp), t)

    inputs = {
        "m": rows["mP"],
        "length": rows["lP"],
        "d": rows["dP"],
        "tp": rows["TtP1"],
        "t": rows[period],
    }
    return linear_budget(period, inertia, inputs, unit="kg m2").result


def hanging(rows: dict[str, Estimate], period: str, mass: str, depth: Estimate) -> Estimate:
    def inertia(t: float, m: float, a: float, g: float) -> float:
        return m * pendulum_gyradius(t, a, g) ** 2

    inputs = {"t": rows[period], "m": rows[mass], "a": depth, "g": rows["g"]}
    return linear_budget(period, inertia, inputs, unit="kg m2").result


def close(found: Estimate, published: Estimate) -> None:
    """Within the published uncertainty, and of like uncertainty."""
    assert abs(found.value - published.value) <= published.uncertainty
    assert found.uncertainty == pytest.approx(published.uncertainty, rel=0.35)


def test_published_wheels() -> None:
    rows, published = table("BrowserMeasured.txt"), table("BrowserBenchmark.txt")
    close(hanging(rows, "TcF1", "mF", rows["lF"]), published["IFyy"])
    close(hanging(rows, "TcR1", "mR", rows["lR"]), published["IRyy"])
    close(torsion(rows, "TtF1"), published["IFxx"])
    close(torsion(rows, "TtR1"), published["IRxx"])


def test_published_frame_and_fork() -> None:
    rows, published = table("BrowserMeasured.txt"), table("BrowserBenchmark.txt")

    def depth(x: Estimate, z: Estimate, foot: Estimate, radius: Estimate) -> Estimate:
        inputs = {"x": x, "z": z, "foot": foot, "r": radius}
        return linear_budget(
            "depth", lambda x, z, foot, r: math.hypot(x - foot, z + r), inputs, unit="m"
        ).result

    frame = depth(published["xB"], published["zB"], Estimate.of(0.0, 0.0), published["rR"])
    fork = depth(published["xH"], published["zH"], published["w"], published["rF"])
    for found, key in (
        (hanging(rows, "TcB1", "mB", frame), "IByy"),
        (hanging(rows, "TcH1", "mH", fork), "IHyy"),
    ):
        assert abs(found.value - published[key].value) <= published[key].uncertainty


@pytest.mark.parametrize(("part", "letter"), [("B", "B"), ("H", "H")])
def test_published_plane_inertias(part: str, letter: str) -> None:
    """Three torsion axes in the plane; the published product is the tensor's: minus the sum."""
    rows, published = table("BrowserMeasured.txt"), table("BrowserBenchmark.txt")
    lean = published["lam"].value
    about = [torsion(rows, f"Tt{part}{k}") for k in (1, 2, 3)]
    angles = [lean - math.radians(rows[f"alpha{part}{k}"].value) + 0.5 * math.pi for k in (1, 2, 3)]
    found = plane_inertia(about, [Estimate.of(one, math.radians(0.2)) for one in angles])
    xx, zz, xz = found.uncertain.values
    names = (f"I{letter}xx", f"I{letter}zz", f"I{letter}xz")
    for value, name in zip((xx, zz, -xz), names, strict=True):
        assert abs(value - published[name].value) <= published[name].uncertainty, name


def test_raw_trace() -> None:
    from scipy.io import loadmat

    path = SHARED / "compound_pendulum" / "BrowserForkCompoundFirst1.mat"
    record = loadmat(path, squeeze_me=True)
    rate = float(record["ActualRate"])
    series = Series("fork", "rate", "V", rate, 0.0, np.asarray(record["data"], dtype=np.float64))
    fit = fit_damped(series.time_s, series.values)
    assert fit.converged
    assert fit.modes[0].period_s == pytest.approx(1.59020, abs=fit.period_uncertainty_s())
    assert fit.modes[0].period_s == pytest.approx(1.59020, abs=1e-4)
    assert fit.modes[0].damping_ratio == pytest.approx(0.0090, abs=2e-4)


def roll(name: str, time: str) -> UsablePart:
    import pandas as pd

    frame = pd.read_csv(SHARED / "roll_decay" / name)
    t = frame[time].to_numpy()
    rate = (t.size - 1) / (t[-1] - t[0])
    values = frame["phi"].to_numpy(dtype=np.float64)
    return usable_part(Series(name, "phi", "rad", float(rate), float(t[0]), values))


def test_roll_decay_of_test_and_simulation() -> None:
    periods, betas, taus = [], [], []
    for name, time in (
        ("model_test_21337.csv.gz", "time"),
        ("fnpf_kvlcc2_rolldecay_0kn.csv.gz", "Time"),
    ):
        part = roll(name, time).series
        fit = fit_damped(part.time_s, part.values)
        local = local_periods(part.time_s, part.values, fit)
        decay = fit_power_decay(local.time_s, local.amplitude)
        periods.append(
            (float(local.period_s[0]), single_run(local, zero_amplitude_period(local).period))
        )
        betas.append(decay.beta)
        taus.append(decay.time_constant_s)
    assert [first for first, _ in periods] == pytest.approx([2.540, 2.540], abs=0.006)
    tested, simulated = (one.estimate for _, one in periods)
    assert abs(tested.value - simulated.value) < 2.0 * math.hypot(
        tested.uncertainty, simulated.uncertainty
    )
    # the periods agree, the decay does not
    assert taus[1] > 3.0 * taus[0]
    assert all(0.4 < beta < 1.0 for beta in betas)


@pytest.mark.parametrize(
    ("name", "time", "peaks_deg", "within_deg"),
    [
        ("model_test_21337.csv.gz", "time", (10.04, 9.47, 8.98), 0.13),
        ("fnpf_kvlcc2_rolldecay_0kn.csv.gz", "Time", (9.90, 9.79, 9.68), 0.02),
    ],
)
def test_the_decay_law_steps_from_peak_to_peak(
    name: str, time: str, peaks_deg: tuple[float, ...], within_deg: float
) -> None:
    """The first peaks as read off the records; the law's first amplitude lies below the test's."""
    part = roll(name, time).series
    local = local_periods(part.time_s, part.values, fit_damped(part.time_s, part.values))
    law = fit_power_decay(local.time_s, local.amplitude)
    amplitude, period = math.radians(peaks_deg[0]), float(local.period_s[0])
    for peak in peaks_deg[1:]:
        rate = (amplitude / law.amplitude) ** law.beta / law.time_constant_s
        amplitude *= (1.0 + law.beta * rate * period) ** (-1.0 / law.beta)
        assert math.degrees(amplitude) == pytest.approx(peak, abs=within_deg)


def test_release_of_the_roll_test_is_found() -> None:
    part = roll("model_test_21337.csv.gz", "time")
    assert 23.0 < part.series.start_s < 28.0
    assert part.series.time_s[-1] > 90.0
