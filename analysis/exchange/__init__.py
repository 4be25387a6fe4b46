"""What other systems write and read: SIMMAN's deliverables, MATLAB's and LabVIEW's files.

:mod:`~analysis.exchange.simman` writes and reads the averaged cycle with its Fourier coefficients;
:mod:`~analysis.exchange.mat` and :mod:`~analysis.exchange.tdms` read recordings, which
:func:`analysis.readers.read_recording` calls by the file's ending. ``docs/exchange.md`` has the
layouts.
"""
