"""A file of runs on a circle against the rows that were written, and what is wrong in it."""

import math

import pytest

from analysis.coefficients.body_cycle import at_order
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963
from pmm.coefficients.turn_file import read_turns, turn_cycles

HEAD = "run,radius_m,turn_rate_rad_s,drift_deg,force_n,moment_n_m,u_force_n,u_moment_n_m"
ROW = "t1,12.0,-0.0625,4.0,9.31,-2.1,0.02,0.01"
BODY = Body(mass_kg=60.0, inertia_kg_m2=20.0)


def written(tmp_path, *lines: str):
    path = tmp_path / "turns.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_a_row_is_a_run_with_its_velocities(tmp_path) -> None:
    (turn,) = read_turns(written(tmp_path, HEAD, ROW))
    assert (turn.run, turn.radius_m, turn.turn_rate_rad_s) == ("t1", 12.0, -0.0625)
    assert turn.drift_rad == pytest.approx(math.radians(4.0))
    assert turn.surge_force_n is None
    (cycle,) = turn_cycles([turn], HORIZONTAL_1963, BODY)
    assert cycle.speed_m_s == pytest.approx(0.75)
    assert cycle.phasors[at_order("across", 0)].real == pytest.approx(-0.75 * math.sin(0.0698132))
    assert cycle.phasors[at_order("ahead", 0)].real == pytest.approx(0.75 * math.cos(0.0698132))
    assert not cycle.has_surge
    assert turn_cycles([], None, None) == ()


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ((), "no run in it"),
        ((HEAD,), "no run in it"),
        ((HEAD, ROW, ROW.replace("12.0", "twelve")), "row 3: radius_m = 'twelve' is no number"),
        ((HEAD, ROW.replace("12.0", "nan")), "radius_m has to be a finite number"),
        ((HEAD, ROW.replace("12.0", "0.0")), "radius_m = 0 is not > 0"),
        ((HEAD, ROW.replace("-0.0625", "0")), "turn_rate_rad_s = 0 is no circle"),
        ((HEAD.replace("radius_m", "radus_m"), ROW), "did you mean radius_m"),
        ((HEAD.replace(",u_force_n", ""), ROW.replace(",0.02", "")), "u_force_n: Field required"),
        ((HEAD, ROW.replace("-0.0625", "-3.58")), "43 m/s, and no tank tows faster than 20 m/s"),
        ((HEAD, ROW + ",7"), "row 2: more values than the head line has columns"),
    ],
)
def test_what_is_wrong_is_told_with_its_row(tmp_path, lines, told) -> None:
    with pytest.raises(ConfigurationError, match=told):
        read_turns(written(tmp_path, *lines))


def test_no_file_another_plane_and_no_body_are_refused(tmp_path) -> None:
    with pytest.raises(ConfigurationError, match="cannot be read"):
        read_turns(tmp_path / "none.csv")
    turns = read_turns(written(tmp_path, HEAD, ROW))
    with pytest.raises(ConfigurationError, match="horizontal plane"):
        turn_cycles(turns, VERTICAL_1963, BODY)
    with pytest.raises(ConfigurationError, match="state \\[model\\]"):
        turn_cycles(turns, HORIZONTAL_1963, None)
