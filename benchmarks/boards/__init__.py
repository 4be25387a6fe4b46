"""Boards: many campaigns through the product's own commands, each case a line that is kept.

``python -m benchmarks.boards nulls``, ``friction`` and ``mutations`` measure a slice and go on
where they were broken off; ``benchmarks.boards.table`` counts what is there.
"""
