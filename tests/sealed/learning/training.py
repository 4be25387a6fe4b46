"""Training campaigns as features: out of the folder in which they were made, or of a kept file.

A kept file has a line of JSON a campaign, compressed; what a classifier learns from is all in it,
so that it need not be made again.
"""

import json
import lzma
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from tests.sealed.learning.campaigns import Numbers
from tests.sealed.learning.features import of_components, of_hypotheses

FEATURES: Final[Mapping[str, Callable[[Numbers], dict[str, float]]]] = {
    "components": of_components,
    "hypotheses": of_hypotheses,
}
_DIGITS: Final = 3
"""Significant ones of a kept feature: trees look at the order of values alone."""


@dataclass(frozen=True)
class Example:
    """A campaign that was made.

    Attributes
    ----------
    right
        The key's first right answer, or its verdict where no name is right.
    stages
        The key's right stages.
    features
        By look, of each feature by name.
    """

    index: int
    right: Sequence[str]
    stages: Sequence[str]
    features: Mapping[str, Mapping[str, float]]


def examples(place: Path) -> list[Example]:
    """Return the campaigns of a folder or of a kept file, by their index."""
    if place.is_file():
        with lzma.open(place, "rt", encoding="utf-8") as lines:
            return [Example(**json.loads(line)) for line in lines]
    return [_example(json.loads(path.read_text())) for path in sorted(place.glob("*.json"))]


def keep(places: Sequence[Path], file: Path) -> int:
    """Write the campaigns of folders and kept files into one file; return how many there are."""
    every = {one.index: one for place in places for one in examples(place)}
    part = file.with_suffix(".part")
    with lzma.open(part, "wt", encoding="utf-8") as lines:
        for index in sorted(every):
            lines.write(json.dumps(asdict(every[index]), separators=(",", ":")) + "\n")
    part.replace(file)
    return len(every)


def _example(kept: Mapping[str, Any]) -> Example:
    return Example(kept["index"], kept["right"], kept["stages"], features_of(kept["numbers"]))


def features_of(looks: Mapping[str, Numbers]) -> dict[str, dict[str, float]]:
    """Return by look the features of what each look says of a campaign, as they are kept."""
    return {look: dict(_rounded(of(looks[look]))) for look, of in FEATURES.items()}


def _rounded(features: Mapping[str, float]) -> Iterator[tuple[str, float]]:
    for name, value in features.items():
        yield name, float(f"{value:.{_DIGITS}g}")
