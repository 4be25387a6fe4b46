"""The kinds of runs, each against what the simulated rig was made of."""

import math
from datetime import date
from pathlib import Path

import numpy as np
import pytest

from hardware.demand import Demand
from hardware.description.kinds import RunKind
from hardware.description.known_loads import KnownMass, LoadDirection, LoadStep
from hardware.description.oscillator import VERTICAL_1963
from pmm.campaign.calibration import read_calibration, write_calibration
from pmm.evaluation.check_weights import calibrate
from pmm.evaluation.rig_tests import known_mass_responses, rung_modes, zero_drifts
from pmm.evaluation.run_results import of_kind, read_results
from pmm.run.states import State
from pmm.run.surroundings import Surroundings
from tests.pmm.run.harness import absent, at_rest, bench, oscillation

HALF_SPACING_M = 0.5


def weight(channel: str, force_n: float, way: LoadDirection, number: int):
    load = LoadStep(channel, force_n, way)
    return at_rest(f"weight-{channel}-{number}", RunKind.CHECK_WEIGHT, 0.5, load=load)


@pytest.mark.slow
def test_check_weights_give_the_scale_that_the_rig_has_wrong(tmp_path: Path) -> None:
    # The aft gauge's scale is 2 % too large.
    steps = [(0.0, "up"), (50.0, "up"), (100.0, "up"), (50.0, "down"), (0.0, "down")]
    runs = [
        weight(channel, force, LoadDirection(way), i)
        for channel in ("force_aft", "force_fore")
        for i, (force, way) in enumerate(steps)
    ]
    with bench(tmp_path, runs) as one:
        line = one.world.nodes["forces[0]"].lines["force_aft"]
        line.scale = line.scale / 1.02
        one.finish()
        assert all(o.outcome == "complete" for o in one.control.outcomes)
    found = calibrate(read_results(tmp_path), date(2026, 1, 1), 365)
    assert found.channels == ("force_aft", "force_fore")
    assert found.matrix == pytest.approx(np.diag([1.02, 1.0]), abs=2e-3)
    assert found.hysteresis == pytest.approx([0.0, 0.0], abs=1e-3)
    path = write_calibration(found, tmp_path / "calibration.toml")
    again = read_calibration(path)
    assert again.matrix == pytest.approx(found.matrix)
    assert not again.is_expired(date(2027, 1, 1))
    assert again.is_expired(date(2027, 1, 2))


def test_a_push_on_swapped_cables_is_refused(tmp_path: Path) -> None:
    run = at_rest("push", RunKind.PUSH, 3.0, load=LoadStep("force_aft", 30.0))
    with bench(tmp_path, [run]) as one:
        aft, fore = (one.world.nodes[f"forces[{i}]"] for i in (0, 1))
        aft.lines, fore.lines = (
            {"force_fore": aft.lines["force_aft"]},
            {"force_aft": fore.lines["force_fore"]},
        )
        one.finish()
        assert type(one.control.fault).__name__ == "PushRefusedError"
        assert "cables are swapped" in str(one.control.fault)
        assert one.at_rest()


@pytest.mark.parametrize("force_n", [30.0, -30.0])
def test_a_right_push_names_channel_and_sign(tmp_path: Path, force_n: float) -> None:
    run = at_rest("push", RunKind.PUSH, 3.0, load=LoadStep("force_fore", force_n))
    with bench(tmp_path, [run]) as one:
        one.finish()
        assert one.control.fault is None
    events = (tmp_path / "push" / "events.jsonl").read_text(encoding="utf-8")
    assert f"force_fore {force_n:+.2g}"[:14] in events


def test_a_known_mass_that_is_moved_is_asked_for() -> None:
    """Placed, the same again, moved, taken off: three things to be done."""
    around = Surroundings()
    masses = (KnownMass(5.0), KnownMass(5.0), KnownMass(5.0, 0.5), None)
    runs = [oscillation(known_mass=mass) for mass in masses]
    asked = [str(demand) for run in runs for demand in around.before(run, VERTICAL_1963)]
    assert [text.split(";")[0] for text in asked] == [
        "mass: put 5 kg on the model at x = 0 m",
        "mass: put 5 kg on the model at x = 0.5 m",
        "mass: take it off",
    ]


