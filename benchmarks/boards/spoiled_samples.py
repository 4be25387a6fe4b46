"""What can be wrong with recorded samples: one function each, which spoils a folder in place."""

from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from benchmarks.boards.folder import Folder, Record
from hardware.description.arrays import FloatArray

Random = np.random.Generator
Mutation = Callable[[Folder, Random], None]


def pick(folder: Folder, rng: Random) -> Record:
    """Return one record, of those that are still records if there are any."""
    names = [name for name, one in folder.records.items() if one.raw is None]
    return folder.records[names[int(rng.integers(len(names)))]] if names else _any(folder)


def _any(folder: Folder) -> Record:
    return next(iter(folder.records.values()))


def some(folder: Folder, rng: Random) -> list[Record]:
    """Return one record, or, as often, all of them."""
    return [pick(folder, rng)] if rng.random() < 0.5 else list(folder.records.values())


def channel(record: Record, rng: Random) -> str | None:
    """Return the name of one of its channels, ``None`` where it has none."""
    names = list(record.channels)
    return names[int(rng.integers(len(names)))] if names else None


def _on_channel(change: Callable[[FloatArray, Random], FloatArray]) -> Mutation:
    """Return what changes one channel, in one record or in all."""

    def mutate(folder: Folder, rng: Random) -> None:
        name = channel(pick(folder, rng), rng)
        for record in some(folder, rng):
            if name in record.channels and record.channels[name].size:
                record.channels[name] = change(record.channels[name].copy(), rng)

    return mutate


def _constant(values: FloatArray, rng: Random) -> FloatArray:
    level = (0.0, float(values[0]), 500.0, 1e300)[int(rng.integers(4))]
    return np.full_like(values, level)


def _one_step(values: FloatArray, rng: Random) -> FloatArray:
    values[:] = values[0]
    values[int(rng.integers(values.size)) :] += 1e-3
    return values


def _missing(values: FloatArray, rng: Random) -> FloatArray:
    kind = int(rng.integers(4))
    if kind == 0:
        return np.full_like(values, np.nan)
    if kind == 1:
        values[rng.random(values.size) < rng.uniform(0.01, 0.95)] = np.nan
    elif kind == 2:
        first = int(rng.integers(values.size))
        values[first : first + int(rng.integers(1, values.size + 1))] = np.nan
    else:
        values[1:] = np.nan
    return values


def _infinite(values: FloatArray, rng: Random) -> FloatArray:
    values[int(rng.integers(values.size))] = (np.inf, -np.inf)[int(rng.integers(2))]
    return values


def _spikes(values: FloatArray, rng: Random) -> FloatArray:
    at = rng.integers(values.size, size=int(rng.integers(1, 5)))
    values[at] += 10.0 ** rng.uniform(-2.0, 12.0)
    return values


def _scaled(values: FloatArray, rng: Random) -> FloatArray:
    values *= (1e-3, 1e3, 180.0 / np.pi, 9.80665, -1.0, 1e-30, 1e30, 0.0)[int(rng.integers(8))]
    return values


def _clipped(values: FloatArray, rng: Random) -> FloatArray:
    low, high = np.nanquantile(values, (0.0, float(rng.uniform(0.0, 0.9))))
    np.clip(values, low, high, out=values)
    return values


def _coarse(values: FloatArray, rng: Random) -> FloatArray:
    step = 10.0 ** rng.uniform(-3.0, 3.0) * (float(np.nanstd(values)) + 1e-12)
    values[:] = np.round(values / step) * step
    return values


def _noise(values: FloatArray, rng: Random) -> FloatArray:
    wide = 10.0 ** rng.uniform(-2.0, 3.0) * (float(np.nanstd(values)) + 1e-9)
    values += wide * rng.standard_normal(values.size)
    return values


def _wander(values: FloatArray, rng: Random) -> FloatArray:
    values += 10.0 ** rng.uniform(-2.0, 4.0) * np.linspace(-1.0, 1.0, values.size)
    return values


def _cut(record: Record, first: int, stop: int) -> None:
    record.times_s = record.times_s[first:stop]
    record.channels = {name: one[first:stop] for name, one in record.channels.items()}


def _few_samples(folder: Folder, rng: Random) -> None:
    counts = (0, 1, 2, 3, 10, 40)
    for record in some(folder, rng):
        _cut(record, 0, counts[int(rng.integers(len(counts)))])


