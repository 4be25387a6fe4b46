"""A diagnosis as an answer that programs read: probabilities, parameters, what is foretold.

``docs/sealed.md`` has the keys; :data:`SCHEMA` names them.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from analysis.gap.components import Part, Stack
from analysis.gap.diagnose import Diagnosis
from analysis.gap.fit import Fit, Problem
from analysis.gap.forecast import Forecast, forecast, further, planned
from analysis.gap.free import Free, free_numbers
from analysis.gap.measurements import INJECTED_HZ
from analysis.gap.polynomial import polynomial, polynomial_ahead
from analysis.gap.priors import Priors
from analysis.gap.propose import Proposal
from analysis.gap.recentre import Recentred
from analysis.gap.verdict import answer_of
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCES
from pmm.gap.case import HeldOut
from pmm.gap.prepare import shares_of
from sim.effects.effect import FurtherMeasurement

SCHEMA: Final = "sealed-answer-1"
_TWO_SIDED = 1.96
_DRAWS = 400
_FORM_KNOWN = 1.0  # standard deviation of the logarithm of by how much a form is off
_ELSE = 0.2  # standard deviation of what a wrong effect makes go away, about what it did so far
_LESS = 0.32  # and by how much less that is at other set-points, at mean
_SURE = 0.85  # of the names above 0.9, 86 % were right on a sealed board
_SEED = 20260


def answer(
    name: str,
    diagnosis: Diagnosis,
    there: Recentred,
    held_out: Sequence[HeldOut],
    priors: Priors,
) -> dict[str, Any]:
    """Return a diagnosis as a dictionary of numbers and texts.

    Parameters
    ----------
    name
        Of the case.
    there
        The rig that the diagnosis began with.
    held_out
        Runs whose outcome is to be foretold.
    """
    free = free_numbers(there.rig, priors)
    best = None if diagnosis.best is None else diagnosis.best.fit
    rival = None if diagnosis.rival is None else diagnosis.rival.fit
    shares = shares_of(diagnosis, there)
    share = 0.0 if best is None else shares[answer_of(best)]
    tried = 0.0 if diagnosis.shrinkage is None else diagnosis.shrinkage.share
    named = _Named(best, rival, share, tried)
    foretold = _Foretold(diagnosis.problem, named, held_out, free, priors)
    found: dict[str, Any] = {
        "schema": SCHEMA,
        "case": name,
        "probabilities": _summing_to_one(shares),
        "stages": _summing_to_one(diagnosis.stages) if best is not None else {},
        "classes": [
            sorted([own, *(other for other, _ in alike)])
            for own, alike in diagnosis.classes.items()
        ],
        "effects": [] if best is None else list(effect_rows(best)),
        "next_run": None if not diagnosis.proposals else next_run(diagnosis.proposals[0]),
    }
    return found | foretold.as_dict()


def _summing_to_one(shares: Mapping[str, float]) -> dict[str, float]:
    rounded = {name: round(float(share), 9) for name, share in shares.items() if share > 5e-10}
    total = sum(rounded.values())
    return {name: share / total for name, share in rounded.items()}


def effect_rows(fit: Fit) -> Iterator[dict[str, Any]]:
    """Yield each effect with its parameters and their 95 % intervals."""
    spread = np.sqrt(np.diagonal(fit.posterior.covariance))
    at = 0
    for candidate in fit.candidates:
        parameters = {name: _fixed(value) for name, value in candidate.held.items()}
        for axis in candidate.axes:
            unit, wide = float(fit.units[at]), _TWO_SIDED * float(spread[at])
            values = [axis.value(unit), axis.value(unit - wide), axis.value(unit + wide)]
            parameters[axis.parameter.name] = dict(
                zip(("value", "low", "high"), values, strict=True)
            )
            at += 1
        yield {"name": candidate.name, "parameters": parameters}


def _fixed(value: float) -> dict[str, float]:
    return {"value": value, "low": value, "high": value}


def next_run(one: Proposal) -> dict[str, Any]:
    """Return a proposed run as the plan and the sealed rig take it."""
    if one.set_point is None:
        return {"kind": str(one.kind), **_besides(one)}
    return {
        "kind": one.kind,
        "frequency_hz": one.set_point.frequency_hz,
        "eccentricity_m": one.set_point.eccentricity_m,
        "strut_phase_rad": one.set_point.strut_phase_rad,
        "carriage_speed_m_s": one.set_point.carriage_speed_m_s,
        "medium": one.set_point.medium.value,
        "drift_rad": one.set_point.drift_rad,
        "preload_n": one.force_n,
    }


def _besides(one: Proposal) -> dict[str, Any]:
    if one.kind == FurtherMeasurement.CHECK_WEIGHT:
        return {"weight_n": one.force_n, "strut": one.strut}
    if one.kind == FurtherMeasurement.INJECTION:
        return {"frequency_hz": INJECTED_HZ, "force_n": one.force_n}
    return {}


@dataclass(frozen=True, eq=False)
class _Named:
    """What the answer names, the second best, how probable the first is, and what it did so far.

    Attributes
    ----------
    tried
        Part of the gap that went away on regimes of the campaign that were withheld from it.
    """

    best: Fit | None
    rival: Fit | None
    share: float
    tried: float


class _Foretold:
    """The withheld runs as foretold without an effect, with the best answer, and by controls."""

    def __init__(
        self,
        problem: Problem,
        named: _Named,
        held_out: Sequence[HeldOut],
        free: Sequence[Free],
        priors: Priors,
    ) -> None:
        self._names = [one.name for one in held_out]
        runs = [planned(problem, one.set_point, at) for at, one in enumerate(held_out)]
        self._there = further(problem, runs, free, priors) if runs else None
        self._problem, self._named = problem, named

    def as_dict(self) -> dict[str, Any]:
        if self._there is None:
            return {"before": {}, "after": {}, "shrinkage": _share(0.0, 0.0, 0.0)}
        stack = self._there.simulator.stack
        plain = forecast(self._problem, self._there, None)
        best = self._named.best
        cured = plain if best is None else forecast(self._problem, self._there, best)
        low, middle, high = (
            (0.0, 0.0, 0.0) if best is None else self._shrinkage(stack, plain, cured)
        )
        return {
            "before": self._runs(stack, plain.values(self._there)),
            "after": self._runs(stack, cured.values(self._there)),
            **self._controls(self._there),
            "shrinkage": _share(float(middle), float(low), float(high)),
        }

    def _shrinkage(
        self, stack: Stack, plain: Forecast, cured: Forecast
    ) -> tuple[float, float, float]:
        """Return the median and the 95 % interval of the part of the forces' gap that goes away.

        By how much a form is off is itself known to a factor of three only; and where the answer is
        another one, as much goes away at most, but for some scatter, as on the regimes that were
        withheld from it.
        """
        rows = np.array([one.channel in FORCES for one in stack.components])
        gap, root, form = (cured.mean - plain.mean)[rows], cured.root[rows], cured.form[rows]
        rng, shares = np.random.default_rng(_SEED), []
        named = min(self._named.share, _SURE) * _DRAWS
        for number in range(_DRAWS):
            if number >= named:
                other = _ELSE * rng.standard_normal() - _LESS * rng.exponential()
                shares.append(min(self._named.tried + float(other), 1.0))
                continue
            off = root @ rng.standard_normal(root.shape[1])
            size = math.exp(_FORM_KNOWN * float(rng.standard_normal()))
            off = off + size * (form @ rng.standard_normal(form.shape[1]))
            shares.append(_shrinks(gap + off, off))
        low, middle, high = np.quantile(shares, (0.025, 0.5, 0.975))
        return float(low), float(middle), float(high)

    def _controls(self, there: Problem) -> dict[str, Any]:
        """Return what the second best answer and a free polynomial foretell."""
        problem, stack = self._problem, there.simulator.stack
        free = forecast(problem, there, polynomial(problem), polynomial_ahead(problem, there))
        found = {"after_polynomial": self._runs(stack, free.values(there))}
        if self._named.rival is not None:
            second = forecast(problem, there, self._named.rival)
            found["after_rival"] = self._runs(stack, second.values(there))
        return found

    def _runs(self, stack: Stack, values: FloatArray) -> dict[str, Any]:
        return {name: harmonics(stack, values, number) for number, name in enumerate(self._names)}


def _shrinks(before: FloatArray, after: FloatArray) -> float:
    """Return the part of a gap that goes away; negative where it grows."""
    old, new = float(np.sqrt(np.mean(before**2))), float(np.sqrt(np.mean(after**2)))
    return 1.0 - new / old if old > 0.0 else 0.0


def _share(value: float, low: float, high: float) -> dict[str, float]:
    return {"value": value, "low": min(low, value), "high": max(high, value)}


def harmonics(stack: Stack, values: FloatArray, run: int) -> dict[str, Any]:
    """Return a run's components by channel: mean, in-phase and quadrature parts by order."""
    found: dict[str, dict[str, Any]] = {}
    for at in np.flatnonzero(stack.run == run):
        one = stack.components[at]
        if not one.channel:
            continue
        channel = found.setdefault(one.channel, {"mean": 0.0, "in_phase": [], "quadrature": []})
        if one.part is Part.MEAN:
            channel["mean"] = float(values[at])
        else:
            channel["in_phase" if one.part is Part.IN_PHASE else "quadrature"].append(
                float(values[at])
            )
    return found
