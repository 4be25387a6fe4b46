"""A campaign's coefficients as JSON and as NetCDF, and back, without loss.

JSON has no numbers that are not finite: NaN is ``null``, infinity the text ``"inf"``. In the
dataset the contributions stand as one long table (input, deviate, entry, part), which most inputs
leave almost empty; records that are no arrays stand as JSON in its attributes.
"""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from analysis.coefficients.campaign_records import (
    CoefficientEntry,
    ConsistencyCheck,
    FormChoice,
    Missing,
    OtherArrangement,
    Outlier,
    ReferenceRow,
)
from analysis.coefficients.campaign_result import CampaignCoefficients, TrialColumns
from analysis.coefficients.names import Form
from analysis.coefficients.recommendation import table
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag
from hardware.description.oscillator import Plane

if TYPE_CHECKING:
    import xarray as xr

SCHEMA = "pmm coefficients 1"

_RECORDS: Mapping[str, type] = {
    "choices": FormChoice,
    "checks": ConsistencyCheck,
    "outliers": Outlier,
    "arrangements": OtherArrangement,
    "missing": Missing,
    "references": ReferenceRow,
}
_TEXTS = ("name", "unit", "method")
Record = TypeVar("Record")


def to_dict(result: CampaignCoefficients) -> dict[str, Any]:
    """Return a campaign's coefficients with nothing but what JSON knows."""
    contributions = [
        {
            "label": contribution.label,
            "degrees_of_freedom": contribution.degrees_of_freedom,
            "rows": contribution.rows.tolist(),
            "parts": contribution.parts.tolist(),
        }
        for contribution in result.uncertain.contributions
    ]
    content = {
        **_head(result),
        "table": list(table(result)),
        "contributions": contributions,
        "trials": {
            "count": result.trials.count,
            "standard_uncertainty": result.trials.standard_uncertainty.tolist(),
        },
        **{name: [asdict(record) for record in getattr(result, name)] for name in _RECORDS},
        "flags": [asdict(flag) for flag in result.flags],
    }
    plain: dict[str, Any] = _plain(content)
    return plain


def from_dict(content: Mapping[str, Any]) -> CampaignCoefficients:
    """Return what :func:`to_dict` was given.

    Raises
    ------
    DataError
        If the content is of another kind.
    """
    _check_schema(content.get("schema"))
    table = content["table"]
    size = len(table)
    contributions = tuple(
        Contribution(
            str(contribution["label"]),
            _number(contribution["degrees_of_freedom"]),
            np.array(contribution["rows"], dtype=np.int64),
            _numbers(contribution["parts"]).reshape(len(contribution["rows"]), -1),
        )
        for contribution in content["contributions"]
    )
    trials = TrialColumns(
        int(content["trials"]["count"]),
        _numbers(content["trials"]["standard_uncertainty"]),
        _numbers([row["trials_low"] for row in table]),
        _numbers([row["trials_high"] for row in table]),
    )
    values = _numbers([row["value"] for row in table]).reshape(size)
    names = [field.name for field in fields(CoefficientEntry)]
    entries = tuple(_record(CoefficientEntry, {name: row[name] for name in names}) for row in table)
    return _result(content, entries, UncertainValues(values, contributions), trials)


def to_dataset(result: CampaignCoefficients) -> "xr.Dataset":
    """Return a campaign's coefficients as a dataset with the dimensions entry and contribution."""
    import xarray as xr

    rows = list(table(result))
    columns: dict[str, Any] = {
        key: ("entry", np.array([row[key] for row in rows], dtype=None if key in _TEXTS else float))
        for key in (rows[0] if rows else {})
        if key != "runs"
    }
    columns["runs"] = ("entry", np.array([json.dumps(row["runs"]) for row in rows]))
    trials_spread = result.trials.standard_uncertainty
    columns["trials_standard_uncertainty"] = ("entry", trials_spread)
    columns |= _long_table(result.uncertain.contributions)
    inputs = result.uncertain.contributions
    columns["input_label"] = (
        "input",
        np.array([contribution.label for contribution in inputs], dtype=str),
    )
    freedom = np.array([contribution.degrees_of_freedom for contribution in inputs])
    columns["input_degrees_of_freedom"] = ("input", freedom)
    attributes: dict[str, Any] = {**_head(result), "trials": result.trials.count}
    for name in (*_RECORDS, "flags"):
        attributes[name] = json.dumps(_plain([asdict(record) for record in getattr(result, name)]))
    return xr.Dataset(columns, attrs=attributes)


