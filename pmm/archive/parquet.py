"""Harmonics as a Parquet file, for other programs."""

from io import BytesIO
from pathlib import Path

from pmm.archive.expression import NUMBER
from pmm.archive.queries import HARMONIC_COLUMNS, RUN_COLUMNS, Row
from pmm.archive.results import LEVEL
from pmm.whole_file import write_whole

_WHOLE = ("repeat", "gate", "order")


def write_parquet(rows: list[Row], path: Path) -> None:
    """Write harmonics, a row each; what is not known is null, the level is in the metadata."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    known = RUN_COLUMNS | HARMONIC_COLUMNS
    names = [one for one in known if one not in ("sha256", "amplitude")] + ["channel", "order"]

    def kind(name: str) -> pa.DataType:
        if name in _WHOLE:
            return pa.int32()
        return pa.float64() if name in known and known[name].kind == NUMBER else pa.string()

    schema = pa.schema([(name, kind(name)) for name in names], {"level": repr(LEVEL)})
    file = BytesIO()
    pq.write_table(pa.Table.from_pylist([dict(one) for one in rows], schema), file)
    write_whole(path, file.getvalue())
