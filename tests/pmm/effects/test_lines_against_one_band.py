"""``pmm effects``: what an effect adds beside the harmonics, one line of text a channel."""

import json
import math

from click.testing import CliRunner

from pmm.cli import cli
from sim.effects.h14_vortex_shedding import TONES, VortexShedding


def shown(*arguments: str) -> str:
    done = CliRunner().invoke(cli, ["effects", *arguments])
    assert done.exit_code == 0, done.output
    return done.stdout


def test_a_band_is_one_line_with_its_power() -> None:
    """The band has the power of one line of the stated amplitude: lift U^2 over root 2."""
    arguments = ("vortex-shedding", "--speed", "1.2")
    told = [one for one in shown(*arguments).splitlines() if one.startswith("beside")]
    power = VortexShedding().lift_n_s2_m2 * 1.2**2 / math.sqrt(2.0)
    assert len(told) == 2
    assert all(f"{TONES} lines from" in one and f"together {power:.4g}" in one for one in told)
    (document,) = json.loads(shown(*arguments, "--json"))["effects"]
    assert len(document["lines"]) == 2 * TONES


def test_few_lines_are_shown_each() -> None:
    told = shown("vortex-shedding:bandwidth=0", "--speed", "1.2")
    assert "beside the harmonics: force_aft 0.72 at 6 Hz" in told


def test_nothing_at_rest_is_said() -> None:
    assert "no harmonic of a recorded channel changes here" in shown("vortex-shedding")
