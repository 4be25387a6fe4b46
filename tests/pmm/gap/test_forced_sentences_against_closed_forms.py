"""What is said of linear bodies under a known force, against the closed form of their motion.

The displacement is F / (C - w^2 M + i w B); nothing of the simulator is used.
"""

import json
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from analysis.gap.pendulum.swings import KINDS
from pmm.cli import cli
from tests.pmm.gap.pendulum_problem import load_problem

MASS_KG, DAMPING, STIFFNESS = 70.0, 60.0, 1000.0
RUNS = ((0.4, 30.0), (0.55, 30.0), (0.6, 30.0), (0.9, 30.0))
TRIED = "force,force_sign,sensor_sign,sensor_gain,sensor_delay,damping,inertia,restoring"
BODY = """
name = "closed form"
[floating]
inertia = 50.0
added_inertia = 20.0
restoring = 1000.0
resistance = { viscous = 60.0 }
[tolerances]
restoring = 2e-3
damping = 0.02
force = 2e-3
"""
RUN = """
[[forced]]
name = "{at}"
force = {{ record = "{at}.csv", channel = "force" }}
measured = [{{ record = "{at}.csv", channel = "heave" }}]
"""


def moved(frequency_hz: float, mass_kg: float, damping: float) -> complex:
    """Return the displacement over the force."""
    omega = 2.0 * math.pi * frequency_hz
    return 1.0 / (STIFFNESS - omega**2 * mass_kg + 1j * omega * damping)


def written(
    folder: Path,
    *,
    mass_kg: float = MASS_KG,
    damping: float = DAMPING,
    gain: float = 1.0,
    growth_per_s: float = 0.0,
    late_s: float = 0.0,
    runs: Sequence[tuple[float, float]] = RUNS,
    force_reversed: tuple[int, ...] = (),
    heave_reversed: tuple[int, ...] = (),
) -> Path:
    """Write records and the file that names them."""
    text, noise = BODY, np.random.default_rng(7)
    time_s = np.arange(0.0, 30.0, 0.05)
    for at, (frequency_hz, force_n) in enumerate(runs):
        wave = force_n * np.exp(2j * math.pi * frequency_hz * time_s)
        # under (1 + g t) exp(s t) it is (H (1 + g t) + g dH/ds) exp(s t)
        grown, omega = 1.0 + growth_per_s * time_s, 2j * math.pi * frequency_hz
        still = gain * moved(frequency_hz, mass_kg, damping)
        slope = -(still**2) * (2.0 * omega * mass_kg + damping) / gain
        heave = (still * grown + growth_per_s * slope) * wave
        heave = (heave * np.exp(-omega * late_s)).real
        force = (wave * grown).real * (-1.0 if at in force_reversed else 1.0)
        heave *= -1.0 if at in heave_reversed else 1.0
        force += noise.normal(0.0, 0.01, time_s.size)
        heave += noise.normal(0.0, 1e-5, time_s.size)
        np.savetxt(
            folder / f"{at}.csv", np.column_stack((time_s, force, heave)), delimiter=",",
            header="time_s,force [N],heave [m]", comments="",
        )  # fmt: skip
        text += RUN.format(at=at)
    path = folder / "case.toml"
    path.write_text(text)
    return path


def said(path: Path) -> tuple[str, str, str]:
    """Return the three sentences."""
    words = ["gap", "pendulum", str(path), "--effects", TRIED, "--most", "1", "--json"]
    done = CliRunner().invoke(cli, words)
    assert done.exit_code == 0, done.stderr
    first, second, third = json.loads(done.stdout)["said"]
    return first, second, third


EVERY = tuple(range(len(RUNS)))


@pytest.mark.slow
def test_a_sign_reversed_in_all_runs_is_the_cause(tmp_path: Path) -> None:
    first, second, third = said(written(tmp_path, heave_reversed=EVERY))
    assert first.startswith("The cause: ")
    assert "force_sign (0.50)" in first
    assert "sensor_sign (0.50)" in first
    assert "cannot be told apart by these records" in first
    assert "1.8e+02 degrees" in second
    assert "a push by hand in the positive direction" in third


@pytest.mark.slow
@pytest.mark.parametrize(
    ("runs", "said_of"), [((1,), "Record 1 is half"), ((0, 2), "Records 0 and 2 are half")]
)
def test_a_sign_reversed_in_some_runs_is_told_of_them(
    tmp_path: Path, runs: tuple[int, ...], said_of: str
) -> None:
    first, _, third = said(written(tmp_path, force_reversed=runs))
    assert first == f"{said_of} a turn off: the force or the reading has the other sign there."
    assert (
        third
        == f"Correct {' and '.join(map(str, runs))}, or leave it out of the file, and look again."
    )


def test_tolerances_do_the_same_beside_a_reversed_sign(tmp_path: Path) -> None:
    (tmp_path / "as").mkdir()
    (tmp_path / "turned").mkdir()
    plain = load_problem(written(tmp_path / "as"))
    turned = load_problem(written(tmp_path / "turned", heave_reversed=EVERY))
    own, other = (one.shared_columns * one.uncertainty[:, None] for one in (plain, turned))
    np.testing.assert_allclose(other, own, atol=1e-6)


@pytest.mark.slow
def test_two_scales_are_headed_together_and_the_share_is_theirs(tmp_path: Path) -> None:
    first, second, third = said(written(tmp_path, gain=1.05))
    assert first.startswith(
        ("The cause: force or sensor_gain;", "The cause: sensor_gain or force;")
    )
    assert "off by up to 5 % of its amplitude" in second
    assert "apart by a known weight on the force gauge" in third


@pytest.mark.slow
def test_damping_is_named_alone_and_takes_its_share_at_resonance(tmp_path: Path) -> None:
    more = 1.25 * DAMPING
    first, second, _ = said(written(tmp_path, damping=more))
    assert first.startswith("The cause: damping, which predicts 100 %")
    assert "cannot be told apart" not in first
    ratios = [abs(moved(f, MASS_KG, more) / moved(f, MASS_KG, DAMPING)) for f, _ in RUNS]
    assert f"off by up to {100.0 * (1.0 - min(ratios)):.2g} % of its amplitude" in second


@pytest.mark.parametrize("growth", [0.05, 0.1, 0.22])
def test_a_force_that_grows_is_followed(tmp_path: Path, growth: float) -> None:
    problem = load_problem(written(tmp_path, growth_per_s=growth / 30.0))
    for kind in ("decay", "period"):
        rows = problem.kind == KINDS.index(kind)
        assert np.abs((problem.observed - problem.nominal)[rows]).max() < 1e-3


@pytest.mark.slow
def test_a_delay_of_more_than_half_a_period_is_found(tmp_path: Path) -> None:
    runs = ((0.6, 30.0), (0.9, 30.0), (1.3, 60.0))
    first, second, _ = said(written(tmp_path, late_s=0.45, runs=runs))
    assert first == "The cause: sensor_delay, which predicts 100 % of what it was not fitted to."
    assert "sensor_delay: delay_s = 0.45 " in second
