"""What other systems write and read: SIMMAN's deliverables, MATLAB's and LabVIEW's files.

:mod:`~analysis.exchange.simman` writes and reads the averaged cycle with its Fourier coefficients;
:mod:`analysis.foreign` reads recordings. ``docs/exchange.md`` has the layouts.
"""
