"""The record of a pendulum test, in the schema of every other run."""

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hardware.description import dataset as schema
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity
from hardware.description.version import program
from sim import signals
from sim.pendulum.bench import PendulumBench
from sim.signals import Signals

if TYPE_CHECKING:
    import xarray as xr

    from sim.pendulum.photogate import Photogate


@dataclass(frozen=True, eq=False)
class GateEdges:
    """Edges of one photogate.

    Attributes
    ----------
    time_s
        On the recorder's clock, increasing, shape ``(edges,)``.
    blocked
        Whether the beam is blocked from that edge on, shape ``(edges,)``.
    """

    label: str
    time_s: FloatArray
    blocked: BoolArray


@dataclass(frozen=True, eq=False)
class PendulumRecord:
    """What a test delivers.

    Attributes
    ----------
    dataset
        Channels over time, as :mod:`hardware.description.dataset` says; edges of the first gate are
        its photocell edges. The provenance holds the truth.
    gates
        Every gate's edges with their states.
    truth
        Mass, centre of gravity, inertia: what an estimator is after, by name with unit.
    """

    dataset: "xr.Dataset"
    gates: tuple[GateEdges, ...]
    truth: dict[str, float]

    def write_gates(self, path: str | Path) -> Path:
        """Write the gates' edges as a timer does: one row per edge, a state 0 or 1 per gate.

        Raises
        ------
        DataError
            If the test has no photogate, or the file is there already.
        """
        path = Path(path)
        if not self.gates:
            raise DataError(f"{path}: this test has no photogate, so no edges to write")
        if path.exists():
            raise DataError(f"{path}: the file is there already; choose another name")
        events = sorted(
            (time, k, int(to))
            for k, gate in enumerate(self.gates)
            for time, to in zip(gate.time_s.tolist(), gate.blocked.tolist(), strict=True)
        )
        states = [0] * len(self.gates)
        header = ",".join(["Time", *(f"State at {gate.label}" for gate in self.gates)])
        lines = [header, ",".join(["s"] + ["State"] * len(self.gates))]
        for time, gate, to in events:
            states[gate] = to
            lines.append(",".join([f"{time:.9f}", *map(str, states)]))
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return path


def record(
    bench: PendulumBench,
    *,
    duration_s: float,
    sample_rate_hz: float,
    seed: int,
    name: str = "simulated",
    test: str = "pendulum",
) -> PendulumRecord:
    """Run a test and return its record.

    Parameters
    ----------
    duration_s, sample_rate_hz
        Of the record, by the recorder's own clock.
    seed
        Of every random number: the same seed gives the same record.

    Raises
    ------
    ConfigurationError
        If an argument is out of range.
    """
    _check(duration_s, sample_rate_hz, seed)
    chain = bench.chain()
    count = math.floor(duration_s * sample_rate_hz + 1e-9) + 1
    true_rate_hz = sample_rate_hz * (1.0 + bench.clock_error)
    _, run = chain.run(chain.start(true_rate_hz, seed), count)
    gates = tuple(_gate(photogate, run, bench) for photogate in bench.photogates)
    truth = bench.body.truth
    provenance = {
        "origin": "simulated",
        "simulator": program(),
        "test": test,
        "seed": str(seed),
        "truth": json.dumps(truth),
        "bench": json.dumps(asdict(bench), default=str),  # harmonics of a force are complex
    }
    attributes: dict[str, str | float] = {
        schema.ATTR_SCHEMA: schema.SCHEMA,
        schema.ATTR_NAME: name,
        schema.ATTR_SAMPLE_RATE: float(sample_rate_hz),
        schema.ATTR_PROVENANCE: json.dumps(provenance),
        schema.ATTR_FLAGS: json.dumps([asdict(flag) for flag in _flags(bench, run)]),
    }
    dataset = _dataset(bench, run, count, sample_rate_hz, gates)
    return PendulumRecord(dataset.assign_attrs(attributes), gates, truth)


def _check(duration_s: float, sample_rate_hz: float, seed: int) -> None:
    faults = [
        f"{key} = {value:g} must be finite and above 0"
        for key, value in (("duration_s", duration_s), ("sample_rate_hz", sample_rate_hz))
        if not (math.isfinite(value) and value > 0.0)
    ]
    if seed < 0:
        faults.append(f"seed = {seed} must not be negative")
    if faults:
        raise ConfigurationError("; ".join(faults))


def _gate(gate: "Photogate", run: Signals, bench: PendulumBench) -> GateEdges:
    times = run[gate.edge_time.name] * (1.0 + bench.clock_error) + bench.delay_s
    blocked = run[gate.blocked.name] > 0.5
    order = np.argsort(times, kind="stable")  # jitter may have swapped two
    return GateEdges(gate.label, times[order], blocked[order])


def _flags(bench: PendulumBench, run: Signals) -> tuple[Flag, ...]:
    """Flag each sensor that reaches the end of its range."""
    flags = []
    for sensor in bench.sensors:
        limit = sensor.channel.full_scale
        beyond = 0
        if limit is not None:
            beyond = int(np.count_nonzero(np.abs(run[sensor.signal.name]) >= limit))
        if beyond:
            channel = sensor.channel
            message = (
                f"{channel.name}: {beyond} samples at the end of its range of {limit:.4g} "
                f"{channel.unit}; let the body go from a smaller displacement"
            )
            flags.append(Flag("saturated", Severity.WARNING, message, channel.name))
    return tuple(flags)


def _dataset(
    bench: PendulumBench,
    run: Signals,
    count: int,
    sample_rate_hz: float,
    gates: tuple[GateEdges, ...],
) -> "xr.Dataset":
    import xarray as xr

    variables: dict[str, Any] = {}
    for sensor in bench.sensors:
        channel = sensor.channel
        described: dict[str, str | float] = {schema.UNITS: channel.unit}
        if channel.full_scale is not None:
            described[schema.FULL_SCALE] = channel.full_scale
        values = run[signals.recorded(channel).name]
        variables[channel.name] = (schema.TIME, values, described)
    if gates:
        variables[schema.EDGE_TIME] = (schema.EDGE, gates[0].time_s, {schema.UNITS: "s"})
    stamps = np.arange(count) / sample_rate_hz + bench.delay_s
    time_s = (schema.TIME, stamps, {schema.UNITS: "s"})
    return xr.Dataset(variables, coords={schema.TIME: time_s})
