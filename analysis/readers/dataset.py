"""A recording as an :class:`xarray.Dataset` and back: the schema that simulator and files share."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from analysis.readers.attributes import (
    channel_attributes,
    channel_names,
    check_storable,
    check_time,
    parse_channel,
    parse_run,
    run_attributes,
)
from analysis.recording import Recording
from hardware.description import dataset as schema

if TYPE_CHECKING:
    import xarray


def to_dataset(recording: Recording) -> "xarray.Dataset":
    """Turn a recording into a dataset; lazily read samples are read whole.

    It is as :mod:`hardware.description.dataset` says.

    Raises
    ------
    DataError
        If the recording has no samples, or a channel's name or unit cannot be kept.
    """
    import xarray as xr

    check_storable(recording)
    samples = recording.samples[:, 0 : recording.sample_count]
    variables: dict[str, Any] = {
        channel.name: (schema.TIME, values, channel_attributes(channel))
        for channel, values in zip(recording.channels, samples, strict=True)
    }
    if recording.photocell_edges_s is not None:
        edges = np.asarray(recording.photocell_edges_s, dtype=np.float64)
        variables[schema.EDGE_TIME] = (schema.EDGE, edges, {schema.UNITS: "s"})
    time = (schema.TIME, recording.time_s(), {schema.UNITS: "s"})
    return xr.Dataset(variables, {schema.TIME: time}, run_attributes(recording))


def from_dataset(dataset: "xarray.Dataset", name: str | None = None) -> Recording:
    """Turn a dataset, such as the simulator's, into a recording.

    Parameters
    ----------
    name
        What the run is called; ``None`` takes the dataset's own name.

    Raises
    ------
    DataError
        If the dataset does not follow the schema; the message names the variable or attribute.
    """
    where = name or str(dataset.attrs.get(schema.ATTR_NAME, "dataset"))
    dimensions = {str(key): tuple(map(str, value.dims)) for key, value in dataset.variables.items()}
    names = channel_names(dimensions, where)
    edges = dataset.get(schema.EDGE_TIME)
    time_s = np.asarray(dataset[schema.TIME].values, dtype=np.float64)
    recording = parse_run(
        dataset.attrs,
        tuple(parse_channel(key, dataset[key].attrs, where) for key in names),
        np.array([dataset[key].values for key in names], dtype=np.float64),
        float(time_s[0]) if time_s.size else 0.0,
        None if edges is None else np.asarray(edges.values, dtype=np.float64),
        where,
    )
    check_time(time_s, recording, 0, where)
    return replace(recording, name=name or recording.name)
