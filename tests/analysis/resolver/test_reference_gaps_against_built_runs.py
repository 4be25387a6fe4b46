"""Missing samples in the channel that tells the phase: what is left tells it as well."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.reference import NoReferenceError
from analysis.resolver.reference_choice import ReferenceChoice, choose_reference
from analysis.resolver.settings import ResolverSettings
from hardware.description.channels import Channel
from hardware.description.flags import Severity

TIME_S = np.arange(4000) / 100.0
THETA = 2.0 * np.pi * 0.8 * TIME_S
GAP = slice(1000, 1007)


def run(kind: str, *gaps: slice) -> Recording:
    told = THETA % (2.0 * np.pi) if kind == "shaft_angle" else 0.02 * np.sin(THETA)
    for gap in gaps:
        told[gap] = np.nan
    channels = (Channel(kind, "rad" if kind == "shaft_angle" else "m"), Channel("force", "N"))
    values = np.stack((told, 3.0 + 5.0 * np.sin(THETA + 0.4)))
    return Recording("run", channels, values, 100.0)


@pytest.mark.parametrize("kind", ["shaft_angle", "displacement_aft"])
def test_the_longest_stretch_without_a_gap_tells_the_phase(kind: str) -> None:
    found = analyse(run(kind, GAP))
    (flag,) = (flag for flag in found.flags if flag.code == "reference_gap")
    assert (flag.severity, flag.channel) == (Severity.WARNING, kind)
    assert "missing are 7 samples from 10.000 s on (0.07 s)" in flag.message
    assert "from 10.070 s to 39.990 s" in flag.message
    assert found.readings[0].opened_s > 10.07 - 1e-9
    assert found.readings[0].periods >= 22
    assert found.readings[0].in_phase[0, 0] == pytest.approx(5.0 * np.cos(0.4), rel=1e-4)


@pytest.mark.parametrize("kind", ["shaft_angle", "displacement_aft"])
def test_the_stretch_that_holds_the_gates_opening_goes_first(kind: str) -> None:
    found = analyse(run(kind, GAP), settings=ResolverSettings(opens_s=1.5, periods=4))
    assert found.readings[0].opened_s == pytest.approx(1.5)
    assert found.readings[0].amplitude[0, 0] == pytest.approx(5.0, rel=1e-4)
    after = analyse(run(kind, GAP), settings=ResolverSettings(opens_s=20.0, periods=5))
    assert after.readings[0].opened_s == pytest.approx(20.0)


@pytest.mark.parametrize("kind", ["shaft_angle", "displacement_aft"])
def test_a_gate_that_opens_in_the_gap_is_refused(kind: str) -> None:
    with pytest.raises(NoReferenceError, match=r"no sample at 10\.03 s .* 7 samples from 10\.000"):
        analyse(run(kind, GAP), settings=ResolverSettings(opens_s=10.03))


@pytest.mark.parametrize("kind", ["shaft_angle", "displacement_aft"])
def test_where_nothing_is_left_the_gaps_are_named(kind: str) -> None:
    every = [slice(k, k + 5) for k in range(50, 4000, 80)]
    with pytest.raises(NoReferenceError, match=r"\d+ samples are missing in 50 places, at most 5"):
        choose_reference(run(kind, *every), ReferenceChoice())
    with pytest.raises(NoReferenceError, match="every sample of channel"):
        choose_reference(run(kind, slice(None)), ReferenceChoice())


def test_without_a_gap_nothing_changes() -> None:
    whole = run("displacement_aft")
    assert not analyse(whole).flags
    assert choose_reference(whole, ReferenceChoice(), 20.0).flags == ()


def test_a_gap_in_another_channel_is_no_gap_of_the_reference() -> None:
    whole = run("displacement_aft")
    values = np.array(whole.samples[:, 0:4000])
    values[1, GAP] = np.nan
    codes = {flag.code for flag in analyse(replace(whole, samples=values)).flags}
    assert "reference_gap" not in codes
    assert "stretch_limited" in codes
