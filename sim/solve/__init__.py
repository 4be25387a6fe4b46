"""What the stages are solved with: exact linear steps, sweeps, periods and compiled loops."""
