"""Cases again as a slower or shorter recorder would have them: thinned, resampled, cut.

It knows recordings by their files alone. What is thinned passes an anti-aliasing filter first, and
is left out where it would keep too few samples a period for the harmonics that are compared.
"""

import gzip
import io
import json
import re
import shutil
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tests.sealed.scoring.by_world import CLEAR_SNR

FloatArray = NDArray[np.float64]

LEAST_SAMPLES: Final = 15.0
"""Samples of the quickest run's period: six harmonics lie within 0.8 of what a rate can show."""
PART: Final = 0.6
_ANGLE: Final = ("shaft_angle", "Winkel [deg]")


@dataclass(frozen=True)
class Variation:
    """A way to have a case again.

    Attributes
    ----------
    ratio
        Of the sample rates, new over old.
    part
        Of each record that is kept, from its beginning.
    """

    name: str
    ratio: Fraction = Fraction(1)
    part: float = 1.0


VARIATIONS: Final = (
    Variation("thin-2", Fraction(1, 2)),
    Variation("thin-5", Fraction(1, 5)),
    Variation("thin-10", Fraction(1, 10)),
    Variation("resampled", Fraction(5, 6)),
    Variation("cut", part=PART),
)


def fits(case: Path, variation: Variation) -> bool:
    """Tell whether a case keeps what is compared."""
    campaign = tomllib.loads((case / "campaign.toml").read_text())
    rate = float(campaign["simulation"]["sample_rate_hz"]) * float(variation.ratio)
    runs = campaign["runs"]
    long_enough = all(int(variation.part * (run["periods"] + 1)) >= 4 for run in runs)
    return long_enough and rate / max(run["frequency_hz"] for run in runs) > LEAST_SAMPLES


def resampled(values: FloatArray, ratio: Fraction, *, ramp: bool = False) -> FloatArray:
    """Return even samples at another rate, from the same first instant, without aliases.

    Parameters
    ----------
    ramp
        Whether the signal runs along a straight line, which is taken out meanwhile.
    """
    from scipy.signal import resample_poly

    if ratio == 1:
        return values
    count = len(values)
    there = np.flatnonzero(np.isfinite(values))
    line = np.polynomial.Polynomial.fit(there, values[there], 1) if ramp else None
    own = values if line is None else values - line(np.arange(count))
    out = resample_poly(own, ratio.numerator, ratio.denominator, padtype="line",
                        window=("kaiser", 8.0))  # fmt: skip
    places = np.arange(len(out)) / float(ratio)
    return np.asarray(out if line is None else out + line(places))


def vary(case: Path, target: Path, variation: Variation) -> None:
    """Write a case's folder again, so varied; it says no more than the case does."""
    target.mkdir(parents=True)
    for file in sorted(case.iterdir()):
        beside = file.suffix == ".csv" and not file.name.endswith("_edges.csv")  # a table
        if file.name == "campaign.toml":
            (target / file.name).write_text(_campaign(file.read_text(), variation))
        elif file.suffix == ".nc":
            _netcdf(file, target / file.name, variation)
        elif file.name.endswith(".csv.gz"):
            _csv(file, target / file.name, variation)
        elif beside or file.suffix == ".toml":
            shutil.copy(file, target / file.name)


def _kept(times: FloatArray, variation: Variation) -> int:
    return int(np.ceil(variation.part * len(times)))


def _netcdf(file: Path, target: Path, variation: Variation) -> None:
    import h5netcdf

    with h5netcdf.File(file, "r") as old, h5netcdf.File(target, "w") as new:
        times = np.asarray(old.variables["time"][:])
        kept = _kept(times, variation)
        for name, value in old.attrs.items():
            new.attrs[name] = value
        new.attrs["sample_rate_hz"] = old.attrs["sample_rate_hz"] * float(variation.ratio)
        for name, variable in old.variables.items():
            values = np.asarray(variable[:])
            if variable.dimensions == ("photocell_edge",):
                values = values[values <= times[kept - 1]]
            elif name == "time":
                count = len(resampled(times[:kept], variation.ratio))
                values = times[0] + np.arange(count) / float(new.attrs["sample_rate_hz"])
            else:
                values = resampled(values[:kept], variation.ratio, ramp=name in _ANGLE)
            dimension = variable.dimensions[0]
            if dimension not in new.dimensions:
                new.dimensions[dimension] = len(values)
            made = new.create_variable(name, (dimension,), np.float64)
            for key, value in variable.attrs.items():
                made.attrs[key] = value
            if len(values):
                made[:] = values


