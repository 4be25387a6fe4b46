"""Records that nobody of this project made: the roll decay of a tanker, and its simulation."""

from pathlib import Path

import pytest

from analysis.gap.pendulum.causes import BEYOND_LINEAR, cause, causes_for
from analysis.gap.pendulum.hypothesis import fit
from analysis.gap.pendulum.search import search
from analysis.gap.pendulum.verdict import judge
from analysis.gap.pendulum.withheld import foretell
from hardware.description.errors import ConfigurationError
from pmm.gap.pendulum import load_problem, read_case
from sim.pendulum.effects import body

SHARED = Path(__file__).parents[3].parent / "shared" / "data"
measured = pytest.mark.skipif(not SHARED.exists(), reason="no shared measured data")

ROLL = """
name = "roll decay"
[measured]
record = "{0}/model_test_21337.csv.gz"
channel = "phi"
[simulated]
record = "{0}/fnpf_kvlcc2_rolldecay_0kn.csv.gz"
channel = "phi"
[tolerances]
inertia = 0.01
restoring = 0.01
amplitude_period = 0.05
nonlinear_restoring = 1.0
"""


@measured
def test_roll_decay_misses_damping_beyond_linear(tmp_path: Path) -> None:
    path = tmp_path / "roll.toml"
    path.write_text(ROLL.format(SHARED / "roll_decay"))
    problem = load_problem(path)
    names = ("inertia", "restoring", "viscous_damping", "quadratic_drag", "cubic_damping")
    chosen = [one for one in causes_for(problem.trials) if one.name in names]
    searched = search(problem, chosen, most=1)
    verdict = judge(problem, searched)
    assert set(verdict.best) & set(BEYOND_LINEAR)
    assert verdict.by_class["damping beyond linear"] > 0.99
    assert verdict.by_class["inertia or stiffness"] < 0.01
    quadratic = fit(problem, [cause(body.QuadraticDrag)])
    for regime in foretell(problem, [quadratic]):
        assert regime.foretold[0].shrinkage > 0.9


def test_errors_of_a_file_are_said(tmp_path: Path) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text('name = "x"\n[measured]\nrecord = "a"\nchannel = "b"\n')
    with pytest.raises(ConfigurationError, match="floating"):
        read_case(path)
    path.write_text('name = "x"\ngyradiusm = 1.0\n')
    with pytest.raises(ConfigurationError, match="gyradius_m"):
        read_case(path)
