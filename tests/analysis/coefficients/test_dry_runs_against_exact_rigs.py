"""Runs in air taken off exact rigs' runs in water, each made a little otherwise."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import fit_cycles
from analysis.coefficients.dry_run import without_dry
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from hardware.description.arrangement import Arrangement
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium
from tests.analysis.coefficients.exact_campaigns import HULLS, RESTORING, struts_of
from tests.exact.hull import polynomial
from tests.exact.rig import ExactRig
from tests.exact.rigs import exact_rig

ORDERS, HERTZ = 7, 0.3
GAUGES = ("force_aft", "force_fore")
MOTIONS = ((0.12, 0.0), (0.0, 0.25))
NAMES = tuple(name for name in HULLS[Plane.HORIZONTAL] if name != "X_vr")


def rig(sway_m: float, turn_rad: float, plane: Plane = Plane.HORIZONTAL, **more: float) -> ExactRig:
    whole = {"frequency_hz": HERTZ, "sway_m": sway_m, "rotation_rad": turn_rad} | more
    made = exact_rig(plane, Arrangement(), **whole)
    hull, restoring = polynomial(HULLS[plane]), RESTORING[plane]
    return replace(made, hull=hull, body=made.body.afloat(), restoring=restoring)


def in_air(wet: ExactRig) -> ExactRig:
    """The same motion where nothing but the body is moved."""
    bare = replace(wet.body, displaced_kg=0.0)
    return replace(wet, hull=polynomial({}), body=bare, restoring=np.zeros((2, 2)), speed_m_s=0.0)


def cycle(one: ExactRig, name: str, gain: float = 1.0, medium: Medium = Medium.WATER) -> BodyCycle:
    struts = struts_of(one, name, ORDERS)
    factors = [gain if label.startswith(GAUGES) else 1.0 for label in struts.phasors.names]
    read = replace(struts, phasors=struts.phasors.mapped(np.diag(factors)))
    return replace(read.model(), medium=medium)


def net(wet: ExactRig, dry: ExactRig, gain: float = 1.0) -> BodyCycle:
    return without_dry(cycle(wet, "wet", gain), cycle(dry, "dry", gain, Medium.AIR))


def named(cycles: list[BodyCycle], names: tuple[str, ...]) -> dict[str, float]:
    fit = fit_cycles(cycles, names, (0, 1, 2, 3))
    return dict(zip(fit.names, fit.values, strict=True))


@pytest.mark.parametrize("faster", [1.0, 1.004])
def test_what_the_water_does_is_left(faster: float) -> None:
    """Of all loads, at another frequency within what is taken for the same, too."""
    cycles = []
    for k, (sway, turn) in enumerate(MOTIONS):
        air = rig(sway, turn, frequency_hz=faster * HERTZ)
        cycles.append(replace(net(rig(sway, turn), in_air(air)), name=f"run {k}"))
    found = named(cycles, NAMES)
    for name in (name for name in NAMES if not name.startswith("X")):
        truth = HULLS[Plane.HORIZONTAL][name]
        assert found[name] == pytest.approx(truth, rel=1e-3), name


def test_x_keeps_nothing_of_the_models_centripetal_load() -> None:
    """In yaw alone, where X_rr r^2 and the mass times x_G r^2 are alike."""
    wet = rig(0.0, 0.25)
    left = net(wet, in_air(wet))
    bodiless = cycle(replace(wet, body=replace(wet.body, mass_kg=0.0, inertia_kg_m2=0.0)), "hull")
    place = left.phasors.index("surge_force 0")
    assert left.phasors.values[place] == pytest.approx(bodiless.phasors.values[place], abs=0.02)


def test_a_gauges_gain_acts_on_what_is_left() -> None:
    wet = [rig(*motion) for motion in MOTIONS]
    dry = [in_air(one) for one in wet]

    def fitted(gain: float) -> np.ndarray:
        cycles = [replace(net(*pair, gain), name=str(k)) for k, pair in enumerate(zip(wet, dry))]  # noqa: B905
        return fit_cycles(cycles, NAMES, (0, 1, 2, 3)).values

    cycles = [replace(net(*pair), name=str(k)) for k, pair in enumerate(zip(wet, dry, strict=True))]
    stated = StatedUncertainties(force_gain_relative=1.0)
    fit = fit_cycles(cycles, NAMES, (0, 1, 2, 3), stated=stated)
    (told,) = [one.dense(len(NAMES))[:, 0] for one in fit.uncertain.contributions
               if one.label == "force_gain_relative"]  # fmt: skip
    shown = (fitted(1.0 + 1e-5) - fitted(1.0 - 1e-5)) / 2e-5
    np.testing.assert_allclose(np.abs(told), np.abs(shown), rtol=1e-3, atol=1e-3 * abs(shown).max())


@pytest.mark.parametrize(
    ("plane", "drift", "said"),
    [
        (Plane.HORIZONTAL, 0.1, "its drift is 0 rad, not 0.1 rad"),
        (Plane.VERTICAL, 0.1, "the model's weight swings in its loads"),
    ],
)
def test_what_no_dry_run_tells_is_refused(plane: Plane, drift: float, said: str) -> None:
    wet = rig(0.05, 0.0, plane, drift_rad=drift)
    own = drift if plane is Plane.VERTICAL else 0.0
    with pytest.raises(ConfigurationError, match=said):
        net(wet, in_air(replace(wet, drift_rad=own)))
