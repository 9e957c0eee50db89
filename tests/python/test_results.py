"""Studies and runs, finished or not, as pandas and xarray."""

import json
import os
import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pandas as pd
import pytest

import talus


def test_measures_are_those_of_the_records(study):
    measures = study.measures
    assert list(measures.index) == [0, 1, 2, 3, 4] and study.complete and study.seed == 5
    for index in measures.index:
        result = json.loads((study.path / f"runs/{index:06d}.json").read_text())
        for name in ("front_mass_99_m", "influence_zone_m", "digest", "steps"):
            assert measures.loc[index, name] == result[name], name
        assert measures.loc[index, "verdict"] == result["quality"]["verdict"]
    assert measures["front_mass_99_m"].mean() == pytest.approx(
        study.summary["quantities"]["front_mass_99_m"]["mean"], rel=1e-14
    )


def test_the_records_of_a_study_without_tables_give_the_same_table(study, tmp_path):
    copy = shutil.copytree(study.path, tmp_path / "copy")
    for name in ("realizations.csv", "study.json"):
        (copy / name).unlink()
    (copy / "runs/000003.json").write_text("{half")  # counts as not run
    found = talus.open(copy)
    assert not found.complete
    with pytest.raises(talus.FileError, match="refresh"):
        found.summary
    wanted = study.measures.drop(index=3)
    pd.testing.assert_frame_equal(found.measures[wanted.columns], wanted, check_dtype=False, check_exact=True)
    assert found.refresh()["realizations"]["done"] == 4


def test_a_table_that_is_behind_is_not_taken(study, tmp_path):
    copy = shutil.copytree(study.path, tmp_path / "copy")
    lines = (copy / "realizations.csv").read_text().splitlines(True)
    (copy / "realizations.csv").write_text("".join(lines[:3]))
    assert list(talus.open(copy).measures.index) == [0, 1, 2, 3, 4]
    (copy / "realizations.csv").write_text('index,status\n0,"done')
    for record in (copy / "runs").glob("*.json"):
        record.unlink()
    with pytest.raises(talus.FileError, match="realizations.csv cannot be read"):
        talus.open(copy).measures


def test_a_killed_study_is_opened_and_continued(case, tmp_path):
    (tmp_path / "case.json").write_text(json.dumps(case))
    process = subprocess.Popen(
        [
            os.environ["TALUS"],
            "study",
            tmp_path / "case.json",
            "--out",
            tmp_path / "out",
            "--realizations",
            "40",
            "--workers",
            "1",
            "--no-figures",
        ],
        stderr=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        start_new_session=True,
    )
    while not list(tmp_path.glob("out/runs/*.json")):
        assert process.poll() is None
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    found = talus.open(tmp_path / "out")
    assert 1 <= len(found.measures) < 40 and set(found.measures["status"]) == {"done"}
    with pytest.raises(talus.FileError, match="holds a study"):
        talus.run(case, found.path)


def test_failed_realizations_have_their_reason(case, tmp_path):
    soft = {**case, "numerics": {"sound_speed_m_s": 5}, "study": {**case["study"], "max_failed_share": 0.0}}
    with pytest.raises(talus.TooManyFailedError) as caught:
        talus.study(soft, tmp_path / "soft", realizations=2, workers=1, figures=False)
    assert caught.value.exit_code == 7
    measures = talus.open(tmp_path / "soft").measures
    assert set(measures["status"]) == {"failed"}
    assert measures["reason"].str.startswith("invalid result: ").all() and measures["front_mass_99_m"].isna().all()


def test_coefficients_and_draws(study):
    xi = study.xi([0, 3])
    assert xi.shape == (2, 50) and list(xi.columns[:2]) == [1, 2]
    printed = subprocess.run(
        [
            os.environ["TALUS"],
            "field",
            study.path / "case.resolved.json",
            "--realization",
            "3",
            "--seed",
            "5",
            "--json",
        ],
        capture_output=True,
        check=True,
    ).stdout
    assert list(xi.loc[3]) == json.loads(printed)["xi"]
    draws = study.draws()
    assert list(draws["mean_friction_angle_deg"]) == list(study.measures["mean_friction_angle_deg"]) and set(
        draws["seed"]
    ) == {5}


def test_statistics_are_those_that_talus_prints(study):
    fronts = study.measures["front_mass_99_m"]
    x = float(fronts.sort_values().iloc[2])
    row = study.exceedance([x], quantity="front_mass_99_m").iloc[0]
    assert (row["k"], row["n"], row["p"]) == (2, 5, 2 / 5) and row["lo"] < 2 / 5 < row["hi"]
    assert sum(study.distribution("front_mass_99_m", edges=[0, x, 100])["histogram"]["counts"]) == 5
    with pytest.raises(talus.UsageError, match="known: influence_zone_m"):
        study.distribution("nonsense")
    with pytest.raises(ValueError, match="neither x nor targets"):
        study.exceedance()


