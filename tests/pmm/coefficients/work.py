"""What the tests send to other processes: found there by its name."""

import os
import signal
import time
from pathlib import Path

import numpy as np


def squared(number: int) -> int:
    return number * number


def drawn(number: int) -> list[float]:
    seed = np.random.SeedSequence(7, spawn_key=(number,))
    return np.random.default_rng(seed).standard_normal(4).tolist()


def killed_once(task: tuple[str, int]) -> list[float]:
    """Die without a word where the mark is not there yet; only ever one process of a test."""
    folder, number = task
    mark = Path(folder) / "killed"
    if number == 5:
        try:
            mark.touch(exist_ok=False)
        except FileExistsError:
            return drawn(number)
        os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(0.01)
    return drawn(number)


def always_dies(number: int) -> int:
    os.kill(os.getpid(), signal.SIGKILL)
    return number


def refuses_four(number: int) -> int:
    return refuses(number) if number == 4 else number


def refuses(number: int) -> int:
    message = f"number {number} is not to be had"
    raise ValueError(message)


def threads(_: int) -> str:
    return os.environ["OPENBLAS_NUM_THREADS"]


def given_up(address: str) -> None:
    """Have a cluster's scheduler forget all work, this too: as it does when it ends."""
    from distributed import Client

    with Client(address, set_as_default=False) as client:
        client.restart(wait_for_workers=False)
