"""One call for each kind of test: bench, effects, record.

Each takes effects of :mod:`sim.pendulum.effects` and a seed; what else a test needs is an argument
of its bench (:mod:`sim.pendulum.benches`), handed on by name.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from sim.acquisition.noise import draw_normal, start_stream
from sim.pendulum.bench import PendulumBench
from sim.pendulum.benches import (
    bifilar_bench,
    compound_bench,
    decay_bench,
    double_pendulum_bench,
    swing_bench,
)
from sim.pendulum.effects.base import PendulumEffect
from sim.pendulum.floating import Floating
from sim.pendulum.photogate import crossings
from sim.pendulum.pivot import HangingWeight, Pendulum
from sim.pendulum.record import PendulumRecord, record
from sim.pendulum.suspension import Suspension


def simulate_swing(
    *,
    effects: Iterable[PendulumEffect] = (),
    seed: int,
    duration_s: float = 160.0,
    sample_rate_hz: float = 256.0,
    **test: Any,
) -> PendulumRecord:
    """Swing, alone or with a model; arguments of :func:`~sim.pendulum.benches.swing_bench`."""
    bench = swing_bench(**test).with_effects(effects)
    return record(
        bench, duration_s=duration_s, sample_rate_hz=sample_rate_hz, seed=seed, test="swing"
    )


def simulate_swing_static(
    weights_kg: Sequence[float],
    lever_m: float,
    *,
    effects: Iterable[PendulumEffect] = (),
    seed: int,
    residual_rad: float = 2e-4,
    duration_s: float = 64.0,
    sample_rate_hz: float = 256.0,
    **test: Any,
) -> tuple[PendulumRecord, ...]:
    """Return a static series: one record for each calibration weight on a rope at one lever.

    Parameters
    ----------
    residual_rad
        Standard deviation of the oscillation that the hand leaves about each rest.
    test
        Arguments of :func:`~sim.pendulum.benches.swing_bench`.
    """
    records = []
    for number, mass_kg in enumerate(weights_kg):
        hung = (HangingWeight(mass_kg, lever_m),) if mass_kg else ()
        bench = swing_bench(**{**test, "weights": hung, "release_rad": 0.0})
        bench = bench.with_effects(effects)
        release = replace(bench.release, displacement_scatter=(residual_rad,))
        records.append(
            record(
                replace(bench, release=release),
                duration_s=duration_s,
                sample_rate_hz=sample_rate_hz,
                seed=_seed_of(seed, number),
                name=f"{mass_kg:g} kg at {lever_m:g} m",
                test="swing_static",
            )
        )
    return tuple(records)


def simulate_bifilar(
    body: Suspension,
    *,
    effects: Iterable[PendulumEffect] = (),
    seed: int,
    duration_s: float = 160.0,
    sample_rate_hz: float = 50.0,
    **test: Any,
) -> PendulumRecord:
    """Yaw and sway on two lines; arguments of :func:`~sim.pendulum.benches.bifilar_bench`."""
    bench = bifilar_bench(body, **test).with_effects(effects)
    return record(
        bench, duration_s=duration_s, sample_rate_hz=sample_rate_hz, seed=seed, test="bifilar"
    )


def simulate_double_pendulum(
    body: Suspension,
    *,
    effects: Iterable[PendulumEffect] = (),
    seed: int,
    duration_s: float = 60.0,
    sample_rate_hz: float = 100.0,
    **test: Any,
) -> PendulumRecord:
    """Surge and pitch; arguments of :func:`~sim.pendulum.benches.double_pendulum_bench`."""
    bench = double_pendulum_bench(body, **test).with_effects(effects)
    rate = sample_rate_hz
    return record(
        bench, duration_s=duration_s, sample_rate_hz=rate, seed=seed, test="double_pendulum"
    )


def simulate_compound_pendulum(
    body: Pendulum,
    *,
    effects: Iterable[PendulumEffect] = (),
    seed: int,
    duration_s: float = 60.0,
    sample_rate_hz: float = 200.0,
    **test: Any,
) -> PendulumRecord:
    """A body on one axis; arguments of :func:`~sim.pendulum.benches.compound_bench`."""
    bench = compound_bench(body, **test).with_effects(effects)
    rate = sample_rate_hz
    return record(
        bench, duration_s=duration_s, sample_rate_hz=rate, seed=seed, test="compound_pendulum"
    )


def simulate_decay(
    body: Floating,
    *,
    release: float,
    effects: Iterable[PendulumEffect] = (),
    seed: int,
    duration_s: float = 60.0,
    sample_rate_hz: float = 100.0,
) -> PendulumRecord:
    """Free decay in roll or heave, from a displacement in rad or m."""
    bench = decay_bench(body, release=release).with_effects(effects)
    return record(
        bench, duration_s=duration_s, sample_rate_hz=sample_rate_hz, seed=seed, test="free_decay"
    )


def simulate_stopwatch(
    bench: PendulumBench,
    *,
    swings: int,
    readings: int = 1,
    coordinate: str = "",
    reaction_s: float = 0.1,
    seed: int,
    sample_rate_hz: float = 100.0,
    longest_s: float = 3600.0,
) -> FloatArray:
    """Return how long so many swings took, by a person with a stopwatch, shape ``(readings,)``.

    The watch is started and stopped as the coordinate passes rest upwards; one reading follows the
    other at the next passage.

    Parameters
    ----------
    reaction_s
        Standard deviation of start and stop together.
    longest_s
        For how long the person would watch.

    Raises
    ------
    ConfigurationError
        If the body has no such coordinate, or a number is below 1.
    DataError
        If the body comes to rest, or the time is up, before all readings are taken.
    """
    if swings < 1 or readings < 1:
        raise ConfigurationError(f"swings = {swings}, readings = {readings}: both must be >= 1")
    names = {coordinate.name: coordinate for coordinate in bench.body.coordinates}
    chosen = names.get(coordinate or next(iter(names)))
    if chosen is None:
        raise ConfigurationError(f"no coordinate {coordinate!r} (known: {', '.join(names)})")
    needed = (swings + 1) * readings
    passages, chain = np.empty(0), bench.chain()
    state = chain.start(sample_rate_hz, seed)
    last = np.empty((3, 0))
    block = round(60.0 * sample_rate_hz)
    while passages.size < needed and state.next_sample < longest_s * sample_rate_hz:
        first = state.next_sample - last.shape[1]
        state, run = chain.run(state, block)
        rows = (chosen.displacement, chosen.rate, chosen.acceleration)
        moved = np.hstack([last, np.stack([run[row.name] for row in rows])])
        at, upwards = crossings(moved, 0.0, sample_rate_hz)
        passages = np.concatenate([passages, (first + at[upwards]) / sample_rate_hz])
        last = moved[:, -1:]
    if passages.size < needed:
        raise DataError(
            f"{passages.size} passages of {chosen.name} in {longest_s:g} s, {needed} needed for "
            f"{readings} reading(s) of {swings} swings: the body has come to rest, or swings too "
            "slowly; take fewer swings"
        )
    starts = np.arange(readings) * (swings + 1)
    _, reaction = draw_normal(start_stream(seed, "stopwatch"), readings)
    true = passages[starts + swings] - passages[starts]
    return np.asarray(true * (1.0 + bench.clock_error) + reaction_s * reaction)


def _seed_of(seed: int, number: int) -> int:
    """Return a seed for one record of a series."""
    return int(np.random.SeedSequence([seed, number]).generate_state(1, np.uint64)[0])
