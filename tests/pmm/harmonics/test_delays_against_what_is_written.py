"""``--delay`` as people write it against the seconds that it means."""

import pytest

from hardware.description.errors import ConfigurationError
from pmm.harmonics.request import HarmonicsRequest


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("F=11.3", 11.3),
        ("F = 11.3 s", 11.3),
        ("F=8/0.5", 16.0),
        ("F=8 m/0.5 m/s", 16.0),
        ("F=8m/0.5", 16.0),
        ("F=-2", -2.0),
    ],
)
def test_seconds_or_a_distance_and_a_speed(text: str, seconds: float) -> None:
    assert HarmonicsRequest(delays=(text,)).delays_s() == {"F": pytest.approx(seconds)}


@pytest.mark.parametrize("text", ["F", "8.2", "=3", "F=", "F=8/0", "F=8,2", "F=nan", "F=8/m"])
def test_others_are_refused_with_what_to_write(text: str) -> None:
    with pytest.raises(ConfigurationError, match="give CHANNEL=SECONDS, or CHANNEL=METRES/SPEED"):
        HarmonicsRequest(delays=(text,)).delays_s()
