"""What an oracle is told of forms, against what an effect changes by definition."""

from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from analysis.gap.observe.components import Component, Part
from hardware.description.arrays import FloatArray
from tests.sealed.generator.case import Case, make
from tests.sealed.generator.catalogue import BY_NAME
from tests.sealed.generator.sizing import Sized
from tests.sealed.true_forms import (
    FILE,
    Changes,
    in_true_form,
    read_forms,
    shared_changes,
    write_forms,
)

_SEED, _INDEX, _OFFSET_N = 71, 4, 0.7


@pytest.fixture(scope="module")
def case() -> Case:
    """A null of world A, with a zero off by a known force in it."""
    null = make(_SEED, _INDEX, null=True)
    effect = Sized(BY_NAME["zero-offset"], _OFFSET_N, {}, 0.0)
    return replace(null, content=replace(null.content, effects=(effect,)))


@pytest.mark.slow
def test_a_zero_that_is_off_changes_one_mean(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tests.sealed.generator.case.make", lambda *_, **__: case)
    key = {"effects": [{}], "seed": str(_SEED), "index": _INDEX, "null": False}
    write_forms(key, tmp_path)
    (changes,) = read_forms(tmp_path).values()
    assert len(changes) == len(case.campaign.runs)
    force = Component("force_aft", Part.MEAN)
    for row in changes.values():
        assert row[force] == pytest.approx(_OFFSET_N, rel=1e-6)
        kept = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE, Part.FREQUENCY)
        others = [abs(x) for one, x in row.items() if one != force and one.part in kept]
        assert max(others) < 1e-6


def test_a_case_without_effects_is_told_none(tmp_path: Path) -> None:
    write_forms({"effects": [], "tolerances": {}}, tmp_path)
    assert not (tmp_path / FILE).exists()
    assert read_forms(tmp_path) == {}


@dataclass
class _Fit:
    candidates: tuple[Any, ...]
    units: FloatArray
    effect_index: FloatArray
    signature: FloatArray
    forms: FloatArray


def _told(*names: str, by_chance: bool = False) -> _Fit:
    """Return a fit of effects that change 1 sigma each of everything, as told."""
    mean, scatter = Component("force_aft", Part.MEAN), Component("", Part.PERIOD_SCATTER)
    parts = tuple(SimpleNamespace(name=one, kind=SimpleNamespace(by_chance=by_chance))
                  for one in names)  # fmt: skip
    stack = SimpleNamespace(
        runs=[SimpleNamespace(name="one"), SimpleNamespace(name="two")],
        components=[mean, scatter, mean],
        run=np.array([0, 0, 1]),
    )
    problem = SimpleNamespace(
        simulator=SimpleNamespace(stack=stack),
        signature=lambda *_: np.ones(3),
        whitened=lambda change: change / 0.5,
    )
    count = len(names)
    fit = _Fit(parts, np.ones(count), np.arange(count), np.full(3, float(count)), np.ones((3, 2)))
    changes: Changes = {"one": {mean: 4.0, scatter: 9.0}}
    return cast("_Fit", in_true_form(cast("Any", problem), cast("Any", fit), {"known": changes}))


def test_a_fit_says_what_it_is_told() -> None:
    """4 N are 8 sigma, and a scatter of 9 is 18. A run that nothing is told of stays."""
    found = _told("known")
    assert found.signature == pytest.approx([8.0, 18.0, 1.0])
    assert found.forms.shape == (3, 0)
    pair = _told("known", "other")
    assert pair.signature == pytest.approx([9.0, 19.0, 2.0])
    assert pair.forms.shape == (3, 2)


def test_luck_has_a_size_and_no_form() -> None:
    assert _told("known", by_chance=True).signature == pytest.approx([1.0, 18.0, 1.0])


def test_noise_that_does_not_cancel_is_no_change() -> None:
    """Of a change of 3 in noise of 1, over many runs, 3 is told; of noise alone a tenth at most."""
    rng, runs = np.random.default_rng(20264), [f"run-{number}" for number in range(400)]
    line, scatter = Component("force_aft", Part.LINE, 1), Component("", Part.PERIOD_SCATTER)

    def draw() -> Changes:
        return {run: {line: 3.0 + rng.normal(), scatter: rng.normal()} for run in runs}

    told = shared_changes((draw(), draw()))
    assert np.mean([told[run][line] for run in runs]) == pytest.approx(3.0 * 9.0 / 9.5, rel=0.03)
    assert np.std([told[run][scatter] for run in runs]) < 0.1
    same = draw()
    exact = shared_changes((same, same))
    assert [exact[run][line] for run in runs] == pytest.approx([same[run][line] for run in runs])
