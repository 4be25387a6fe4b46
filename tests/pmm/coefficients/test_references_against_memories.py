"""Oracle: the largest deviation of a memory from the table that it is held against."""

from pathlib import Path

import numpy as np
import pytest

from analysis.coefficients.names import Form
from hardware.description.oscillator import Plane
from pmm.campaign.campaign_file import read_campaign
from pmm.coefficients.references import read_references
from pmm.coefficients.settings import ReferenceFile

EXAMPLE = Path(__file__).parents[3] / "examples" / "gap" / "campaign.toml"


@pytest.mark.parametrize("same", [True, False])
def test_a_reference_that_is_the_memorys_table_allows_for_its_misfit(
    same: bool, tmp_path: Path
) -> None:
    omega = np.linspace(0.5, 20.0, 40)
    memory = 150j * omega / (5.0**2 - omega**2 + 4j * omega) * (1.0 - 0.1 * np.tanh(omega - 5.0))
    rows = zip(omega, 20.0 + memory.imag / omega, memory.real, strict=True)
    text = "omega_rad_s,a33_analytic_kg,b33_analytic_kg_s\n"
    text += "".join(f"{w},{a},{b}\n" for w, a, b in rows)
    for name in ("heave.csv", "other.csv"):
        (tmp_path / name).write_text(text)
    head = '[radiation]\nfile = "heave.csv"\nstates = 2\n\n[hull]'
    (tmp_path / "campaign.toml").write_text(EXAMPLE.read_text().replace("[hull]", head))
    campaign = read_campaign(tmp_path / "campaign.toml")
    file = ReferenceFile(str(tmp_path / ("heave.csv" if same else "other.csv")))
    (found,) = read_references((file,), Plane.VERTICAL, Form.SEAKEEPING, (campaign,))
    fitted = campaign.memory
    assert fitted is not None
    assert fitted.error > 0.02
    assert found.table.allowance_relative == pytest.approx(fitted.error if same else 0.0)
    assert (found.flag is not None) is same
    assert found.flag is None or f"{fitted.error:.2g} at most" in found.flag.message
