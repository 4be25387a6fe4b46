"""Where to put given weights for a target mass, centre of gravity and gyradii."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from analysis.inertia.elementary_functions import Value
from analysis.inertia.parts import BodyPart, combined
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError

_STARTS = 12
_HOLD = 1e-4  # tolerances a box's width from its middle: tells equal solutions apart, no more
_AXES = ("x_m", "y_m", "z_m")
_TURNS = ("roll_m", "pitch_m", "yaw_m")


@dataclass(frozen=True)
class Weight:
    """A weight to place.

    Attributes
    ----------
    low_m, high_m
        Corners of the box in which its centre may lie (x, y, z); equal where it is fixed.
    gyradii_m
        Of the weight itself; 0 for a small one.
    """

    name: str
    mass_kg: float
    low_m: tuple[float, float, float]
    high_m: tuple[float, float, float]
    gyradii_m: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class BallastTarget:
    """Wanted mass properties; ``None`` where any value will do.

    Attributes
    ----------
    centre_m
        x, y, z of the centre of gravity.
    gyradii_m
        Roll, pitch, yaw.
    tolerance_mass_kg, tolerance_m
        How near is near enough.
    """

    mass_kg: float | None = None
    centre_m: tuple[float | None, float | None, float | None] = (None, None, None)
    gyradii_m: tuple[float | None, float | None, float | None] = (None, None, None)
    tolerance_mass_kg: float = 0.01
    tolerance_m: float = 0.001


@dataclass(frozen=True)
class Ballasting:
    """Places of the weights, and the mass properties that follow.

    Attributes
    ----------
    positions_m
        Shape ``(weights, 3)``.
    body
        The ballasted model's ten parameters, as :class:`analysis.inertia.parts.BodyPart` has them.
    errors
        Reached less wanted, by name (``mass_kg``, ``x_m``, ``yaw_m`` ...), for what was asked.
    feasible
        Whether all errors are within the tolerances.
    message
        Says so, and how near it gets where not.
    """

    positions_m: FloatArray
    body: FloatArray
    errors: dict[str, float]
    feasible: bool
    message: str


def place_ballast(
    base: BodyPart, weights: Sequence[Weight], target: BallastTarget, *, seed: int = 0
) -> Ballasting:
    """Find the weights' places by bounded least squares from several starts.

    Among equal solutions the one nearest to the boxes' middles is taken.

    Raises
    ------
    ConfigurationError
        For no weights, a mass that is not above zero, or a box whose corners are swapped.
    """
    from scipy.optimize import least_squares

    _check(weights)
    low = np.array([weight.low_m for weight in weights]).ravel()
    high = np.array([weight.high_m for weight in weights]).ravel()
    free = high > low
    middle = 0.5 * (low + high)

    def full(place: FloatArray) -> FloatArray:
        everything: FloatArray = middle.copy()
        everything[free] = place
        return everything

    weight_per_m = _HOLD / (high - low)[free]

    def misfit(place: FloatArray) -> FloatArray:
        errors = _errors(_body(base, weights, full(place)), target)
        scaled = [_scaled(key, value, target) for key, value in errors.items()]
        return np.concatenate([scaled, weight_per_m * (place - middle[free])])

    def slope(place: FloatArray) -> FloatArray:
        rows = _slopes(_body(base, weights, full(place)), weights, full(place), target)
        return np.concatenate([rows[:, free], np.diag(weight_per_m)])

    best = middle
    if free.any():
        generator = np.random.default_rng(seed)
        starts = [middle[free]]
        starts += [generator.uniform(low[free], high[free]) for _ in range(_STARTS)]
        settle = partial(
            least_squares,
            jac=slope,
            bounds=(low[free], high[free]),
            # the dogleg: equal solutions make a valley along which "trf" creeps for seconds
            method="dogbox",
            xtol=1e-10,
            ftol=1e-10,
            gtol=1e-10,
        )
        solved = [settle(misfit, start) for start in starts]
        best = full(np.asarray(min(solved, key=lambda solution: float(solution.cost)).x))
    body = _body(base, weights, best)
    errors = _errors(body, target)
    worst = {key: value for key, value in errors.items() if abs(_scaled(key, value, target)) > 1.0}
    return Ballasting(best.reshape(-1, 3), body, errors, not worst, _message(worst, target))


def _check(weights: Sequence[Weight]) -> None:
    if not weights:
        raise ConfigurationError("ballast: no weights to place; give at least one")
    for weight in weights:
        swapped = [
            axis for axis, a, b in zip("xyz", weight.low_m, weight.high_m, strict=True) if a > b
        ]
        if not weight.mass_kg > 0.0 or swapped:
            raise ConfigurationError(
                f"ballast {weight.name!r}: mass {weight.mass_kg:g} kg must be above 0 and low_m "
                f"not above high_m (swapped in: {', '.join(swapped) or 'none'})"
            )


def _body(base: BodyPart, weights: Sequence[Weight], place: FloatArray) -> FloatArray:
    rows = [base.parameters]
    for weight, where in zip(weights, place.reshape(-1, 3), strict=True):
        moments = weight.mass_kg * np.array(weight.gyradii_m) ** 2
        rows.append(np.concatenate([[weight.mass_kg], where, moments, np.zeros(3)]))
    return combined(np.array(rows), np.ones(len(rows)))


def _errors(body: FloatArray, target: BallastTarget) -> dict[str, float]:
    errors = {}
    if target.mass_kg is not None:
        errors["mass_kg"] = float(body[0] - target.mass_kg)
    for name, value, wanted in zip(_AXES, body[1:4], target.centre_m, strict=True):
        if wanted is not None:
            errors[name] = float(value - wanted)
    gyradii = np.sqrt(np.maximum(body[4:7], 0.0) / body[0])
    for name, value, wanted in zip(_TURNS, gyradii, target.gyradii_m, strict=True):
        if wanted is not None:
            errors[name] = float(value - wanted)
    return errors


def _slopes(
    body: FloatArray, weights: Sequence[Weight], place: FloatArray, target: BallastTarget
) -> FloatArray:
    """Return the scaled errors' derivatives by all coordinates, shape ``(errors, 3 weights)``.

    A weight moves the centre of gravity by its share of the mass, and an inertia about it by
    ``2 m (p - c)`` in each coordinate across the axis: what the centre's own motion adds is nil.
    """
    mass = np.array([weight.mass_kg for weight in weights])
    arm = 2.0 * mass[:, None] * (place.reshape(-1, 3) - body[1:4])
    rows = []
    for key in _errors(body, target):
        row = np.zeros((len(weights), 3))
        if key in _AXES:
            row[:, _AXES.index(key)] = mass / body[0]
        elif key in _TURNS:
            turn = _TURNS.index(key)
            across = [k for k in range(3) if k != turn]
            gyradius = np.sqrt(max(body[4 + turn], 0.0) / body[0])
            row[:, across] = arm[:, across] / max(2.0 * body[0] * gyradius, 1e-300)
        rows.append(_scaled(key, row.ravel(), target))
    return np.reshape(rows, (-1, place.size))


def _scaled(key: str, error: Value, target: BallastTarget) -> Any:
    return error / (target.tolerance_mass_kg if key == "mass_kg" else target.tolerance_m)


def _message(worst: dict[str, float], target: BallastTarget) -> str:
    if not worst:
        return "all targets are met within their tolerances"
    parts = [
        f"mass off by {value:+.4g} kg (tolerance {target.tolerance_mass_kg:g}): other weights"
        if key == "mass_kg"
        else f"{key.removesuffix('_m')} off by {1e3 * value:+.4g} mm "
        f"(tolerance {1e3 * target.tolerance_m:g})"
        for key, value in worst.items()
    ]
    return (
        "not feasible with these weights within these boxes; the nearest: "
        + "; ".join(parts)
        + ". Widen the boxes, split the weights, or change their masses"
    )
