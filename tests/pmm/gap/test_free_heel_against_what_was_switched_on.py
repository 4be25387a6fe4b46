"""A model that is free to roll, simulated and recorded: nothing is named, or what was put in."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.pmm.coefficients.test_free_heel_against_linear_response import FILE
from tests.pmm.gap.rigs import run

FRICTION_N = 0.1  # of forces of 5 N, read with 0.01 N of noise
LOOKED_FOR = [
    part
    for name in ("coulomb-friction", "cubic-damping", "amplifier-lag")
    for part in ("--effects", name)
]
RUNS = {"slow": (0.15, 60.0, 0.0), "sway": (0.25, 30.0, 0.0), "yaw": (0.25, 60.0, 64.28)}
REST = '[[at_rest]]\nname = "rest"\nfile = "rest.nc"\nkind = "zero"\nduration_s = 10.0\n'


def campaign() -> str:
    head = FILE[: FILE.index("[[at_rest]]")]
    return f"{head}{REST}number = 1\n" + "".join(
        f'[[runs]]\nname = "{name}"\nfrequency_hz = {hertz}\neccentricity_mm = {size}\n'
        f'strut_phase_deg = {phase}\nperiods = 6\nnumber = {k}\nzero_before = "rest"\n'
        "carriage_speed_m_s = 1.2\n"
        for k, (name, (hertz, size, phase)) in enumerate(RUNS.items(), 2)
    )


def told(folder: Path, *options: str) -> dict[str, Any]:
    """What the command says of what the rig records with something switched on."""
    (folder / "made.toml").write_text(campaign(), encoding="utf-8")
    done = run("simulate", folder / "made.toml", "--output", folder / "rig", *options)
    assert done.exit_code == 0, done.output
    done = run("gap", folder / "rig", *LOOKED_FOR, "--jobs", "1", "--json")
    assert done.exit_code == 0, done.output
    return dict(json.loads(done.stdout))


@pytest.mark.slow
def test_a_rig_that_is_as_it_is_believed_has_no_gap(tmp_path: Path) -> None:
    assert told(tmp_path)["verdict"] == "none"


@pytest.mark.slow
def test_friction_is_named_with_its_size(tmp_path: Path) -> None:
    found = told(tmp_path, "--effect", f"coulomb-friction:friction_n={FRICTION_N}")
    assert found["verdict"] == "effect"
    assert found["ranking"][0]["probability"] > 0.9
    (effect,) = found["ranking"][0]["effects"]
    friction = effect["parameters"]["friction_n"]
    assert friction["low"] < FRICTION_N < friction["high"]
    assert friction["value"] == pytest.approx(FRICTION_N, rel=0.05)
