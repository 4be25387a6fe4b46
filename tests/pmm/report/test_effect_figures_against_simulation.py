"""What the figures of chain and signature show, against the simulation that they are drawn from."""

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import SetPoint
from pmm.document.style import render
from pmm.report.chain_figures import chain_figure, traces
from pmm.report.signature_figure import channels_of, signature_figure, signature_grid
from sim.effects.catalogue import build
from sim.rig import SimulatedRig, vertical_rig

RIG = vertical_rig().ideal()
HEAVE = SetPoint(0.8, 0.02)
PERIOD_S = 1.0 / 0.8


def stretch(rig: SimulatedRig, set_point: SetPoint = HEAVE):  # type: ignore[no-untyped-def]
    return traces(rig, set_point, sample_rate_hz=200.0, settling_periods=3, seed=1)


def changed(text: str, set_point: SetPoint = HEAVE):  # type: ignore[no-untyped-def]
    return stretch(build(text).change(RIG, set_point), set_point)


def test_traces_begin_at_the_pulse() -> None:
    found = stretch(RIG)
    at_pulse = found.at("displacement_aft", np.array([0.0, PERIOD_S]))
    assert at_pulse == pytest.approx([0.0, 0.0], abs=1e-9)
    assert found.time_s[0] < 0.0 < 2.0 * PERIOD_S < found.time_s[-1]
    assert np.min(np.abs(found.edges_s)) == 0.0


def test_a_late_photocell_is_seen_as_a_turn_of_all_signals() -> None:
    nominal, late = stretch(RIG), changed("photocell-delay:delay_s=0.01")
    own = nominal.values["displacement_aft"]
    other = late.at("displacement_aft", nominal.time_s)
    expected = 0.02 * np.sin(2.0 * np.pi * 0.8 * (nominal.time_s + 0.01))
    np.testing.assert_allclose(other[20:-20], expected[20:-20], atol=1e-8)
    assert np.abs(other - own).max() > 5e-4


def test_difference_of_the_figure_is_the_effect() -> None:
    nominal, rough = stretch(RIG), changed("coulomb-friction:friction_n=2")
    figure = chain_figure(nominal, rough, PERIOD_S, "run", "effect")
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    for stage in ("drive", "mechanism", "model and water", "dynamometers", "acquisition"):
        assert stage in titles
    assert "carriage" not in titles  # it stands still
    right = figure.axes[titles.index("model and water") + 1]
    values = right.get_lines()[0].get_ydata()
    inside = (nominal.time_s >= 0.0) & (nominal.time_s <= 2.0 * PERIOD_S)
    gap = (rough.values["force_aft"] - nominal.values["force_aft"])[inside]
    np.testing.assert_array_equal(values, gap)
    assert np.abs(values).max() == pytest.approx(2.0)
    assert titles[titles.index("mechanism") + 1] == "no difference"


def test_nominal_run_alone_has_one_column() -> None:
    nominal = stretch(RIG)
    figure = chain_figure(nominal, None, PERIOD_S, "run")
    inside = (nominal.time_s >= 0.0) & (nominal.time_s <= 2.0 * PERIOD_S)
    drawn = [axes.get_lines()[0] for axes in figure.axes]
    assert all(np.array_equal(line.get_xdata(), nominal.time_s[inside]) for line in drawn)
    assert len({axes.get_subplotspec().colspan.start for axes in figure.axes}) == 1  # type: ignore[union-attr]


def test_a_moving_carriage_is_shown() -> None:
    found = stretch(RIG, SetPoint(0.8, 0.02, 0.0, 1.2))
    figure = chain_figure(found, None, PERIOD_S, "run")
    assert "carriage" in [axes.get_title(loc="left") for axes in figure.axes]


def test_grid_holds_theory_and_simulation_over_both() -> None:
    effect = build("quadratic-damping:rotation_n_m_s2=0")
    grid = signature_grid(effect, RIG, HEAVE)
    assert grid.amplitudes_m == pytest.approx([0.01, 0.02, 0.03])
    assert (grid.frequencies_hz[0], grid.frequencies_hz[-1]) == pytest.approx((0.4, 1.2))
    key = ("force_aft", 1)
    assert grid.simulated[key] == pytest.approx(grid.theory[key], rel=1e-4)
    # As frequency squared and amplitude squared.
    size = grid.theory[key].imag
    law = np.outer(grid.amplitudes_m**2, grid.frequencies_hz**2)
    assert size / size[0, 0] == pytest.approx(law / law[0, 0], rel=1e-9)
    assert ("force_aft", 2) not in grid.simulated


@pytest.mark.slow
def test_figure_has_theory_as_lines_and_simulation_as_circles() -> None:
    effect = build("connecting-rod")
    grid = signature_grid(effect, RIG, HEAVE)
    figure = signature_figure(effect, grid, "parameters")
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert any(title.endswith(": mean") for title in titles)
    axes = figure.axes[titles.index("force_aft: in phase 2")]
    line, circles = axes.get_lines()[:2]
    assert (line.get_marker(), circles.get_marker()) == ("None", "o")
    np.testing.assert_array_equal(line.get_ydata(), grid.theory["force_aft", 2][0].real)
    again = signature_figure(effect, grid, "parameters")
    assert render(figure, "png", "one") == render(again, "png", "one")


def test_limits_of_the_oscillator_hold() -> None:
    grid = signature_grid(build("cable"), RIG, SetPoint(1.9, 0.055))
    assert grid.amplitudes_m.max() <= RIG.oscillator.eccentricity_m.high
    assert grid.frequencies_hz.max() <= RIG.oscillator.frequency_hz.high
    with pytest.raises(ConfigurationError, match="frequency_hz"):
        signature_grid(build("cable"), RIG, SetPoint(3.0, 0.02))


def test_channels_are_those_that_theory_names() -> None:
    assert channels_of(build("hum"), RIG, HEAVE) == ("recorded_force_aft", "recorded_force_fore")
    named = channels_of(build("connecting-rod"), RIG, HEAVE)
    assert named[:2] == ("force_aft", "force_fore")
    assert "displacement_aft" in named
