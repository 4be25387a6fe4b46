"""Turning circles against those that an open simulator computes of the same numbers.

shipmmg 0.0.11 (github.com/ShipMMG/shipmmg, commit b004dab, MIT): ``simulate_mmg_3dof`` on KVLCC2's
numbers with the rudder laid at 15.8 degrees a second to 35 degrees, at tolerances of 1e-8. Its wake
in drift is another law and its drift angle that of the centre of gravity, so both ships here have
no wake and their centre of gravity midships; all other equations are in use.
"""

import math
from dataclasses import replace

import pytest

from analysis.manoeuvring.manoeuvres import turning_circle
from tests.analysis.manoeuvring.published import kvlcc2

SHIP = replace(kvlcc2, X_G=0.0, W_P0=0.0, C1=0.0)
RATE_HZ = 13.449624631352837  # at which shipmmg's propeller turned, and ours has to
SHIPMMG = {
    1.0: (2.5167189420, 1.0627794758, 2.5704244573),
    -1.0: (2.4069477675, 0.9719465111, 2.3584626339),
}
"""Advance, transfer and tactical diameter over the length, to starboard and to port."""


@pytest.mark.sample(1)
@pytest.mark.parametrize("side", SHIPMMG)
def test_a_turning_circle_is_that_of_shipmmg(side: float) -> None:
    ship = SHIP.ship()
    assert ship.rate_hz[0] == pytest.approx(RATE_HZ, rel=1e-12)
    found = turning_circle(ship, side * math.radians(35.0))
    values = (found.advance[0], found.transfer[0], found.tactical_diameter[0])
    assert values == pytest.approx(SHIPMMG[side], rel=2e-6)
