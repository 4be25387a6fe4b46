"""Make ``hulls.csv``: added mass and damping of four hulls by a panel method, zero frequency too.

Run from the project's root where capytaine 3.0 is installed (the project itself does not need it):
``python -m tests.data.panel.make``.
"""

import csv
import math
from pathlib import Path
from typing import Any, Final

import capytaine as cpt
import numpy as np

HERE = Path(__file__).parent
FREQUENCIES_HZ: Final = (0.0, *(round(float(f), 3) for f in np.geomspace(0.1, 2.0, 20)))
DOFS: Final = ("Heave", "Pitch", "Sway", "Yaw")
SUBMERGED_M: Final = 0.4


def spheroid(length_m: float, diameter_m: float, depth_m: float) -> Any:
    """Return the panels of a spheroid whose axis lies at a depth."""
    sphere = cpt.mesh_sphere(radius=1.0, resolution=(40, 40))
    axes = np.array([length_m, diameter_m, diameter_m]) / 2.0
    vertices = sphere.vertices * axes - np.array([0.0, 0.0, depth_m])
    return cpt.Mesh(vertices=vertices, faces=sphere.faces)


def box(length_m: float, beam_m: float, draught_m: float, offset_m: float) -> Any:
    """Return the panels of a box, half of which lies above the water."""
    size = (length_m, beam_m, 2.0 * draught_m)
    return cpt.mesh_parallelepiped(size=size, resolution=(36, 6, 8), center=(0.0, offset_m, 0.0))


def hulls() -> dict[str, Any]:
    """Return the meshes by name."""
    cylinder = cpt.mesh_vertical_cylinder(radius=0.4, length=1.0, resolution=(12, 40, 20))
    twin = box(2.5, 0.25, 0.15, -0.35).join_meshes(box(2.5, 0.25, 0.15, 0.35))
    return {
        "spheroid_L3.0_B0.5": spheroid(3.0, 0.5, 0.0).immersed_part(),
        "submerged_spheroid_L3.0_D0.4_depth0.4": spheroid(3.0, 0.4, SUBMERGED_M),
        "cylinder_R0.4_T0.5": cylinder.immersed_part(),
        "twin_hull_L2.5_B0.25_T0.15_gap0.45": twin.immersed_part(),
    }


def rows(name: str, mesh: Any) -> list[list[str]]:
    """Return frequency, added mass and damping of each motion, in SI units."""
    depth = SUBMERGED_M if name.startswith("submerged") else 0.0
    body = cpt.FloatingBody(
        mesh=mesh,
        lid_mesh=None if depth else mesh.generate_lid(),
        dofs=cpt.rigid_body_dofs(rotation_center=(0.0, 0.0, -depth)),
        name=name,
    )
    solver, found = cpt.BEMSolver(), []
    for frequency_hz in FREQUENCIES_HZ:
        for dof in DOFS[: 3 if name.startswith("cylinder") else 4]:  # a round one makes no yaw
            omega = 2.0 * math.pi * frequency_hz
            problem = cpt.RadiationProblem(
                body=body, radiating_dof=dof, omega=omega, rho=1000.0, g=9.81
            )
            result = solver.solve(problem, keep_details=False)
            values = (result.added_masses[dof], result.radiation_dampings[dof])
            texts = (f"{values[0]:.6g}", f"{values[1]:.5g}")
            found.append([name, dof.lower(), f"{frequency_hz:g}", *texts])
    return found


if __name__ == "__main__":
    with (HERE / "hulls.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["body", "dof", "freq_hz", "added_mass", "damping"])
        for name, mesh in hulls().items():
            writer.writerows(rows(name, mesh))
