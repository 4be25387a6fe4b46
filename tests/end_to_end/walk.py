"""Commands that take a campaign, and what every one of them owes: done, or a way out.

The oracle is the promise of the command line: status 0, or 1 or 2 with a sentence. Recordings of
this program carry checksums: nothing is said of them. Others have none, which is noted once.
"""

import re
from pathlib import Path
from typing import Final

from click.testing import CliRunner

from pmm.cli import cli

# Two effects in place of the catalogue: what takes time is not what is asked for here.
GAP: Final = ("gap", "--jobs", "1", "--effects", "coulomb-friction", "--effects", "gain-error")
COMMANDS: Final = (("report",), ("coefficients",), ("analyse",), GAP)
_UNCHECKED: Final = "without checksums, so that no change would be seen: "


def done_or_a_way_out(
    campaign: Path, command: tuple[str, ...], refusal: str | None = None, *, checked: bool = True
) -> None:
    """Run a command on a campaign; ``refusal`` is what it has to say where it refuses."""
    done = CliRunner().invoke(cli, [command[0], str(campaign), *command[1:]])
    assert done.exception is None or isinstance(done.exception, SystemExit), repr(done.exception)
    if done.exit_code == 0:
        assert refusal is None, f"{command[0]} does not refuse any more"
        assert done.stdout
        assert "not what was written" not in done.output
        assert done.stderr.count(_UNCHECKED) == (not checked)
        return
    said = re.sub(r"\s+", " ", done.stderr)
    assert done.exit_code in (1, 2)
    assert "error: " in said
    assert refusal is not None, said
    assert re.search(refusal, said), said
