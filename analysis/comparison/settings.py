"""What is asked of a comparison."""

import math
from dataclasses import dataclass
from typing import Final

from hardware.description.errors import ConfigurationError

HIGHEST_ORDER: Final = 3


@dataclass(frozen=True)
class ComparisonSettings:
    """How the second channel shows what the first one shows.

    Attributes
    ----------
    order
        The second is this derivative of the first in time; negative where the first is one of the
        second.
    levers
        Channels beside the first, in its recording, which the second feels too, each by an arm that
        is found: an angle where the sensors stand apart.
    band_hz
        Frequencies that count; ``None`` takes those at which the channels stand out of the noise.
    most_lag_s
        Lags beyond are not looked for; ``None`` takes 10 s, or a quarter of what both recorded.
    from_s, to_s
        Part of the second recording that counts, on its clock.
    """

    order: int = 0
    levers: tuple[str, ...] = ()
    band_hz: tuple[float, float] | None = None
    most_lag_s: float | None = None
    from_s: float = -math.inf
    to_s: float = math.inf

    def check(self) -> None:
        """Refuse what cannot be.

        Raises
        ------
        ConfigurationError
            If it cannot.
        """
        if abs(self.order) > HIGHEST_ORDER:
            raise ConfigurationError(
                f"derivative {self.order}: it should be from -{HIGHEST_ORDER} to {HIGHEST_ORDER}"
            )
        if self.levers and self.order < 0:
            raise ConfigurationError(
                "channels with a lever stand beside the first one, which is then to be the "
                "displacement: change the channels' places"
            )
        if self.band_hz is not None and not 0.0 <= self.band_hz[0] < self.band_hz[1]:
            low, high = self.band_hz
            raise ConfigurationError(f"a band from {low:g} to {high:g} Hz; write the lower first")
        if self.most_lag_s is not None and not 0.0 < self.most_lag_s < math.inf:
            raise ConfigurationError(f"a largest lag of {self.most_lag_s:g} s; it must be above 0")
        if not self.from_s < self.to_s:
            raise ConfigurationError(f"from {self.from_s:g} s to {self.to_s:g} s: nothing is left")
