"""Where a run stands in its campaign, by adding up what was done before it."""

from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import h5netcdf
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers.netcdf import write_recording
from analysis.recording import Recording
from hardware.description.channels import FORCE_AFT
from hardware.description.errors import ConfigurationError
from hardware.description.kinds import RunKind
from pmm.campaign.campaign import Campaign, Simulation
from pmm.campaign.clock import clock_of
from pmm.campaign.order import made_in_order, place_in
from pmm.campaign.runs import AtRest, Run
from sim.effects.campaign import CampaignRun
from sim.effects.catalogue import catalogue

RUNS = (Run("a", 0.5, 0.02, periods=6), Run("b", 1.0, 0.02, periods=6), Run("c", 2.0, 0.01))
# Settling, the periods, and one more: (3 + 6 + 1) / 0.5 Hz, and so on.
TOOK_S = (20.0, 10.0, 7.0)
WAITING_S = 100.0
ZEROS = tuple(AtRest(f"zero-{at}", RunKind.ZERO, f"zero-{at}.nc", 30.0) for at in (1, 2))


def campaign(runs: tuple[Run, ...], zeros: tuple[AtRest, ...] = ()) -> Campaign:
    return Campaign(
        runs=runs, at_rest=zeros, simulation=Simulation(settling_periods=3, waiting_s=WAITING_S)
    )


def test_runs_alone_follow_each_other_in_the_files_order() -> None:
    """Whatever their numbers are."""
    runs = tuple(replace(one, number=9 - at) for at, one in enumerate(RUNS))
    places = [place_in(campaign(runs), one) for one in runs]
    assert [one.index for one in places] == [0, 1, 2]
    assert [one.since_start_s for one in places] == [0.0, 120.0, 230.0]
    assert [one.waited_s for one in places] == [0.0, WAITING_S, WAITING_S]
    assert [one.before for one in places] == [None, RUNS[0].set_point, RUNS[1].set_point]


@pytest.mark.parametrize("numbered", [True, False])
def test_zero_runs_take_their_time(numbered: bool) -> None:
    """Zero, a, b, zero, c: by numbers, or because c names the second as before it."""
    runs, zeros = RUNS, ZEROS
    if numbered:
        runs = tuple(replace(one, number=n) for one, n in zip(RUNS, (2, 3, 5), strict=True))
        zeros = tuple(replace(one, number=n) for one, n in zip(ZEROS, (1, 4), strict=True))
    else:
        runs = (
            replace(RUNS[0], zero_before="zero-1"),
            RUNS[1],
            replace(RUNS[2], zero_before="zero-2"),
        )
    made = campaign(runs, zeros)
    assert [one.name for one in made_in_order(made)] == ["zero-1", "a", "b", "zero-2", "c"]
    since = {one.name: place_in(made, one) for one in (*runs, *zeros)}
    assert {name: one.since_start_s for name, one in since.items()} == {
        "zero-1": 0.0,
        "a": 30.0 + WAITING_S,
        "b": 30.0 + TOOK_S[0] + 2.0 * WAITING_S,
        "zero-2": 30.0 + sum(TOOK_S[:2]) + 3.0 * WAITING_S,
        "c": 60.0 + sum(TOOK_S[:2]) + 4.0 * WAITING_S,
    }
    assert since["c"].index == 2
    assert since["c"].waited_s == 30.0 + 2.0 * WAITING_S
    assert since["c"].before == runs[1].set_point


def test_a_zero_run_after_the_last_that_names_it() -> None:
    runs = (replace(RUNS[0], zero_after="zero-1"), replace(RUNS[1], zero_after="zero-1"), RUNS[2])
    made = made_in_order(campaign(runs, ZEROS[:1]))
    assert [one.name for one in made] == ["a", "b", "zero-1", "c"]


def test_a_record_of_which_nothing_tells_the_time_has_no_place() -> None:
    made = campaign(RUNS, ZEROS)
    assert made_in_order(made) == RUNS
    with pytest.raises(ConfigurationError, match="nothing says when 'zero-2' was made; number all"):
        place_in(made, ZEROS[1])


def _recorded(folder: Path, began_min: Sequence[float | None]) -> Campaign:
    """Write a record of 50 s at each of these minutes of one night; return their campaign."""
    night = datetime(2026, 3, 28, 23, 0, tzinfo=UTC)
    for one, minute in zip(RUNS, began_min, strict=True):
        utc = {} if minute is None else {"started_utc": str(night + timedelta(minutes=minute))}
        made = Recording(one.name, (FORCE_AFT,), np.ones((1, 501)), 10.0, provenance=utc)
        write_recording(made, folder / f"{one.name}.nc")
    return campaign(RUNS)


def test_what_recordings_say_of_their_times_counts(tmp_path: Path) -> None:
    """Made in another order than the file's, the last one the next morning."""
    made = _recorded(tmp_path, (20.0, 0.0, 600.0))
    clock = clock_of(made, tmp_path)
    a, b, c = (place_in(made, one, clock) for one in made.runs)
    assert [one.index for one in (b, a, c)] == [0, 1, 2]
    assert [one.since_start_s for one in (b, a, c)] == [0.0, 1200.0, 36000.0]
    assert [one.waited_s for one in (b, a, c)] == [0.0, 1150.0, 34750.0]
    assert [one.before for one in (b, a, c)] == [None, RUNS[1].set_point, RUNS[0].set_point]


@pytest.mark.parametrize("began_min", [(0.0, 20.0, None), (0.0, 20.0, 20.5)])
def test_times_that_are_not_all_there_or_do_not_fit_do_not_count(
    began_min: tuple[float | None, ...], tmp_path: Path
) -> None:
    """A rig that is simulated faster than time has records that overlap."""
    made = _recorded(tmp_path, began_min)
    assert not clock_of(made, tmp_path)
    assert place_in(made, made.runs[1], clock_of(made, tmp_path)).waited_s == WAITING_S


@pytest.mark.parametrize("told", ["[1, 2]", "7", "null", '{"started_utc": 7}', "no JSON"])
def test_what_is_no_time_does_not_count(told: str, tmp_path: Path) -> None:
    made = _recorded(tmp_path, (0.0, 20.0, 600.0))
    with h5netcdf.File(tmp_path / "b.nc", "a") as file:
        file.attrs["provenance"] = told
    assert not clock_of(made, tmp_path)


@given(st.floats(0.0, 1e12), st.sampled_from(sorted(catalogue())))
def test_no_campaign_is_too_long_for_an_effect(since_s: float, name: str) -> None:
    place = CampaignRun(3, since_s, since_s, RUNS[0].set_point)
    assert catalogue()[name]().at_run(place).name == name