def from_dataset(dataset: "xr.Dataset") -> CampaignCoefficients:
    """Return what :func:`to_dataset` was given.

    Raises
    ------
    DataError
        If the dataset is of another kind.
    """
    attributes = dataset.attrs
    _check_schema(attributes.get("schema"))
    size = dataset.sizes["entry"]
    content: dict[str, Any] = {**attributes}
    for name in (*_RECORDS, "flags"):
        content[name] = json.loads(attributes[name])
    by_name = {
        field.name: dataset[field.name].values.tolist() for field in fields(CoefficientEntry)
    }
    by_name["runs"] = [json.loads(text) for text in by_name["runs"]]
    entries = tuple(
        _record(CoefficientEntry, {name: column[k] for name, column in by_name.items()})
        for k in range(size)
    )
    names = ("trials_standard_uncertainty", "trials_low", "trials_high")
    trials = TrialColumns(int(attributes["trials"]), *(dataset[n].values for n in names))
    values = np.asarray(dataset["value"].values, dtype=np.float64)
    return _result(content, entries, UncertainValues(values, _from_long(dataset)), trials)


def _head(result: CampaignCoefficients) -> dict[str, Any]:
    return {
        "schema": SCHEMA,
        "form": str(result.form),
        "plane": str(result.plane),
        "normalisation": result.normalisation,
        "level": result.level,
    }


def _result(
    content: Mapping[str, Any],
    entries: tuple[CoefficientEntry, ...],
    uncertain: UncertainValues,
    trials: TrialColumns,
) -> CampaignCoefficients:
    records: dict[str, Any] = {
        name: tuple(_record(kind, record) for record in content[name])
        for name, kind in _RECORDS.items()
    }
    flags = tuple(map(Flag.read, content["flags"]))
    return CampaignCoefficients(
        Form(content["form"]),
        Plane(content["plane"]),
        str(content["normalisation"]),
        float(content["level"]),
        entries,
        uncertain,
        trials,
        flags=flags,
        **records,
    )


def _long_table(contributions: Sequence[Contribution]) -> dict[str, Any]:
    """Return entry, input, deviate and part of everything that is in the contributions."""
    long_rows: list[tuple[Any, ...]] = [(np.zeros(0),) * 4]
    for k, contribution in enumerate(contributions):
        rows, deviates = np.meshgrid(
            contribution.rows, np.arange(contribution.parts.shape[1]), indexing="ij"
        )
        inputs = np.full(rows.size, k)
        long_rows.append((rows.ravel(), inputs, deviates.ravel(), contribution.parts.ravel()))
    names = ("of_entry", "of_input", "of_deviate", "part")
    kinds = (np.int64, np.int64, np.int64, np.float64)
    return {
        name: ("contribution", np.concatenate(column).astype(kind))
        for name, kind, column in zip(names, kinds, zip(*long_rows, strict=True), strict=True)
    }


def _from_long(dataset: "xr.Dataset") -> tuple[Contribution, ...]:
    names = ("of_entry", "of_input", "of_deviate", "part")
    entry, owner, deviate, part = (dataset[name].values for name in names)
    labels = dataset["input_label"].values.tolist()
    freedom = dataset["input_degrees_of_freedom"].values
    contributions = []
    for k, label in enumerate(labels):
        of_label = owner == k
        count = int(deviate[of_label].max()) + 1
        rows = entry[of_label].reshape(-1, count)[:, 0]
        parts = part[of_label].reshape(-1, count)
        contributions.append(Contribution(str(label), float(freedom[k]), rows, parts))
    return tuple(contributions)


def _check_schema(schema: object) -> None:
    if schema != SCHEMA:
        raise DataError(f"no coefficients of a campaign: schema {schema!r}, {SCHEMA!r} is needed")


def _record(kind: type[Record], content: Mapping[str, Any]) -> Record:
    """Build a record: lists are tuples, text and ``None`` are numbers where the field is one."""
    annotations = {field.name: str(field.type) for field in fields(kind)}  # type: ignore[arg-type]
    return kind(**{name: _typed(content[name], wanted) for name, wanted in annotations.items()})


def _typed(value: Any, wanted: str) -> Any:
    if "float" in wanted:
        return tuple(map(_number, value)) if "tuple" in wanted else _number(value)
    return tuple(value) if isinstance(value, list | tuple) else value


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else ("inf" if value > 0.0 else "-inf")
    return value


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)


def _numbers(values: Any) -> FloatArray:
    if isinstance(values, list):
        return np.array([_numbers(value) for value in values], dtype=np.float64)
    return np.asarray(_number(values))
