"""Rows of the archive as a Parquet file, for other programs."""

from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path

from pmm.archive.expression import NUMBER, KnownColumn
from pmm.archive.queries import Row
from pmm.archive.results import LEVEL
from pmm.whole_file import write_whole

_WHOLE = ("repeat", "gate", "order")


def write_parquet(columns: Mapping[str, KnownColumn], rows: Sequence[Row], path: Path) -> None:
    """Write rows; what is not known is null, the intervals' level is in the metadata."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    def kind(name: str) -> pa.DataType:
        if name in _WHOLE:
            return pa.int32()
        return pa.float64() if columns[name].kind == NUMBER else pa.string()

    schema = pa.schema([(name, kind(name)) for name in columns], {"level": repr(LEVEL)})
    file = BytesIO()
    pq.write_table(pa.Table.from_pylist([dict(one) for one in rows], schema), file)
    write_whole(path, file.getvalue())
