"""A campaign of text files by Newton's law in exact geometry: nothing of the product is in it.

A ship model of known coefficients hangs on two struts that slide along it, in the horizontal plane.
Velocities and accelerations are differences of positions in time.
"""

import math
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

HALF_M, MASS_KG, INERTIA_KG_M2, CG_X_M, SPEED_M_S = 0.35, 48.0, 9.6, 0.04, 1.1
PUT_IN = {
    "Y_vdot": -35.0, "Y_v": -62.0, "Y_rdot": -1.1, "Y_r": 8.0,
    "N_vdot": -1.4, "N_v": -31.0, "N_rdot": -4.2, "N_r": -14.0, "Y_vvv": -210.0,
}  # fmt: skip
SURGE = {"X_0": -9.0, "X_vv": -20.0, "X_vr": 40.0, "X_rr": 3.0, "X_udot": -2.5}
FIRST_RAD, RATE_HZ, STEP_S = 0.7, 100.0, 1e-4
NOISE_N, NOISE_M, OFFSETS_N = 0.05, 2e-5, (0.4, -0.2)
COLUMNS = {
    "displacement_aft": "Weg hinten [mm]",
    "displacement_fore": "Weg vorne [mm]",
    "force_aft": "Kraft hinten [N]",
    "force_fore": "Kraft vorne [N]",
}
WITH_SURGE = COLUMNS | {"force_x": "Kraft laengs [N]"}
HEAD = """
name = "newton"
tared = true
[oscillator]
plane = "horizontal"
half_spacing_m = 0.35
frequency_hz = {{low = 0.05, high = 3.0}}
eccentricity_m = {{low = 0.005, high = 0.3}}
force_per_strut_n = 500.0
[model]
mass_kg = {mass_kg}
inertia_kg_m2 = 9.6
cg_x_m = 0.04
{more}
[columns]
separator = ";"
time = "Zeit [s]"
[columns.channels]
{columns}
"""
RUN = """
[[runs]]
name = "{name}"
file = "{name}.csv"
frequency_hz = {frequency_hz}
eccentricity_mm = {eccentricity_mm}
strut_phase_rad = {phase_rad}
carriage_speed_m_s = {speed_m_s}
medium = "{medium}"
"""

State = tuple[np.ndarray, ...]
Waves = Callable[[np.ndarray], np.ndarray]


def written(
    folder: Path,
    *,
    amplitudes_m: tuple[float, ...] = (0.05, 0.1),
    kinds: tuple[str, ...] = ("sway", "yaw"),
    dry: bool = False,
    columns: Mapping[str, str] | None = None,
    lasting_s: Mapping[str, float] | None = None,
    mass_kg: float = MASS_KG,
    more: str = "",
    frequencies_hz: tuple[float, ...] = (0.25, 0.4),
    waves: Waves | None = None,
    cross: Mapping[str, float] | None = None,
) -> Path:
    """Write a campaign, of two frequencies by default, and return its folder.

    Parameters
    ----------
    dry
        Whether there are runs in air as well.
    columns
        Which channel is said to be in which column; by default all in the right one.
    lasting_s
        Of runs that are not 56 s long.
    mass_kg
        What the campaign file says.
    more
        To stand in the campaign file.
    waves
        Load of the waves that sway makes, per velocity, at some frequencies in Hz; kg/s.
    cross
        Further terms of Y; all loads then go with the square of the model's own speed.
    """
    text = HEAD.format(
        mass_kg=mass_kg,
        more=more,
        columns="\n".join(
            f'{a} = "{b}"' for a, b in (COLUMNS if columns is None else columns).items()
        ),
    )
    runs = [
        (f"{kind}-{frequency_hz}-{size_m}", kind, frequency_hz, size_m, medium)
        for medium in (("water", "air") if dry else ("water",))
        for frequency_hz in frequencies_hz
        for size_m in amplitudes_m
        for kind in kinds
    ]
    for seed, (stem, kind, frequency_hz, size_m, medium) in enumerate(runs):
        name = stem if medium == "water" else f"dry-{stem}"
        speed = SPEED_M_S if medium == "water" else 0.0
        turned = 2.0 * math.atan2(2.0 * math.pi * frequency_hz * HALF_M, speed)
        phase_rad = {"sway": 0.0, "yaw": turned, "mixed": 0.5 * turned}[kind]
        lasts_s = (lasting_s or {}).get(name, 56.0)
        wet = medium == "water"
        record = read(
            frequency_hz, size_m, phase_rad, speed, lasts_s, seed, wet=wet, waves=waves, cross=cross
        )
        header = ";".join(["Zeit [s]", *WITH_SURGE.values()])
        np.savetxt(folder / f"{name}.csv", record, "%.6f", ";", header=header, comments="")
        text += RUN.format(
            name=name, frequency_hz=frequency_hz, eccentricity_mm=1e3 * size_m,
            phase_rad=phase_rad, speed_m_s=speed, medium=medium,
        )  # fmt: skip
    (folder / "campaign.toml").write_text(text)
    return folder


