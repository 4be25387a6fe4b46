"""X_0 and X_vv of a campaign in a ship's file: one definition, and no thrust in the resistance."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.coefficients.campaign_nonlinear import SURGE_FORCES
from analysis.coefficients.campaign_records import CoefficientEntry
from analysis.coefficients.campaign_result import CampaignCoefficients, no_trials
from analysis.coefficients.exchange import to_dict
from analysis.coefficients.names import Form
from analysis.coefficients.resistance_form import PROPELLED
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from pmm.manoeuvre.prediction import ship_of
from pmm.manoeuvre.ship_file import ShipFile, StatedHull, read_ship

EXAMPLE = Path(__file__).parents[3] / "examples" / "manoeuvre" / "kvlcc2.toml"
SPEED_M_S, X_UU, X_VV = 1.179, -25.0, -45.0
TURNED = Flag(PROPELLED, Severity.NOTE, "its propeller turned", None, ("tow",))


def ship_file(
    folder: Path, x_0_n: float, flags: tuple[Flag, ...] = (), **stated: float
) -> ShipFile:
    """The example with X_0 and X_vv of one tow, X_vv that of a constant speed u ahead."""
    file = read_ship(EXAMPLE)
    assert isinstance(file, ShipFile)
    entries = tuple(
        CoefficientEntry(name, "", SURGE_FORCES, 0.0, SPEED_M_S, 0.0, 0.0, ("tow",), math.nan, 1.0)
        for name in ("X_0", "X_vv")
    )
    values = np.array([x_0_n, X_VV])
    uncertain = UncertainValues(
        values, (Contribution("gauge", np.inf, np.arange(2), 0.01 * values[:, None]),)
    )
    found = CampaignCoefficients(
        Form.MANOEUVRING, Plane.HORIZONTAL, "dimensional", 0.95, entries, uncertain, no_trials(2),
        flags=flags,
    )  # fmt: skip
    place = folder / "coefficients.json"
    place.write_text(json.dumps({"coefficients": to_dict(found)}))
    surge = ("X_0", "X_vv", "X_vr", "X_rr", "X_vvvv")
    rest = {name: one for name, one in file.hull.values.items() if name not in surge}
    return replace(file, hull=StatedHull("mmg", rest | stated), coefficients=str(place))


def test_a_hull_at_a_drift_has_the_force_of_the_polynomial_that_was_measured(
    tmp_path: Path,
) -> None:
    ship = ship_of(ship_file(tmp_path, X_UU * SPEED_M_S**2), 20, 1)
    for u, v in ((SPEED_M_S, 0.0), (1.0, 0.3), (0.6, -0.5)):
        still = np.zeros(ship.count)
        found = ship.hull(still + u, still + v, still)[0]
        assert found[0] == pytest.approx(X_UU * u**2 + X_VV * v**2, rel=1e-9)
        assert np.std(found[1:] / found[0]) == pytest.approx(0.01, rel=0.5), "gauge errors go along"


def test_a_resistance_with_thrust_in_it_is_not_taken(tmp_path: Path) -> None:
    in_thrust = X_UU * SPEED_M_S**2 + 18.0
    with pytest.raises(ConfigurationError, match="X_0 is that of runs whose propeller turned"):
        ship_of(ship_file(tmp_path, in_thrust, (TURNED,)), 0, 1)
    unit = 0.5 * read_ship(EXAMPLE).water.density_kg_m3 * 7.0 * 0.455
    alone = ship_of(ship_file(tmp_path, in_thrust, (TURNED,), X_0=X_UU / unit), 0, 1)
    bare = ship_of(ship_file(tmp_path, X_UU * SPEED_M_S**2), 0, 1)
    assert alone.rate_hz == pytest.approx(bare.rate_hz, rel=1e-9)


def test_runs_of_a_propeller_at_rest_keep_theirs(tmp_path: Path) -> None:
    other = replace(TURNED, runs=("another",))
    ship = ship_of(ship_file(tmp_path, X_UU * SPEED_M_S**2, (other,)), 0, 1)
    assert ship.hull(*np.array([[SPEED_M_S], [0.0], [0.0]]))[0] == pytest.approx(
        X_UU * SPEED_M_S**2
    )
