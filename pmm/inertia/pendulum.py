"""``pmm inertia pendulum``: a body swinging about one axis or two, or on a torsion rod."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from analysis.inertia.compound_pendulum import compound_pendulum, lamboley
from analysis.inertia.damping import small_damping_of
from analysis.inertia.elementary_functions import Value, sqrt
from analysis.inertia.lengthening import Lengthening, pendulum_lengthening
from analysis.inertia.record import damping_of
from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.monte_carlo import Assessment, assess
from hardware.description.oscillator import Plane
from pmm.inertia.air import air_rules, period_without_air, without_air
from pmm.inertia.experiment import Experiment
from pmm.inertia.hanging import hanging_rules
from pmm.inertia.job_table import JobTable
from pmm.inertia.outcome import Finding, Outcome, PlaneAxes, assessed, without_repeats
from pmm.inertia.period_source import PeriodSource
from pmm.inertia.reading import one_of
from pmm.inertia.sketch import about_axis
from pmm.inertia.sources import PeriodRuns
from pmm.inertia.stated_values import given_or_none, gravity_of, stated_value
from pmm.inertia.torsion import TorsionTable, about_rod, in_plane, stiffness


@dataclass(frozen=True)
class SecondAxis:
    """The same body about an axis ``apart_m`` above the first (Lamboley)."""

    period: PeriodSource
    apart_m: float
    u_apart_m: float = 0.0


@dataclass(frozen=True, kw_only=True)
class PendulumJob(JobTable):
    """The file of ``pmm inertia pendulum``.

    Attributes
    ----------
    depth_m
        Of the centre of gravity below the axis.
    period
        Not where ``torsion`` has axes with periods of their own.
    """

    period: PeriodSource | None = None
    name: str = "pendulum"
    axis: Literal["roll", "pitch", "yaw"] = "pitch"
    depth_m: float | None = None
    u_depth_m: float = 0.0
    second: SecondAxis | None = None
    torsion: TorsionTable | None = None

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """The depth, a second axis that gives it, or a torsion rod; or the period alone."""
        yield from one_of(table, "depth_m", "second", "torsion", needed=False)
        yield from air_rules(table)
        yield from hanging_rules(table)
        rod = table.get("torsion")
        several = isinstance(rod, dict) and rod.get("axes")
        if several and "period" in table:
            yield "period", "and torsion.axes are both given; each axis has its own"
        elif not several and "period" not in table and (rod or "hanging" not in table):
            yield "period", "is missing"
        if rod is not None and "entrained_air" in table:
            yield "entrained_air", "is for swings; it is not taken off a torsion rod's inertia"


def run(path: str) -> Outcome:
    """Do what a pendulum's file says.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, or the data do not carry what is asked.
    """
    test = Experiment.of(path, PendulumJob)
    swung = _swing(test)
    test.plumb()
    test.flags += [flag for redundancy in test.redundancy for flag in redundancy.flags()]
    gyradii: dict[str, Estimate] = (
        {} if swung.gyradius is None else {test.table.axis: swung.gyradius.result}
    )
    budgets = [] if swung.gyradius is None else [swung.gyradius.budget]
    test.weigh(gyradii, budgets, without_repeats(test.flags))
    planes = {"pitch": Plane.VERTICAL, "yaw": Plane.HORIZONTAL}
    return test.outcome("pendulum", planes.get(test.table.axis), axes=swung.axes)


@dataclass(frozen=True)
class _Swung:
    """What a test gave: the gyradius about the file's axis, if it follows."""

    gyradius: Assessment | None = None
    axes: PlaneAxes | None = None


def _swing(test: Experiment[PendulumJob]) -> _Swung:
    """Do what the file has the geometry for."""
    table = test.table
    if table.torsion is not None:
        return _on_rod(test, table.torsion)
    if table.depth_m is not None or table.second is not None:
        return _on_axis(test)
    if table.period is not None:
        _period(test, None)
        test.findings += decay_findings(test.periods[0])
        test.notes.append(
            "no depth_m, second or torsion is given: period and decay are all that follows"
        )
    return _Swung()


