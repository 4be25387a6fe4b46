"""The Python front door: ``import pmm``, then :func:`pmm.open` and :func:`pmm.simulate`.

Each call does what a command does, by the same functions, and returns a result that tells itself as
the command's tables, as a data frame, as a dataset and as figures (``docs/python.md``).
"""
