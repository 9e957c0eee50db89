"""Directories of runs and studies, opened for reading. All numbers are those that talus wrote or prints."""

from __future__ import annotations

import json
import os
import pathlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd
import xarray as xr

from talus.errors import FileError
from talus.program import call, options
from talus.records import draws_of_result, read_document, read_measures, read_table, row_of_result
from talus.snapshots import read_snapshots

_CASE = "case.resolved.json"


class Run:
    """The directory of a run; also of one that is still going on or was stopped. Reading is thread-safe.

    Raises:
        FileError: the directory does not hold a run
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.path = pathlib.Path(directory)
        if not (self.path / _CASE).exists() or (self.path / "plan.json").exists():
            raise FileError(f"{self.path} does not hold a run: `talus.run` or `talus run --out` makes one")

    def __repr__(self) -> str:
        return f"<talus.Run {self.path}{'' if self.finished else ', not finished'}>"

    @property
    def finished(self) -> bool:
        """Whether it has a result."""
        return (self.path / "result.json").exists()

    @property
    def result(self) -> dict[str, Any]:
        """result.json; units are in the keys. Raises FileError where the run has not finished."""
        if not self.finished:
            raise FileError(f"{self.path} has no result yet: the run goes on or was stopped; `talus.run` continues it")
        return read_document(self.path / "result.json")

    @property
    def case(self) -> dict[str, Any]:
        """The case with all defaults; itself a valid case."""
        return read_document(self.path / _CASE)

    @property
    def verdict(self) -> str:
        """sound, doubtful, invalid or not_assessed; the reasons are in result["quality"]."""
        return str(self.result.get("quality", {}).get("verdict", "not_assessed"))

    @property
    def measures(self) -> pd.Series[Any]:
        """The row of this run in the table of a study."""
        return pd.Series(row_of_result(self.result))

    @property
    def history(self) -> pd.DataFrame:
        """history.csv: front [m], centre of mass [m], speed [m/s] and energies [J/m], indexed by `time_s`."""
        return self._table("history.csv")

    @property
    def targets(self) -> pd.DataFrame:
        """targets.csv: depth, speed, dynamic pressure and load at the targets, indexed by `time_s`; of cases with
        targets."""
        return self._table("targets.csv")

    def snapshots(self, *, walls: bool = False, fields: Sequence[str] | None = None) -> xr.Dataset:
        """The snapshots; see `talus.read_snapshots`. Positions are those of the case's own coordinates [m]."""
        return read_snapshots(self.path / "snapshots.vtkhdf", walls=walls, fields=fields)

    def _table(self, name: str) -> pd.DataFrame:
        path = self.path / name
        if not path.exists():
            raise FileError(f"{path} does not exist: the run has just begun, or its case has no such records")
        return read_table(path, "time_s")


