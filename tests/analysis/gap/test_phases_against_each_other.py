"""Whatever tells the phase, the harmonics of one and the same run are the same."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.observe.observation import Observed, observe
from analysis.gap.observe.phase import choose_phase
from analysis.readers.dataset import from_dataset
from analysis.recording import Recording
from analysis.resolver.reference_choice import ReferenceChoice
from hardware.description.channels import DISPLACEMENT_AFT, FORCE_AFT, SHAFT_ANGLE, Channel
from hardware.description.errors import DataError
from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Acquisition, Digitiser
from sim.rig import SimulatedRig
from sim.run import simulate

POINT = SetPoint(0.8, 0.02, 0.0, 0.0)


@pytest.fixture
def recording(rig: SimulatedRig) -> Recording:
    clean = {name: Digitiser() for name in ("shaft_angle", "displacement_aft", "displacement_fore")}
    quiet = replace(rig, acquisition=Acquisition(**clean))
    dataset = simulate(quiet, POINT, periods=8, sample_rate_hz=200.0, seed=3)
    return replace(from_dataset(dataset), set_point=POINT)


def without(recording: Recording, *names: str) -> Recording:
    kept = [name for name in recording.channel_names if name not in names]
    return replace(recording.select(kept), photocell_edges_s=None)


def force(observed: Observed) -> np.ndarray:
    seen = observed.observation
    rows = [at for at, one in enumerate(seen.components) if one.channel == FORCE_AFT.name]
    steady = [at for at in rows if seen.components[at].order]
    return seen.values[steady][:12]


def test_encoder_displacement_and_photocell_tell_the_same(recording: Recording) -> None:
    by_pulses = observe(recording)
    by_motion = observe(without(recording, SHAFT_ANGLE.name))
    by_encoder = observe(without(recording, DISPLACEMENT_AFT.name, "displacement_fore"))
    assert by_pulses.reference_channel is None
    assert by_motion.reference_channel == DISPLACEMENT_AFT.name
    assert by_encoder.reference_channel is None
    size = np.abs(force(by_pulses)).max()
    assert force(by_encoder) == pytest.approx(force(by_pulses), abs=2e-5 * size)
    assert force(by_motion) == pytest.approx(force(by_pulses), abs=2e-5 * size)


def test_a_signal_of_another_instrument_tells_it_as_a_photocell_would(recording: Recording) -> None:
    synchro = np.sin(recording.values(SHAFT_ANGLE.name))
    samples = np.vstack([np.asarray(recording.samples[:, : recording.sample_count]), synchro])
    more = replace(
        without(recording),
        channels=(*recording.channels, Channel("synchro", "V")),
        samples=samples,
    )
    found = observe(more, ReferenceChoice(channel="synchro"))
    assert found.reference_channel is None
    size = np.abs(force(observe(recording))).max()
    assert force(found) == pytest.approx(force(observe(recording)), abs=2e-5 * size)


def test_missing_samples_of_the_encoder_do_not_matter(recording: Recording) -> None:
    samples = np.array(recording.samples[:, : recording.sample_count])
    samples[recording.index(SHAFT_ANGLE.name)] %= 2.0 * np.pi
    samples[recording.index(SHAFT_ANGLE.name), 300:304] = np.nan
    holed = without(replace(recording, samples=samples), DISPLACEMENT_AFT.name, "displacement_fore")
    phased, _ = choose_phase(holed)
    pulses = recording.photocell_edges_s
    assert pulses is not None
    assert phased.photocell_edges_s is not None
    shared = [one for one in pulses if np.abs(phased.photocell_edges_s - one).min() < 1e-4]
    assert len(shared) >= len(pulses) - 1


def test_what_tells_no_phase_is_refused(recording: Recording) -> None:
    speed = replace(
        recording,
        channels=(Channel("carriage_speed", "m/s"),),
        samples=np.ones((1, recording.sample_count)),
        photocell_edges_s=None,
    )
    with pytest.raises(DataError, match="nothing in it tells the phase"):
        choose_phase(speed)
