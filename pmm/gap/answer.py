"""A diagnosis as an answer that programs read: probabilities, parameters, what is foretold.

``docs/sealed.md`` has the keys; :data:`SCHEMA` names them.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np

from analysis.gap.design.forecast import forecast, planned, with_further_runs
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
    table: dict[str, Any] = {
        "schema": SCHEMA,
        "case": name,
        "probabilities": _summing_to_one(diagnosis.answers.by_answer),
        "stages": _summing_to_one(diagnosis.stages) if best is not None else {},
        "classes": [
            sorted([effect, *(twin for twin, _ in alike)])
            for effect, alike in diagnosis.classes.items()
        ],
        "effects": [] if best is None else list(effect_rows(best)),
        "next_run": None if not diagnosis.proposals else next_run(diagnosis.proposals[0]),
    }
    return table | foretold.as_dict()


def _summing_to_one(shares: Mapping[str, float]) -> dict[str, float]:
    rounded = {name: round(float(share), 9) for name, share in shares.items() if share > 5e-10}
    total = sum(rounded.values())
    return {name: share / total for name, share in rounded.items()}


def effect_rows(fit: Fit) -> Iterator[dict[str, Any]]:
    """Yield each effect with its parameters and their 95 % intervals, in the catalogue's form."""
    spread = np.sqrt(np.diagonal(fit.posterior.covariance))
    at = 0
    for candidate in fit.candidates:
        forms = {parameter.name for parameter in candidate.kind.parameters() if parameter.forms}
        held = {name: value for name, value in candidate.fixed_values.items() if name not in forms}
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


def next_run(proposal: Proposal) -> dict[str, Any]:
    """Return a proposed run as the plan and the sealed rig take it."""
    if proposal.set_point is None:
        return {"kind": str(proposal.kind), **_further_settings(proposal)}
    return {
        "kind": proposal.kind,
        "frequency_hz": proposal.set_point.frequency_hz,
        "eccentricity_m": proposal.set_point.eccentricity_m,
        "strut_phase_rad": proposal.set_point.strut_phase_rad,
        "carriage_speed_m_s": proposal.set_point.carriage_speed_m_s,
        "medium": proposal.set_point.medium.value,
        "drift_rad": proposal.set_point.drift_rad,
        "preload_n": proposal.force_n,
    }


def _further_settings(proposal: Proposal) -> dict[str, Any]:
    if proposal.kind == FurtherMeasurement.CHECK_WEIGHT:
        return {"weight_n": proposal.force_n, "strut": proposal.strut}
    if proposal.kind == FurtherMeasurement.INJECTION:
        return {"frequency_hz": INJECTED_HZ, "force_n": proposal.force_n}
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
        self._names = [run.name for run in held_out]
        runs = [planned(problem, run.set_point, at) for at, run in enumerate(held_out)]
        self._there = with_further_runs(problem, runs, free, tolerances) if runs else None
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

    def _controls(self, further_problem: Problem) -> dict[str, Any]:
        """Return what the second best answer and a free polynomial foretell."""
        problem, stack = self._problem, further_problem.simulator.stack
        free = forecast(
            problem,
            further_problem,
            polynomial(problem),
            polynomial_ahead(problem, further_problem),
        )
        controls = {"after_polynomial": self._runs(stack, free.values(further_problem))}
        if self._named.rival is not None:
            second = forecast(problem, further_problem, self._named.rival)
            controls["after_rival"] = self._runs(stack, second.values(further_problem))
        return controls

    def _runs(self, stack: Stack, values: FloatArray) -> dict[str, Any]:
        return {name: harmonics(stack, values, number) for number, name in enumerate(self._names)}


def harmonics(stack: Stack, values: FloatArray, run: int) -> dict[str, Any]:
    """Return a run's components by channel: mean, in-phase and quadrature parts by order."""
    channels: dict[str, dict[str, Any]] = {}
    for at in np.flatnonzero(stack.run == run):
        component = stack.components[at]
        if not component.channel:
            continue
        channel = channels.setdefault(
            component.channel, {"mean": 0.0, "in_phase": [], "quadrature": []}
        )
        if component.part is Part.MEAN:
            channel["mean"] = float(values[at])
        else:
            channel["in_phase" if component.part is Part.IN_PHASE else "quadrature"].append(
                float(values[at])
            )
    return channels
