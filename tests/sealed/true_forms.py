"""What is there in its true form and size, for the oracle: what it changes of its case's own runs.

A case is made again from its key and recorded with each of its effects and without any: what
repeats with hardly any noise, lines and scatter on two draws of the case's own. The diagnosis's own
observation of both tells what the effect changes; a hypothesis that names it says so too, whatever
form the catalogue knows. Hypotheses that name something else keep the catalogue's forms.
"""

import json
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final
from unittest.mock import patch

import numpy as np

from analysis.gap.observe.components import (
    SETTLING,
    STEADY_PARTS,
    Component,
    Part,
    Stack,
)
from hardware.description.arrays import FloatArray
from tests.sealed.variations import Variation, vary

if TYPE_CHECKING:
    from analysis.gap.forward.problem import Problem
    from analysis.gap.search.fit import Fit
    from tests.sealed.generator.case import Case
    from tests.sealed.generator.sizing import Sized

FILE: Final = "forms.json"
"""What a told case has beside its campaign."""

Shown = Mapping[str, Mapping[Component, float]]
"""What is observed, by run and component."""

_QUIET: Final = 1e-3  # noise and steps over those of the case
_DRAWS: Final = 2  # of the noise: two tell what is shared
_NOTHING: Final = 1e-300  # below the square of any change
_REPEATING: Final = (*STEADY_PARTS, *SETTLING)

Changes = Mapping[str, Mapping[Component, float]]
"""What an effect changes, by run and component."""


def write_forms(truth: Mapping[str, Any], folder: Path, variation: Variation | None = None) -> None:
    """Write what each effect of a key changes into the folder of its case; nothing without any.

    Parameters
    ----------
    variation
        How the folder's records are varied, if they are.
    """
    from tests.sealed.generator.case import make

    if not truth.get("effects"):
        return
    world = truth.get("world", "A")
    case = make(int(truth["seed"]), truth["index"], null=truth["null"], where=world)
    kept = {
        name: {
            run: [[one.channel, one.part.value, one.order, change] for one, change in row.items()]
            for run, row in changes.items()
        }
        for name, changes in changes_of(case, variation).items()
    }
    (folder / FILE).write_text(json.dumps(kept))


def read_forms(folder: Path) -> dict[str, Changes]:
    """Return what is told in the folder of a case, by effect; nothing if it is no told one."""
    file = folder / FILE
    kept = json.loads(file.read_text()) if file.exists() else {}
    return {
        name: {
            run: {Component(channel, Part(part), order): change
                  for channel, part, order, change in rows}
            for run, rows in changes.items()
        }
        for name, changes in kept.items()
    }  # fmt: skip


def changes_of(case: "Case", variation: Variation | None = None) -> dict[str, Changes]:
    """Return what each effect of a case changes by itself."""
    from tests.sealed.generator.background import with_all

    usual = with_all(case.situation.parameters, case.always)
    records = [
        _quiet(case),
        *(replace(case, seed=case.seed + draw) for draw in range(1, 1 + _DRAWS)),
    ]
    without = [_observed(one, usual, variation) for one in records]
    out: dict[str, Changes] = {}
    for sized in case.content.effects:
        there = [_observed(one, sized.put(usual), variation) for one in records]
        out[_name(case, sized)] = _changes(there, without)
    return out


def _name(case: "Case", sized: "Sized") -> str:
    """Return the name that an answer has for an effect: its own, or that of what says the same."""
    (first, *_), own = case.content.right or ((),), sized.effect.name
    known = {name for answer in case.content.right for name in answer}
    return own if own in known or len(first) != 1 else first[0]


def _observed(case: "Case", parameters: FloatArray, variation: Variation | None) -> Shown:
    """Return what the diagnosis observes of a case's runs in another reality."""
    from pmm.gap.load import load_campaign
    from tests.sealed.generator.files import write_open

    with TemporaryDirectory() as room:
        write_open(replace(case, parameters=parameters), Path(room))
        folder = Path(room) / case.name
        if variation is not None:
            vary(folder, Path(room) / "varied", variation)
            folder = Path(room) / "varied"
        loaded = load_campaign(folder)
    runs = (*loaded.runs, *loaded.at_rest)
    return {
        run.name: dict(zip(run.observed.components, run.observed.values, strict=True))
        for run in runs
    }


