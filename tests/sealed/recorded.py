"""World E: campaigns that the rig's own programs or others recorded, and measured records.

Each is there whole, cut and thinned; what is thinned passes an anti-aliasing filter first. The
folder is answered as a board is; pendulums and free decays are asked by their own command.
"""

import json
import subprocess
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.channels import SHAFT_ANGLE
from tests.sealed.generator.toml import as_toml
from tests.sealed.variations import LEAST_SAMPLES, Variation, resampled

if TYPE_CHECKING:
    from analysis.recording import Recording

ROOT: Final = Path(__file__).parents[2]
WHOLE: Final = Variation("whole")
VARIATIONS: Final = (
    WHOLE,
    Variation("cut", part=0.6),
    Variation("thin-2", Fraction(1, 2)),
    Variation("thin-5", Fraction(1, 5)),
    Variation("thin-10", Fraction(1, 10)),
)
NOTHING: Final = ("none", "coefficients")
BEYOND_LINEAR: Final = "damping beyond linear"
UNTOLD: Final = "untold"
EXPECTED: Final = "expected.json"


@dataclass(frozen=True)
class Source:
    """Where a campaign comes from, the program that makes it, and what is right to say of it.

    Attributes
    ----------
    command
        Arguments of ``pmm``; ``{}`` is the folder that it writes. Nothing for one that is there.
    made
        The campaign's folder, below the one that was written or the project's.
    """

    name: str
    right: tuple[str, ...]
    command: tuple[str, ...]
    made: str


SOURCES: Final = (
    Source("run", NOTHING, ("demo", "--vertical-only", "--output", "{}"), "vertical"),
    Source("simulate", NOTHING, ("simulate", "examples/gap/campaign.toml", "--output", "{}"), "."),
    Source("simulate-friction", ("coulomb-friction",),
           ("simulate", "examples/gap/campaign.toml", "--output", "{}",
            "--effect", "coulomb-friction:friction_n=0.3"), "."),
    # Its aft gauge drifts and its hull has added mass (truth.toml); the campaign states neither.
    Source("foreign", ("zero-drift", "coefficients"), (), "examples/foreign"),
)  # fmt: skip


def pmm(arguments: Sequence[str]) -> str:
    """Return what a command of the program prints; its error ends all."""
    code = "from pmm.cli import main; main()"
    done = subprocess.run([sys.executable, "-c", code, *arguments], cwd=ROOT, check=True,
                          stdout=subprocess.PIPE, text=True)  # fmt: skip
    return done.stdout


def recorded(output: Path, shared: Path) -> Iterator[str]:
    """Make what is not there yet, and yield each name when it is.

    Parameters
    ----------
    shared
        Folder of the measured records; without it they are left out.
    """
    expected: dict[str, dict[str, Any]] = {}
    for source in SOURCES:
        for variation in VARIATIONS:
            name = f"{source.name}.{variation.name}"
            if _campaign(_made(source, output), output / "cases" / name, variation):
                expected[name] = {"source": source.name, "right": list(source.right)}
                yield name
    for name, kind, right, text in _measured(output / "pendulums", shared):
        (output / "pendulums" / f"{name}.toml").write_text(text)
        expected[name] = {"source": kind, "right": list(right)}
        yield name
    (output / EXPECTED).write_text(json.dumps(expected, indent=1) + "\n")


def _made(source: Source, output: Path) -> Path:
    folder = (output / "made" / source.name).absolute()
    if source.command and not folder.exists():
        pmm([str(folder) if one == "{}" else one for one in source.command])
    return (folder if source.command else ROOT) / source.made


