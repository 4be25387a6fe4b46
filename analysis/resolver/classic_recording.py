"""The modes of 1963 on a whole recording, and the average over whole samples for comparison."""

from itertools import pairwise

import numpy as np

from analysis.recording import Recording
from analysis.resolver.classic import check_harmonics, products
from analysis.resolver.classic_average import (
    LEAST_TIME_CONSTANT_PERIODS,
    AverageState,
    NeedleReadings,
    RunningAverage,
)
from analysis.resolver.classic_gate import SAMPLE_SLACK, GatedIntegrator
from analysis.resolver.classic_gate_state import GateReading, IntegratorState
from analysis.resolver.reference import PhaseReference
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

_BLOCK_SAMPLES = 65_536  # taken at a time


def running_average(
    recording: Recording,
    reference: PhaseReference,
    *,
    time_constant_s: float | None = None,
    harmonics: int = 3,
) -> NeedleReadings:
    """Watch the needles over a whole recording.

    Parameters
    ----------
    time_constant_s
        By default the shortest allowed, 1.5 periods.

    Raises
    ------
    ConfigurationError
        As :class:`RunningAverage`.
    DataError
        If a sample is missing, or there is none at all.
    """
    recording.check_even("the running average")
    if recording.sample_count == 0:
        raise DataError(f"{recording.name}: no samples; give a recording that has some")
    frequency_hz = reference.frequency_hz
    tau = LEAST_TIME_CONSTANT_PERIODS / frequency_hz if time_constant_s is None else time_constant_s
    mode = RunningAverage(
        recording.channel_names, recording.sample_rate_hz, frequency_hz, tau, harmonics
    )
    state, parts = AverageState(recording.start_s), []
    for start in range(0, recording.sample_count, _BLOCK_SAMPLES):
        values = recording.samples[:, start : start + _BLOCK_SAMPLES]
        state, needles = mode.advance(state, values, reference.cycles_at)
        parts.append(needles)
    return NeedleReadings(
        np.concatenate([part.times_s for part in parts]),
        np.concatenate([part.in_phase for part in parts], axis=-1),
        np.concatenate([part.quadrature for part in parts], axis=-1),
        np.concatenate([part.settled for part in parts]),
    )


def gated_readings(
    recording: Recording,
    reference: PhaseReference,
    *,
    periods: int = 1,
    harmonics: int = 3,
    pulses_s: FloatArray | None = None,
) -> tuple[GateReading, ...]:
    """Read the held integrals, one after the other, the reset pressed after each.

    The pulse that closes a gate does not open the next: there is one reading in ``periods + 1``
    pulse intervals, as on the apparatus.

    Parameters
    ----------
    pulses_s
        By default the recording's photocell edges; without a photocell, where the reference
        completes whole revolutions.

    Raises
    ------
    ConfigurationError
        As :class:`analysis.resolver.classic_gate.GatedIntegrator`.
    DataError
        If not one gate closes within the recording, or a period has too few samples.
    """
    recording.check_even("the gated integration of 1963")
    pulses = _pulses(recording, reference) if pulses_s is None else pulses_s
    numbers = recording.sample_number(pulses)
    inside = (numbers >= -SAMPLE_SLACK) & (numbers <= recording.sample_count - 1 + SAMPLE_SLACK)
    pulses = pulses[inside]
    mode = GatedIntegrator(recording.channel_names, recording.sample_rate_hz, periods, harmonics)
    closing = numbers[inside][periods :: periods + 1]
    if not closing.size:
        raise DataError(
            f"{recording.name}: {len(pulses)} pulses between {recording.start_s:.3f} s and "
            f"{recording.end_s:.3f} s; a gate of {periods} periods needs {periods + 1}"
        )
    # A block ends with the sample after a closing pulse, so that the reset comes before the next.
    ends = np.ceil(closing - SAMPLE_SLACK).astype(np.intp) + 1
    cuts = np.unique(np.concatenate((ends, np.arange(0, ends[-1], _BLOCK_SAMPLES))))
    state, readings = IntegratorState(recording.start_s, waiting_pulses_s=tuple(pulses)), []
    no_pulses = np.empty(0)
    for start, stop in pairwise(cuts):
        values = recording.samples[:, int(start) : int(stop)]
        state = mode.advance(state, values, no_pulses, reference.cycles_at)
        if state.reading is not None:
            readings.append(state.reading)
            state = mode.reset(state)
    return tuple(readings)


def _pulses(recording: Recording, reference: PhaseReference) -> FloatArray:
    if recording.photocell_edges_s is not None:
        return recording.photocell_edges_s
    low, high = reference.cycles_at(np.array([recording.start_s, recording.end_s]))
    return reference.times_at(np.arange(np.ceil(low - 1e-9), np.floor(high + 1e-9) + 1.0))


def rounded_gate(
    recording: Recording,
    reference: PhaseReference,
    opened_s: float,
    closed_s: float,
    harmonics: int = 3,
) -> GateReading:
    """Average the products over a gate cut to whole samples: the rival, not for use.

    What a first digital copy of the apparatus does: the samples from the one nearest the opening
    pulse to the one before that nearest the closing pulse, each counted once. Up to one sample is
    missing or too much.

    Raises
    ------
    DataError
        If the gate does not lie within the recording or holds no sample.
    """
    check_harmonics(harmonics)
    first, end = np.rint(recording.sample_number(np.array([opened_s, closed_s]))).astype(np.intp)
    if not 0 <= first < end <= recording.sample_count:
        raise DataError(
            f"{recording.name}: the gate from {opened_s:.6g} s to {closed_s:.6g} s is samples "
            f"{first} to {end} of {recording.sample_count}; it must lie within the recording"
        )
    times_s = recording.time_s(int(first), int(end))
    values = recording.samples[:, int(first) : int(end)]
    cycles = reference.cycles_at(times_s)
    mean = products(values, cycles, harmonics).mean(axis=-1)
    turns = float(np.diff(reference.cycles_at(np.array([opened_s, closed_s])))[0])
    return GateReading(opened_s, closed_s, round(turns), mean[:, 0::2], mean[:, 1::2])