def _quiet(case: "Case") -> "Case":
    """Return a case with hardly any noise: where two records are cut otherwise, none cancels."""
    noise = case.campaign.rig.noise
    loud = {one.name for one in fields(noise)} - {"colour_s", "wander_s"}
    noise = replace(noise, **{name: _QUIET * getattr(noise, name) for name in loud})
    rig = replace(case.campaign.rig, noise=noise)
    return replace(case, campaign=replace(case.campaign, rig=rig))


def _changes(there: Sequence[Shown], without: Sequence[Shown]) -> Changes:
    """Return changes: of what repeats those without noise, of all else what the draws share."""
    quiet, *loud = (
        {run: _difference(shown[run], usual.get(run, {})) for run in shown}
        for shown, usual in zip(there, without, strict=True)
    )
    shared = shared_changes(loud)
    return {
        run: {one: change for one, change in row.items() if one.part in _REPEATING}
        | shared.get(run, {})
        for run, row in quiet.items()
    }


def shared_changes(draws: Sequence[Changes]) -> dict[str, dict[Component, float]]:
    """Return the mean of two draws' changes, less the noise that is left in it.

    Where an effect cuts records otherwise, noise does not cancel. Over a channel's part the draws'
    product is the square of what they share; the square of their mean has the noise's beside it.
    """
    one, other = draws
    by_part: dict[tuple[str, Part], list[tuple[str, Component]]] = defaultdict(list)
    for run, row in one.items():
        for component in row.keys() & other.get(run, {}).keys():
            if component.part not in _REPEATING:
                by_part[component.channel, component.part].append((run, component))
    found: dict[str, dict[Component, float]] = defaultdict(dict)
    for there in by_part.values():
        pairs = np.array([(one[run][component], other[run][component]) for run, component in there])
        mean = pairs.mean(axis=1)
        share = max(float(pairs.prod(axis=1).sum()), 0.0) / max(float(mean @ mean), _NOTHING)
        for (run, component), value in zip(there, mean, strict=True):
            found[run][component] = share * float(value)
    return found


def _difference(
    shown: Mapping[Component, float], usual: Mapping[Component, float]
) -> dict[Component, float]:
    return {one: value - usual[one] for one, value in shown.items() if one in usual}


@contextmanager
def knowing(forms: Mapping[str, Changes]) -> Iterator[None]:
    """Have every hypothesis weighed in the true form of its effects, in this process."""
    from analysis.gap.search import hypotheses

    weighed = hypotheses.weighed

    def told(problem: "Problem", fits: "Sequence[Fit]", *rest: Any) -> Any:
        return weighed(problem, [in_true_form(problem, fit, forms) for fit in fits], *rest)

    with patch.object(hypotheses, "weighed", told):
        yield


def in_true_form(problem: "Problem", fit: "Fit", forms: Mapping[str, Changes]) -> "Fit":
    """Return a fit whose effects change what they truly do where they were fitted.

    What luck makes of an effect has no form: of such a one only its lines and its scatter are told.
    What no record has stays as it is.
    """
    stack, signature = problem.simulator.stack, fit.signature.copy()
    repeating = np.array([one.part in _REPEATING for one in stack.components])
    known = [one.name in forms for one in fit.candidates]
    for number, candidate in enumerate(fit.candidates):
        if known[number]:
            own = problem.signature((candidate,), fit.units[fit.effect_index == number])
            beyond = problem.whitened(as_stacked(forms[candidate.name], stack)) - own
            by_luck = repeating & candidate.kind.by_chance
            signature += np.where(by_luck, 0.0, np.nan_to_num(beyond))
    other_forms = fit.forms[:, :0] if all(known) else fit.forms
    return replace(fit, signature=signature, forms=other_forms)


def as_stacked(changes: Changes, stack: Stack) -> FloatArray:
    """Return changes in the order of what is compared; no number where there is none."""
    names = [stack.runs[number].name for number in stack.run]
    return np.array(
        [
            changes.get(name, {}).get(component, np.nan)
            for name, component in zip(names, stack.components, strict=True)
        ]
    )
