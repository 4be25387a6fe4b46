"""A gate that runs into the ramp of the reference is said to; one on steady periods is not."""

import numpy as np
import pytest

from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.channels import Channel

RATE_HZ, STOPS_S = 100.0, 40.0


def _recording() -> Recording:
    """A wave maker that fades out over 6 s, and a force that does not know of it yet."""
    time_s = np.arange(6000) / RATE_HZ
    fade = np.clip(1.0 - (time_s - STOPS_S) / 6.0, 0.0, 1.0)
    rng = np.random.default_rng(6)
    rows = np.array([0.02 * fade * np.sin(6.0 * time_s), 15.0 * np.cos(6.0 * time_s)])
    rows += np.array([[1e-5], [1e-2]]) * rng.standard_normal(rows.shape)
    return Recording("run", (Channel("stroke", "m"), Channel("F", "N")), rows, RATE_HZ)


@pytest.mark.parametrize(("opens_s", "said"), [(25.0, False), (33.0, True)])
def test_a_gate_into_the_ramp_is_said(opens_s: float, said: bool) -> None:
    settings = ResolverSettings(opens_s=opens_s, periods=8)
    found = analyse(_recording(), ReferenceChoice(channel="stroke"), settings)
    flags = [flag for flag in found.flags if flag.code == "reference_unsteady"]
    assert bool(flags) is said
    if said:
        assert flags[0].channel == "stroke"
        assert "leaves 0.02 m" in flags[0].message


def test_the_force_alone_would_not_show_it() -> None:
    settings = ResolverSettings(opens_s=33.0, periods=8)
    found = analyse(_recording(), ReferenceChoice(channel="stroke"), settings)
    assert "transient" not in {flag.code for flag in found.readings[0].flags}
