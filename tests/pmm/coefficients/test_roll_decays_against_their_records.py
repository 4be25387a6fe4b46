"""K_p from what ``pmm inertia pendulum`` tells of roll that ``solve_ivp`` made."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import solve_ivp

from analysis.coefficients.roll_decay import RollDecay, with_decays
from hardware.description.errors import ConfigurationError
from pmm.cli import cli
from pmm.coefficients.settings import read_settings
from tests.analysis.coefficients.test_roll_decay_against_solve_ivp import (
    BODY,
    GRAVITY,
    HEEL,
    K_P,
    K_PDOT,
    campaign,
)

RELEASES_RAD = (0.10, 0.11, 0.12)
JOB = """
name = "roll, afloat"
axis = "roll"
[period]
records = ["roll-0.csv", "roll-1.csv", "roll-2.csv"]
channel = "heel"
"""
DECAY = """
[[roll_decays]]
result = "roll.json"
u_gm_m = 2e-4
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three decays at rest as an inclinometer reads them, and what the command says of them."""
    place = tmp_path_factory.mktemp("decays")
    time_s = np.arange(0.0, 40.0, 0.05)
    stiff, generator = BODY.mass_kg * GRAVITY * 0.02, np.random.default_rng(29)

    def rates(_: float, state: np.ndarray) -> list[float]:
        return [state[1], (K_P * state[1] - stiff * state[0]) / (4.6 - K_PDOT)]

    for k, release in enumerate(RELEASES_RAD):
        rolled = solve_ivp(rates, (0.0, 40.0), [release, 0.0], "DOP853", time_s, rtol=1e-9)
        read = rolled.y[0] + 1e-4 * generator.standard_normal(time_s.size)
        columns = np.column_stack((time_s, read))
        path = place / f"roll-{k}.csv"
        np.savetxt(path, columns, "%.7f", ",", header="time [s],heel [rad]", comments="")
    (place / "roll.toml").write_text(JOB, encoding="utf-8")
    ran = CliRunner().invoke(cli, ["inertia", "pendulum", str(place / "roll.toml"), "--json"])
    assert ran.exit_code == 0, ran.stderr
    (place / "roll.json").write_text(ran.stdout, encoding="utf-8")
    return place


def decay_of(folder: Path, text: str) -> RollDecay:
    path = folder / "coefficients.toml"
    path.write_text(text, encoding="utf-8")
    (decay,) = read_settings(path).roll_decays
    return decay


def test_a_named_result_gives_what_the_equation_was_made_of(folder: Path) -> None:
    decay = decay_of(folder, DECAY)
    assert decay.period_degrees_of_freedom < 100.0
    assert 2.0 <= decay.damping_degrees_of_freedom < 100.0
    assert decay.u_gm_m == 2e-4
    found = with_decays(campaign(), [decay], HEEL, BODY)
    spread = found.uncertain.standard_uncertainty
    for name, value in (("K_p", K_P), ("K_pdot", K_PDOT)):
        (row,) = found.rows(name, method="roll decay")
        assert 0.0 < spread[row] < 0.1 * abs(value)
        assert found.values[row] == pytest.approx(value, rel=2e-3), name


def test_what_is_wrong_with_it_is_said_once(folder: Path) -> None:
    (folder / "other.json").write_text('{"results": {}}', encoding="utf-8")
    for text, said in (
        (DECAY.replace("roll.json", "none.json"), "tells no period_s and no small_damping_ratio"),
        (DECAY.replace("roll.json", "other.json"), "`pmm inertia pendulum FILE --json` of roll"),
        (DECAY + "period_s = 1.6\n", "and period_s are both given; leave one of them out"),
    ):
        with pytest.raises(ConfigurationError, match=said) as raised:
            decay_of(folder, text)
        assert len(str(raised.value).splitlines()) <= 2
