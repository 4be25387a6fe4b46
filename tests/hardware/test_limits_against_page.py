"""The page on safety states the numbers that are in force."""

from pathlib import Path

import pytest

from hardware import limits

PAGE = (Path(__file__).parents[2] / "docs" / "safety.md").read_text(encoding="utf-8")
SHORT_S, LONG_S = limits.REST_WINDOW_S
STATED = [
    f"| shaft at rest below | {100 * limits.SHAFT_REST_SHARE:g} % of `highest_frequency_hz` |",
    f"| axis at rest below | {100 * limits.AXIS_REST_SHARE:g} % of its `speed` |",
    f"| positions looked at | {1e3 * SHORT_S:g} ms to {LONG_S:g} s |",
    f"| wander at rest | {limits.REST_COUNTS} counts |",
    f"| quick stop to rest within | {limits.REST_DEADLINE_S:g} s |",
    f"| coasting is recorded and waited for | {limits.COASTING_S:g} s |",
    f"| speed measured over | {limits.SPEED_WINDOW_S:g} s |",
    f"| a cycle late while struts follow a path | {limits.LATE_PERIODS:g} periods |",
    f"| overspeed lasts | {limits.OVERSPEED_S:g} s |",
    f"| overspeed | {limits.OVERSPEED:g} times the highest frequency |",
    f"| frequency, gate armed or open | within {100 * limits.FREQUENCY_SHARE:g} % of the run's",
    f"but for {limits.FREQUENCY_S:g} s |",
    f"by more than {100 * limits.READ_BACK_SHARE:g} %",
    f"| carriage at rest below | {100 * limits.CARRIAGE_REST_SHARE:g} % of `highest_speed_m_s`",
    f"| carriage speed, gate armed or open | within {100 * limits.CARRIAGE_SHARE:g} % of the run's",
    f"its tolerance, but for {limits.CARRIAGE_S:g} s |",
    f"| a reading is no speed of the carriage beyond | {limits.CARRIAGE_PLAUSIBLE:g} times",
    f"end of its track by | {limits.TRACK_MARGIN:g} times its braking way",
    f"| a lost port is opened on a reset | {limits.RECONNECT_TRIES} times, each waits "
    f"{limits.RECONNECT_S:g} s |",
    f"| a shaft that has to stand may move for | {limits.RESTLESS_S:g} s |",
]


@pytest.mark.parametrize("row", STATED)
def test_the_page_states_it(row: str) -> None:
    assert row in PAGE
