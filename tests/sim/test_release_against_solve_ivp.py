"""A model that is let go from a heel: the simulator's roll against ``solve_ivp``."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hardware.description.errors import ConfigurationError
from hardware.description.heel import Heel, RollConstraint
from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Acquisition
from sim.acquisition.digitiser import Digitiser
from sim.model.heel import Heeling
from sim.rest import rig_at_rest
from sim.rig import MODEL_2M5, SimulatedRig, horizontal_rig
from sim.run import simulate

GRAVITY, INERTIA, GM, K_P, K_PDOT = 9.80665, 1.4, 0.03, -0.8, -0.3
POINT = SetPoint(0.1, 0.0, release_rad=-0.2)


def rig(held: RollConstraint) -> SimulatedRig:
    nominal = horizontal_rig()
    return replace(
        nominal,
        body=replace(MODEL_2M5, cg_z_m=0.0),
        acquisition=Acquisition(heel_angle=Digitiser()),
        heel=Heel(held, inertia_kg_m2=INERTIA, gm_m=GM),
        heel_loads={"K_p": K_P, "K_pdot": K_PDOT},
    )


@pytest.mark.parametrize("held", RollConstraint)
def test_it_rolls_from_there_as_the_equation_says_however_it_is_held_else(
    held: RollConstraint,
) -> None:
    own = rig_at_rest(rig(held))
    run = simulate(own, POINT, periods=1, settling_periods=0, sample_rate_hz=50.0, seed=1)
    time_s = run["time"].values

    def rates(_: float, state: np.ndarray) -> list[float]:
        righting = MODEL_2M5.mass_kg * GRAVITY * GM * math.sin(state[0])
        return [state[1], (K_P * state[1] - righting) / (INERTIA - K_PDOT)]

    whole = solve_ivp(rates, (0.0, time_s[-1]), [-0.2, 0.0], "DOP853", time_s, rtol=1e-10)
    assert run["heel_angle"].values == pytest.approx(whole.y[0], abs=1e-6)


def test_a_state_goes_on_and_another_release_begins_anew() -> None:
    from sim.mechanism.geometry import BodyMotion

    still = BodyMotion(*(np.zeros(30) for _ in BodyMotion._fields))
    given = (
        rig(RollConstraint.FREE).heel,
        MODEL_2M5,
        rig(RollConstraint.FREE).heeling(SetPoint(0.1, 0.0)).terms,
    )
    rolled, after = Heeling(*given, release_rad=0.1).rolling(still, (), 0.02)
    more, _ = Heeling(*given, release_rad=0.1).rolling(still, after, 0.02)
    assert abs(more[0, 0] - rolled[0, -1]) < 0.02 * abs(rolled[1, -1]) * 1.01 + 1e-9
    other, _ = Heeling(*given, release_rad=-0.15).rolling(still, after, 0.02)
    assert other[0, 0] == -0.15
    rest, _ = Heeling(*given).rolling(still, after, 0.02)
    assert not rest[0].any()


def test_a_rig_without_heel_lets_nothing_go() -> None:
    with pytest.raises(ConfigurationError, match=r"\[heel\] is missing"):
        horizontal_rig().chain(replace(POINT, frequency_hz=0.5, eccentricity_m=0.01))
