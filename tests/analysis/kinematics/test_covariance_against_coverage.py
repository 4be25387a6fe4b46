"""From samples with noise to body axes: the resolver's joint covariance against what it covers."""

import numpy as np
import pytest

from analysis.coefficients.phasors import Phasors, interleaved
from analysis.coefficients.strut_cycle import measured_cycle
from analysis.kinematics.averaged import in_body_axes
from analysis.kinematics.cycle import harmonics
from analysis.kinematics.geometry import Waves
from analysis.recording import Recording
from analysis.resolver.analyse import Settings, analyse
from analysis.uncertainty import student_factor
from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint
from hardware.description.channels import Channel
from hardware.description.oscillator import HORIZONTAL_1963, Plane
from hardware.description.setpoint import SetPoint
from tests.analysis.kinematics.exact import geometry_of, measured
from tests.exact.rig import ExactRig
from tests.exact.rigs import exact_rig
from tests.exact.run import DISPLACEMENTS, READINGS, record

ORDERS, DRAWS = 3, 40
NAMES = [f"{name} {n}" for n in range(ORDERS + 1) for name in ("v", "r", "force", "moment", "X")]
UNITS = ["m/s", "rad/s", "N", "N m", "N"] * (ORDERS + 1)
PARTS = [f"{name} {part}" for name in NAMES for part in ("sine", "cosine")]
# A mean has no quadrature, and a turn there and back none at all.
KNOWN = {name for name in PARTS if name.endswith("0 cosine")} | {"r 0 sine"}


def resolved(rig: ExactRig, seed: int) -> Phasors:
    """Return v, r and the loads from one noisy record, as the resolver reads it."""
    run = record(
        rig, 50.0, 12.0, noise=np.array([0.3, 0.5, 0.2]), displacement_noise_m=1e-3, seed=seed
    )
    channels = tuple(Channel(name, "m" if name in DISPLACEMENTS else "N") for name in run.channels)
    recording = Recording(
        "run",
        channels,
        np.stack(list(run.channels.values())),
        run.sample_rate_hz,
        photocell_edges_s=run.photocell_edges_s,
        set_point=SetPoint(rig.frequency_hz, 0.1, carriage_speed_m_s=rig.speed_m_s),
    )
    settings = Settings(channels=(*DISPLACEMENTS, *READINGS), harmonics=ORDERS)
    struts = measured_cycle(analyse(recording, settings=settings), HORIZONTAL_1963)
    return struts.phasors.through(lambda parts: turned(rig, parts), NAMES, UNITS)


def turned(rig: ExactRig, parts: Waves) -> Waves:
    """Return the harmonics of v, r and the loads."""
    found = in_body_axes(geometry_of(rig), parts, rig.omega)
    return harmonics(np.concatenate((found.motion.velocity[..., 1:, :], found.loads), -2), ORDERS)


@pytest.mark.parametrize(
    "arrangement",
    [
        Arrangement(),
        Arrangement(Joint.SLIDES_ON_RIG, gauges=Gauges.RIG, drift_by=DriftBy.MODEL_TURNED),
    ],
    ids=["defaults", "others"],
)
def test_intervals_in_body_axes_cover_95_percent(arrangement: Arrangement) -> None:
    rig = exact_rig(Plane.HORIZONTAL, arrangement, rotation_rad=0.35, drift_rad=0.1)
    true = turned(rig, measured(rig, ORDERS))
    inside = []
    for seed in range(DRAWS):
        found = resolved(rig, seed)
        factor = student_factor(np.array([found.sources[0].degrees_of_freedom]), 0.95)
        width = factor * np.sqrt(np.diagonal(found.covariance))
        inside.append(np.abs(interleaved(found.values) - true) < width)
    uncertain = [k for k, name in enumerate(PARTS) if name not in KNOWN]
    assert np.mean(np.array(inside)[:, uncertain]) == pytest.approx(0.95, abs=0.02)
