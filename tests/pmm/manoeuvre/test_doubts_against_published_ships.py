"""Numbers of ships: published ones are believed, and not with the mass, signs or units wrong."""

import re
from pathlib import Path

import pytest

from analysis.manoeuvring.steering import Propeller
from analysis.water import Water
from pmm.manoeuvre.plausibility import BODY, SHIP, TURN, doubts_of_body, doubts_of_ship
from pmm.manoeuvre.prediction import predict, ship_of
from pmm.manoeuvre.ship_file import ShipBody, ShipFile, StatedHull, SubmergedFile, read_ship
from pmm.manoeuvre.submerged import body_of
from tests.analysis.manoeuvring.published import kvlcc2

ROOT = Path(__file__).parents[3]
EXAMPLES = ROOT / "examples" / "manoeuvre"

TEXT, BELOW = (
    EXAMPLES.joinpath(name).read_text(encoding="utf-8")
    for name in ("kvlcc2.toml", "submerged.toml")
)
# Mariner (Chislett and Stroem-Tejsen 1965), prime, 1e-5, as printed: Y_r and N_r hold the mass,
# and the rudder is positive to port.
MARINER = {
    "X_udot": -42.0, "Y_vdot": -748.0, "N_rdot": -43.8, "Y_v": -1160.0, "Y_r": -499.0,
    "N_v": -264.0, "N_r": -166.0, "Y_d": 278.0, "N_d": -139.0,
}  # fmt: skip
MASS, CG_X, INERTIA = 798.0, -0.023, 39.2
LENGTH_M, DRAUGHT_M, SPEED_M_S, SEA = 160.93, 7.468, 7.717, Water(15.0, 35.16504)
# DARPA's SUBOFF (Roddy 1990), prime, about its midpoint, bare hull and fully appended, whose m' is
# 0.0181; of the water alone, by the vertical plane (the bare body is the same in both).
SUBOFF = {
    "bare": {"Z_wdot": -0.01332, "M_qdot": -0.00068, "Z_w": -0.005948, "Z_q": -0.001811,
             "M_w": 0.012795, "M_q": -0.001597},
    "appended": {"Z_wdot": -0.014529, "M_qdot": -0.000860, "Z_w": -0.013910, "Z_q": -0.007545,
                 "M_w": 0.010324, "M_q": -0.003702},
}  # fmt: skip


def mariner(changes: dict[str, float]) -> tuple[str, ...]:
    """What is doubted of the Mariner with some of its printed numbers changed."""
    values = {name: 1e-5 * one for name, one in (MARINER | changes).items()} | {"X_0": -0.001}
    unit = 0.5e-5 * SEA.density_kg_m3 * LENGTH_M**3
    body = ShipBody(LENGTH_M, DRAUGHT_M, MASS * unit, INERTIA * unit * LENGTH_M**2, CG_X * LENGTH_M)
    screw = Propeller(6.706, kvlcc2.K, kvlcc2.T_P, kvlcc2.W_P0)
    hull = StatedHull("prime", values)
    file = ShipFile(SPEED_M_S, SEA, body, screw, rudder_rate_deg_s=5.0, hull=hull)
    return doubts_of_ship(file, ship_of(file, 0, 0))


WATER_ALONE = {"Y_r": -499.0 + MASS, "N_r": -166.0 + MASS * CG_X}
TO_STARBOARD = {"Y_d": -278.0, "N_d": 139.0}


def test_the_mariner_is_believed_once_its_mass_and_its_rudder_are_turned() -> None:
    assert mariner(WATER_ALONE | TO_STARBOARD) == ()


@pytest.mark.parametrize(
    ("left", "said", "remedy"),
    [
        (TO_STARBOARD, "Y_r/m = -0.625 is outside", "take it out of both"),
        (WATER_ALONE, "-Y_d/(rho/2 L d U²) = -0.0", "turn the signs of a rudder"),
        (WATER_ALONE | TO_STARBOARD | {"N_v": 264.0}, "N_v over Inoue's = -0.6", "turns the bow"),
        (WATER_ALONE | TO_STARBOARD | {"Y_v": 1160.0}, "Y_v over Inoue's = -0.9", "resists sway"),
        (WATER_ALONE | TO_STARBOARD | {"N_d": -139.0}, "rudder's lever N_d/(-Y_d L) = -0.5",
         "is the rudder aft?"),
        (WATER_ALONE | {"Y_d": -278.0 / 57.3, "N_d": 139.0 / 57.3}, "-Y_d/(rho/2 L d U²) = 0.00",
         "are angles in radians"),
    ],
)  # fmt: skip
def test_what_the_mariner_is_not_is_doubted_with_its_remedy(
    left: dict[str, float], said: str, remedy: str
) -> None:
    (told,) = mariner(left)
    assert told.startswith(said)
    assert remedy in told


