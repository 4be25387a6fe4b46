"""Records that nobody of this project made: the roll decay of a tanker, and its simulation."""

import math
from pathlib import Path

import pytest

from analysis.gap.pendulum.causes import BEYOND_LINEAR, cause, causes_for
from analysis.gap.pendulum.further import Reach, propose
from analysis.gap.pendulum.hypothesis import fit
from analysis.gap.pendulum.search import search
from analysis.gap.pendulum.verdict import TOLD_APART, judge
from analysis.gap.pendulum.withheld import foretell
from analysis.inertia.spread import SURE
from hardware.description.errors import ConfigurationError, DataError
from pmm.gap.pendulum import load_problem
from pmm.gap.pendulum_file import read_case
from sim.pendulum.effects import body, setup

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


ROD = """
name = "rod"
gyradius_m = 0.343
gravity_m_s2 = 9.81
swings = 60
[tolerances]
inertia = 0.05
restoring = 3e-4
amplitude_period = 0.02
line_excess = 5e-4
spacing = 2.5e-4
"""


@measured
def test_what_makes_a_rods_suspensions_differ_cannot_be_told(tmp_path: Path) -> None:
    """The same causes and sizes as from the gyradii alone, and no more sure: lines and clamps."""
    tables = []
    for path in sorted((SHARED / "bifilar").glob("*.csv")):
        spacing, line = (float(one[1:]) for one in path.stem.split("_"))
        tables.append(
            f'[[suspensions]]\nname = "{path.stem}"\ngates = "{path.as_posix()}"\n'
            f"half_spacing_m = {spacing / 2.0}\nline_m = {line}\n"
        )
    file = tmp_path / "rod.toml"
    file.write_text(ROD + "".join(tables))
    problem = load_problem(file)
    both = fit(problem, [cause(setup.LineExcess), cause(setup.ClampMass)])
    excess, share = (
        axis.value(float(unit))
        for one, unit in zip(both.causes, both.units, strict=True)
        for axis in one.axes
    )
    assert excess == pytest.approx(0.0141, abs=2e-3)
    assert share == pytest.approx(0.0151, abs=2e-3)
    (regime,) = foretell(problem, [both])
    assert regime.name == "each suspension"
    assert 0.3 < regime.foretold[0].shrinkage < SURE
    other = fit(problem, [cause(setup.LineExcess), cause(setup.SpacingError)])
    (further,) = propose(problem, both, other, reach=Reach((0.16, 0.16), (1.1, 1.1)))
    assert further.gain > 2.0 * math.log(TOLD_APART)


@measured
def test_too_few_swings_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "rod.toml"
    gates = next((SHARED / "bifilar").glob("*.csv")).as_posix()
    table = (
        f'[[suspensions]]\nname = "one"\ngates = "{gates}"\nhalf_spacing_m = 0.2\nline_m = 0.6\n'
    )
    file.write_text(ROD.replace("swings = 60", "swings = 24") + table)
    with pytest.raises(DataError, match="one: 6 windows of swings are too few"):
        load_problem(file)


def test_errors_of_a_file_are_said(tmp_path: Path) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text('name = "x"\n[measured]\nrecord = "a"\nchannel = "b"\n')
    with pytest.raises(ConfigurationError, match="floating"):
        read_case(path)
    path.write_text('name = "x"\ngyradiusm = 1.0\n')
    with pytest.raises(ConfigurationError, match="gyradius_m"):
        read_case(path)
