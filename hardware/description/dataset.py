"""Names in the dataset of a run, as the simulator returns it and as a recording is kept on disk.

A run is an :class:`xarray.Dataset` with

* a dimension ``time`` with the coordinate ``time`` in seconds, evenly spaced;
* one variable per channel over ``time``, named as the channel, with the attribute ``units`` (SI)
  and, where known, ``full_scale``;
* optionally a dimension ``photocell_edge`` with the variable ``photocell_edge_time`` in seconds,
  one per pulse, not tied to the samples;
* the attributes below.

A file also has the group ``checksums``, which says what each variable and attribute was when it was
written (:mod:`analysis.readers.checksums`).

``docs/formats.md`` describes the same for people.
"""

from typing import Final

SCHEMA: Final = "pmm-run-1"

TIME: Final = "time"
EDGE: Final = "photocell_edge"
EDGE_TIME: Final = "photocell_edge_time"

UNITS: Final = "units"
FULL_SCALE: Final = "full_scale"

# Attributes of the dataset.
ATTR_SCHEMA: Final = "schema"
ATTR_NAME: Final = "run_name"
ATTR_SAMPLE_RATE: Final = "sample_rate_hz"
ATTR_SET_POINT: Final = "set_point"  # JSON of a SetPoint
ATTR_PROVENANCE: Final = "provenance"  # JSON, text to text
ATTR_FLAGS: Final = "flags"  # JSON, a list of flags
ATTR_CHECKSUMS: Final = "checksums"  # of a file: what kind of checksums its group holds

CHECKSUMS: Final = "checksums"  # the group

# Keys of the provenance that run control writes: the gate that the photocell opened and closed.
GATE_OPENED: Final = "gate_opened_s"
GATE_PERIODS: Final = "gate_periods"
