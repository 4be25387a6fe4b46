"""Coefficients beside the effects that a gap names are those that the simulator was given.

Pitch was run at four frequencies and heave in water at one: what heave asks of the moment is told
by what the rod adds at twice the frequency, if each coefficient counts as it does beside the rod.
"""

import json
from pathlib import Path

import pytest

from tests.pmm.gap.rigs import EXAMPLE, run

PUT_IN = ("connecting-rod:rod_length_m=1.5", "coulomb-friction:friction_n=0.3")
RUNS = (
    ("air", 0.5, 20, 0), ("air", 0.7, 20, 180), ("air", 1.1, 20, 0), ("water", 0.5, 20, 180),
    ("water", 0.9, 20, 180), ("water", 0.5, 10, 0), ("water", 0.7, 10, 180),
    ("water", 1.1, 10, 180),
)  # fmt: skip


def _campaign(folder: Path) -> Path:
    head = EXAMPLE.read_text(encoding="utf-8").split("[[runs]]")[0]
    runs = [
        f'[[runs]]\nname = "run-{number}"\nmedium = "{medium}"\nfrequency_hz = {hz}\n'
        f"eccentricity_mm = {mm}\nstrut_phase_deg = {deg}\nperiods = 6\n"
        f"carriage_speed_m_s = {1.2 if medium == 'water' else 0.0}\n"
        for number, (medium, hz, mm, deg) in enumerate(RUNS)
    ]
    (folder / "plan.toml").write_text("\n".join((head, *runs)), encoding="utf-8")
    effects = [word for one in PUT_IN for word in ("--effect", one)]
    done = run("simulate", folder / "plan.toml", "--output", folder / "rig", *effects)
    assert done.exit_code == 0, done.output
    return folder / "rig"


@pytest.mark.slow
def test_every_coefficient_is_the_one_that_was_put_in(tmp_path: Path) -> None:
    names = ",".join(one.split(":")[0] for one in PUT_IN)
    found = run("gap", _campaign(tmp_path), "--effects", names, "--json")
    assert found.exit_code == 0, found.output
    said = json.loads(found.stdout)
    assert {one["name"] for one in said["effects"]} == {*names.split(",")}, said["verdict"]
    rows = {one["name"]: one for one in said["coefficients"]}
    assert len(rows) == 16
    off = {name: (row["with_effect"] - row["stated"]) / row["u_with"] for name, row in rows.items()}
    assert max(map(abs, off.values())) < 3.5, off
    # Without the effects the same coefficient is far off, by its own uncertainty as by this one.
    wrong = rows["M_wdot"]
    assert abs(wrong["without"] - wrong["stated"]) > 5.0 * max(wrong["u_without"], wrong["u_with"])
