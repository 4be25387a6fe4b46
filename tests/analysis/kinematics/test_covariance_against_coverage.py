"""From samples with noise to body axes: the resolver's joint covariance against what it covers."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_axes import labels
from analysis.coefficients.phasors import Phasors, interleaved
from analysis.coefficients.strut_cycle import measured_cycle
from analysis.kinematics.body_frame import CHANNELS
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from analysis.uncertainty.freedom import student_factor
from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint
from hardware.description.channels import Channel
from hardware.description.oscillator import HORIZONTAL_1963, Plane
from hardware.description.setpoint import SetPoint
from tests.analysis.coefficients.exact_campaigns import struts_of
from tests.exact.rig import ExactRig
from tests.exact.rigs import exact_rig
from tests.exact.run import DISPLACEMENTS, READINGS, record

ORDERS, DRAWS = 3, 40
PARTS = [f"{name} {part}" for name in labels(CHANNELS, ORDERS) for part in ("sine", "cosine")]
KNOWN = {name for name in PARTS if name.endswith("0 cosine")}  # a mean has no quadrature


def resolved(rig: ExactRig, seed: int) -> Phasors:
    """Return motion and loads from one noisy record, as the resolver reads it."""
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
        set_point=SetPoint(rig.frequency_hz, 0.1, 0.0, rig.speed_m_s, drift_rad=rig.drift_rad),
    )
    settings = ResolverSettings(channels=(*DISPLACEMENTS, *READINGS), harmonics=ORDERS)
    oscillator = replace(HORIZONTAL_1963, **vars(rig.arrangement))
    struts = measured_cycle(analyse(recording, settings=settings), oscillator)
    return struts.model().phasors


@pytest.mark.sample(1)
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
    exact = struts_of(rig, "exact", ORDERS).model()
    true = interleaved(exact.phasors.values)
    inside = []
    for seed in range(DRAWS):
        found = resolved(rig, seed)
        factor = student_factor(np.array([found.real.contributions[0].degrees_of_freedom]), 0.95)
        width = factor * found.real.standard_uncertainty
        inside.append(np.abs(interleaved(found.values) - true) < width)
    uncertain = [k for k, name in enumerate(PARTS) if name not in KNOWN]
    assert np.mean(np.array(inside)[:, uncertain]) == pytest.approx(0.95, abs=0.02)
