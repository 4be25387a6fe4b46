"""A campaign's coefficients through JSON and NetCDF and back: nothing is lost."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from analysis.coefficients.campaign_records import (
    LINEAR,
    CoefficientEntry,
    ConsistencyCheck,
    FormChoice,
    Missing,
    OtherArrangement,
    Outlier,
    ReferenceRow,
)
from analysis.coefficients.campaign_result import (
    CampaignCoefficients,
    TrialColumns,
    no_trials,
)
from analysis.coefficients.exchange import from_dataset, from_dict, to_dataset, to_dict
from analysis.coefficients.names import Form
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane


def campaign(*, drawn: bool = True) -> CampaignCoefficients:
    entries = (
        CoefficientEntry(
            "Y_v", "N s/m", LINEAR, 0.2, 1.2, 0.1, 0.0, ("sway 1", "sway 2"), 0.4, math.nan
        ),
        CoefficientEntry(
            "Y_vvv", "N s3/m3", "higher", math.nan, 1.2, 0.2, 0.1, ("sway 1",), math.nan, 1.1
        ),
        CoefficientEntry("Y_v", "N s/m", LINEAR, 0.1, 1.2, 0.1, 0.0, ("sway 3",), 0.4, math.nan),
    )
    scatter = Contribution(
        "scatter of sway 1", 7.0, np.array([1, 0]), np.array([[1.0, 0.2, 0.1], [0.3, 0.0, -0.5]])
    )
    mass = Contribution("mass_kg", math.inf, np.array([0, 1, 2]), np.array([[0.1], [0.2], [0.1]]))
    trials = TrialColumns(
        100, np.array([1.0, math.nan, 2.0]), np.array([-1.0, math.nan, 3.0]), np.ones(3)
    )
    return CampaignCoefficients(
        Form.MANOEUVRING,
        Plane.HORIZONTAL,
        "dimensional",
        0.95,
        entries,
        UncertainValues(np.array([-120.0, -300.0, -119.0]), (scatter, mass)),
        trials if drawn else no_trials(3),
        choices=(
            FormChoice(
                "force", ("a", "b"), ("cubic", "quadratic"), (3, 3), (4.0, 9.5), (10.0, math.inf),
                (0.9, 0.1), 1.0, "not separable", "linear", 9.0, "take a larger amplitude",
            ),
        ),
        checks=(
            ConsistencyCheck(
                "two tests", "Y_v", "N s/m", "one", "other", 1.0, 2.0, -1.0, 0.5, 8.0, True, ""
            ),
        ),
        outliers=(Outlier("sway 2", ("sway 1", "sway 3"), "force", 9.0, 4.0, "stands off"),),
        arrangements=(
            OtherArrangement(
                "gauges", "model", "rig", math.nan, 3.0, ("N_r", "Y_v"), (3.0, 1.5), "open", "",
            ),
        ),
        missing=(Missing("N_r", "add a run in yaw"),),
        references=(
            ReferenceRow("Y_v", "N s/m", 0.2, 1.2, "strip", 1.0, 0.1, 1.05, -0.05, 0.0, True),
        ),
        flags=(Flag("digits_lost", Severity.WARNING, "a small difference", "Y_v"),),
    )  # fmt: skip


def same(one: CampaignCoefficients, other: CampaignCoefficients) -> None:
    for name in ("form", "plane", "normalisation", "level", "choices", "checks", "outliers"):
        assert getattr(one, name) == getattr(other, name), name
    for name in ("missing", "references", "flags"):
        assert getattr(one, name) == getattr(other, name), name
    for name in ("entries", "arrangements"):  # as text: a NaN is never itself
        assert str(getattr(one, name)) == str(getattr(other, name))
    np.testing.assert_array_equal(one.values, other.values)
    np.testing.assert_array_equal(one.uncertain.covariance(), other.uncertain.covariance())
    np.testing.assert_array_equal(
        one.uncertain.degrees_of_freedom, other.uncertain.degrees_of_freedom
    )
    assert one.trials.count == other.trials.count
    for name in ("standard_uncertainty", "low", "high"):
        np.testing.assert_array_equal(getattr(one.trials, name), getattr(other.trials, name))


@pytest.mark.parametrize("drawn", [True, False])
def test_json_there_and_back(drawn: bool) -> None:
    before = campaign(drawn=drawn)
    text = json.dumps(to_dict(before), allow_nan=False)
    same(before, from_dict(json.loads(text)))


@pytest.mark.parametrize("drawn", [True, False])
def test_netcdf_there_and_back(drawn: bool, tmp_path: Path) -> None:
    import xarray as xr

    before, path = campaign(drawn=drawn), tmp_path / "coefficients.nc"
    to_dataset(before).to_netcdf(path, engine="h5netcdf")
    with xr.open_dataset(path, engine="h5netcdf") as dataset:
        same(before, from_dataset(dataset))


def test_another_file_is_refused() -> None:
    with pytest.raises(DataError, match="schema 'pmm run 1', 'pmm coefficients 1' is needed"):
        from_dict({"schema": "pmm run 1"})


def test_rows_are_found_in_order_of_frequency() -> None:
    found = campaign()
    assert found.rows("Y_v") == [2, 0]
    assert found.rows("Y_vvv") == [1]
    assert found.uncertain.shares(1)["scatter of sway 1"] == pytest.approx(1.05 / 1.09)
    assert found.select([2]).entries[0].runs == ("sway 3",)
