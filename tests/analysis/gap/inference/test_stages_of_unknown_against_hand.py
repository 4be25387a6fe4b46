"""Where something unknown comes from that no stage tells: counts of known effects, by hand."""

from collections.abc import Mapping

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.inference.shapes import Shapes

STAGES = ("water", "structure", "carriage", "drive")


def _shapes(effects: Mapping[str, tuple[str, int]]) -> Shapes:
    """Return shapes of effects, each with its stage and a number of directions."""
    names = [name for name, (_, count) in effects.items() for _ in range(count)]
    return Shapes(np.zeros((1, len(names))), tuple(names),
                  tuple(effects[name][0] for name in names), {})  # fmt: skip


def test_each_effect_counts_once_and_each_stage_one_more() -> None:
    known = {"waves": ("water", 3), "drag": ("water", 1), "cable": ("structure", 1),
             "lag": ("drive", 2)}  # fmt: skip
    shapes, among = _shapes(known), ("water", "structure", "carriage")
    shares = [shapes.stage_share(stage, among) for stage in among]
    assert shares == pytest.approx([3 / 6, 2 / 6, 1 / 6])
    assert shapes.stage_share("drive", ("drive",)) == 1.0


def test_nothing_known_leaves_all_alike() -> None:
    assert _shapes({}).stage_share("water", STAGES) == pytest.approx(1 / 4)


@given(
    st.dictionaries(
        st.text(min_size=1), st.tuples(st.sampled_from(STAGES), st.integers(1, 3)), max_size=9
    ),
    st.sets(st.sampled_from(STAGES), min_size=1),
)
def test_shares_are_positive_and_sum_to_one(
    known: dict[str, tuple[str, int]], among: set[str]
) -> None:
    shares = [_shapes(known).stage_share(stage, sorted(among)) for stage in among]
    assert min(shares) > 0.0
    assert sum(shares) == pytest.approx(1.0)
