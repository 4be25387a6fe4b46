"""What a further run tells, against physics: what only it can tell."""

from dataclasses import replace

import numpy as np
import pytest

from tests.sealed.generator.case import Case, make
from tests.sealed.generator.catalogue import BY_NAME
from tests.sealed.generator.further import parsed
from tests.sealed.generator.kinds import Content
from tests.sealed.generator.sizing import Sized
from tests.sealed.generator.worth import Told, sizes_of

SEED, INDEX = 11, 10  # a campaign of which no run is in air
RIGHT = {"mass-error"}


@pytest.fixture(scope="module")
def heavier() -> Case:
    """Return a campaign in water alone, whose model is 3 % heavier than believed."""
    case = make(SEED, INDEX, null=True)
    assert {run.medium for run in case.campaign.runs} == {"water"}
    there = Sized(BY_NAME["mass-error"], 0.03, {}, 0.0)
    content = Content("single", "gap", (there,), (("mass-error",),), (there.effect.stage,))
    return replace(case, content=content)


@pytest.mark.slow
def test_only_a_run_in_air_tells_the_model_s_mass_from_the_water_s(heavier: Case) -> None:
    sizes, last = sizes_of(heavier), heavier.campaign.runs[-1]
    # Fewer runs than it has: the same physics in a third of the time.
    told = Told.by(heavier, heavier.campaign.runs[:3], sizes)
    wet = heavier.campaign.runs[0]
    again = {"frequency_hz": wet.frequency_hz, "eccentricity_m": wet.eccentricity_m,
             "strut_phase_rad": wet.strut_phase_rad,
             "carriage_speed_m_s": wet.carriage_speed_m_s}  # fmt: skip
    dry = {**again, "medium": "air", "carriage_speed_m_s": 0.0}
    before, in_water, in_air, at_rest = (
        (told + Told.by(heavier, [parsed(one, last)], sizes) if one else told).log_odds(RIGHT, (4,))
        for one in (None, {**again, "medium": "water"}, dry, {"kind": "rest"})
    )
    assert in_air > in_water + 1.0
    assert at_rest == pytest.approx(before, abs=0.5)
    assert np.isfinite(in_air)
