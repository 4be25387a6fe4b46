"""Texts that are read whole: serial lines, what a browser posts, and files of TOML."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from functools import reduce
from operator import xor
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from pydantic import TypeAdapter, ValidationError

from benchmarks.fuzz.promises import REFUSED, check_finite
from benchmarks.machine import ROOT
from hardware.lines import decode
from pmm.campaign.calibration import read_calibration
from pmm.campaign.campaign_file import read_campaign
from pmm.console.requests import (
    AnswerPosted,
    CommandPosted,
    DropPosted,
    PlanPosted,
    TakePosted,
    TokenPosted,
)
from pmm.plan.plan import read_plan
from pmm.plan.rig_file import read_rig_file
from sim.devices.bench_file import read_bench

Read = Callable[[bytes], object]
LINES: Final = [
    b"P,17,4294967295,3*44\r\n", b"T,0,0,0", b"A,65535,1000000,-0.0125", b"A,1,2,1.5e-3",
    b"P,65536,99999999999,1", b"T,7,1000000,12",
]  # fmt: skip
POSTED: Final = [
    b'{"command": "start"}',
    b'{"command": "quick stop"}',
    b'{"question": "medium: bring the model into water; press Enter", "answer": "20.0"}',
    b'{"name": "plan.toml"}',
    b'{"text": "rig = \\"rig.toml\\"\\n[[runs]]\\nmotion = \\"heave\\""}',
    b'{"number": 3}',
    b'{"confirm": true}',
    b'{"token": "0123456789abcdef"}',
]
_MODELS: Final = [
    TypeAdapter(one)
    for one in (CommandPosted, AnswerPosted, PlanPosted, DropPosted, TakePosted, TokenPosted)
]
_CALIBRATION: Final = b"""made = "2026-01-01"
expires = "2027-01-01"
channels = ["force_aft", "force_fore"]
matrix = [[1.0, 0.01], [0.02, 0.99]]
standard_uncertainty = [[1e-4, 0.0], [0.0, 1e-4]]
hysteresis = [0.001, 0.002]
nonlinearity = [0.0, 0.0]
"""
# What is mutated, by its file's name, and who reads which file then.
TABLES: Final[Mapping[str, tuple[str, str, Callable[[Path], Any]]]] = MappingProxyType(
    {
        "campaign": ("campaign.toml", "campaign.toml", read_campaign),
        "plan": ("plan.toml", "plan.toml", read_plan),
        "rig": ("rig.toml", "rig.toml", read_rig_file),
        "simulated rig": ("simulated.toml", "simulated.toml", read_bench),
        "calibration": ("calibration.toml", "calibration.toml", read_calibration),
    }
)


def read_line(data: bytes) -> object:
    """Decode a line as it came, and once more with the checksum that it should have."""
    body = data.partition(b"*")[0].replace(b"\r", b"").replace(b"\n", b"")
    found = []
    for raw in (data, body + b"*%02X\r\n" % reduce(xor, body, 0)):
        try:
            found.append(decode(raw, "fuzzed"))
        except REFUSED:
            continue
    check_finite(found)
    return len(found)


def read_posted(data: bytes) -> object:
    """Read a posted text as each kind of request."""
    found = []
    for model in _MODELS:
        try:
            found.append(model.validate_json(data))
        except ValidationError as error:
            str(error)
    check_finite([one.model_dump() for one in found])
    return len(found)


def tables(kind: str, _folder: Path) -> list[bytes]:
    """Return good files of a kind: those of the examples."""
    name = TABLES[kind][0]
    if kind == "calibration":
        return [_CALIBRATION]
    found = [one.read_bytes() for one in sorted(ROOT.glob(f"examples/*/{name}"))]
    return [one for one in found if one.strip()]


def reading(kind: str, folder: Path, _stack: ExitStack) -> Read:
    """Return what reads a file of a kind, good files beside it."""
    name, entry, read = TABLES[kind]
    for path in (ROOT / "examples" / "vertical").glob("*.toml"):
        (folder / path.name).write_bytes(path.read_bytes())

    def take(data: bytes) -> object:
        (folder / name).write_bytes(data)
        found = read(folder / entry)
        check_finite(found)
        return type(found).__name__

    return take