def _short(folder: Folder, rng: Random) -> None:
    for record in some(folder, rng):
        first = int(rng.integers(record.times_s.size + 1))
        _cut(record, first, first + int(rng.integers(1, 200)))


def _without_channel(folder: Folder, rng: Random) -> None:
    name = channel(pick(folder, rng), rng)
    for record in some(folder, rng):
        record.channels.pop(str(name), None)


def _without_channels(folder: Folder, rng: Random) -> None:
    """Leave each record some channels of its own."""
    for record in folder.records.values():
        kept = [name for name in record.channels if rng.random() < 0.6]
        record.channels = {name: record.channels[name] for name in kept}


def _only_one_channel(folder: Folder, rng: Random) -> None:
    name = channel(pick(folder, rng), rng)
    for record in some(folder, rng):
        record.channels = {key: one for key, one in record.channels.items() if key == name}


def _another_rate(folder: Folder, rng: Random) -> None:
    """A run of another rate: its time with it, or only one of the two."""
    factor = float(rng.choice([0.5, 2.0, 10.0, 0.01]))
    kind = int(rng.integers(3))
    for record in some(folder, rng):
        record.rate_hz *= factor if kind != 1 else 1.0
        record.times_s = record.times_s / (factor if kind != 2 else 1.0)


def _fewer_samples_a_second(folder: Folder, rng: Random) -> None:
    step = int(rng.integers(2, 40))
    for record in some(folder, rng):
        record.times_s = record.times_s[::step]
        record.channels = {name: one[::step] for name, one in record.channels.items()}
        record.rate_hz /= step


def _swapped(folder: Folder, rng: Random) -> None:
    record = pick(folder, rng)
    names = list(record.channels)
    mixed = [record.channels[name] for name in rng.permutation(names)]
    record.channels = dict(zip(names, mixed, strict=True))


def _swapped_records(folder: Folder, rng: Random) -> None:
    names = list(folder.records)
    mixed = [folder.records[name] for name in rng.permutation(names)]
    folder.records = dict(zip(names, mixed, strict=True))


def _uneven_time(folder: Folder, rng: Random) -> None:
    for record in some(folder, rng):
        if record.times_s.size < 3:
            continue
        at, kind = int(rng.integers(1, record.times_s.size)), int(rng.integers(5))
        times = record.times_s.copy()
        if kind == 0:
            times[at:] += rng.uniform(0.001, 5.0)
        elif kind == 1:
            times[at] = times[at - 1]
        elif kind == 2:
            times = times[::-1].copy()
        elif kind == 3:
            times[at] = np.nan
        else:
            times += rng.uniform(0.0, 0.02, times.size)
        record.times_s = times


def _photocell(folder: Folder, rng: Random) -> None:
    for record in some(folder, rng):
        edges = record.edges_s
        if edges is None or not edges.size:
            continue
        spoiled = (
            None,
            np.empty(0),
            edges[:1],
            edges[:2],
            edges[::-1].copy(),
            np.repeat(edges, 2),
            edges + 1e4,
            np.append(edges, np.nan),
            edges[rng.random(edges.size) < 0.6],
            np.sort(np.append(edges, rng.uniform(0.0, 10.0, 3))),
        )
        record.edges_s = spoiled[int(rng.integers(len(spoiled)))]


OF_SAMPLES: Final[Mapping[str, Mutation]] = {
    "constant channel": _on_channel(_constant),
    "channel with one step": _on_channel(_one_step),
    "missing samples": _on_channel(_missing),
    "infinite sample": _on_channel(_infinite),
    "spikes": _on_channel(_spikes),
    "another unit or sign": _on_channel(_scaled),
    "clipped channel": _on_channel(_clipped),
    "coarse channel": _on_channel(_coarse),
    "noise": _on_channel(_noise),
    "wander": _on_channel(_wander),
    "few samples": _few_samples,
    "short record": _short,
    "channel not there": _without_channel,
    "different sensors from run to run": _without_channels,
    "one channel": _only_one_channel,
    "another rate": _another_rate,
    "fewer samples a second": _fewer_samples_a_second,
    "channels swapped": _swapped,
    "records swapped": _swapped_records,
    "uneven time": _uneven_time,
    "photocell": _photocell,
}
