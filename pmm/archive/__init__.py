"""What is known over many campaign folders, in one SQLite file that can be made again from them.

:mod:`~pmm.archive.contents` reads a folder, :mod:`~pmm.archive.indexing` takes it in,
:mod:`~pmm.archive.queries` answers. Computing is handed in by the command.
"""
