"""Write this campaign as another system would have recorded it: ``python make.py``.

The runs are those of ``truth.toml``, simulated. What the other system does with them: German names,
millimetres, kilonewtons, degrees, semicolons and decimal commas, a fore gauge that is mounted the
other way round, single samples lost, and in one run a gap of 0.3 s.
"""

import gzip
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

HERE = Path(__file__).parent
HEADER = "Zeit [ms];Weg A [mm];Weg B [mm];Kraft A;Kraft B;Kurbel"
LOST_EVERY = 701  # samples
GAP = ("nicken_120", 500, 530)  # run, first and last sample that are missing


def main() -> None:
    """Simulate and write."""
    from click.testing import CliRunner

    from analysis.readers import read_recording
    from pmm.cli import cli

    with TemporaryDirectory() as folder:
        made = CliRunner().invoke(cli, ["simulate", str(HERE / "truth.toml"), "--output", folder])
        if made.exit_code:
            raise SystemExit(made.stderr)
        for path in sorted(Path(folder).glob("*.nc")):
            recording = read_recording(path)
            rows = table(
                recording.time_s(),
                *(recording.values(name) for name in recording.channel_names[:5]),
            )
            write(HERE / f"{path.stem}.csv.gz", rows, path.stem)


def table(
    time_s: np.ndarray,
    angle_rad: np.ndarray,
    aft_m: np.ndarray,
    fore_m: np.ndarray,
    force_aft_n: np.ndarray,
    force_fore_n: np.ndarray,
) -> np.ndarray:
    """Return the columns of the header in the other system's units."""
    degrees = np.degrees(angle_rad) % 360.0
    return np.column_stack(
        [1e3 * time_s, 1e3 * aft_m, 1e3 * fore_m, force_aft_n / 1e3, -force_fore_n / 1e3, degrees]
    )


def write(path: Path, rows: np.ndarray, run: str) -> None:
    """Write a run, the same bytes every time."""
    lines = [HEADER]
    for number, row in enumerate(rows.tolist()):
        if run == GAP[0] and GAP[1] <= number <= GAP[2]:
            continue
        line = "{:.0f};{:.3f};{:.3f};{:.6f};{:.6f};{:.2f}".format(*row)
        if number % LOST_EVERY == LOST_EVERY - 1:
            line = ";".join([line.split(";")[0], *[""] * 5])
        lines.append(line.replace(".", ","))
    path.write_bytes(gzip.compress("\n".join([*lines, ""]).encode(), mtime=0))


if __name__ == "__main__":
    main()
