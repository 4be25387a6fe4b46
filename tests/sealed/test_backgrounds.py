"""What is always on stays unseen: all of it together, in all runs, below one sigma."""

import pytest

from tests.sealed.generator.background import Background
from tests.sealed.generator.case import make
from tests.sealed.generator.effect import heavier
from tests.sealed.generator.parameters import P

pytestmark = pytest.mark.slow  # the time loop takes 20 s to compile


@pytest.mark.parametrize("index", range(1, 13))
def test_noise_free_null_is_the_nominal_within_a_sigma(index: int) -> None:
    case = make(11, index, null=True)
    background = Background(case.situation, case.projection)
    # The ideal has a shaft that nothing moves, and nothing else than the hull as it is.
    assert background.of(case.parameters) < 1.0
    assert case.background == pytest.approx(background.of(case.parameters))
    assert len(case.always) >= 3


def test_a_light_drive_would_be_seen() -> None:
    case = make(11, 1, null=True)
    background = Background(case.situation, case.projection)
    light = case.situation.parameters.copy()
    heavier(light, 5.0 / light[P.MOTOR_INERTIA])
    assert background.of(light) > 3.0