def _campaign(folder: Path, target: Path, variation: Variation) -> bool:
    """Write a campaign so varied, in SI units; tell whether it keeps what is compared."""
    from analysis.readers.netcdf import write_recording
    from pmm.campaign.campaign_file import read_campaign
    from pmm.campaign.recording_source import RecordingSource, open_recording

    campaign = read_campaign(folder / "campaign.toml")
    rows = tomllib.loads((folder / "campaign.toml").read_text())
    sources = [
        *(RecordingSource.of(campaign, one, folder) for one in campaign.runs),
        *(RecordingSource.of(campaign, one, folder) for one in campaign.at_rest),
    ]
    opened = {str(one.name): open_recording(one) for one in sources}
    fast = max(run.frequency_hz for run in campaign.runs)
    rate_hz = min(one.sample_rate_hz for one in opened.values()) * float(variation.ratio)
    if rate_hz < LEAST_SAMPLES * fast:
        return False
    target.mkdir(parents=True, exist_ok=True)
    for name, one in opened.items():
        if not (target / f"{name}.nc").exists():
            write_recording(_varied(one, variation), target / f"{name}.nc")
    for key in ("columns", "calibration"):
        rows.pop(key, None)
    for row in (*rows["runs"], *rows.get("at_rest", ())):
        row["file"] = f"{row['name']}.nc"
        for key in ("calibration", "sample_rate_hz", "edges_file", "periods"):
            row.pop(key, None)
    text = "\n".join(f"{key} = {as_toml(value)}" for key, value in rows.items())
    (target / "campaign.toml").write_text(text + "\n")
    return True


def _varied(one: "Recording", variation: Variation) -> "Recording":
    """Return a recording cut or thinned."""
    kept = int(np.ceil(variation.part * one.sample_count))
    rows = [
        resampled(_values(one, name)[:kept], variation.ratio, ramp=name == SHAFT_ANGLE.name)
        for name in one.channel_names
    ]
    end_s = one.start_s + kept / one.sample_rate_hz
    edges = one.photocell_edges_s
    return replace(
        one,
        samples=np.array(rows),
        sample_rate_hz=one.sample_rate_hz * float(variation.ratio),
        photocell_edges_s=None if edges is None else edges[edges < end_s],
    )


def _values(one: "Recording", name: str) -> FloatArray:
    """Return a channel's samples; an angle that begins anew at each turn goes on."""
    values = one.values(name).copy()
    if name == SHAFT_ANGLE.name:
        there = np.isfinite(values)
        values[there] = np.unwrap(values[there])
    return values


ROLL: Final = """name = "roll decay"
[measured]
record = "{0}"
channel = "phi"
[simulated]
record = "{1}"
channel = "phi"
[tolerances]
inertia = 0.01
restoring = 0.01
amplitude_period = 0.05
nonlinear_restoring = 1.0
"""
ROD: Final = """name = "rod"
gyradius_m = 0.343
gravity_m_s2 = 9.81
swings = 60
[tolerances]
inertia = 0.05
restoring = 3e-4
amplitude_period = 0.02
line_excess = 5e-4
spacing = 2.5e-4
"""
# Of a roll decay: its first part or its last, and the rate that is left, Hz (0: as it was).
_DECAYS: Final = {
    "whole": (0.0, 1.0, 0.0),
    "first-half": (0.0, 0.5, 0.0),
    "second-half": (0.5, 1.0, 0.0),
    "10-hz": (0.0, 1.0, 10.0),
    "5-hz": (0.0, 1.0, 5.0),
}
_HALVES: Final = {"whole": (0.0, 1.0), "first-half": (0.0, 0.5), "second-half": (0.5, 1.0)}