def test_snapshots_carry_units_and_identity(study, tmp_path):
    run = study.run(2, tmp_path / "two")
    shown = run.snapshots()
    with h5py.File(run.path / "snapshots.vtkhdf") as file:
        soil = file["VTKHDF/PointData/is_wall"][:] == 0
        points = file["VTKHDF/Points"][:].reshape(-1, len(soil), 3)[:, soil, :2]
        assert np.array_equal(shown["position"], points)
        assert np.array_equal(shown["time"], file["VTKHDF/Steps/Values"][:])
    assert (
        shown["velocity"].attrs["units"] == "m/s"
        and shown["stress"].attrs["units"] == "Pa"
        and shown["time"].attrs["units"] == "s"
    )
    assert (shown.attrs["seed"], shown.attrs["realization"], shown.attrs["title"]) == (5, 2, "Small slope")
    assert shown.attrs["case_hash"] == study.plan["case_hash"] == run.result["provenance"]["case_hash"]
    assert (
        shown["position"].dims == ("time", "particle", "axis")
        and shown.sizes["particle"] == run.result["particles"]["soil"]
    )
    assert run.snapshots(walls=True, fields=["density"]).sizes["particle"] == sum(run.result["particles"].values())
    assert study.snapshots("first").attrs["realization"] == 0
    with pytest.raises(talus.FileError, match="no field speed"):
        run.snapshots(fields=["speed"])
    assert run.history.index[-1] == run.result["time_s"] and run.measures["digest"] == study.measures.loc[2, "digest"]


def test_snapshots_of_a_growing_file_end_with_its_last_complete_step(study, tmp_path):
    file = shutil.copy(study.path / "profiles/first.vtkhdf", tmp_path)
    with h5py.File(file, "r+") as h5:
        h5["VTKHDF/Steps"].attrs.modify("NSteps", np.int64(2))
    assert talus.read_snapshots(file).sizes["time"] == 2
    (tmp_path / "other.vtkhdf").write_text("no HDF5")
    with pytest.raises(talus.FileError, match="other.vtkhdf cannot be read"):
        talus.read_snapshots(tmp_path / "other.vtkhdf")


def test_an_ensemble_has_the_times_asked_for(study, tmp_path):
    exact = {"time.snapshots_exact": True, "time.snapshot_times_s": [0.3, 0.6]}
    runs = {index: study.run(index, tmp_path / str(index), changes=exact) for index in (4, 1)}
    together = talus.snapshot_ensemble(runs)
    assert (together.sizes["realization"], together.sizes["time"]) == (2, 3)
    assert list(together["realization"]) == [1, 4] and list(together["time"]) == [0.0, 0.3, 0.6]
    assert np.array_equal(together["time_of_snapshot"], [[0.0, 0.3, 0.6]] * 2)  # to the last bit
    assert np.array_equal(
        together["position"].sel(realization=4, time=0.6), runs[4].snapshots()["position"].sel(time=0.6)
    )
    assert together["velocity"].attrs["units"] == "m/s" and "realization" not in together.attrs
    with pytest.raises(talus.FileError, match="no snapshot near 0.45 s"):
        talus.snapshot_ensemble(runs, times_s=[0.45])
    late = talus.snapshot_ensemble(runs, times_s=[0.0, 50.0])
    assert late["ended"].sel(time=50.0).all() and not late["ended"].sel(time=0.0).any()
    histories = talus.history_ensemble(runs, times_s=[0.0, 0.5, 50.0])
    last = runs[1].history["front_m"].iloc[-1]
    assert histories["front_m"].sel(realization=1, time=50.0) == last
    with pytest.raises(ValueError, match="no run"):
        talus.snapshot_ensemble({})


def test_snapshots_fall_after_the_times_asked_for_otherwise_and_the_digest_is_that_of_before(case, study, tmp_path):
    loose = study.run(1, tmp_path / "loose")  # compares the digests
    times = loose.snapshots()["time"].to_numpy()
    assert 0.25 < times[1] < 0.26 and 0.5 < times[2] < 0.51
    assert "snapshots_exact" not in loose.case["time"]
    stopped = talus.run(
        case,
        tmp_path / "stopped",
        realization=1,
        changes={"time.snapshots_exact": True, "time.end_s": 0.4, "time.snapshot_times_s": [0.25]},
    )
    assert list(stopped.snapshots()["time"]) == [0.0, 0.25, 0.4]


def test_what_is_neither_a_study_nor_a_run(tmp_path, study):
    for wrong, words in ((tmp_path, "holds neither"), (tmp_path / "none", "no such directory")):
        with pytest.raises(talus.FileError, match=words):
            talus.open(wrong)
    with pytest.raises(talus.FileError, match="does not hold a run"):
        talus.Run(study.path)
    with pytest.raises(talus.FileError, match="does not hold a study"):
        talus.Study(tmp_path)
