"""The limit of the walls' echoes against ITTC 7.5-02-07-02.1, table 1."""

import math

import pytest

from pmm.plan.echoes import echo_limit


@pytest.mark.parametrize(
    ("ratio", "limit"), [(0.5, 0.635), (1.0, 0.378), (2.0, 0.280), (4.0, 0.245)]
)
def test_the_table_is_the_ittcs(ratio: float, limit: float) -> None:
    assert echo_limit(ratio) == limit


def test_between_its_rows_the_limit_is_between_theirs() -> None:
    assert 0.280 < echo_limit(1.5) < 0.378


@pytest.mark.parametrize("ratio", [0.4, 5.0])
def test_outside_the_table_there_is_no_limit(ratio: float) -> None:
    assert math.isnan(echo_limit(ratio))
