"""Density and viscosity against the tables of ITTC 7.5-02-01-03 (revision 02, 2011).

The salt tables' densities are those of TEOS-10 one atmosphere below the surface, 4.5e-5 too much.
"""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.water import SEA_WATER_G_KG, Water, froude_number, reynolds_number
from hardware.description.errors import ConfigurationError

# Table 1, fresh water, 10 to 40 degrees, kg/m3.
FRESH_KG_M3 = (
    999.7025, 999.6079, 999.5004, 999.3801, 999.2474, 999.1026, 998.9461, 998.7780, 998.5986,
    998.4083, 998.2072, 997.9955, 997.7735, 997.5414, 997.2994, 997.0476, 996.7864, 996.5158,
    996.2360, 995.9471, 995.6495, 995.3431, 995.0281, 994.7048, 994.3731, 994.0333, 993.6855,
    993.3298, 992.9663, 992.5951, 992.2164,
)  # fmt: skip
# Table 3, sea water, 1 to 30 degrees, kg/m3 and m2/s.
SEA_KG_M3 = (
    1028.0941, 1028.0197, 1027.9327, 1027.8336, 1027.7225, 1027.6000, 1027.4662, 1027.3214,
    1027.1659, 1027.0000, 1026.8238, 1026.6376, 1026.4416, 1026.2360, 1026.0210, 1025.7967,
    1025.5633, 1025.3210, 1025.0700, 1024.8103, 1024.5421, 1024.2656, 1023.9808, 1023.6881,
    1023.3873, 1023.0788, 1022.7626, 1022.4389, 1022.1078, 1021.7694,
)  # fmt: skip
SEA_M2_S = (
    1.7926e-6, 1.7341e-6, 1.6787e-6, 1.6262e-6, 1.5762e-6, 1.5288e-6, 1.4836e-6, 1.4406e-6,
    1.3995e-6, 1.3604e-6, 1.3230e-6, 1.2873e-6, 1.2532e-6, 1.2205e-6, 1.1892e-6, 1.1592e-6,
    1.1304e-6, 1.1028e-6, 1.0763e-6, 1.0508e-6, 1.0263e-6, 1.0027e-6, 9.8002e-7, 9.5818e-7,
    9.3713e-7, 9.1683e-7, 8.9726e-7, 8.7837e-7, 8.6014e-7, 8.4253e-7,
)  # fmt: skip
# Table 4, 15 degrees, 10 to 40 g/kg, every 5, kg/m3.
AT_15_KG_M3 = (1006.7950, 1010.6056, 1014.4192, 1018.2379, 1022.0628, 1025.8944, 1029.7328)


def test_density_of_fresh_water() -> None:
    for t, expected in enumerate(FRESH_KG_M3, 10):
        assert Water(t).density_kg_m3 == pytest.approx(expected, rel=1e-5)


def test_density_of_sea_water() -> None:
    for t, expected in enumerate(SEA_KG_M3, 1):
        assert Water(t, SEA_WATER_G_KG).density_kg_m3 == pytest.approx(expected, rel=1e-4)


def test_density_over_salinity() -> None:
    for salinity, expected in zip(range(10, 41, 5), AT_15_KG_M3, strict=True):
        assert Water(15.0, salinity).density_kg_m3 == pytest.approx(expected, rel=1e-4)


def test_viscosity_of_sea_water() -> None:
    for t, expected in enumerate(SEA_M2_S, 1):
        found = Water(t, SEA_WATER_G_KG).kinematic_viscosity_m2_s
        assert found == pytest.approx(expected, rel=1e-4)


def test_viscosity_of_fresh_water() -> None:
    """ITTC at 15 and 20 degrees; IAPWS SR6-08's own check value at 298.15 K and 0.1 MPa."""
    assert Water(15.0).kinematic_viscosity_m2_s == pytest.approx(1.1386e-6, rel=1e-4)
    assert Water(20.0).kinematic_viscosity_m2_s == pytest.approx(1.0034e-6, rel=1e-4)
    assert Water(25.0).viscosity_pa_s == pytest.approx(889.996774e-6, rel=1e-8)


@pytest.mark.parametrize(
    ("temperature", "salinity", "said"),
    [
        (40.1, 0.0, "temperature_deg_c = 40.1 is outside 0 to 40 degrees Celsius"),
        (-0.1, 35.0, "temperature_deg_c = -0.1 is outside"),
        (math.nan, 0.0, "temperature_deg_c = nan is outside"),
        (15.0, 43.0, "salinity_g_kg = 43 is outside 0 to 42 g/kg"),
        (15.0, 0.03516504, "salinity_g_kg = 0.035165 is less than tap water has; give it in g/kg"),
    ],
)
def test_water_outside_the_tables_is_refused(
    temperature: float, salinity: float, said: str
) -> None:
    with pytest.raises(ConfigurationError, match=said):
        Water(temperature, salinity)


@given(st.floats(0.5, 40.0), st.floats(10.0, 400.0), st.floats(1.0, 10.0))
def test_froude_scaling_keeps_fn_and_raises_re(scale: float, length: float, speed: float) -> None:
    water = Water(15.0)
    small = speed / math.sqrt(scale)
    assert froude_number(small, length / scale) == pytest.approx(froude_number(speed, length))
    ratio = reynolds_number(speed, length, water) / reynolds_number(small, length / scale, water)
    assert ratio == pytest.approx(scale**1.5)
