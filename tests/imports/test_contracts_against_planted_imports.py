"""Each contract of ``pyproject.toml`` breaks by an import planted against it, and no other does."""

from copy import deepcopy
from pathlib import Path

import grimp
import pytest
from importlinter import configuration
from importlinter.application.use_cases import read_user_options
from importlinter.contracts.forbidden import ForbiddenContract
from importlinter.contracts.layers import LayersContract
from importlinter.contracts.protected import ProtectedContract

HOUSE = Path(__file__).parents[2]
configuration.configure()
CONFIGURATION = read_user_options(str(HOUSE / "pyproject.toml"))
NAMES = {one["name"] for one in CONFIGURATION.contracts_options}
KINDS = {"forbidden": ForbiddenContract, "layers": LayersContract, "protected": ProtectedContract}

# Contract, the file that is planted in, and what is planted there.
PLANTED = [
    (
        "Within the gap diagnosis each room builds on those before it",
        "analysis/gap/observe/components.py",
        "import analysis.gap.search.fit",
    ),
    ("Imports go down only", "sim/run.py", "import analysis.reading_limits"),
    ("Imports go down only", "hardware/rest.py", "import pmm.places"),
    ("A wheel needs no tests, benchmarks or pages", "pmm/places.py", "import tests.clusters"),
    ("A wheel needs no tests, benchmarks or pages", "sim/run.py", "import benchmarks.noises"),
    ("The vocabulary knows nobody", "hardware/description/body.py", "import hardware.roles"),
    ("The vocabulary knows nobody", "hardware/description/body.py", "import serial"),
    (
        "Analysis and simulation know no device but the simulated ones",
        "analysis/uncertainty/values.py",
        "import hardware.pacing",
    ),
    (
        "Analysis and simulation know no device but the simulated ones",
        "sim/rig.py",
        "import hardware.pacing",
    ),
    (
        "Only a controller on the bus meets the simulated devices",
        "pmm/cli/demo.py",
        "import sim.devices.bus",
    ),
    (
        "Only hardware and the simulated devices speak to a bus or a port",
        "pmm/places.py",
        "import can",
    ),
    ("Who knows the simulator is named here", "analysis/exchange/simman.py", "import sim.rig"),
    ("Who knows the simulator is named here", "pmm/doctor/host.py", "import sim.rig"),
    (
        "No analysis builds on the gap diagnosis",
        "analysis/uncertainty/values.py",
        "import analysis.gap",
    ),
    (
        "What drives a rig never reaches the simulator",
        "pmm/recorder/journal.py",
        "import analysis.gap.judge.diagnosis",
    ),
    ("Within sim each link knows those before it", "sim/solve/relaxation.py", "import sim.rig"),
    ("Within sim each link knows those before it", "sim/drive/gear.py", "import sim.coupled.march"),
    ("Within sim each link knows those before it", "sim/gauges/dynamometer.py", "import sim.rig"),
    ("The water knows no model in it", "sim/model/water/tank.py", "import sim.model.hull"),
    ("Within pmm imports go down only", "pmm/run/gate.py", "import pmm.console.pacing"),
    ("Within pmm imports go down only", "pmm/recorder/disk.py", "import pmm.campaign.calibration"),
]


@pytest.fixture(scope="module")
def house() -> grimp.ImportGraph:
    """Return who imports whom in the packages, as they stand."""
    packages = CONFIGURATION.session_options["root_packages"]
    return grimp.build_graph(*packages, include_external_packages=True, cache_dir=None)


def _broken(house: grimp.ImportGraph) -> set[str]:
    """Return which contracts are broken by the imports of a graph."""
    contracts = [
        KINDS[one["type"]](one["name"], CONFIGURATION.session_options, one)
        for one in CONFIGURATION.contracts_options
    ]
    # Some contracts change the graph that they check.
    return {one.name for one in contracts if not one.check(deepcopy(house), verbose=False).kept}


def test_without_planted_imports_all_are_kept(house: grimp.ImportGraph) -> None:
    assert _broken(house) == set()


def test_each_contract_has_an_import_planted_against_it() -> None:
    assert {contract for contract, _, _ in PLANTED} == NAMES


@pytest.mark.sample(7)
@pytest.mark.parametrize(("contract", "file", "planted"), PLANTED)
def test_a_planted_import_breaks_its_contract_alone(
    house: grimp.ImportGraph, contract: str, file: str, planted: str
) -> None:
    importer = file.removesuffix(".py").replace("/", ".")
    assert importer in house.modules
    imported = planted.removeprefix("import ")
    changed = deepcopy(house)
    if imported not in changed.modules:
        imported = imported.partition(".")[0]  # of packages not our own the graph has the top only
        changed.add_module(imported, is_squashed=True)
    changed.add_import(importer=importer, imported=imported)
    assert _broken(changed) == {contract}
