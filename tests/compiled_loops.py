"""Compiles what takes tens of seconds: once, side by side, before workers share the tests.

Each worker would else compile every loop, at the first test that needs it, and every module of
tests. Short runs ask for the loops, so that they are compiled for what the product hands them;
collecting asks for the modules.
"""

import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

HOUSE: Final = Path(__file__).parents[1]


def march_and_balance() -> None:
    """Run a rig with friction until it is steady, and one whose gauges give way from rest."""
    from dataclasses import replace

    from hardware.description.setpoint import SetPoint
    from sim.model.law_point import Acting
    from sim.model.laws import Quadratic
    from sim.rig import Mounting, vertical_rig
    from sim.run import simulate, steady_run

    rig = replace(
        vertical_rig(),
        mounting=Mounting(gauge_stiffness_n_m=1e5),
        forces=(Acting(Quadratic(10.0)),),
    )
    run = SetPoint(0.5, 0.05)
    steady_run(rig, run)
    simulate(rig, run, periods=1, settling_periods=1, sample_rate_hz=50.0, seed=1)


def swing() -> None:
    """Let a pendulum swing."""
    from sim.pendulum.simulation import simulate_swing

    simulate_swing(seed=1, duration_s=1.0)


# What compiles, and which loops: one of which is kept, all are.
LOOPS: Final[Mapping[Callable[[], None], str]] = {
    march_and_balance: "march.march",
    swing: "kernel.run",
}


def _are_kept(loops: str) -> bool:
    from sim.solve.compilation import cache_folder

    chosen = os.environ.get("NUMBA_CACHE_DIR", "")
    return any(cache_folder(chosen).rglob(f"{loops}-*.nbi"))


def compile_loops() -> None:
    """Compile what is not kept from before, each group of loops in a process of its own.

    Where a group is missing, the modules of tests are taken to be as new, and compiled beside it.

    Raises
    ------
    subprocess.CalledProcessError
        If that fails; the process has said why.
    """
    missing = [group.__name__ for group, loops in LOOPS.items() if not _are_kept(loops)]
    if not missing:
        return
    commands = [[sys.executable, "-m", "tests.compiled_loops", name] for name in missing]
    begun = [subprocess.Popen(command, cwd=HOUSE) for command in commands]
    # What it fails at, the workers fail at too, and say so.
    collect = [sys.executable, "-m", "pytest", "--collect-only", "-qq", "-p", "no:cacheprovider"]
    subprocess.run(collect, cwd=HOUSE, stdout=subprocess.DEVNULL, check=False)
    for process in begun:
        if process.wait():
            raise subprocess.CalledProcessError(process.returncode, process.args)


if __name__ == "__main__":
    {group.__name__: group for group in LOOPS}[sys.argv[1]]()
