"""A hull's matrices, as a campaign reports them, are what its own simulated runs give."""

import numpy as np
import pytest

from analysis.coefficients.hull_coefficients import as_reported
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from tests.analysis.coefficients.campaign import loaded, pure
from tests.sim.manoeuvring import from_added_mass_and_damping

RIGS = [vertical_rig().ideal(), horizontal_rig().ideal()]


@pytest.mark.sample(5)
@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.oscillator.plane)
@pytest.mark.parametrize("form", list(Form))
@pytest.mark.parametrize(("speed_m_s", "ahead_m"), [(0.0, 0.0), (1.5, 0.0), (1.5, -0.3)])
def test_names_signs_point_and_incidence(
    rig: SimulatedRig, form: Form, speed_m_s: float, ahead_m: float
) -> None:
    points = pure(0.8, 1e-6, speed_m_s)  # matrices are those of small angles
    runs = [loaded(rig, one, name=str(k)).about(ahead_m) for k, one in enumerate(points)]
    solved = linear_fit(runs, form, StatedUncertainties()).fit
    said = as_reported(
        np.array(rig.water.added_mass),
        np.array(rig.water.damping),
        rig.oscillator.plane,
        form,
        point_ahead_m=ahead_m,
        speed_m_s=speed_m_s,
        frequency_hz=0.8,
    )
    assert set(said) == set(solved.names)
    expected = [float(said[name]) for name in solved.names]
    np.testing.assert_allclose(solved.values, expected, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.oscillator.plane)
def test_derivatives_are_those_that_the_simulator_was_given(rig: SimulatedRig) -> None:
    water = rig.water
    put_in = from_added_mass_and_damping(water.added_mass, water.damping)
    matrices = np.array(water.added_mass), np.array(water.damping)
    said = as_reported(*matrices, rig.oscillator.plane, Form.MANOEUVRING)
    rates = [value for name, value in said.items() if name.endswith("dot")]
    others = [value for name, value in said.items() if not name.endswith("dot")]
    np.testing.assert_array_equal(rates, np.transpose(put_in.acceleration).ravel())
    np.testing.assert_array_equal(others, np.transpose(put_in.velocity).ravel())
