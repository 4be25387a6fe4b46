"""The installation: Python, the libraries, compiled loops, the simulated rig's entry points."""

import re
from collections.abc import Iterator
from importlib.metadata import entry_points
from pathlib import Path
from typing import Final

from hardware.description.version import installing
from planar_motion_mechanism import DISTRIBUTION
from pmm.doctor.findings import MachineFinding, MachineStatus
from pmm.doctor.machine import Machine

_OLDEST: Final = (3, 11)
_AREA: Final = "installation"
_NEEDED: Final = (
    ("can.interface", "pmm-simulated"),
    ("pmm.serial_urls", "sim"),
    ("pmm.drivers", "cia402-shaft"),
)
_REQUIREMENT: Final = re.compile(r"([\w.-]+)(?:\[[\w,]*\])?\s*(?:>=\s*([\d.]+))?")
_INSTALL: Final = "python -m pip install --upgrade"


def check_installation(machine: Machine) -> Iterator[MachineFinding]:
    """Look at Python, the libraries that are asked for, and what makes loops fast."""
    yield _python(machine)
    yield from _libraries(machine)
    yield from _files(machine)
    yield _compiled(machine)
    for group, name in _NEEDED:
        if not entry_points(group=group, name=name):
            told = f"{name} is not registered"
            cure = "install the package anew: python -m pip install --editable ."
            yield MachineFinding(_AREA, f"entry point {group}", MachineStatus.FAULT, told, cure)


def _python(machine: Machine) -> MachineFinding:
    found = ".".join(map(str, machine.python))
    if machine.python >= _OLDEST:
        return MachineFinding(_AREA, "Python", MachineStatus.OK, found)
    oldest = ".".join(map(str, _OLDEST))
    return MachineFinding(
        _AREA,
        "Python",
        MachineStatus.FAULT,
        f"{found}, needed is {oldest}",
        f"install Python {oldest} or newer and make the environment anew",
    )


def _libraries(machine: Machine) -> Iterator[MachineFinding]:
    wanted = [
        requirement for requirement in machine.requirements() if "extra ==" not in requirement
    ]
    wrong = 0
    for one in wanted:
        match = _REQUIREMENT.match(one)
        name, least = match.groups() if match else (one, None)
        found = machine.installed(name)
        if found is None:
            wrong += 1
            yield MachineFinding(
                _AREA, name, MachineStatus.FAULT, "not installed", f"{_INSTALL} '{one}'"
            )
        elif least and _numbers(found) < _numbers(least):
            wrong += 1
            told = f"{found}, needed is {least} or newer"
            yield MachineFinding(_AREA, name, MachineStatus.FAULT, told, f"{_INSTALL} '{one}'")
    if not wrong:
        yield MachineFinding(
            _AREA, "libraries", MachineStatus.OK, f"{len(wanted)} of {len(wanted)} are there"
        )


def _files(machine: Machine) -> Iterator[MachineFinding]:
    changed = list(machine.changed_files())
    if changed:
        told = f"{len(changed)} differ from what was installed, first {changed[0]}"
        cure = f"{_INSTALL} --force-reinstall --no-deps {DISTRIBUTION}"
        yield MachineFinding(_AREA, "own files", MachineStatus.FAULT, told, cure)


def _numbers(text: str) -> tuple[int, ...]:
    return tuple(int(part) for part in re.findall(r"\d+", text.split("+")[0])[:3])


def _compiled(machine: Machine) -> MachineFinding:
    what = "compiled loops (numba)"
    found = machine.installed("numba")
    if found is None:
        told = "not installed: loops that go from sample to sample are interpreted, which is slow"
        return MachineFinding(_AREA, what, MachineStatus.WARNING, told, installing("fast"))
    folder = Path(machine.compiled_in) if machine.compiled_in else machine.home / "sim"
    if not machine.may_write(folder):
        told = f"{found}, but {folder} cannot be written to: compiled anew in every process"
        return MachineFinding(
            _AREA, what, MachineStatus.WARNING, told, "set NUMBA_CACHE_DIR to a folder of your own"
        )
    kept = sum(1 for _ in folder.rglob("*.nbi")) if folder.is_dir() else 0
    later = "" if kept else "; the first use compiles for some 20 s"
    return MachineFinding(_AREA, what, MachineStatus.OK, f"{found}, {kept} loops kept{later}")
