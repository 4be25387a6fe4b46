"""Optional first stage: phase-sensitive detection of a signal that still rides on a carrier.

A strain gauge bridge fed with a carrier (1000 Hz in 1963) gives ``E(t) e_c sin(w_c t + phi)``. The
product with ``2 sin(w_c t + phi) / e_c`` is ``E(t)`` plus its image at twice the carrier; a
symmetric FIR low-pass takes the image away and its delay, the same for all frequencies, is taken
off the time. An offset of the raw signal lands on the carrier's frequency and goes too.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.recording import Recording
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.channels import SHAFT_ANGLE, Channel
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity

ATTENUATION_DB = 140.0  # of the stop band; the pass band is then flat to 10^(-140/20) = 1e-7
ROOM = 3.0  # carrier, image and output rate over the bandwidth, at least
QUADRATURE_LIMIT = 0.01  # of the detected signal: above, the phase is not the carrier's
_BLOCK_SAMPLES = 1 << 18


@dataclass(frozen=True)
class DecimationFilter:
    """A symmetric FIR low-pass with decimation.

    Attributes
    ----------
    taps
        Shape ``(2 * half + 1,)``; their sum is 1.
    half
        Delay in samples, a multiple of ``decimation``.
    """

    taps: FloatArray
    half: int
    decimation: int

    def valid(self, values: NDArray[np.inexact]) -> NDArray[np.inexact]:
        """Filter and decimate, keeping only outputs that need no sample beyond the ends.

        Output j belongs to input sample ``half + j * decimation``; shape ``(..., samples)`` to
        ``(..., outputs)``.
        """
        from scipy.signal import upfirdn

        full = upfirdn(self.taps, values, up=1, down=self.decimation, axis=-1)
        skipped = 2 * self.half // self.decimation
        return np.asarray(full[..., skipped : skipped + self.outputs(values.shape[-1])])

    def outputs(self, samples: int) -> int:
        """Return how many outputs :meth:`valid` gives."""
        return max(0, (samples - 2 * self.half - 1) // self.decimation + 1)


def design_low_pass(
    sample_rate_hz: float,
    carrier_hz: float,
    bandwidth_hz: float,
    output_rate_hz: float | None = None,
) -> DecimationFilter:
    """Design the filter: flat to 1e-6 up to the bandwidth, carrier and image down by over 100 dB.

    The stop band (Kaiser window, 140 dB) begins a bandwidth below the lowest of the carrier, the
    image at twice the carrier (as sampled) and the output rate, so that nothing folds back into
    the pass band.

    Parameters
    ----------
    output_rate_hz
        A whole fraction of the sample rate; by default the lowest of at least 4 bandwidths.

    Raises
    ------
    ConfigurationError
        If the carrier lies above half the sample rate, the bandwidth is over a third of carrier,
        image or output rate, or the output rate is no whole fraction of the sample rate.
    """
    _check_carrier(sample_rate_hz, carrier_hz, bandwidth_hz)
    decimation = _decimation(sample_rate_hz, bandwidth_hz, output_rate_hz)
    turns = 2.0 * carrier_hz / sample_rate_hz
    limits = {
        "the carrier": carrier_hz,
        "twice the carrier as sampled": abs(turns - round(turns)) * sample_rate_hz,
    }
    if decimation > 1:
        limits["the output rate"] = sample_rate_hz / decimation
    limit_name, lowest_hz = min(limits.items(), key=lambda item: item[1])
    if ROOM * bandwidth_hz > lowest_hz * (1.0 + 1e-12):
        raise ConfigurationError(
            f"bandwidth_hz = {bandwidth_hz:g} is too near {limit_name} at {lowest_hz:g} Hz; at "
            f"most {lowest_hz / ROOM:g} Hz: take a narrower one, or another rate"
        )
    return _kaiser(bandwidth_hz / sample_rate_hz, lowest_hz / sample_rate_hz, decimation)


def _check_carrier(sample_rate_hz: float, carrier_hz: float, bandwidth_hz: float) -> None:
    for name, value in (("carrier_hz", carrier_hz), ("bandwidth_hz", bandwidth_hz)):
        if not value > 0.0:
            raise ConfigurationError(f"{name} = {value:g}: must be above 0")
    if carrier_hz + bandwidth_hz >= sample_rate_hz / 2.0:
        raise ConfigurationError(
            f"carrier_hz = {carrier_hz:g} with {bandwidth_hz:g} Hz either side does not fit below "
            f"half the sample rate, {sample_rate_hz / 2.0:g} Hz; sample faster than "
            f"{2.0 * (carrier_hz + bandwidth_hz):g} Hz"
        )


def _decimation(sample_rate_hz: float, bandwidth_hz: float, output_rate_hz: float | None) -> int:
    if output_rate_hz is None:
        return max(1, int(sample_rate_hz / (4.0 * bandwidth_hz)))
    if not 0.0 < output_rate_hz <= sample_rate_hz:
        raise ConfigurationError(
            f"output_rate_hz = {output_rate_hz:g}: must be above 0 and at most {sample_rate_hz:g}"
        )
    decimation = round(sample_rate_hz / output_rate_hz)
    if abs(sample_rate_hz / output_rate_hz - decimation) > 1e-9 * decimation:
        raise ConfigurationError(
            f"output_rate_hz = {output_rate_hz:g} is no whole fraction of the sample rate of "
            f"{sample_rate_hz:g} Hz; the nearest is {sample_rate_hz / decimation:g} Hz"
        )
    return decimation


def _kaiser(band: float, lowest: float, decimation: int) -> DecimationFilter:
    """Low-pass from ``band`` to ``lowest - band``, both over the sample rate."""
    from scipy.signal import firwin, kaiser_beta

    transition = lowest - 2.0 * band
    length = (ATTENUATION_DB - 7.95) / (2.285 * 2.0 * np.pi * transition)
    half = decimation * int(np.ceil(length / 2.0 / decimation))
    window = ("kaiser", float(kaiser_beta(ATTENUATION_DB)))
    return DecimationFilter(
        np.asarray(firwin(2 * half + 1, lowest / 2.0, window=window, fs=1.0)), half, decimation
    )


def demodulate(
    recording: Recording,
    channels: Sequence[str],
    carrier_hz: float,
    *,
    carrier_phase_rad: float | None = None,
    carrier_amplitude: float = 1.0,
    bandwidth_hz: float = 50.0,
    output_rate_hz: float | None = None,
) -> Recording:
    """Detect the signals that ride on a carrier.

    The recording is half the filter's length shorter at either end, ``start_s`` moved accordingly;
    NaN wherever the filter meets a missing sample.

    Parameters
    ----------
    channels
        Those on the carrier. The others go through the same low-pass, so that all keep the same
        time base and phase; the shaft angle, which jumps at each turn, is only thinned out.
    carrier_phase_rad
        ``phi`` of ``sin(w_c t + phi)`` on the recording's time. By default it is taken, channel by
        channel, from where the quadrature vanishes; that leaves the sign of ``E`` open (phi in
        (-pi/2, pi/2] is chosen), and a flag gives the phase and says so.
    carrier_amplitude
        ``e_c``: the raw signal for ``E = 1``; the channels' unit is kept.
    bandwidth_hz
        Up to here ``E`` comes through unchanged to 1e-6.
    output_rate_hz
        A whole fraction of the sample rate; by default the lowest of at least 4 bandwidths.

    Raises
    ------
    ConfigurationError
        As :func:`design_low_pass`, or if the carrier's amplitude is not above 0.
    DataError
        If there is no such channel, the record is shorter than the filter, or a channel carries no
        signal at the carrier.
    """
    if not carrier_amplitude > 0.0:
        raise ConfigurationError(f"carrier_amplitude = {carrier_amplitude:g}: must be above 0")
    recording.check_even("a carrier's low-pass")
    rate_hz = recording.sample_rate_hz
    low_pass = design_low_pass(rate_hz, carrier_hz, bandwidth_hz, output_rate_hz)
    rows = [recording.index(name) for name in channels]
    samples, detected = _filtered(recording, rows, carrier_hz, low_pass)
    flags, rescaled = [_ends_flag(recording, low_pass)], list(recording.channels)
    for row, signal in zip(rows, detected, strict=True):
        phase, phase_flags = _phase(recording.channels[row].name, signal, carrier_phase_rad)
        samples[row] = (signal * np.exp(-1j * phase)).real / carrier_amplitude
        rescaled[row] = _rescaled(recording.channels[row], carrier_amplitude)
        flags += phase_flags
    return replace(
        recording,
        channels=tuple(rescaled),
        samples=samples,
        sample_rate_hz=rate_hz / low_pass.decimation,
        start_s=recording.start_s + low_pass.half / rate_hz,
        flags=(*recording.flags, *flags),
    )


def _check_length(recording: Recording, low_pass: DecimationFilter) -> None:
    if low_pass.outputs(recording.sample_count) < 2:
        raise DataError(
            f"{recording.name}: {recording.sample_count} samples are too few for the carrier's "
            f"low-pass; at least {2 * low_pass.half + low_pass.decimation + 1} are needed: "
            "give a longer record or a wider bandwidth"
        )


def _filtered(
    recording: Recording, rows: list[int], carrier_hz: float, low_pass: DecimationFilter
) -> tuple[FloatArray, ComplexArray]:
    """All channels low-passed, and those in ``rows`` detected as ``E e_c exp(i phi)``."""
    _check_length(recording, low_pass)
    count, step = low_pass.outputs(recording.sample_count), low_pass.decimation
    samples = np.empty((len(recording.channels), count))
    detected = np.empty((len(rows), count), dtype=np.complex128)
    angle = [k for k, channel in enumerate(recording.channels) if channel.name == SHAFT_ANGLE.name]
    each = max(1, _BLOCK_SAMPLES // step)
    for first in range(0, count, each):
        last = min(first + each, count)
        start, stop = first * step, (last - 1) * step + 2 * low_pass.half + 1
        raw = recording.samples[:, start:stop]
        turns = (carrier_hz * recording.time_s(start, stop)) % 1.0
        carrier = 2.0 * (np.sin(2.0 * np.pi * turns) + 1j * np.cos(2.0 * np.pi * turns))
        samples[:, first:last] = low_pass.valid(raw)
        samples[angle, first:last] = raw[angle, low_pass.half : stop - start : step][
            :, : last - first
        ]
        detected[:, first:last] = low_pass.valid(raw[rows] * carrier)
    return samples, detected


def _phase(name: str, signal: ComplexArray, given_rad: float | None) -> tuple[float, list[Flag]]:
    """Phase of the carrier in one channel, and what is to be said about it."""
    finite = signal[np.isfinite(signal)]
    # The square does not care for the sign of E; its mean points at twice the phase.
    energy, square = float(np.sum(np.abs(finite) ** 2)), complex(np.sum(finite**2))
    if not energy > 0.0:
        raise DataError(f"{name}: no signal at the carrier; name the channels that ride on it")
    phase = float(np.angle(square)) / 2.0 if given_rad is None else given_rad
    quadrature_share = float(np.sqrt(np.sum((finite * np.exp(-1j * phase)).imag ** 2) / energy))
    flags = []
    if given_rad is None:
        message = (
            f"carrier phase {phase:.6f} rad taken from the quadrature's null; the sign of the "
            "signal is not known: if it comes out reversed, put a '-' before its column"
        )
        flags.append(Flag("carrier_phase_estimated", Severity.NOTE, message, channel=name))
    if quadrature_share > QUADRATURE_LIMIT:
        message = (
            f"{quadrature_share:.3g} of the signal stands in quadrature to the carrier phase "
            f"{phase:.6f} rad, more than {QUADRATURE_LIMIT:g}: noise, or wrong carrier frequency "
            "or phase"
        )
        flags.append(Flag("carrier_quadrature", Severity.WARNING, message, channel=name))
    if finite.size < signal.size:
        message = f"{signal.size - finite.size} of {signal.size} samples lost to missing ones"
        flags.append(Flag("carrier_gap", Severity.VOID, message, channel=name))
    return phase, flags


def _ends_flag(recording: Recording, low_pass: DecimationFilter) -> Flag:
    lost_s = low_pass.half / recording.sample_rate_hz
    return Flag(
        "carrier_ends_dropped",
        Severity.NOTE,
        f"{lost_s:.6g} s dropped at either end: half the length of the carrier's low-pass",
    )


def _rescaled(channel: Channel, carrier_amplitude: float) -> Channel:
    if channel.full_scale is None:
        return channel
    return replace(channel, full_scale=channel.full_scale / carrier_amplitude)
