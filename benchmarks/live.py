"""What the live resolver takes of a core, and whether its final values are the batch's."""

import time
from dataclasses import dataclass

import numpy as np

from analysis.recording import Recording
from analysis.resolver.classic_average import AverageState, RunningAverage
from analysis.resolver.estimate import resolve
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.live_resolver import LiveResolver
from analysis.resolver.photocell import from_photocell
from analysis.resolver.sums import period_sums
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.signals import Truth, draw_coefficients, recorded

_CHANNELS = 16
_RATE_HZ = 10_000.0
_BLOCK = 100
_GATE_PERIODS = 4
_NOISE = 0.1


@dataclass(frozen=True)
class _Run:
    """What processing a run block by block took, in seconds of processor time."""

    total_s: float
    worst_s: float
    finals: list[Harmonics]


def run(quick: bool, report: Report) -> Outcome:
    """Play a minute of motion at 1 Hz and at 0.1 Hz to the resolver."""
    rows: list[Row] = []
    measured: dict[str, float] = {"difference": 0.0}
    for frequency_hz, key in ((1.0137, "share_1_hz"), (0.10137, "share_0_1_hz")):
        seconds = (10.0 if frequency_hz > 0.5 else 55.0) if quick else 60.0
        report(f"{frequency_hz:g} Hz")
        recording = _record(frequency_hz, seconds)
        rounds = 1 if quick else 3
        ours, rival = _interleaved(recording, frequency_hz, rounds)
        measured[key] = ours.total_s / seconds
        difference = _difference(recording, ours.finals)
        measured["difference"] = max(measured["difference"], difference)
        for name, found in (("live resolver", ours), ("running average of 1963", rival)):
            rows.append(_row(name, frequency_hz, seconds, found, rival))
        rows[-2]["final readings"] = len(ours.finals)
        rows[-2]["largest difference from the batch"] = difference
    caption = f"{_CHANNELS} channels at 10 kHz in blocks of 10 ms, harmonics 1 to 3"
    return Outcome({caption: rows}, measured, _notes(rounds))


def _notes(rounds: int) -> tuple[str, ...]:
    return (
        f"Processor time, the better of {rounds} interleaved rounds; the resolver gates "
        f"{_GATE_PERIODS} periods and shows the needles (`provisional()`) after every block.",
        "The rival is the running average of 1963 as this project keeps it, in the same blocks.",
        "The worst block is the one in which a pulse came: the whole period is summed then, as the "
        "batch would.",
    )


def _record(frequency_hz: float, seconds: float) -> Recording:
    rng = np.random.default_rng(1963)
    truth = Truth(frequency_hz, 0.3, draw_coefficients((10.0, 1.0, 0.3, 0.1), _CHANNELS, rng))
    times_s = np.arange(round(seconds * _RATE_HZ)) / _RATE_HZ
    samples = truth.values(times_s)
    samples += _NOISE * rng.standard_normal(samples.shape)
    return recorded(samples, _RATE_HZ, truth.edges_s(float(times_s[-1])))


def _interleaved(recording: Recording, frequency_hz: float, rounds: int) -> tuple[_Run, _Run]:
    ours, rivals = [], []
    for _ in range(rounds):
        ours.append(_resolve(recording))
        rivals.append(_average(recording, frequency_hz))
    return _best(ours), _best(rivals)


def _best(runs: list[_Run]) -> _Run:
    return min(runs, key=lambda one: one.total_s)


def _resolve(recording: Recording) -> _Run:
    resolver = LiveResolver(recording.channels, _RATE_HZ, periods=_GATE_PERIODS)
    pulses = _pulses(recording)
    coming, finals, took = 0, [], []
    for start in range(0, recording.sample_count, _BLOCK):
        block = recording.samples[:, start : start + _BLOCK]
        started = time.thread_time()
        finals += resolver.push(block)
        while coming < len(pulses) and pulses[coming] * _RATE_HZ < start + _BLOCK:
            finals += resolver.pulse(pulses[coming])
            coming += 1
        resolver.provisional()
        took.append(time.thread_time() - started)
    return _Run(sum(took), max(took), finals + resolver.finish())


def _average(recording: Recording, frequency_hz: float) -> _Run:
    mode = RunningAverage(recording.channel_names, _RATE_HZ, frequency_hz, 1.5 / frequency_hz)
    reference = from_photocell(np.asarray(_pulses(recording)))
    state, took = AverageState(0.0), []
    mode.advance(state, recording.samples[:, :_BLOCK], reference.cycles_at)  # loads its filter
    for start in range(0, recording.sample_count, _BLOCK):
        block = recording.samples[:, start : start + _BLOCK]
        started = time.thread_time()
        state, _ = mode.advance(state, block, reference.cycles_at)
        took.append(time.thread_time() - started)
    return _Run(sum(took), max(took), [])


def _pulses(recording: Recording) -> list[float]:
    edges_s = recording.photocell_edges_s
    return [] if edges_s is None else edges_s.tolist()


def _difference(recording: Recording, finals: list[Harmonics]) -> float:
    """Return the largest difference of a coefficient from the batch's, over all gates."""
    reference = from_photocell(np.asarray(_pulses(recording)))
    sums = period_sums(recording, reference)
    gates = range(sums.period_count - _GATE_PERIODS + 1)
    batch = [resolve(recording, sums[k : k + _GATE_PERIODS]) for k in gates]
    return max(
        float(np.abs(live.coefficients - whole.coefficients).max())
        for live, whole in zip(finals, batch, strict=True)
    )


def _row(name: str, frequency_hz: float, seconds: float, found: _Run, rival: _Run) -> Row:
    blocks = seconds * _RATE_HZ / _BLOCK
    return {
        "method": name,
        "motion, Hz": frequency_hz,
        "share of a core, %": 100.0 * found.total_s / seconds,
        "time over the rival": found.total_s / rival.total_s,
        "mean block, us": 1e6 * found.total_s / blocks,
        "worst block, ms": 1e3 * found.worst_s,
        "final readings": "",
        "largest difference from the batch": "",
    }


BENCHMARK = Benchmark("live", "Live", run)