def _csv(file: Path, target: Path, variation: Variation) -> None:
    with gzip.open(file, "rt") as lines:
        header = lines.readline().strip().split(",")
        rows = np.loadtxt(lines, delimiter=",", ndmin=2)
    kept = _kept(rows[:, 0], variation)
    columns = [
        resampled(rows[:kept, i], variation.ratio, ramp=i == 0 or name in _ANGLE)
        for i, name in enumerate(header)
    ]
    text = io.StringIO()
    np.savetxt(text, np.column_stack(columns), fmt="%.9g", delimiter=",",
               header=",".join(header), comments="")  # fmt: skip
    with target.open("wb") as out, gzip.GzipFile("", "wb", fileobj=out, mtime=0) as packed:
        packed.write(text.getvalue().encode())
    edges = file.with_name(file.name.removesuffix(".csv.gz") + "_edges.csv")
    if edges.exists():
        end = rows[kept - 1, 0]
        head, *times = edges.read_text().splitlines()
        text_of = "\n".join([head, *(t for t in times if float(t) <= end)]) + "\n"
        (target.parent / edges.name).write_text(text_of)


def _campaign(text: str, variation: Variation) -> str:
    """Return the campaign's file: rate, white noise and periods as they now are."""
    ratio = float(variation.ratio)

    def scaled(found: re.Match[str], by: float) -> str:
        return f"{found[1]}{float(found[2]) * by!r}"

    def fewer(found: re.Match[str]) -> str:
        return f"{found[1]}{max(int(variation.part * (int(found[2]) + 1)) - 1, 1)}"

    text = re.sub(r"(sample_rate_hz = )([0-9.e+-]+)", lambda m: scaled(m, ratio), text)
    text = re.sub(r"(noise_rms = )([0-9.e+-]+)", lambda m: scaled(m, min(ratio, 1.0) ** 0.5), text)
    return text if variation.part == 1.0 else re.sub(r"(periods = )([0-9]+)", fewer, text)


def varied(board: Path, output: Path, most: int) -> Iterator[str]:
    """Write a board's first cases in all variations that fit; yield each name when it is there.

    What is there already is kept. The folder has no keys: its cases are answered as a board's, and
    compared with the answers to the board.
    """
    for case in sorted((board / "cases").iterdir())[:most]:
        for variation in VARIATIONS:
            name = f"{case.name}.{variation.name}"
            target, made = output / "cases" / name, output / ".making" / name
            if target.exists() or not fits(case, variation):
                continue
            shutil.rmtree(made, ignore_errors=True)
            vary(case, made, variation)
            target.parent.mkdir(parents=True, exist_ok=True)
            made.rename(target)
            yield name


@dataclass(frozen=True)
class Agreement:
    """How often a variation is answered as the case: shares, with their counts."""

    name: str
    count: int
    same_class: float
    near: float


def _answer(path: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(path.read_text())
    return found


def counted(truth: dict[str, Any], variation: Variation) -> bool:
    """Tell whether a variation of a case is compared: SNR from 10 in both."""
    return bool(truth["verdict"] != "none" and truth["snr"] * variation.part**0.5 >= CLEAR_SNR)


def agreements(board: Path, output: Path) -> list[Agreement]:
    """Compare answers to variations with those to their cases, SNR from 10 in both."""
    out = []
    for variation in VARIATIONS:
        pairs = []
        for path in sorted((output / "answers").glob(f"*.{variation.name}.json")):
            name = path.stem.split(".")[0]
            truth = _answer(board / "keys" / name / "truth.json")
            if counted(truth, variation):
                own = _answer(board / "answers" / f"{name}.json")
                pairs.append(alike(own, _answer(path), truth))
        if pairs:
            same, near = np.mean(np.array(pairs, dtype=float), axis=0)
            out.append(Agreement(variation.name, len(pairs), float(same), float(near)))
    return out


def alike(own: dict[str, Any], other: dict[str, Any], truth: dict[str, Any]) -> tuple[bool, bool]:
    """Return whether the class is the same, and whether its probability is within 0.1."""
    shares, theirs = own["probabilities"], other["probabilities"]
    if not shares or not theirs:
        return False, False
    best, rival = (max(sorted(one), key=lambda n: one[n]) for one in (shares, theirs))
    groups = [{name, *truth["classes"].get(name, [])} for name in best.split("+")]
    names = {"+".join(sorted(one)) for one in product(*groups)}
    said, now = (sum(one.get(name, 0.0) for name in names) for one in (shares, theirs))
    return rival in names, rival in names and abs(said - now) <= 0.1