def read(folder: Path, text: str) -> ShipFile | SubmergedFile:
    path = folder / "ship.toml"
    path.write_text(text, encoding="utf-8")
    return read_ship(path)


def doubts(file: ShipFile | SubmergedFile) -> tuple[str, ...]:
    if isinstance(file, SubmergedFile):
        return doubts_of_body(file, body_of(file, 0, 0))
    return doubts_of_ship(file, ship_of(file, 0, 0))


@pytest.mark.parametrize("name", ["kvlcc2.toml", "kcs.toml", "submerged.toml"])
def test_the_examples_are_believed(name: str) -> None:
    assert doubts(read_ship(EXAMPLES / name)) == ()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("mass_kg = 3269.4", "mass_kg = 3.2694", "m/(rho/2 L² d) = 0.000294 is outside 0.05 to"),
        ("inertia_kg_m2 = 10208.0", "inertia_kg_m2 = 40832.0", "sqrt(I_z/m)/L = 0.505 is outside"),
        ("Y_vdot = -0.223", "Y_vdot = 0.223", "-Y_vdot/m = -0.76 is outside 0.15 to 4"),
        ("speed_m_s = 1.179", "speed_m_s = 15.7", "Fn = 1.89 is outside 0.02 to 0.6"),
        ("rate_deg_s = 15.8", "rate_deg_s = 2.34", "rudder's rate at full scale in °/s = 0.346"),
        ("N_r = -0.049", "N_r = 0.049", "N_r over Inoue's = -0.919 is outside 0.15 to 6"),
        ("Y_r = 0.083", "Y_r = -0.2105", "Y_r/m = -0.717 is outside -0.4 to 1"),
        ('system = "mmg"', 'system = "prime"', "Y_v over Inoue's = 11.8 is outside"),
        ("slope = 2.747", "slope = -2.747", "-Y_d/(rho/2 L d U²) = -0.0685 is outside"),
        ("area_m2 = 0.0539", "area_m2 = 539.0", "-Y_d/(rho/2 L d U²) = 685 is outside"),
        ("draught_m = 0.455", "draught_m = 0.30", "H_R/d = 1.15 is outside 0.2 to 1.05"),
        ("draught_m = 0.455", "draught_m = 455.0", "L/d = 0.0154 is outside 4 to 80"),
    ],
)
def test_what_can_hardly_be_a_ship_is_doubted(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    assert old in TEXT
    several = doubts(read(tmp_path, TEXT.replace(old, new, 1)))
    assert any(one.startswith(said) for one in several), several
    assert all("): " in one for one in several), "each says what to look at"


@pytest.mark.parametrize("name", SUBOFF)
def test_submarines_that_were_published_are_believed(tmp_path: Path, name: str) -> None:
    text = BELOW
    for term, value in SUBOFF[name].items():
        text = re.sub(rf"(?m)^{term} = .*$", f"{term} = {value}", text, count=1)
    assert doubts(read(tmp_path, text)) == ()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("Z_q = -0.0060", "Z_q = 0.0120", "-Z_q/m = -0.666"),
        ("M_w = 0.0098", "M_w = -0.0098", "lever M_w/(-Z_w L) = -0.49"),
        ("Z_w = -0.020", "Z_w = 0.020", "-Z_w/m = -1.11"),
        ("M_q = -0.0040", "M_q = 0.0040", "-M_q/m = -0.222"),
    ],
)
def test_what_can_hardly_be_a_submarine_is_doubted(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    assert old in BELOW
    told = doubts(read(tmp_path, BELOW.replace(old, new, 1)))
    assert any(one.startswith(said) for one in told), told


def test_the_page_has_the_tables_of_bounds() -> None:
    page = (ROOT / "docs" / "manoeuvre.md").read_text(encoding="utf-8")
    for bound in (*SHIP.values(), *TURN.values(), *BODY.values()):
        row = f"| {bound.name} | {bound.low:g} to {bound.high:g} | {bound.source} |"
        assert row in page, bound.name


def test_a_hull_that_is_curved_in_drift_alone_turns_as_no_ship_does(tmp_path: Path) -> None:
    """KVLCC2 without what its oscillations tell beside its drift tests."""

    def told(text: str) -> tuple[str, ...]:
        (tmp_path / "ship.toml").write_text(text, encoding="utf-8")
        file = read_ship(tmp_path / "ship.toml")
        return predict(file, 0, 0, 0.95, lambda _: None).doubts

    assert told(TEXT) == ()
    alone = re.sub(r"(?m)^[YN]_(vvr|vrr|rrr) = .*$", "", TEXT)
    doubts_told = told(alone)
    for said in ("Y has Y_vvv and no term", "N has N_vvv and no", "starboard: steady drift in"):
        assert any(said in one for one in doubts_told), doubts_told
    assert any("lever_relative" in one for one in told(TEXT.replace("e = -0.710", "e = 0.710")))