class Study:
    """The directory of a study or of a job of talusd; also of one that is still going on, was killed, or has failed
    runs. Reading is thread-safe.

    Raises:
        FileError: the directory does not hold a study
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.path = pathlib.Path(directory)
        if not (self.path / "plan.json").exists():
            raise FileError(f"{self.path} does not hold a study: `talus.study` or `talus study --out` makes one")
        self.plan: dict[str, Any] = read_document(self.path / "plan.json")
        self.seed = int(self.plan["seed"])
        """Key of all random numbers."""
        self.planned = int(self.plan["realizations"])
        """Number of realizations that the study asks for."""

    def __repr__(self) -> str:
        return f"<talus.Study {self.path}: {len(self.measures)} of {self.planned} realizations>"

    @property
    def case(self) -> dict[str, Any]:
        """The case with all defaults; itself a valid case."""
        return read_document(self.path / _CASE)

    @property
    def measures(self) -> pd.DataFrame:
        """One row per realization that has ended, indexed by `realization`: the columns of realizations.csv (lengths
        in m, angles in deg), with `status` (done, failed), `verdict` and `verdict_reasons`. A study that was killed is
        read from its records.
        """
        return read_measures(self.path)

    @property
    def complete(self) -> bool:
        """Whether all planned realizations have ended."""
        return len(self.measures) >= self.planned

    @property
    def summary(self) -> dict[str, Any]:
        """study.json: statistics of all measures, with their intervals, as talus computed them.

        Raises:
            FileError: there is none yet; `talus.study` continues the study, `refresh` makes one of what has ended
        """
        if not (self.path / "study.json").exists():
            raise FileError(
                f"{self.path} has no study.json: the study goes on or was killed. `talus.study` continues it; "
                "refresh() makes a summary of the realizations that have ended"
            )
        return read_document(self.path / "study.json")

    def refresh(self) -> dict[str, Any]:
        """Lets talus write the tables and study.json from the records, and returns the summary. Not while the study
        goes on.

        Raises:
            FileError: another process works in the directory, or no realization has ended
        """
        call(["stats", str(self.path), "--from-runs", "--json"])
        return self.summary

    def exceedance(
        self, x: Iterable[float] = (), *, quantity: str | None = None, targets: Iterable[str] = ()
    ) -> pd.DataFrame:
        """Probability that a quantity is beyond each x, or that targets are reached: the answer of `talus stats --at`.

        Args:
            x: in the unit that ends the quantity's name
            quantity: key of a measure, or TARGET.NUMBER ("house.peak_depth_m"); None: the leading one, front_mass_99_m
            targets: names of targets of the case
        Returns:
            a row per value: `quantity`, `x`, `k` of `n` realizations, `p`, and its 95 % interval `lo` to `hi` (Wilson)
        Raises:
            FileError: there are no tables yet; see refresh
            UsageError, CaseError: no such quantity or target
        """
        asked = [str(value) for value in x] + [f"name={name}" for name in targets]
        if not asked:
            raise ValueError("neither x nor targets are given")
        at = [argument for value in asked for argument in ("--at", value)]
        output = call(["stats", str(self.path), *options(None, quantity=quantity), *at, "--json"])
        return pd.DataFrame(json.loads(output))

    def distribution(
        self, quantity: str, *, bins: int | None = None, edges: Sequence[float] | None = None
    ) -> dict[str, Any]:
        """Statistics and histogram of a measure with other bins: what `talus stats --quantity` prints. Raises as
        exceedance."""
        joined = None if edges is None else ",".join(map(str, edges))
        found: dict[str, Any] = json.loads(
            call(["stats", str(self.path), *options(None, quantity=quantity, bins=bins, edges=joined)])
        )
        return found

    def draws(self, realizations: Iterable[int] | None = None) -> pd.DataFrame:
        """What was drawn for the soil of realizations: the numbers under `field` of their results.

        Args:
            realizations: indices; None: all that have a result in runs/ (a merged study has none)
        Returns:
            indexed by `realization`, with `seed`; columns such as mean_friction_angle_deg; units are in their names
        Raises:
            FileError: a realization that is asked for has no result
        """
        runs = self.path / "runs"
        if realizations is None:
            realizations = sorted(int(path.stem) for path in runs.glob("*.json") if path.stem.isdigit())
        rows = [
            {"realization": i, "seed": self.seed} | draws_of_result(read_document(runs / f"{i:06d}.json"))
            for i in realizations
        ]
        return pd.DataFrame(rows, columns=None if rows else ["realization", "seed"]).set_index("realization")

    def xi(self, realizations: Iterable[int] | None = None) -> pd.DataFrame:
        """The standard normal coefficients of the random field of realizations, drawn again by `talus field`: they
        depend on seed and index alone. Takes some 0.05 s for each.

        Args:
            realizations: indices >= 0; None: all of `measures`
        Returns:
            a row per realization, indexed by `realization`; columns are the numbers of the modes, from 1
        """
        indices = list(self.measures.index if realizations is None else realizations)
        path = str(self.path / _CASE)
        rows = [
            json.loads(call(["field", path, *options(None, realization=i, seed=self.seed), "--json"]))["xi"]
            for i in indices
        ]
        frame = pd.DataFrame(rows, index=pd.Index(indices, name="realization"))
        return frame.rename(columns=lambda mode: mode + 1)

    def run(
        self,
        realization: int,
        directory: str | os.PathLike[str],
        *,
        changes: Mapping[str, Any] | None = None,
        timeout_s: float | None = None,
    ) -> Run:
        """Runs a realization again, to have its snapshots and history; the same call continues one that was stopped.

        Args:
            directory: for the files of the run
            changes: keys of the case to set, such as {"time.snapshot_interval_s": 1}
        Raises:
            FileError: its digest is not the one of the study although no key was changed
        """
        keys = dict(changes or {})
        if "time.snapshot_interval_s" in keys:  # the resolved case spells the times out, and a case may have only one
            keys.setdefault("time.snapshot_times_s", None)
        arguments = options(keys, realization=realization, seed=self.seed, out=directory)
        call(["run", str(self.path / _CASE), *arguments], timeout_s=timeout_s)
        found = Run(directory)
        measures = self.measures
        if not changes and realization in measures.index:
            digest = str(measures.loc[realization, "digest"])
            if digest and digest != found.result["digest"]:
                raise FileError(
                    f"realization {realization} has the digest {found.result['digest']}, not {digest}: the study was "
                    "made by another version of talus, or on a processor without AVX2"
                )
        return found

    def snapshots(
        self, which: str = "farthest", *, walls: bool = False, fields: Sequence[str] | None = None
    ) -> xr.Dataset:
        """The snapshots that the study keeps: of realization 0 ("first") and of the one that went farthest
        ("farthest").

        Raises:
            FileError: they are not there (a merged study, or no realization has ended); `run` makes those of any
            realization
        """
        names = {"first": "first", "farthest": "worst"}
        if which not in names:
            raise ValueError(f'which is "{which}"; allowed: {", ".join(names)}; `run` makes those of any realization')
        return read_snapshots(self.path / "profiles" / f"{names[which]}.vtkhdf", walls=walls, fields=fields)


def open_results(directory: str | os.PathLike[str]) -> Study | Run:
    """Opens the directory of a study or of a run, finished or not. `talus.open`.

    Raises:
        FileError: it holds neither
    """
    path = pathlib.Path(directory)
    if (path / "plan.json").exists():
        return Study(path)
    if (path / _CASE).exists():
        return Run(path)
    raise FileError(
        f"{path} holds neither a study (plan.json) nor a run ({_CASE})"
        + ("" if path.is_dir() else ": there is no such directory")
    )
