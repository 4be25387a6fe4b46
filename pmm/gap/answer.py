"""A diagnosis as an answer that programs read: probabilities, parameters, what is foretold.

``docs/sealed.md`` has the keys; :data:`SCHEMA` names them.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np

from analysis.gap.design.forecast import forecast, further, planned
from analysis.gap.design.measurements import INJECTED_HZ
from analysis.gap.design.proposals import Proposal
from analysis.gap.forward.free_numbers import Free
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.judge.answer import NamedAnswer, named_answer, predicted_shrinkage
from analysis.gap.judge.diagnosis import Diagnosis
from analysis.gap.observe.components import Part, Stack
from analysis.gap.search.fit import Fit
from analysis.gap.search.polynomial import polynomial, polynomial_ahead
from hardware.description.arrays import FloatArray
from pmm.gap.case import HeldOut
from sim.effects.effect import FurtherMeasurement

SCHEMA: Final = "sealed-answer-1"
_TWO_SIDED = 1.96


def answer(
    name: str,
    diagnosis: Diagnosis,
    free: Sequence[Free],
    held_out: Sequence[HeldOut],
    tolerances: Tolerances,
) -> dict[str, Any]:
    """Return a diagnosis as a dictionary of numbers and texts.

    Parameters
    ----------
    name
        Of the case.
    free
        What is left free, about what is stated.
    held_out
        Runs whose outcome is to be foretold.
    """
    named = named_answer(diagnosis)
    best = named.best
    foretold = _Foretold(diagnosis.problem, named, held_out, free, tolerances)
    found: dict[str, Any] = {
        "schema": SCHEMA,
        "case": name,
        "probabilities": _summing_to_one(diagnosis.answers.by_answer),
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
    """Yield each effect with its parameters and their 95 % intervals, in the catalogue's form."""
    spread = np.sqrt(np.diagonal(fit.posterior.covariance))
    at = 0
    for candidate in fit.candidates:
        forms = {one.name for one in candidate.kind.parameters() if one.forms}
        held = {name: value for name, value in candidate.held.items() if name not in forms}
        parameters = {name: _fixed(value) for name, value in held.items()}
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


class _Foretold:
    """The withheld runs as foretold without an effect, with the best answer, and by controls."""

    def __init__(
        self,
        problem: Problem,
        named: NamedAnswer,
        held_out: Sequence[HeldOut],
        free: Sequence[Free],
        tolerances: Tolerances,
    ) -> None:
        self._names = [one.name for one in held_out]
        runs = [planned(problem, one.set_point, at) for at, one in enumerate(held_out)]
        self._there = further(problem, runs, free, tolerances) if runs else None
        self._problem, self._named = problem, named

    def as_dict(self) -> dict[str, Any]:
        if self._there is None:
            nothing = {"value": 0.0, "low": 0.0, "high": 0.0}
            return {"before": {}, "after": {}, "shrinkage": nothing}
        stack = self._there.simulator.stack
        plain = forecast(self._problem, self._there, None)
        best = self._named.best
        cured = plain if best is None else forecast(self._problem, self._there, best)
        low, middle, high = predicted_shrinkage(self._named, stack, plain, cured)
        return {
            "before": self._runs(stack, plain.values(self._there)),
            "after": self._runs(stack, cured.values(self._there)),
            **self._controls(self._there),
            "shrinkage": {"value": middle, "low": low, "high": high},
        }

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
