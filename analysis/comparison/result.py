"""What a comparison found."""

from collections.abc import Mapping
from dataclasses import dataclass

from analysis.comparison.parts import Parts
from analysis.uncertainty.estimate import Estimate
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag


@dataclass(frozen=True, eq=False)
class ComparedTrace:
    """Both channels on the second one's clock, up to twice their highest frequency, in its unit.

    Attributes
    ----------
    measured
        The second channel, shape ``(samples,)``.
    expected
        What gain, lag, clock rate and dead band make of the first one.
    """

    time_s: FloatArray
    measured: FloatArray
    expected: FloatArray


@dataclass(frozen=True, eq=False)
class ChannelComparison:
    """A second channel over a first one: ``second(t) = gain first(t - lag(t))``.

    Attributes
    ----------
    first, second
        Names: recording and channel.
    unit
        Of what the second shows; its derivative's where the first shows one of it.
    order
        The second shows this derivative of the first.
    from_s, to_s, mid_s
        What of the record counted, on the second channel's clock, and its middle.
    motion_hz
        Half of the power lies below.
    band_hz
        Lowest and highest frequency at which the second follows the first.
    gain
        In the second's unit over that of what the first shows.
    lag_s
        Of the second channel behind the first, in the middle of the record.
    modulo_s
        The lag is known but for whole multiples of this; ``None`` where it is known.
    clock_rate
        Growth of the lag, s/s: by how much the second's clock runs fast against the first's.
    levers
        By channel: the arm, in the second's unit over the channel's.
    dead_band
        What the first goes after a reversal before the second follows, in the first's unit;
        ``None`` where it was not looked for.
    dead_band_found
        Whether it stands out; then the other values allow for it.
    over_time, over_frequency
        What single parts say.
    """

    first: str
    second: str
    unit: str
    order: int
    from_s: float
    to_s: float
    mid_s: float
    motion_hz: float
    band_hz: tuple[float, float]
    gain: Estimate
    lag_s: Estimate
    modulo_s: float | None
    clock_rate: Estimate
    levers: Mapping[str, Estimate]
    dead_band: Estimate | None
    dead_band_found: bool
    over_time: Parts
    over_frequency: Parts
    trace: ComparedTrace
    flags: tuple[Flag, ...] = ()

    def lag_at(self, time_s: float) -> Estimate:
        """Return the lag at some time on the second channel's clock.

        In the middle of the record lag and clock rate are as good as independent.
        """
        from_mid_s = time_s - self.mid_s
        grown = self.clock_rate.value * from_mid_s
        moved = self.lag_s.following(self.lag_s.value + grown, 1.0)
        spread = abs(self.clock_rate.uncertainty * from_mid_s)
        return moved.widened(spread, self.clock_rate.degrees_of_freedom)
