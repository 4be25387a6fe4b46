"""Make the README's pictures anew from the example recording: ``python docs/images/make.py``."""

from pathlib import Path

from analysis.readers import ColumnMap, read_recording
from analysis.resolver.analyse import Settings, analyse
from pmm.report.plots import FIGURES
from pmm.report.style import drawing

HERE = Path(__file__).parent
EXAMPLE = HERE.parents[1] / "examples" / "recordings"


def main() -> None:
    """Draw the gate and the phasors of the example."""
    recording = read_recording(
        EXAMPLE / "heave.csv.gz", ColumnMap.from_toml(EXAMPLE / "heave.toml")
    )
    analysis = analyse(recording, settings=Settings(channels=("force_aft", "force_fore")))
    for name in ("gate", "phasors"):
        with drawing():
            FIGURES[name](analysis, 0).savefig(HERE / f"{name}.png", dpi=90)


if __name__ == "__main__":
    main()
