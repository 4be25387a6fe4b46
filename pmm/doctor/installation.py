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
            text = f"{name} is not registered"
            cure = "install the package anew: python -m pip install --editable ."
            yield MachineFinding(_AREA, f"entry point {group}", MachineStatus.FAULT, text, cure)


def _python(machine: Machine) -> MachineFinding:
    version = ".".join(map(str, machine.python))
    if machine.python >= _OLDEST:
        return MachineFinding(_AREA, "Python", MachineStatus.OK, version)
    oldest = ".".join(map(str, _OLDEST))
    return MachineFinding(
        _AREA,
        "Python",
        MachineStatus.FAULT,
        f"{version}, needed is {oldest}",
        f"install Python {oldest} or newer and make the environment anew",
    )


def _libraries(machine: Machine) -> Iterator[MachineFinding]:
    requirements = [
        requirement for requirement in machine.requirements() if "extra ==" not in requirement
    ]
    fault_count = 0
    for requirement in requirements:
        match = _REQUIREMENT.match(requirement)
        name, least = match.groups() if match else (requirement, None)
        version = machine.installed(name)
        if version is None:
            fault_count += 1
            yield MachineFinding(
                _AREA, name, MachineStatus.FAULT, "not installed", f"{_INSTALL} '{requirement}'"
            )
        elif least and _numbers(version) < _numbers(least):
            fault_count += 1
            text = f"{version}, needed is {least} or newer"
            yield MachineFinding(
                _AREA, name, MachineStatus.FAULT, text, f"{_INSTALL} '{requirement}'"
            )
    if not fault_count:
        yield MachineFinding(
            _AREA,
            "libraries",
            MachineStatus.OK,
            f"{len(requirements)} of {len(requirements)} are there",
        )


def _files(machine: Machine) -> Iterator[MachineFinding]:
    changed_files = list(machine.changed_files())
    if changed_files:
        text = f"{len(changed_files)} differ from what was installed, first {changed_files[0]}"
        cure = f"{_INSTALL} --force-reinstall --no-deps {DISTRIBUTION}"
        yield MachineFinding(_AREA, "own files", MachineStatus.FAULT, text, cure)


def _numbers(text: str) -> tuple[int, ...]:
    return tuple(int(part) for part in re.findall(r"\d+", text.split("+")[0])[:3])


def _compiled(machine: Machine) -> MachineFinding:
    item = "compiled loops (numba)"
    version = machine.installed("numba")
    if version is None:
        text = "not installed: loops that go from sample to sample are interpreted, which is slow"
        return MachineFinding(_AREA, item, MachineStatus.WARNING, text, installing("fast"))
    folder = Path(machine.compiled_in) if machine.compiled_in else machine.home / "sim"
    if not machine.may_write(folder):
        text = f"{version}, but {folder} cannot be written to: compiled anew in every process"
        return MachineFinding(
            _AREA, item, MachineStatus.WARNING, text, "set NUMBA_CACHE_DIR to a folder of your own"
        )
    loop_count = sum(1 for _ in folder.rglob("*.nbi")) if folder.is_dir() else 0
    note = "" if loop_count else "; the first use compiles for some 20 s"
    return MachineFinding(
        _AREA, item, MachineStatus.OK, f"{version}, {loop_count} loops kept{note}"
    )
