"""Runs of known content, for the figures and the page."""

import numpy as np

from analysis.recording import Recording
from analysis.resolver.analysis import Analysis, analyse
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.channels import Channel

FREQUENCY_HZ = 1.0137
DRIFT_N_PER_S = 0.05
SLOSH = 1.37


def run(
    loads: int = 2,
    seconds: float = 20.0,
    *,
    names: tuple[str, ...] = (),
    name: str = "run 1",
    noise_n: float = 0.3,
    seed: int = 1,
) -> Recording:
    """Make a run of some loads and, as the first channel, a displacement."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(int(seconds * 100.0)) / 100.0
    theta = 2.0 * np.pi * FREQUENCY_HZ * time_s
    values = [0.03 * np.sin(theta)]
    for k in range(loads):
        harmonics = 20.0 * np.sin(theta + 0.4 * k) + 0.8 * np.cos(2.0 * theta)
        slosh = 0.5 * np.sin(SLOSH * theta)
        noise = rng.normal(0.0, noise_n, len(time_s))
        values.append(3.0 + harmonics + slosh + DRIFT_N_PER_S * time_s + noise)
    labels = names or tuple(f"force_{k}" for k in range(loads))
    channels = (Channel("displacement_aft", "m"), *(Channel(label, "N") for label in labels))
    edges_s = np.arange(1, int(seconds * FREQUENCY_HZ)) / FREQUENCY_HZ
    return Recording(
        name,
        channels,
        np.array(values),
        100.0,
        photocell_edges_s=edges_s,
        provenance={"file": name},
    )


def analysed(recording: Recording | None = None, **settings: object) -> Analysis:
    """Resolve a run with its photocell."""
    return analyse(recording or run(), ReferenceChoice(), ResolverSettings(**settings))  # type: ignore[arg-type]
