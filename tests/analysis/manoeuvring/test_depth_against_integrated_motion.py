"""Critical and reversal speed of a submerged body against its motion integrated by SciPy."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.manoeuvring.depth import SubmergedBody
from hardware.description.errors import ConfigurationError

# A synthetic body of revolution with small tail planes: unstable at high speed.
L, RHO, G = 4.0, 1000.0, 9.80665
UNIT = 0.5 * RHO * L**3
M, I_Y, X_G, BG = 0.018 * UNIT, 0.0009 * UNIT * L**2, 0.01, 0.02
PRIME = {
    "Z_wdot": -0.016, "Z_qdot": -0.0004, "M_wdot": -0.0005, "M_qdot": -0.0008,
    "Z_w": -0.020, "Z_q": -0.0060, "M_w": 0.0098, "M_q": -0.0040,
}  # fmt: skip
Z_D, M_D = -0.005, -0.0024


def body(**other: float) -> SubmergedBody:
    values = {name: np.array([value]) for name, value in (PRIME | other).items()}
    return SubmergedBody(L, RHO, M, I_Y, X_G, M * G * BG, values)


def rates(
    state: np.ndarray,
    speed: float,
    delta: float = 0.0,
    c: dict[str, float] = PRIME,
    righting_n_m: float = M * G * BG,
) -> np.ndarray:
    """Gertler and Hagen's equations for small motions, written out: w, q, theta, depth."""
    w, q, theta, _ = state
    half = 0.5 * RHO
    z = half * L**2 * speed * c["Z_w"] * w + half * L**3 * speed * c["Z_q"] * q
    z += half * L**2 * speed**2 * Z_D * delta + M * speed * q
    m = half * L**3 * speed * c["M_w"] * w + half * L**4 * speed * c["M_q"] * q
    m += half * L**3 * speed**2 * M_D * delta - M * X_G * speed * q - righting_n_m * theta
    left = np.array(
        [
            [M - half * L**3 * c["Z_wdot"], -M * X_G - half * L**4 * c["Z_qdot"]],
            [-M * X_G - half * L**4 * c["M_wdot"], I_Y - half * L**5 * c["M_qdot"]],
        ]
    )
    return np.array([*np.linalg.solve(left, [z, m]), q, w - speed * theta])


def growth(speed: float) -> float:
    """How much a push is larger after many periods than after few, as a logarithm."""
    times = np.linspace(0.0, 400.0, 4001)
    start = np.array([0.01, 0.0, 0.0, 0.0])
    found = solve_ivp(
        lambda t, y: rates(y, speed), (0.0, 400.0), start, "DOP853", times, rtol=1e-9, atol=1e-14
    )
    size = np.abs(found.y[2])
    return math.log(size[3000:].max() / size[1000:2000].max())


def test_oscillations_grow_above_the_critical_speed_and_die_below() -> None:
    critical = float(body().critical_speed_m_s[0])
    assert 0.5 < critical < 20.0
    assert growth(0.97 * critical) < 0.0 < growth(1.03 * critical)
    assert body().root(critical)[0] == pytest.approx(0.0, abs=1e-9)


def test_a_body_that_is_stable_at_every_speed_has_none() -> None:
    stable = body(M_w=0.001)
    assert stable.index[0] > 0.0 > body().index[0]
    assert np.isinf(stable.critical_speed_m_s[0])
    assert all(stable.root(speed)[0] < 0.0 for speed in (0.5, 5.0, 50.0))


SPEEDS = (0.02, 0.1, 0.4, 1.0, 2.5, 6.0, 15.0, 40.0, 100.0)


def test_no_growing_disturbance_is_called_stable() -> None:
    """By the eigenvalues of the written-out equations, of bodies of any sign and righting."""
    rng = np.random.default_rng(7)
    kinds = set()
    for _ in range(300):
        signs = {name: float(rng.choice([-1.0, 1.0, 1.0])) for name in ("Z_w", "M_w", "M_q", "Z_q")}
        other = {name: sign * PRIME[name] * rng.uniform(0.2, 2.0) for name, sign in signs.items()}
        righting = M * G * BG * float(rng.choice([-1.0, 1.0, 1.0]))
        values = {name: np.array([value]) for name, value in (PRIME | other).items()}
        low, high = SubmergedBody(L, RHO, M, I_Y, X_G, righting, values).stable_speeds_m_s
        for speed in SPEEDS:
            columns = [rates(one, speed, 0.0, PRIME | other, righting)[:3] for one in np.eye(4)[:3]]
            grows = float(np.linalg.eigvals(np.array(columns).T).real.max()) > 0.0
            assert grows != bool(low[0] < speed < high[0]), (other, righting, speed)
        kinds.add((bool(low[0] > 0.0), bool(np.isinf(high[0])), bool(np.isnan(low[0]))))
    # at every speed, below one, above one, at none
    assert kinds == {
        (False, True, False),
        (False, False, False),
        (True, True, False),
        (False, False, True),
    }


def test_a_plane_reverses_where_its_depth_rate_changes_sign() -> None:
    """Where the motion has come to rest: rise or dive of the same plane at two speeds."""
    reversal = float(body().reversal_speed_m_s(Z_D, M_D)[0])

    def depth_rate(speed: float) -> float:
        end = solve_ivp(
            lambda t, y: rates(y, speed, 0.01), (0.0, 2000.0), np.zeros(4), "LSODA", rtol=1e-9
        ).y[:, -1]
        return float(rates(end, speed, 0.01)[3])

    assert reversal < float(body().critical_speed_m_s[0])
    low, high = depth_rate(0.95 * reversal), depth_rate(1.05 * reversal)
    assert low * high < 0.0


def test_what_is_missing_is_said() -> None:
    with pytest.raises(ConfigurationError, match="no M_w: stability in the vertical plane"):
        SubmergedBody(L, RHO, M, I_Y, 0.0, 1.0, {k: np.zeros(1) for k in PRIME if k != "M_w"})
