"""Records that nobody of this project made: the roll decay of a tanker, and its simulation."""

import gzip
import math
from pathlib import Path

import numpy as np
import pytest

from analysis.gap.pendulum.causes import BEYOND_LINEAR, cause, causes_for
from analysis.gap.pendulum.further import Reach, propose
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import fit, weigh
from analysis.gap.pendulum.verdict import CAUSE, TOLD_APART, UNTOLD, judge
from analysis.gap.pendulum.withheld import predict_withheld
from analysis.inertia.spread import SURE
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from pmm.gap.pendulum_file import read_case
from sim.pendulum.effects import body, setup
from tests.pmm.gap.pendulum_problem import load_problem
from tests.sealed.recorded import ROD, ROLL

SHARED = Path(__file__).parents[3].parent / "shared" / "data"
measured = pytest.mark.skipif(not SHARED.exists(), reason="no shared measured data")

RELEASED_S = 26.2  # of the model test's record; before that the body is held


def roll(folder: Path, record: str) -> PendulumProblem:
    """Return the problem of one record of the roll decay."""
    path = folder / "roll.toml"
    path.write_text(ROLL.format(record, SHARED / "roll_decay" / "fnpf_kvlcc2_rolldecay_0kn.csv.gz"))
    return load_problem(path)


def swings() -> FloatArray:
    """Return the model test's time in s and roll in rad since the release, shape (samples, 2)."""
    with gzip.open(SHARED / "roll_decay" / "model_test_21337.csv.gz", "rt") as lines:
        rows = np.genfromtxt(lines, delimiter=",", names=True)
    found = np.column_stack((rows["time"], rows["phi"]))
    return np.asarray(found[found[:, 0] > RELEASED_S], np.float64)


def part(rows: FloatArray, name: str) -> FloatArray:
    """Return a half of a record, or the record thinned by means to a rate in Hz."""
    half = len(rows) // 2
    if name in ("first half", "second half"):
        return rows[:half] if name == "first half" else rows[half:]
    each = round(100.0 / float(name.split()[0]))
    kept = rows[: len(rows) // each * each]
    return np.asarray(kept.reshape(-1, each, 2).mean(axis=1), np.float64)


@pytest.mark.slow
@measured
@pytest.mark.parametrize("name", ["whole", "first half", "second half", "10 Hz", "5 Hz"])
def test_roll_decay_misses_damping_beyond_linear(name: str, tmp_path: Path) -> None:
    record = SHARED / "roll_decay" / "model_test_21337.csv.gz"
    if name != "whole":
        record = tmp_path / "part.csv"
        rows = part(swings(), name)
        np.savetxt(record, rows, delimiter=",", header="time,phi", comments="")
    problem = roll(tmp_path, record.as_posix())
    causes = causes_for(problem.trials)
    weighed = weigh(problem, causes, most=2)
    verdict = judge(weighed)
    if name == "second half":  # its decrement hardly changes
        assert verdict.outcome == UNTOLD
        return
    assert verdict.by_class["inertia or stiffness"] < 0.01
    assert verdict.outcome == CAUSE
    assert set(verdict.best.names) & set(BEYOND_LINEAR)
    assert verdict.by_class["damping beyond linear"] > 0.95


@pytest.mark.slow
@measured
def test_quadratic_drag_foretells_the_roll_decay(tmp_path: Path) -> None:
    problem = roll(tmp_path, (SHARED / "roll_decay" / "model_test_21337.csv.gz").as_posix())
    quadratic = fit(problem, [cause(body.QuadraticDrag)])
    for regime in predict_withheld(problem, [quadratic]):
        assert regime.foretold[0].shrinkage > 0.9


def rod(folder: Path, half: int | None = None) -> PendulumProblem:
    """Return the problem of one rod on four suspensions, of a half of each record or of all."""
    tables = []
    for path in sorted((SHARED / "bifilar").glob("*.csv")):
        spacing, line = (float(one[1:]) for one in path.stem.split("_"))
        gates = path
        if half is not None:
            rows = path.read_text().splitlines(keepends=True)
            middle = len(rows) // 2
            gates = folder / path.name
            gates.write_text("".join(rows[:3] + (rows[middle:] if half else rows[3:middle])))
        tables.append(
            f'[[suspensions]]\nname = "{path.stem}"\ngates = "{gates.as_posix()}"\n'
            f"half_spacing_m = {spacing / 2.0}\nline_m = {line}\n"
        )
    file = folder / "rod.toml"
    file.write_text(ROD + "".join(tables))
    return load_problem(file)


@pytest.mark.slow
@measured
@pytest.mark.parametrize("half", [None, 0, 1])
def test_what_makes_a_rods_suspensions_differ_cannot_be_told(
    half: int | None, tmp_path: Path
) -> None:
    problem = rod(tmp_path, half)
    assert judge(weigh(problem, causes_for(problem.trials), most=2)).outcome == UNTOLD


@pytest.mark.slow
@measured
def test_lines_and_clamps_of_a_rod_are_as_large_as_from_the_gyradii(tmp_path: Path) -> None:
    problem = rod(tmp_path)
    both = fit(problem, [cause(setup.LineExcess), cause(setup.ClampMass)])
    excess, share = (
        axis.value(float(unit)) for axis, unit in zip(both.axes, both.units, strict=True)
    )
    assert excess == pytest.approx(0.0141, abs=2e-3)
    assert share == pytest.approx(0.0151, abs=2e-3)
    (regime,) = predict_withheld(problem, [both])
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
    file.write_text(ROD.replace("swings = 60", "swings = 16") + table)
    with pytest.raises(DataError, match="one: 4 windows of swings are too few"):
        load_problem(file)


def test_errors_of_a_file_are_said(tmp_path: Path) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text('name = "x"\n[measured]\nrecord = "a"\nchannel = "b"\n')
    with pytest.raises(ConfigurationError, match="floating"):
        read_case(path)
    path.write_text('name = "x"\ngyradiusm = 1.0\n')
    with pytest.raises(ConfigurationError, match="gyradius_m"):
        read_case(path)
    hung = '[[suspensions]]\nname = "a"\ngates = "a.csv"\nhalf_spacing_m = 0.2\nline_m = 0.6\n'
    for stated in ("", "gyradius_m = -0.3\n"):
        path.write_text(f'name = "x"\n{stated}{hung}')
        with pytest.raises(ConfigurationError, match="gyradius_m is needed by"):
            read_case(path)
