"""How the equations are solved: linear steps, harmonic balance, marches and sweeps."""
