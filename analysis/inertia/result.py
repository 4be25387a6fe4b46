"""The result of a test: mass, centre of gravity, inertia and gyradii with their uncertainties."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

from analysis.inertia.elementary_functions import Value
from analysis.uncertainty.budget import Budget, derived
from analysis.uncertainty.estimate import Estimate, joint
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag
from hardware.description.oscillator import Plane


@dataclass(frozen=True)
class MassProperties:
    """Mass properties of a model.

    Attributes
    ----------
    cg_x, cg_z
        Centre of gravity from the midpoint between the struts, forward and down positive, m.
    gyradii
        About axes through the centre of gravity: some of ``roll``, ``pitch``, ``yaw``, m.
    budgets
        Where each number comes from.
    """

    name: str
    mass: Estimate
    cg_x: Estimate
    cg_z: Estimate
    gyradii: Mapping[str, Estimate]
    budgets: tuple[Budget, ...] = ()
    flags: tuple[Flag, ...] = ()

    def inertia(self, axis: str) -> Estimate:
        """Return the moment of inertia about the axis through the centre of gravity, kg m2.

        Raises
        ------
        ConfigurationError
            If that axis was not measured.
        """
        inputs = {"mass": self.mass, "gyradius": self._gyradius(axis)}
        return derived("I", _inertia, "kg m2", **inputs)

    def about_midpoint(self, plane: Plane) -> Estimate:
        """Return the inertia that a campaign in this plane needs, about the struts' midpoint.

        Pitch for the vertical plane, yaw for the horizontal one.
        """
        axis = "pitch" if plane is Plane.VERTICAL else "yaw"
        inputs = {"mass": self.mass, "gyradius": self._gyradius(axis), "ahead": self.cg_x}
        below = {"below": self.cg_z} if plane is Plane.VERTICAL else {}
        return derived("I", _inertia, "kg m2", **inputs, **below)

    def _gyradius(self, axis: str) -> Estimate:
        if axis not in self.gyradii:
            axes = ", ".join(self.gyradii) or "none"
            raise ConfigurationError(f"{self.name}: no {axis} gyradius was measured (have: {axes})")
        return self.gyradii[axis]

    def numbers(self) -> dict[str, object]:
        """Return everything as JSON takes it."""
        measured = {"mass_kg": self.mass, "cg_x_m": self.cg_x, "cg_z_m": self.cg_z}
        measured |= {f"k_{axis}_m": value for axis, value in self.gyradii.items()}
        quantities = measured | {f"i_{axis}_kg_m2": self.inertia(axis) for axis in self.gyradii}
        return {
            "name": self.name,
            "quantities": {key: estimate_numbers(value) for key, value in quantities.items()},
            "correlations": [
                {"between": pair, "coefficient": r} for pair, r in _correlations(measured)
            ],
            "budgets": {budget.name: budget_rows(budget) for budget in self.budgets},
            "flags": [
                {"code": flag.code, "severity": str(flag.severity), "message": flag.message}
                for flag in self.flags
            ],
        }


def _inertia(mass: Value, gyradius: Value, **arms: Value) -> Value:
    square = gyradius * gyradius
    for arm in arms.values():
        square = square + arm * arm
    return mass * square


def _correlations(estimates: Mapping[str, Estimate]) -> Iterator[tuple[list[str], float]]:
    """Yield pairs of names and their correlation coefficients, where these are not zero."""
    coefficients = joint(estimates.values()).correlation()
    for (i, first), (k, second) in combinations(enumerate(estimates), 2):
        if coefficients[i, k] != 0.0:
            yield [first, second], float(coefficients[i, k])


def estimate_numbers(estimate: Estimate) -> dict[str, object]:
    """Return an estimate as JSON takes it; infinite degrees of freedom are ``null``."""
    low, high = estimate.interval()
    return {
        "value": estimate.value,
        "standard_uncertainty": estimate.uncertainty,
        "degrees_of_freedom": finite_or_none(estimate.degrees_of_freedom),
        "interval_95": [low, high],
        "unit": estimate.unit,
    }


def budget_rows(budget: Budget) -> list[dict[str, object]]:
    """Return the rows of a budget as JSON takes them."""
    return [{key: finite_or_none(value) for key, value in row.items()} for row in budget.table()]


def finite_or_none(value: float | str) -> float | str | None:
    """Return a value as JSON takes it: ``None`` for a number that is infinite or not one."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def model_toml(result: MassProperties, plane: Plane) -> str:
    """Return the ``[model]`` table of a campaign, and its uncertainties beside it.

    ``[model]`` has the keys of :class:`hardware.description.body.Body`; ``[model_uncertainty]`` has
    the standard uncertainties under the same keys and the inertia's degrees of freedom.

    Raises
    ------
    ConfigurationError
        If the plane's gyradius was not measured.
    """
    inertia = result.about_midpoint(plane)
    axis = "transverse" if plane is Plane.VERTICAL else "vertical"
    rows = {
        "mass_kg": result.mass,
        "inertia_kg_m2": inertia,
        "cg_x_m": result.cg_x,
        "cg_z_m": result.cg_z,
    }
    lines = [f"# {_one_line(result.name)}: inertia about the {axis} axis through the midpoint"]
    lines.append("[model]")
    lines += [f"{key} = {value.value!r}" for key, value in rows.items()]
    lines += ["", "[model_uncertainty]  # standard uncertainties, one sigma"]
    lines += [f"{key} = {value.uncertainty!r}" for key, value in rows.items()]
    freedom = inertia.degrees_of_freedom
    lines.append(f"inertia_degrees_of_freedom = {freedom if math.isfinite(freedom) else 'inf'}")
    return "\n".join(lines) + "\n"


def _one_line(text: str) -> str:
    return " ".join(text.split())


@dataclass(frozen=True)
class Comparison:
    """A measured value against a target.

    Attributes
    ----------
    verdict
        ``pass`` where the whole interval of 95 % lies within the tolerance, ``fail`` where none of
        it does, ``undecided`` between: measure better.
    """

    name: str
    measured: Estimate
    target: float
    tolerance: float
    verdict: str
    message: str


def compare_with_target(
    name: str, measured: Estimate, target: float, tolerance: float
) -> Comparison:
    """Compare with the target or a design value, within the uncertainty.

    Raises
    ------
    ConfigurationError
        If the tolerance is not above zero.
    """
    if not tolerance > 0.0:
        raise ConfigurationError(f"{name}: a tolerance of {tolerance:g}; it must be above 0")
    low, high = measured.interval()
    if low >= target - tolerance and high <= target + tolerance:
        verdict = "pass"
    elif high < target - tolerance or low > target + tolerance:
        verdict = "fail"
    else:
        verdict = "undecided"
    message = (
        f"{name}: {measured.value:.5g} ({low:.5g} to {high:.5g}) {measured.unit} against "
        f"{target:.5g} +- {tolerance:.2g}: {verdict}"
    )
    return Comparison(name, measured, target, tolerance, verdict, message)
