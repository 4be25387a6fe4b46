"""Tilts under weights that hang below or above the pivot, from the balance of moments itself."""

import math
from pathlib import Path

import pytest
from scipy.optimize import brentq

from pmm.inertia import swing
from pmm.inertia.outcome import Outcome

MASS_KG, MOMENT_KG_M = 42.28, 3.0146


def tilt_rad(weight_kg: float, lever_m: float, drop_m: float, rest_rad: float) -> float:
    """Return the angle at which the swing, at ``rest_rad`` when empty, hangs with a weight."""

    def moment(angle_rad: float) -> float:
        turned = angle_rad - rest_rad
        pull = weight_kg * (lever_m * math.cos(turned) - drop_m * math.sin(turned))
        return pull - MOMENT_KG_M * math.sin(turned)

    return brentq(moment, -0.6, 0.6, xtol=1e-15)


def tilted(folder: Path, levers: str) -> Outcome:
    path = folder / "job.toml"
    path.write_text(
        "gravity_m_s2 = 9.81\nu_gravity_m_s2 = 0.0005\n"
        f"[tare]\nmass_kg = {MASS_KG}\nperiod = {{ period_s = 7.29, u_period_s = 0.001 }}\n{levers}"
    )
    return swing.run(str(path))


def lever(
    name: str,
    lever_m: float,
    drop_m: float,
    weights: list[float],
    *,
    rest_rad: float = 0.0,
    more: str = "",
) -> str:
    tilts = [tilt_rad(weight, lever_m, drop_m, rest_rad) for weight in weights]
    return (
        f'[[tare.levers]]\nname = "{name}"\nlever_m = {lever_m}\ndrop_m = {drop_m}\n{more}'
        f"weight_kg = {weights}\ntilt_rad = {tilts}\n"
    )


@pytest.mark.parametrize("drops", [(0.1, 0.1), (-0.1, -0.1), (0.5, 0.3)])
@pytest.mark.parametrize("rest_rad", [0.0, 1e-3])
def test_the_moment_is_that_of_the_swing_alone(
    drops: tuple[float, float], rest_rad: float, tmp_path: Path
) -> None:
    weights = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    both = zip(("C1", "C2"), (0.2, 0.4), drops, strict=True)
    outcome = tilted(tmp_path, "".join(lever(*one, weights, rest_rad=rest_rad) for one in both))
    found = {one.name: one.estimate.value for one in outcome.findings}
    (test,) = outcome.statics
    # the tangent of a sum is not the sum of the tangents: a few tenths of the offset
    limit = 1e-9 + 0.3 * rest_rad
    assert found["tare_cg_below_pivot_m"] == pytest.approx(MOMENT_KG_M / MASS_KG, rel=limit)
    assert test.result.pooled.offset_rad.value == pytest.approx(rest_rad, abs=1e-5)


def test_the_drops_uncertainty_counts_by_the_weight(tmp_path: Path) -> None:
    """By hand, of one weight: S = m d / tan - m h."""
    outcome = tilted(tmp_path, lever("C", 0.2, 0.1, [0.0, 0.8, 0.8], more="u_drop_m = 0.002\n"))
    below = next(one for one in outcome.findings if one.name == "tare_cg_below_pivot_m")
    assert below.estimate.uncertainty == pytest.approx(0.8 * 0.002 / MASS_KG, rel=1e-4)
