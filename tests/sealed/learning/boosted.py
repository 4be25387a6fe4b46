"""An amortised classifier: gradient boosting on features of campaigns, as a row of a board."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from tests.sealed.learning.campaigns import LOOKS
from tests.sealed.learning.features import as_matrix
from tests.sealed.learning.training import FEATURES, Example, examples
from tests.sealed.peers.scene import scene
from tests.sealed.peers.sheet import NONE, sheet, stages_of

NEEDS: Final = "sklearn"
SEED: Final = 26
ROUNDS, LEAVES, RATE, LEAST, PENALTY = 60, 6, 0.1, 20, 1.0
"""Trees of each answer, leaves of a tree, learning rate, least examples of a leaf, and the penalty
of a leaf's square. By validation on training campaigns: halved or doubled each moves the mean log
loss by less than 0.1; with 3 examples and no penalty it is 12 to 15, as rare answers' leaves run
away."""


@dataclass(frozen=True, eq=False)
class Classifier:
    """A fitted classifier of answers and one of stages, over the same features.

    Attributes
    ----------
    names
        The features, in their order.
    trained_on
        How many campaigns.
    """

    look: str
    names: tuple[str, ...]
    answers: Any
    stages: Any
    trained_on: int

    @classmethod
    def fitted(cls, found: Sequence[Example], look: str) -> "Classifier":
        """Fit to training campaigns; a pair counts as half of each of its effects.

        Raises
        ------
        DataError
            If scikit-learn is not installed, or fewer than two answers were made.
        """
        if find_spec(NEEDS) is None:
            raise DataError("scikit-learn is not installed: pip install -e .[peers]")
        if len({name for one in found for name in one.right}) < 2:
            raise DataError(
                f"{len(found)} campaigns: make more (python -m tests.sealed.learning campaigns)"
            )
        rows = [one.features[look] for one in found]
        names = tuple(sorted({name for row in rows for name in row}))
        matrix = as_matrix(rows, names)
        answers = _boosted(matrix, [one.right for one in found])
        stages = _boosted(matrix, [one.stages or (NONE,) for one in found])
        return cls(look, names, answers, stages, len(found))

    def shares(self, features: Mapping[str, float]) -> tuple[dict[str, float], dict[str, float]]:
        """Return how probable each answer and each stage is."""
        row = as_matrix([features], self.names)
        return _by_name(self.answers, row), _by_name(self.stages, row)

    def answer(self, case: Path) -> dict[str, Any]:
        """Return the answer to a case's folder."""
        features = FEATURES[self.look](LOOKS[self.look](case))
        return self.answer_to(case.name, features, scene(case).foretold())

    def answer_to(
        self, case: str, features: Mapping[str, float],
        foretold: tuple[Mapping[str, Any], Mapping[str, Any]],
    ) -> dict[str, Any]:  # fmt: skip
        """Return the answer by a case's features; nothing is foretold to shrink."""
        shares, stages = self.shares(features)
        stages.pop(NONE, None)
        certain = math.fsum(stages.values()) > 0.0
        return sheet(case, shares, stages if certain else stages_of(shares), foretold)


@cache
def classifier(campaigns: Path, look: str) -> Classifier:
    """Return the classifier fitted to all campaigns of a place; once in a process."""
    return Classifier.fitted(examples(campaigns), look)


def _boosted(matrix: FloatArray, right: Sequence[tuple[str, ...]]) -> Any:
    from sklearn.ensemble import HistGradientBoostingClassifier

    at = [number for number, names in enumerate(right) for _ in names]
    weights = [1.0 / len(names) for names in right for _ in names]
    model = HistGradientBoostingClassifier(
        max_iter=ROUNDS, max_leaf_nodes=LEAVES, learning_rate=RATE, min_samples_leaf=LEAST,
        l2_regularization=PENALTY, max_features=0.2, early_stopping=False, random_state=SEED,
    )  # fmt: skip
    return model.fit(matrix[at], [name for names in right for name in names], weights)


def _by_name(model: Any, row: FloatArray) -> dict[str, float]:
    shares = model.predict_proba(row)[0]
    return {str(name): float(share) for name, share in zip(model.classes_, shares, strict=True)}


def importance(
    model: Any, matrix: FloatArray, right: Sequence[Collection[str]],
    groups: Mapping[str, Sequence[int]], rng: np.random.Generator,
) -> dict[str, FloatArray]:  # fmt: skip
    """Return of each campaign whether it is told right no longer when a group is shuffled.

    Breiman (2001), over groups of columns that are shuffled together: 1 where it was right and is
    no longer, -1 where it is only then, else 0; shape ``(campaigns,)``.
    """

    def reached(values: FloatArray) -> FloatArray:
        said = model.predict(values)
        return np.array([float(one in names) for one, names in zip(said, right, strict=True)])

    whole, falls = reached(matrix), {}
    for name, columns in groups.items():
        shuffled = matrix.copy()
        shuffled[:, columns] = matrix[rng.permutation(len(matrix))][:, columns]
        falls[name] = whole - reached(shuffled)
    return falls