@pytest.mark.slow
def test_a_known_mass_shows_gain_lag_and_sign_of_each_gauge(tmp_path: Path) -> None:
    runs = [
        oscillation("dry", kind=RunKind.DRY, medium="air", frequency_hz=1.5),
        oscillation(
            "mass",
            kind=RunKind.KNOWN_MASS,
            medium="air",
            frequency_hz=1.5,
            known_mass=KnownMass(5.0, 0.1),
        ),
    ]
    with bench(tmp_path, runs) as one:
        one.finish()
    results = read_results(tmp_path)
    known, dry = of_kind(results, "known-mass"), of_kind(results, "dry")
    for found in known_mass_responses(known, dry, HALF_SPACING_M):
        assert found.gain == pytest.approx(1.0, abs=0.01)
        assert abs(found.lag_s) < 1e-3


@pytest.mark.slow
def test_a_pluck_test_finds_the_mode_that_rings(tmp_path: Path) -> None:
    frequency_hz, ratio = 11.3, 0.02
    omega = 2.0 * math.pi * frequency_hz
    run = at_rest("pluck", RunKind.PLUCK, 6.0)
    with bench(tmp_path, [run]) as one:
        line = one.world.nodes["forces[0]"].lines["force_aft"]
        one.until(State.GATE_OPEN)
        plucked_s = one.world.time_s + 1.0
        while one.control.state is State.GATE_OPEN:
            since = one.world.time_s + 0.01 - plucked_s
            line.push = 0.0
            if since > 0.0:
                ringing = math.sin(omega * math.sqrt(1.0 - ratio**2) * since)
                line.push = 40.0 * math.exp(-ratio * omega * since) * ringing
            one.control.step()
        one.finish()
    (mode,) = rung_modes(read_results(tmp_path))
    damped_hz = frequency_hz * math.sqrt(1.0 - ratio**2)
    assert mode.frequency_hz == pytest.approx(damped_hz, rel=1e-3)
    assert mode.damping_ratio == pytest.approx(ratio, rel=0.05)


@pytest.mark.slow
def test_zeros_are_read_without_the_restoring_force(tmp_path: Path) -> None:
    runs = [at_rest("zero-1", RunKind.ZERO), oscillation(), at_rest("zero-2", RunKind.ZERO)]
    with bench(tmp_path, runs) as one:
        one.finish(40000)
    for drift in zero_drifts(of_kind(read_results(tmp_path), "zero")):
        assert abs(drift.first_n) < 0.05
        assert drift.largest_change_n < 0.05


@pytest.mark.slow
def test_the_operator_is_asked_for_what_the_rig_cannot_do_itself(tmp_path: Path) -> None:
    asked: list[str] = []

    def person(question: str) -> str | None:
        asked.append(question)
        return ""

    run = at_rest("tow", RunKind.STATIC_DRIFT, speed_m_s=1.2, drift_rad=0.1, prompts=("look",))
    with bench(tmp_path, [run], prompt=person) as one:
        one.until(State.GATE_OPEN)
        assert one.world.plant._around.drift_rad == 0.1, "the simulated operator turned the model"
        one.finish(40000)
        assert one.control.outcomes[0].outcome == "complete"
        assert one.world.plant.value("carriage_speed") == 0.0
    assert [q.part for q in asked if isinstance(q, Demand)] == ["prompt"]
    turn, look = Surroundings().before(run, VERTICAL_1963)  # as a rig that is not simulated asks
    assert (turn.part, turn.value, look.part) == ("drift", 0.1, "prompt")
    assert "turn the whole oscillator on the carriage: 0.1000 rad (5.73 deg), bow up" in turn
    assert absent("anybody?") is None