def _on_axis(test: Experiment[PendulumJob]) -> _Swung:
    """About one axis at a known depth, or about two."""
    table = test.table
    gravity, seed = gravity_of(table), table.monte_carlo_seed
    first = _period(test)
    if table.second is None:
        depth = stated_value(table, "depth_m")
        in_air = compound_pendulum(first, depth, gravity, seed=seed)
        gyradius = without_air(table, in_air, depth=depth, seed=seed + 2)
    else:
        second = test.period(
            table.second.period, "second.period", lengthens=pendulum_lengthening
        ).period
        apart = stated_value(table.second, "apart_m")
        below, in_air = lamboley(first, second, apart, gravity, seed=seed)
        gyradius = in_air
        if table.entrained_air is not None:
            first, second = (period_without_air(table, period) for period in (first, second))
            below, gyradius = lamboley(first, second, apart, gravity, seed=seed)
            gyradius = without_air(table, gyradius, delayed="coefficient", seed=seed + 2)
        depth = below.budget.result
        test.findings.append(assessed("depth_m", "CG below the first axis", below))
    name, words = f"k_{table.axis}_m", f"{table.axis} gyradius"
    apart_m = None if table.second is None else table.second.apart_m
    test.sketches.append(about_axis(table.name, {"body": depth.value}, {}, apart_m))
    if table.entrained_air is not None:
        name_in_air = f"k_{table.axis}_in_air_m"
        test.findings.append(assessed(name_in_air, f"{words}, with its air", in_air))
    test.findings.append(assessed(name, words, gyradius))
    mass = given_or_none(table.model, "mass_kg", "model")
    if mass is not None:
        inputs = {"mass_kg": mass, "gyradius_m": gyradius.budget.result}
        about = assess("I", _inertia, inputs, unit="kg m2", seed=seed + 3)
        test.findings.append(_about(table, about))
    return _Swung(gyradius)


def _on_rod(test: Experiment[PendulumJob], torsion: TorsionTable) -> _Swung:
    """On a torsion rod: about the file's axis, or about several in the centre plane."""
    table, seed = test.table, test.table.monte_carlo_seed
    rod = stiffness(test, torsion, seed)
    mass = given_or_none(table.model, "mass_kg", "model")
    if torsion.axes:
        plane = in_plane(test, torsion, rod)
        return _Swung(axes=None if mass is None else plane.ellipse(mass))
    about = about_rod(rod, _period(test, None), seed + 1)
    test.findings.append(_about(table, about))
    if mass is None:
        return _Swung()
    inputs = {"inertia_kg_m2": about.budget.result, "mass_kg": mass}
    gyradius = assess("k", _gyradius, inputs, unit="m", seed=seed + 2)
    test.findings.append(assessed(f"k_{table.axis}_m", f"{table.axis} gyradius", gyradius))
    return _Swung(gyradius)


def _period(
    test: Experiment[PendulumJob], lengthens: Lengthening | None = pendulum_lengthening
) -> Estimate:
    source = test.table.period or PeriodSource()
    return test.period(source, "period", lengthens=lengthens).period


def _about(table: PendulumJob, about: Assessment) -> Finding:
    words = f"{table.axis} inertia about the CG"
    return assessed(f"i_{table.axis}_kg_m2", words, about)


def _inertia(mass_kg: Value, gyradius_m: Value) -> Value:
    return mass_kg * gyradius_m * gyradius_m


def _gyradius(inertia_kg_m2: Value, mass_kg: Value) -> Value:
    return sqrt(inertia_kg_m2 / mass_kg)


def decay_findings(runs: PeriodRuns) -> list[Finding]:
    """Return the period: of records at no amplitude, with the damped one and damping ratios.

    The damped period is that of the whole record at its amplitudes; releases differ in it as they
    do in the other.
    """
    period = runs.period
    words = "period at no amplitude, undamped" if runs.records else "period as observed"
    findings = [Finding("period_s", words, period)]
    if runs.records:
        damped = float(np.mean([record.fit.modes[0].period_s for record in runs.records]))
        damped_period = period.following(damped, 1.0)
        findings.append(
            Finding("damped_period_s", "damped period of the whole record", damped_period)
        )
        findings += [
            Finding("damping_ratio", "damping ratio of the whole record", damping_of(runs.records)),
            Finding(
                "small_damping_ratio",
                "damping ratio of small swings, friction and drag apart",
                small_damping_of(runs.records),
            ),
        ]
    return findings
