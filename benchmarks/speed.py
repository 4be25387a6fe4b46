"""Time of the period sums over that of a plain sum and of a matrix product, and of rivals."""

import importlib.util
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.estimate import resolve
from analysis.resolver.photocell import from_photocell
from analysis.resolver.sums import period_sums
from analysis.threads import cores, spread
from benchmarks import speed_rivals
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.signals import Truth, draw_coefficients, recorded
from benchmarks.timing import Contender, interleave
from hardware.description.arrays import FloatArray

Rival = Callable[[FloatArray, float, float], FloatArray]

_CHANNELS = 8
_AMPLITUDES = (10.0, 1.0, 0.3, 0.1)
_FREQUENCY_HZ = 1.0 + 1.0 / 97.3  # commensurate with neither rate
_SUM = "plain sum"
_SHARED_SUM = f"{_SUM}, {cores()} threads"
_QUIET = 1.05  # time by the clock over a core's part of the processor's: above, others had a core
_PRODUCT = "matrix product of the same size"
_OURS = "period sums"
_SHARED = f"period sums, {cores()} threads"
_NAIVE = "sine and cosine per channel and harmonic"
_NAIVE_PIECE = f"{_NAIVE}, in a piece that the cache holds"


@dataclass
class _Field:
    """A record, and who is timed on it; ``found`` keeps the coefficients of the last call."""

    truth: Truth
    rate_hz: float
    recording: Recording
    samples: FloatArray
    found: dict[str, FloatArray] = field(default_factory=dict)
    contenders: list[Contender] = field(default_factory=list)

    def add_rival(
        self, name: str, rival: Rival, part: int, channels: int = 0, rounds: int = 2
    ) -> None:
        """Enter a rival that gets the first ``1 / part`` of the samples, of some channels only."""
        channels = channels or len(self.samples)
        piece = self.samples[:channels, : self.samples.shape[1] // part]
        scale = part * len(self.samples) / channels

        def call() -> None:
            self.found[name] = rival(piece, self.rate_hz, self.truth.frequency_hz)

        self.contenders.append(Contender(name, call, scale, rounds))

    def add_ours(self, name: str, threads: int) -> None:
        """Enter the period sums alone, and with what makes harmonics of them."""
        edges_s = self.recording.photocell_edges_s
        reference = from_photocell(np.empty(0) if edges_s is None else edges_s)

        def whole() -> None:
            sums = period_sums(self.recording, reference, threads=threads)
            self.found[name] = resolve(self.recording, sums).coefficients

        def alone() -> None:
            period_sums(self.recording, reference, threads=threads)

        whole()  # gives the error
        self.contenders.append(Contender(name, alone))
        self.contenders.append(Contender(f"{name}, and harmonics with intervals", whole))

    def error(self, name: str) -> float | str:
        """Return the largest error of an in-phase or quadrature part."""
        found = self.found.get(name.removesuffix(", and harmonics with intervals"))
        if found is None:
            return ""
        return float(np.abs(found - self.truth.coefficients[: len(found)])[:, 1:].max())


def _field(count: int, rate_hz: float) -> _Field:
    rng = np.random.default_rng(1963)
    truth = Truth(_FREQUENCY_HZ, 0.0, draw_coefficients(_AMPLITUDES, _CHANNELS, rng))
    samples = np.empty((_CHANNELS, count))
    step = 1_000_000
    for start in range(0, count, step):
        numbers = np.arange(start, min(start + step, count))
        samples[:, numbers[0] : numbers[-1] + 1] = truth.values(numbers / rate_hz)
    recording = recorded(samples, rate_hz, truth.edges_s((count - 1) / rate_hz))
    return _Field(truth, rate_hz, recording, samples)


def run(quick: bool, report: Report) -> Outcome:
    """Time a long record and runs of a minute."""
    report("making the record")
    long, notes = _long(1_000_000 if quick else 10_000_000, quick=quick)
    interleave(long.contenders, 2 if quick else 15, report)
    minute = _minute()
    interleave(minute.contenders, 3 if quick else 20, report)
    best = {c.name: c.best_processor_s for c in long.contenders}
    measured = {
        "over_sum": best[_OURS] / best[_SUM],
        "over_product": best[_OURS] / best[_PRODUCT],
        "sine_and_cosine_over_ours": best[_NAIVE] / best[_OURS],
        "sine_and_cosine_in_cache_over_ours": best[_NAIVE_PIECE] / best[_OURS],
    }
    clock = {c.name: c.best_s for c in long.contenders}
    if cores() == 2 and clock[_SHARED_SUM] < _QUIET * best[_SHARED_SUM] / cores():
        measured["two_threads_over_one"] = clock[_SHARED] / clock[_OURS]
    tables = {
        f"Eight channels of {long.samples.shape[1]:,} samples, 10 kHz": _rows(long),
        "Runs of a minute: eight channels at 200 Hz": _run_rows(minute),
    }
    return Outcome(tables, measured, notes)


def _long(count: int, *, quick: bool) -> tuple[_Field, tuple[str, ...]]:
    long = _field(count, 10_000.0)
    long.contenders.append(Contender(_SUM, long.samples.sum))
    parts = np.array_split(long.samples, cores())
    long.contenders.append(
        Contender(_SHARED_SUM, lambda: spread(np.ndarray.sum, parts, len(parts)))
    )
    basis = np.random.default_rng(7).standard_normal((count, 7))
    long.contenders.append(Contender(_PRODUCT, lambda: long.samples @ basis))
    notes = [
        "No noise: the errors are the methods' own. Each rival got the first part of the record "
        "that its row names, and its time is scaled up in proportion. The best round counts, "
        "of fifteen for the sums, of two for the rivals, one after the other in each round.",
        "The nearest bins and the plain products suffer from a record that is not whole periods; a "
        "user would cut it first.",
        f"The matrix product is that of the samples with a basis of {basis.shape[1]} columns as "
        "long as they are, on one thread: what the sums would cost at least if the basis were made "
        "before. It reads that basis from memory too, which the sums need not.",
        "Times are of the processor, all threads together, so that what else the machine does "
        "counts less; the gain by threads is by the clock, and judged only where the plain sum by "
        "as many threads had its cores to itself.",
        "A plain sum is as fast as one core reads memory, so the ratio to it depends on the "
        "machine: how fast its memory is for one core, against how fast that core multiplies.",
    ]
    _enter_ours(long)
    long.add_rival(_NAIVE, speed_rivals.sine_and_cosine, 1, channels=1)
    long.add_rival(_NAIVE_PIECE, speed_rivals.sine_and_cosine, 20)
    long.add_rival("trigonometry reused", speed_rivals.trigonometry_reused, 1)
    long.add_rival("rfft of the whole run", speed_rivals.nearest_bins, 1, channels=1)
    _enter_peers(long, 5 if quick else 20, notes)
    long.add_rival("scipy curve_fit, 8 parameters", speed_rivals.curve_fit, 200, channels=1)
    return long, tuple(notes)


def _minute() -> _Field:
    minute = _field(12_000, 200.0)
    minute.contenders.append(Contender(_SUM, minute.samples.sum))
    _enter_ours(minute)
    minute.contenders.append(Contender("analyse, all of it", lambda: analyse(minute.recording)))
    minute.add_rival(_NAIVE, speed_rivals.sine_and_cosine, 1, rounds=5)
    minute.add_rival("trigonometry reused", speed_rivals.trigonometry_reused, 1, rounds=5)
    minute.add_rival("rfft of the whole run", speed_rivals.nearest_bins, 1, rounds=5)
    _enter_peers(minute, 1, [])
    minute.add_rival("scipy curve_fit, 8 parameters", speed_rivals.curve_fit, 1, rounds=2)
    return minute


def _enter_ours(arena: _Field) -> None:
    arena.add_ours(_OURS, 1)
    if cores() > 1:
        arena.add_ours(_SHARED, cores())


def _enter_peers(arena: _Field, part: int, notes: list[str]) -> None:
    for module, name, rival in (
        ("ulia", "ulia (lock-in)", speed_rivals.ulia),
        ("rota", "rota-order (order tracking)", speed_rivals.rota_order),
    ):
        if importlib.util.find_spec(module) is None:
            notes.append(f"{name} was left out: it is not installed.")
        else:
            arena.add_rival(name, rival, part)


def _rows(arena: _Field) -> list[Row]:
    plain = arena.contenders[0].best_processor_s
    return [
        {
            "method": c.name,
            "measured on": "all" if c.scale == 1.0 else f"1/{c.scale:.0f}",
            "processor, s": c.best_processor_s,
            "over sum": c.best_processor_s / plain,
            "by the clock, s": c.best_s,
            "million samples a second of processor": arena.samples.size / c.best_processor_s / 1e6,
            "largest error of S, C": arena.error(c.name),
        }
        for c in arena.contenders
    ]


def _run_rows(arena: _Field) -> list[Row]:
    ours = next(c.best_processor_s for c in arena.contenders if c.name == _OURS)
    return [
        {
            "method": c.name,
            "processor a run, ms": 1e3 * c.best_processor_s,
            "runs a second": 1.0 / c.best_processor_s,
            f"over {_OURS}": c.best_processor_s / ours,
            "largest error of S, C": arena.error(c.name),
        }
        for c in arena.contenders
    ]


BENCHMARK = Benchmark("speed", "Speed", run)
