"""A job that ends in every way, in a module that other processes find by its name."""

import os
import time

HANGS_S = 60.0


def awkward(job: str) -> str:
    """Do what the job is called; any other name is done at once."""
    if job == "raises":
        raise ValueError("no such thing")
    if job == "dies":
        os._exit(3)
    if job == "hangs":
        time.sleep(HANGS_S)
    return f"{job} by {os.environ['OMP_NUM_THREADS']} thread"