def read(
    frequency_hz: float, size_m: float, phase_rad: float, speed_m_s: float, lasts_s: float,
    seed: int, *, wet: bool, waves: Waves | None = None, cross: Mapping[str, float] | None = None,
) -> np.ndarray:  # fmt: skip
    """Return time, displacements in mm and forces in N, as columns; the last is that ahead."""
    time_s = np.arange(round(lasts_s * RATE_HZ)) / RATE_HZ

    def place(at_s: np.ndarray) -> State:
        angle = 2.0 * math.pi * frequency_hz * at_s + FIRST_RAD
        aft, fore = size_m * np.sin(angle), size_m * np.sin(angle + phase_rad)
        heading = np.arctan((fore - aft) / (2.0 * HALF_M))  # the aft strut's pivot is the model's
        return (
            speed_m_s * at_s - HALF_M + HALF_M * np.cos(heading),
            aft + HALF_M * np.sin(heading),
            heading,
            aft,
            fore,
        )

    def velocity(at_s: np.ndarray) -> State:
        ahead, across, rate = _slope(lambda t: place(t)[:3], at_s)
        heading = place(at_s)[2]
        along = ahead * np.cos(heading) + across * np.sin(heading)
        return along, across * np.cos(heading) - ahead * np.sin(heading), rate

    along, v, r = velocity(time_s)
    u_dot, v_dot, r_dot = _slope(velocity, time_s)
    turned = v_dot + along * r
    force = MASS_KG * (turned + CG_X_M * r_dot)
    moment = INERTIA_KG_M2 * r_dot + MASS_KG * CG_X_M * turned
    ahead = MASS_KG * (u_dot - v * r - CG_X_M * r**2)
    if wet:
        of = PUT_IN
        way = np.hypot(along, v) / speed_m_s if cross is not None else np.ones_like(v)
        force = force - of["Y_vdot"] * v_dot - of["Y_rdot"] * r_dot - of["Y_r"] * r * way
        force = force - of["Y_v"] * v * way - of["Y_vvv"] * v**3 / way
        for name, value in (cross or {}).items():
            force = force - value * v ** name.count("v") * r ** name.count("r") / way
        if waves is not None:
            force = force + _waves(waves, frequency_hz, lambda t: velocity(t)[1], time_s)
        moment = moment - of["N_vdot"] * v_dot - of["N_rdot"] * r_dot
        moment = moment - (of["N_v"] * v + of["N_r"] * r) * way
        ahead = ahead - SURGE["X_0"] * (along / speed_m_s) ** 2 - SURGE["X_vv"] * v**2
        ahead = ahead - SURGE["X_vr"] * v * r - SURGE["X_rr"] * r**2 - SURGE["X_udot"] * u_dot
    _, _, heading, aft, fore = place(time_s)
    lever_fore = 2.0 * HALF_M / np.cos(heading) - HALF_M  # the fore strut slides along the model
    at_fore = (moment + force * HALF_M) / (lever_fore + HALF_M)
    noise = np.random.default_rng(seed).normal(size=(5, len(time_s)))
    return np.stack(
        [
            time_s,
            1e3 * (aft + NOISE_M * noise[0]),
            1e3 * (fore + NOISE_M * noise[1]),
            force - at_fore + NOISE_N * noise[2] + OFFSETS_N[0],
            at_fore + NOISE_N * noise[3] + OFFSETS_N[1],
            ahead + NOISE_N * noise[4],
        ],
        axis=1,
    )


def _slope(of: Callable[[np.ndarray], State], at_s: np.ndarray) -> State:
    before, after = of(at_s - STEP_S), of(at_s + STEP_S)
    return tuple((b - a) / (2.0 * STEP_S) for a, b in zip(before, after, strict=True))


def _waves(
    waves: Waves, frequency_hz: float, v: Callable[[np.ndarray], np.ndarray], time_s: np.ndarray
) -> np.ndarray:
    """Return the load of the waves, order by order: the motion has gone on for ever."""
    orders = np.arange(1, 8)
    turns = np.arange(256) / 256
    parts = np.fft.rfft(v(turns / frequency_hz))[orders] / 128
    angles = 2j * math.pi * frequency_hz * np.outer(time_s, orders)
    return np.asarray((np.exp(angles) @ (waves(orders * frequency_hz) * parts)).real)


def exchanged(*names: str) -> dict[str, str]:
    """Return the columns with those of two channels exchanged."""
    first, second = names
    return COLUMNS | {first: COLUMNS[second], second: COLUMNS[first]}
