"""``pmm doctor`` names each planted fault with its cure, and finds none on a sound machine."""

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from hardware.serial_port import PluggedPort
from pmm.cli import cli
from pmm.doctor import machine as this
from pmm.doctor.findings import MachineFinding, MachineStatus
from pmm.doctor.host import check_host
from pmm.doctor.installation import check_installation
from pmm.doctor.machine import Machine
from pmm.doctor.reach import check_buses, check_ports

EXAMPLES = Path(__file__).parents[3] / "examples"


def sound(root: Path) -> Machine:
    """A machine with a CAN interface that is up, a port, space, priority and the right time."""
    net = root / "sys/class/net/can0"
    net.mkdir(parents=True)
    (net / "type").write_text("280\n")
    (net / "flags").write_text("0x40081\n")
    (net / "operstate").write_text("up\n")
    return Machine(
        root=root,
        python=(3, 12),
        home=root,
        compiled_in=str(root),
        requirements=lambda: ("numpy>=2.0", "python-can[multicast]>=4.5", 'ruff; extra == "dev"'),
        installed=lambda name: "5.0.1",
        ports=lambda: (PluggedPort("/dev/ttyUSB0", "usb:A7", "photocell"),),
        may_use=lambda device: True,
        may_write=lambda folder: True,
        free_bytes=lambda folder: 50_000_000_000,
        highest_priority=lambda: 99,
        may_lock_memory=lambda: True,
        synchronised=lambda: True,
        worst_lateness_s=lambda: 1e-4,
        monotonic_resolution_s=lambda: 1e-9,
        changed_files=lambda: (),
    )


def look(machine: Machine) -> list[MachineFinding]:
    checks = (check_installation, check_buses, check_ports)
    return [one for check in checks for one in check(machine)] + list(
        check_host(machine, Path("runs"))
    )


def test_a_sound_machine_has_no_fault(tmp_path: Path) -> None:
    assert {one.status for one in look(sound(tmp_path))} == {MachineStatus.OK}


PLANTED: dict[str, tuple[dict[str, Any], str, str]] = {
    "library missing": (
        {"installed": lambda name: None if name == "numpy" else "5.0"}, "numpy", "pip install"
    ),
    "library too old": (
        {"installed": lambda name: "4.4.9" if name == "python-can" else "5.0"},
        "python-can",
        "python-can[multicast]>=4.5",
    ),
    "own file overwritten": (
        {"changed_files": lambda: ("sim/rig.py",)}, "own files", "--force-reinstall"
    ),
    "old Python": ({"python": (3, 10)}, "Python", "3.11"),
    "port without permission": (
        {"may_use": lambda device: False}, "/dev/ttyUSB0", "usermod -aG dialout"
    ),
    "disk full": ({"free_bytes": lambda folder: 150_000_000}, "disk", "make room"),
    "folder not writable": ({"may_write": lambda folder: False}, "disk", "--output"),
    "coarse clock": ({"monotonic_resolution_s": lambda: 0.0156}, "monotonic", "timer"),
}  # fmt: skip


@pytest.mark.parametrize("fault", PLANTED)
def test_each_fault_is_named_with_its_cure(tmp_path: Path, fault: str) -> None:
    changed, what, cure = PLANTED[fault]
    faults = [one for one in look(replace(sound(tmp_path), **changed))
              if one.status is MachineStatus.FAULT]  # fmt: skip
    assert len(faults) == 1
    assert what in faults[0].what
    assert cure in faults[0].cure


def test_a_bus_that_is_down_is_named_with_its_cure(tmp_path: Path) -> None:
    machine = sound(tmp_path)
    (tmp_path / "sys/class/net/can0/flags").write_text("0x40080\n")
    (fault,) = (one for one in look(machine) if one.status is not MachineStatus.OK)
    assert (fault.what, fault.status) == ("CAN can0", MachineStatus.FAULT)
    assert fault.cure == "sudo ip link set can0 up type can bitrate 1000000"


WARNED: dict[str, tuple[dict[str, Any], str]] = {
    "clock not synchronised": ({"synchronised": lambda: False}, "set-ntp"),
    "no real-time priority": ({"highest_priority": lambda: 0}, "rtprio 10"),
    "memory that may not be locked": ({"may_lock_memory": lambda: False}, "memlock unlimited"),
    "late timer": ({"worst_lateness_s": lambda: 0.02}, "power saving"),
    "little space": ({"free_bytes": lambda folder: 1_000_000_000}, "make room"),
    "no numba": (
        {"installed": lambda name: None if name == "numba" else "5.0"},
        "planar-motion-mechanism[fast]",
    ),
    "no cache": ({"may_write": lambda folder: folder.name == "runs"}, "NUMBA_CACHE_DIR"),
}


@pytest.mark.parametrize("weakness", WARNED)
def test_each_weakness_is_a_warning_with_its_cure(tmp_path: Path, weakness: str) -> None:
    changed, cure = WARNED[weakness]
    (found,) = (one for one in look(replace(sound(tmp_path), **changed))
                if one.status is not MachineStatus.OK)  # fmt: skip
    assert found.status is MachineStatus.WARNING
    assert cure in found.cure


def test_the_machine_itself_answers_every_question(tmp_path: Path) -> None:
    assert this.monotonic_resolution_s() < 1.0
    assert this.worst_lateness_s() >= 0.0
    assert this.free_bytes(tmp_path / "not" / "there") > 0
    assert this.may_write(tmp_path / "not" / "there")
    assert not this.may_write(Path(__file__) / "beneath-a-file")
    assert this.synchronised() in (True, False, None)
    assert (this.highest_priority() or 0) >= 0
    assert this.may_lock_memory() in (True, False, None)
    assert this.installed("no-such-package-anywhere") is None


def test_a_rig_whose_devices_answer_is_sound() -> None:
    result = CliRunner().invoke(cli, ["doctor", str(EXAMPLES / "vertical/rig.toml"), "--json"])
    found = json.loads(result.stdout)
    (devices,) = (one for one in found["findings"] if one["area"] == "devices")
    assert devices["status"] == "ok"
    assert "eccentricity" in devices["found"]


def _copied(folder: Path, old: str, new: str) -> str:
    shutil.copytree(EXAMPLES / "vertical", folder / "rig")
    text = (folder / "rig" / "rig.toml").read_text(encoding="utf-8")
    assert old in text
    changed = folder / "rig" / "changed.toml"
    changed.write_text(text.replace(old, new, 1), encoding="utf-8")
    return str(changed)


def test_a_node_that_does_not_answer_is_named_with_its_cure(tmp_path: Path) -> None:
    rig = _copied(tmp_path, "node = 5", "node = 17")
    result = CliRunner().invoke(cli, ["doctor", rig, "--json"])
    assert result.exit_code == 1
    faults = [one for one in json.loads(result.stdout)["findings"] if one["status"] == "fault"]
    silent = next(one for one in faults if "17" in one["found"])
    assert silent["found"] == "node 17 does not answer"
    assert "check its power, its node id" in silent["cure"]


def test_a_bus_that_cannot_be_opened_is_named_with_its_cure(tmp_path: Path) -> None:
    rig = _copied(tmp_path, 'interface = "pmm-simulated"', 'interface = "no-such-adapter"')
    result = CliRunner().invoke(cli, ["doctor", rig, "--json"])
    assert result.exit_code == 1
    (fault,) = (one for one in json.loads(result.stdout)["findings"] if one["area"] == "devices")
    assert fault["status"] == "fault"
    assert "no-such-adapter" in fault["found"]
    assert "pmm devices scan" in fault["cure"]