def _measured(output: Path, shared: Path) -> Iterator[tuple[str, str, tuple[str, ...], str]]:
    """Yield name, source, what is right and the file of each measured record."""
    if not shared.exists():
        return
    output.mkdir(parents=True, exist_ok=True)
    decay = shared / "roll_decay"
    for name, (first, last, rate_hz) in _DECAYS.items():
        record = output / f"roll-{name}.csv"
        _thinned(decay / "model_test_21337.csv.gz", record, first, last, rate_hz)
        right = (BEYOND_LINEAR, UNTOLD) if name == "second-half" else (BEYOND_LINEAR,)
        simulated = decay / "fnpf_kvlcc2_rolldecay_0kn.csv.gz"
        yield f"roll-{name}", "roll decay", right, ROLL.format(record.absolute(), simulated)
    for name, (first, last) in _HALVES.items():
        rows = [ROD]
        for gates in sorted((shared / "bifilar").glob("*.csv")):
            own = output / f"{gates.stem}-{name}.csv"
            head, lines = _lines(gates)
            part = slice(int(first * len(lines)), int(last * len(lines)))
            own.write_text("\n".join([*head, *lines[part]]) + "\n")
            spacing, line = (float(one[1:]) for one in gates.stem.split("_"))
            rows.append(f'[[suspensions]]\nname = "{gates.stem}"\ngates = "{own.absolute()}"\n'
                        f"half_spacing_m = {spacing / 2.0}\nline_m = {line}\n")  # fmt: skip
        yield f"rod-{name}", "bifilar", (UNTOLD,), "".join(rows)


def _lines(path: Path) -> tuple[list[str], list[str]]:
    """Return the lines of a file of two gates: those of its head, and its events."""
    lines = [line for line in path.read_text().splitlines() if line]
    return lines[:2], lines[2:]


def _thinned(source: Path, target: Path, first: float, last: float, rate_hz: float) -> None:
    """Write a part of a record of even samples, at a lower rate if one is given."""
    import gzip

    with gzip.open(source, "rt") as lines:
        header = lines.readline().strip()
        rows = np.loadtxt(lines, delimiter=",", ndmin=2)
    own = rows[int(first * len(rows)) : int(last * len(rows))]
    ratio = Fraction(1)
    if rate_hz:
        ratio = Fraction(rate_hz * float(np.mean(np.diff(own[:, 0])))).limit_denominator(100)
    columns = [resampled(own[:, i], ratio) for i in range(own.shape[1])]
    if rate_hz:
        columns[0] = own[0, 0] + np.arange(len(columns[0])) / rate_hz
    np.savetxt(target, np.column_stack(columns), fmt="%.12g", delimiter=",", header=header,
               comments="")  # fmt: skip


def said_of(output: Path, name: str) -> str:
    """Return what is said first of a case that was answered, or of a pendulum, which is asked."""
    file = output / "pendulums" / f"{name}.toml"
    if not file.exists():
        found = json.loads((output / "answers" / f"{name}.json").read_text())
        shares: Mapping[str, float] = found["probabilities"]
        if not shares:
            return str(found["failed"])
        return max(sorted(shares), key=lambda one: shares[one])
    try:
        told = json.loads(pmm(["gap", "pendulum", str(file), "--json"]))
    except subprocess.CalledProcessError as error:
        return f"failed, exit status {error.returncode}"
    if told["verdict"] != "cause":
        return str(told["verdict"])
    # The classes are nested: the narrowest one that is more probable than not is what is said.
    if float(told["classes"][BEYOND_LINEAR]) > 0.5:
        return BEYOND_LINEAR
    return max(sorted(told["classes"]), key=lambda one: float(told["classes"][one]))


@dataclass(frozen=True)
class Counted:
    """How many of a source's cases are said right, and what is said of the others."""

    source: str
    right: int
    count: int
    wrong: Mapping[str, str]


def counted(output: Path) -> list[Counted]:
    """Count what is said, source by source."""
    expected = json.loads((output / EXPECTED).read_text())
    said = {name: said_of(output, name) for name in expected}
    own = {name: said[name] in row["right"] for name, row in expected.items()}
    sources = Counter(row["source"] for row in expected.values())
    of = {name: row["source"] for name, row in expected.items()}
    return [
        Counted(source, sum(own[name] for name in own if of[name] == source), count,
                {name: said[name] for name in own if of[name] == source and not own[name]})
        for source, count in sources.items()
    ]  # fmt: skip
