"""Oracles: the convolution with the kernel, Kramers and Kronig's relations, and the energy."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import simpson

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim.model.water.radiation import Radiation, constant
from tests.sim.model.water.ladder import Ladder
from tests.sim.model.water.passivity import is_passive
from tests.sim.model.water.retardation import retardation


def random_passive(seed: int, blocks: int = 3, size: int = 2) -> Radiation:
    ladder = Ladder(blocks, size)
    numbers = np.random.default_rng(seed).normal(size=sum(map(len, ladder.bases)))
    found = ladder.matrices(numbers)
    gain = np.zeros((ladder.states, 2))
    gain[:, :size] = found.input
    return Radiation(np.diag([3.0, 2.0]), found.state, gain, gain.T)


def decaying() -> Radiation:
    """One state per motion, K = K_0 exp(-beta t): the catalogue's closed form for a memory."""
    return Radiation(
        np.diag([5.0, 1.0]), np.diag([-2.0, -3.0]), np.diag([4.0, 1.0]), np.diag([4.0, 1.0])
    )


def test_exponential_kernel_in_closed_form() -> None:
    """A - A_inf = -K_0/(beta^2 + w^2), B = K_0 beta/(beta^2 + w^2)."""
    omega = np.array([0.0, 0.4, 2.0, 17.0])
    a, b = decaying().added_mass(omega), decaying().damping(omega)
    np.testing.assert_allclose(a[:, 0, 0], 5.0 - 16.0 / (4.0 + omega**2), rtol=1e-13)
    np.testing.assert_allclose(b[:, 0, 0], 32.0 / (4.0 + omega**2), rtol=1e-13)
    np.testing.assert_array_equal(a[:, 0, 1], 0.0)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_states_do_what_the_convolution_does(seed: int) -> None:
    """mu(t) = int K(t - s) v(s) ds by trapezium, against the states by exact steps."""
    radiation, step = random_passive(seed), 2e-3
    time = np.arange(3000) * step
    velocity = np.stack([np.sin(3.1 * time) * np.exp(-0.3 * time), np.sin(1.7 * time) ** 2])
    kernel = retardation(radiation, time)
    convolved = sum(
        np.array([np.convolve(kernel[:, i, j], velocity[j])[: time.size] for i in (0, 1)])
        - (np.outer(kernel[0, :, j], velocity[j]) + np.outer(kernel[:, :, j].T[:, :1], 0.0)) / 2.0
        for j in (0, 1)
    )
    states = np.array(step_through(radiation, velocity, step))
    np.testing.assert_allclose(
        step * np.asarray(convolved), states, atol=2e-5 * np.abs(states).max()
    )


def step_through(radiation: Radiation, velocity: FloatArray, step: float) -> FloatArray:
    """Advance the states by exact steps, the velocity linear between samples."""
    from scipy.signal import cont2discrete

    n = radiation.states
    a, b, c, d, _ = cont2discrete(
        (radiation.state_matrix, radiation.input_matrix, radiation.output_matrix, np.zeros((2, 2))),
        step,
        method="foh",
    )
    state, loads = np.zeros(n), np.empty_like(velocity)
    for i in range(velocity.shape[1]):
        loads[:, i] = c @ state + d @ velocity[:, i]
        state = a @ state + b @ velocity[:, i]
    return loads


@pytest.mark.parametrize("seed", [4, 5])
def test_kramers_and_kronig(seed: int) -> None:
    """K(t) = (2/pi) int B cos(w t) dw, and A(w) = A_inf - (1/w) int K(t) sin(w t) dt."""
    radiation = random_passive(seed, blocks=2)
    slowest = -np.linalg.eigvals(radiation.state_matrix).real.max()
    time = np.linspace(0.0, 25.0 / slowest, 10_001)
    kernel = retardation(radiation, time)
    for omega in (0.3, 1.1, 4.0):
        sine = simpson(kernel * np.sin(omega * time)[:, None, None], time, axis=0)
        cosine = simpson(kernel * np.cos(omega * time)[:, None, None], time, axis=0)
        a = radiation.added_mass_infinite - sine / omega
        np.testing.assert_allclose(radiation.added_mass(omega), a, atol=1e-4 * np.abs(a).max())
        scale = np.abs(radiation.memory(omega)).max()
        np.testing.assert_allclose(radiation.damping(omega), cosine, atol=1e-4 * scale)


def test_kernel_starts_at_the_integral_of_the_damping() -> None:
    """K(0) = (2/pi) int_0^inf B dw."""
    radiation = random_passive(6)
    omega = np.concatenate([np.linspace(0.0, 50.0, 50_001), np.geomspace(50.0, 1e6, 20_000)[1:]])
    integral = np.trapezoid(radiation.damping(omega), omega, axis=0) * 2.0 / math.pi
    scale = np.abs(integral).max()
    np.testing.assert_allclose(retardation(radiation, np.zeros(1))[0], integral, atol=1e-4 * scale)


