"""K_p and K_pdot of decays against the roll that ``solve_ivp`` makes of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.coefficients.campaign_records import ROLL_DECAY, CoefficientEntry
from analysis.coefficients.campaign_result import CampaignCoefficients, no_trials
from analysis.coefficients.names import Form
from analysis.coefficients.recommendation import recommended
from analysis.coefficients.roll_decay import RollDecay, with_decays
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.heel import Heel, RollConstraint
from hardware.description.oscillator import Plane

GRAVITY = 9.80665
BODY, HEEL = Body(170.0, 120.0), Heel(RollConstraint.SET, inertia_kg_m2=4.6, gm_m=0.02)
K_P, K_PDOT, K_PHI, U_K_PHI = -0.7, -0.9, -0.65, 0.03


def campaign() -> CampaignCoefficients:
    """K_phi at 1.2 m/s, the median of its runs, with its uncertainty."""
    entry = CoefficientEntry("K_phi", "N m", "static drift", 0.0, 1.2, 0, 0, ("a",), 1.0, 1.0)
    scatter = Contribution("scatter", np.inf, np.arange(1), np.array([[U_K_PHI]]))
    values = UncertainValues(np.array([K_PHI]), (scatter,))
    return CampaignCoefficients(Form.MANOEUVRING, Plane.HORIZONTAL, "dimensional", 0.95, (entry,),
                                values, no_trials(1))  # fmt: skip


def decay(k_phi: float, speed_m_s: float) -> RollDecay:
    """The mean time between crossings and the fall of the peaks, from the equation of motion."""
    stiff = BODY.mass_kg * GRAVITY * 0.02 - k_phi

    def rates(_: float, state: np.ndarray) -> list[float]:
        return [state[1], (K_P * state[1] - stiff * state[0]) / (4.6 - K_PDOT)]

    def crossing(_: float, state: np.ndarray) -> float:
        return float(state[0])

    def peak(_: float, state: np.ndarray) -> float:
        return float(state[1])

    peak.direction = crossing.direction = -1.0  # type: ignore[attr-defined]
    found = solve_ivp(rates, (0.0, 20.0), [0.1, 0.0], events=(crossing, peak), rtol=1e-10,
                      atol=1e-13)  # fmt: skip
    period = float(np.diff(found.t_events[0]).mean())
    peaks = found.y_events[1][:, 0]
    fall = float(np.log(peaks[1] / peaks[3]) / 2.0)
    return RollDecay(period, fall / np.hypot(fall, 2.0 * np.pi), speed_m_s=speed_m_s)


def test_a_decay_tells_damping_and_added_inertia() -> None:
    found = with_decays(campaign(), [decay(0.0, 0.0), decay(K_PHI, 1.206)], HEEL, BODY)
    for speed in (0.0, 1.206):
        for name, value in (("K_p", K_P), ("K_pdot", K_PDOT)):
            (row,) = found.rows(name, method=ROLL_DECAY, speed_m_s=speed)
            assert found.values[row] == pytest.approx(value, rel=1e-5), (name, speed)
            assert row in recommended(found)


def test_uncertainties_move_it_as_other_decays_would() -> None:
    nominal, by = decay(K_PHI, 1.2), {"period_s": 0.004, "damping_ratio": 0.002}
    spread = replace(nominal, u_period_s=0.004, u_damping_ratio=0.002, u_gm_m=2e-4)
    found = with_decays(campaign(), [spread], HEEL, BODY)
    values = with_decays(campaign(), [nominal], HEEL, BODY).values
    changes = [
        with_decays(campaign(), [replace(nominal, **{key: getattr(nominal, key) + step})], HEEL,
                    BODY).values - values
        for key, step in by.items()
    ]  # fmt: skip
    changes.append(with_decays(campaign(), [nominal], replace(HEEL, gm_m=0.0202), BODY).values
                   - values)  # fmt: skip
    other = campaign()
    moved = replace(other, uncertain=replace(other.uncertain, values=np.array([K_PHI + U_K_PHI])))
    changes.append(with_decays(moved, [nominal], HEEL, BODY).values - values)
    told = found.uncertain.standard_uncertainty[1:]
    np.testing.assert_allclose(told, np.linalg.norm(changes, axis=0)[1:], rtol=0.01)


def test_what_it_needs_is_said() -> None:
    with pytest.raises(ConfigurationError, match=r"K_p takes mass_kg of \[model\], and inertia"):
        with_decays(campaign(), [decay(0.0, 0.0)], Heel(RollConstraint.SET), BODY)
    with pytest.raises(ConfigurationError, match=r"damping_ratio = 1\.5 between -1 and 1"):
        RollDecay(1.0, 1.5)
