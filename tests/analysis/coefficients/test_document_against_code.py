"""The examples of docs/coefficients.md run, and end near what was put in."""

import re
from pathlib import Path

import numpy as np
import pytest

DOCUMENT = Path(__file__).parents[3] / "docs" / "coefficients.md"


@pytest.mark.slow
def test_the_example_runs() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    names: dict[str, object] = {}
    for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        exec(compile(block, str(DOCUMENT), "exec"), names)  # noqa: S102 - our own document
    fit, beside = names["linear"].fit, names["beside"]  # type: ignore[attr-defined]
    put_in = {"Z_wdot": -75.0, "Z_w": -190.0, "M_qdot": -22.0, "M_q": -55.0}
    for name, value in put_in.items():
        k = fit.names.index(name)
        assert abs(fit[name] - value) <= fit.uncertain.half_width(0.999)[k]
    assert names["added_mass"] == fit["Z_wdot"]
    ratio = beside.standard_uncertainty / fit.uncertain.standard_uncertainty  # type: ignore[attr-defined]
    np.testing.assert_allclose(ratio, 1.0, atol=0.1)
    campaign = names["campaign"]
    for k in campaign.rows("Z_wdot"):  # type: ignore[attr-defined]
        width = campaign.uncertain.half_width(0.999)[k]  # type: ignore[attr-defined]
        assert abs(campaign.values[k] + 75.0) <= width  # type: ignore[attr-defined]
    system = "prime (rho/2, L = 2.5 m, U = 1.2 m/s)"
    assert names["in_prime"].normalisation == system  # type: ignore[attr-defined]
    assert names["lines"][0].share > 0.2  # type: ignore[index]


def test_every_flag_is_in_the_document() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    folder = Path(__file__).parents[3] / "analysis" / "coefficients"
    codes = set()
    for path in folder.glob("*.py"):
        codes |= set(re.findall(r'Flag\(\s*"(\w+)"', path.read_text(encoding="utf-8")))
    assert len(codes) >= 7
    assert not [code for code in codes if f"`{code}`" not in text]
