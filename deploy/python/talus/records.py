"""The measures of a study as a table: from realizations.csv, or from the records in runs/ where that is behind."""

from __future__ import annotations

import json
import pathlib
from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from talus.errors import FileError

_TEXTS = ["status", "digest", "reason", "verdict", "verdict_reasons", "lower_bounds"]
_FAILED = ".failed.json"


def read_document(path: pathlib.Path) -> dict[str, Any]:
    """A JSON file. Raises FileError naming it where it is missing or damaged."""
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise FileError(f"{path} cannot be read: {error}") from error
    if not isinstance(document, dict):
        raise FileError(f"{path} is not a document of Talus")
    return document


def read_measures(directory: pathlib.Path) -> pd.DataFrame:
    """One row per realization that has ended. A record of runs/ that is damaged counts as not run, as for `talus
    study`.

    Returns:
        indexed by `realization`, in order; the columns of realizations.csv (units in their names), texts empty where
        there is none
    Raises:
        FileError: realizations.csv is damaged
    """
    table, runs = directory / "realizations.csv", directory / "runs"
    records = sum(1 for _ in _record_files(runs))
    if table.exists():
        found = _from_table(table)
        if len(found) >= records:
            return found
    rows = [row for row in map(_row, _record_files(runs)) if row]
    frame = pd.DataFrame(rows, columns=None if rows else ["realization", *_TEXTS]).set_index("realization").sort_index()
    return frame.assign(**{name: frame[name].fillna("") for name in _TEXTS if name in frame})


def read_table(path: pathlib.Path, index: str) -> pd.DataFrame:
    """A CSV file of Talus: every number as it was written, to the last bit; empty ones are NaN. The checksums of its
    lines are left to talus. Raises FileError where it is damaged."""
    try:
        frame = pd.read_csv(path, dtype=str, keep_default_na=False).drop(columns="checksum", errors="ignore")
        frame = pd.DataFrame({name: frame[name] if name in _TEXTS else _numbers(frame[name]) for name in frame})
        return frame.set_index(index)
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise FileError(
            f"{path} cannot be read: {error}; `talus stats --from-runs` writes the tables of a study again"
        ) from error


def _numbers(column: pd.Series[Any]) -> pd.Series[Any]:
    whole = column.str.fullmatch("-?[0-9]+").all()
    return column.astype("int64") if whole else column.where(column != "", "nan").astype(float)


def _from_table(path: pathlib.Path) -> pd.DataFrame:
    return read_table(path, "index").rename_axis("realization").sort_index()


def _record_files(runs: pathlib.Path) -> Iterator[pathlib.Path]:
    """Results and failure records: NUMBER.json and NUMBER.failed.json."""
    for path in runs.glob("*.json") if runs.is_dir() else ():
        if path.name.split(".", 1)[0].isdigit():
            yield path


def _row(path: pathlib.Path) -> dict[str, Any] | None:
    try:
        document = read_document(path)
    except FileError:
        return None
    index = {"realization": int(path.name.split(".", 1)[0])}
    if path.name.endswith(_FAILED):
        return index | {"status": "failed", "reason": str(document.get("reason", ""))}
    return index | row_of_result(document)


def row_of_result(result: Mapping[str, Any]) -> dict[str, Any]:
    """The row of a result.json, with the names of realizations.csv. An invalid result counts as failed."""
    quality = result.get("quality", {})
    invalid = quality.get("verdict") == "invalid"
    objections = "; ".join(f"{reason['check']}: {reason['message']}" for reason in quality.get("reasons", ()))
    row = {
        "status": "failed" if invalid else "done",
        "reason": f"invalid result: {objections}" if invalid else "",
        "verdict": quality.get("verdict", "not_assessed"),
        "verdict_reasons": objections,
        "lower_bounds": " ".join(result.get("lower_bounds", ())),
        "digest": result.get("digest", ""),
    }
    if invalid:
        return row
    numbers = {name: value for name, value in result.items() if name.endswith("_m") and not isinstance(value, Mapping)}
    for target in result.get("targets", ()):
        numbers |= {f"{target['name']}.{key}": value for key, value in target.items() if key not in ("name", "kind")}
    field = result.get("field") or {}
    numbers |= {name: field.get(name) for name in ("mean_friction_angle_deg", "captured_variance")}
    return row | numbers | {name: result.get(name) for name in ("steps", "wall_clock_s", "left_domain")}


def draws_of_result(result: Mapping[str, Any]) -> dict[str, float]:
    """What came out for the soil of a run: the numbers under `field`, members of objects as "cohesion.mean_kPa"."""
    found: dict[str, float] = {}

    def add(prefix: str, value: Any) -> None:
        if isinstance(value, Mapping):
            for name, member in value.items():
                add(f"{prefix}.{name}" if prefix else name, member)
        elif isinstance(value, (int, float)) and not isinstance(value, bool):
            found[prefix] = value

    add("", result.get("field") or {})
    return found