@given(seed=st.integers(0, 10**6), blocks=st.integers(2, 5), size=st.integers(1, 2))
def test_every_ladder_is_passive_and_has_no_damping_at_rest(
    seed: int, blocks: int, size: int
) -> None:
    radiation = random_passive(seed, blocks, size)
    assert is_passive(radiation)
    omega = np.geomspace(1e-3, 1e3, 400)
    damping = radiation.damping(omega)
    symmetric = (damping + damping.swapaxes(1, 2)) / 2.0
    memory = radiation.memory(omega)
    hermitian = (memory + memory.conj().swapaxes(1, 2)) / 2.0
    scale = np.abs(memory).max()
    assert np.linalg.eigvalsh(symmetric).min() > -1e-12 * scale
    assert np.linalg.eigvalsh(hermitian).min() > -1e-12 * scale
    # What is left of two coupled motions at rest is skew: it does no work.
    still = radiation.memory(0.0)
    assert np.abs(still + still.T).max() < 1e-8 * scale


@pytest.mark.slow
@given(seed=st.integers(0, 10**6), motion=st.integers(0, 10**6))
def test_no_motion_gets_energy_out_of_the_water(seed: int, motion: int) -> None:
    """Work up to any time exceeds what the states hold, |xi|^2/2: for random piecewise motions."""
    radiation, step = random_passive(seed), 0.01
    from scipy.linalg import expm

    generator = np.random.default_rng(motion)
    held = np.repeat(generator.normal(size=(2, 20)), 25, axis=1)
    n = radiation.states
    # xi and the work, exactly, for a velocity held over each step: work' = v C xi.
    state, work, worst = np.zeros(n), 0.0, 0.0
    for velocity in held.T:
        drive = np.zeros((n + 2, n + 2))
        drive[:n, :n], drive[:n, n] = radiation.state_matrix, radiation.input_matrix @ velocity
        drive[n + 1, :n] = velocity @ radiation.output_matrix
        after = expm(drive * step) @ np.concatenate([state, [1.0, work]])
        state, work = after[:n], after[n + 1]
        worst = min(worst, work - 0.5 * state @ state)
    assert worst > -1e-9 * (1.0 + abs(work))


def test_a_narrow_negative_stretch_is_seen() -> None:
    """A weak resonance of the wrong sign: 1e-4 wide, far from the main pole."""
    good = decaying()
    for gain, passive in ((1e-3, True), (-1e-3, False)):
        sharp = np.array([[0.0, 30.0], [-30.0, -1e-4 * 30.0]])
        inputs = np.array([[0.0, 0.0], [1.0, 0.0]])
        assert is_passive(good.joined(sharp, inputs, gain * inputs.T)) is passive


def test_coupling_beyond_the_diagonal_is_not_passive() -> None:
    """B_12 above sqrt(B_11 B_22) gives energy to some combination of both motions."""
    for factor, passive in ((0.5, True), (1.5, False)):
        kernel = np.array([[4.0, 2.0 * factor], [2.0 * factor, 1.0]])
        coupled = Radiation(np.eye(2), -2.0 * np.eye(2), np.eye(2), kernel)
        assert is_passive(coupled) is passive


def test_no_states_is_a_constant_added_mass() -> None:
    still = constant([[3.0, 0.5], [0.5, 2.0]])
    assert still.states == 0
    assert is_passive(still)
    np.testing.assert_array_equal(still.added_mass([0.0, 9.0])[1], [[3.0, 0.5], [0.5, 2.0]])
    assert not still.damping([0.0, 1.0]).any()


def test_is_a_value() -> None:
    assert random_passive(1) == random_passive(1)
    assert hash(random_passive(1)) == hash(random_passive(1))
    assert random_passive(1) != random_passive(2)
    with pytest.raises(ValueError, match="read-only"):
        random_passive(1).state_matrix[0, 0] = 1.0


def test_rows_of_a_file_are_as_good_as_arrays() -> None:
    from pydantic import TypeAdapter, ValidationError

    memory = random_passive(1)
    names = ("added_mass_infinite", "state_matrix", "input_matrix", "output_matrix")
    rows = {name: getattr(memory, name).tolist() for name in names}
    read = TypeAdapter(Radiation).validate_python
    assert read(rows) == memory == Radiation(**rows)
    assert Radiation(np.eye(2).tolist(), [], [], []) == constant(np.eye(2))  # type: ignore[arg-type]
    with pytest.raises(ValidationError, match=r"input_matrix\n.*list of rows of numbers"):
        read({**rows, "input_matrix": [[1.0, 0.0], [1.0]]})
    with pytest.raises(ConfigurationError, match="output_matrix has to be a list of rows"):
        Radiation(**{**rows, "output_matrix": "heave"})
    with pytest.raises(ValidationError, match="inputmatrix"):
        read({**rows, "inputmatrix": []})


def test_refuses_what_is_not_a_fading_memory() -> None:
    with pytest.raises(ConfigurationError, match=r"eigenvalue with real part 0\.5"):
        Radiation(np.eye(2), np.array([[0.5]]), np.zeros((1, 2)), np.zeros((2, 1)))
    with pytest.raises(ConfigurationError, match=r"input_matrix has shape \(2, 1\)"):
        Radiation(np.eye(2), -np.eye(1), np.zeros((2, 1)), np.zeros((2, 1)))
    with pytest.raises(ConfigurationError, match="not finite"):
        constant([[np.nan, 0.0], [0.0, 0.0]])


@pytest.mark.parametrize("share", [0.3, -1.0, 2.0])
def test_water_is_carried_along_or_passed(share: float) -> None:
    with pytest.raises(ConfigurationError, match=rf"aboard has {share:g}; .* 0 .* or 1"):
        Radiation(
            np.eye(2), -np.eye(1), np.zeros((1, 2)), np.zeros((2, 1)), aboard=np.array([share])
        )
