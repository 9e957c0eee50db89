"""The program as functions: what its exit codes and messages become, time limits, and a program that is not there."""

import json
import os
import pathlib
import signal
import stat
import threading
import time

import pytest

import talus


def test_all_faults_of_a_case_have_their_pointer(case, tmp_path):
    with pytest.raises(talus.CaseError) as caught:
        talus.validate(case, changes={"material.density_kg_m3": -5, "nonsense": 1})
    assert [fault.pointer for fault in caught.value.faults] == ["/material/density_kg_m3", "/nonsense"]
    assert "allowed >= 1 and <= 1e+05" in str(caught.value) and caught.value.exit_code == 3
    with pytest.raises(talus.CaseError) as caught:
        talus.run(case, tmp_path / "out", changes={"material.density_kg_m3": -5})
    assert [fault.pointer for fault in caught.value.faults] == ["/material/density_kg_m3"]
    assert not (tmp_path / "out").exists()
    (tmp_path / "broken.json").write_text('{"a": }')
    with pytest.raises(talus.CaseError) as caught:
        talus.validate(tmp_path / "broken.json")
    assert caught.value.faults[0].pointer.endswith("broken.json:1:7")


def test_validate_reports(case):
    report = talus.validate(case, changes={"particle_spacing_m": 1.0})
    assert report["valid"] and report["title"] == "Small slope"
    assert report["particles"]["soil"] < talus.validate(case)["particles"]["soil"]


def test_texts_numbers_and_lists_are_set(case, tmp_path):
    run = talus.run(
        case,
        tmp_path / "out",
        realization=0,
        seed=3,
        changes={"title": "Hang", "numerics.precision": "double", "time.snapshot_times_s": [], "time.end_s": 0.1},
    )
    assert (run.case["title"], run.result["backend"], run.case["time"]["snapshot_times_s"]) == ("Hang", "plain", [])
    assert run.result["provenance"]["seed"] == 3 and run.verdict in ("sound", "doubtful")


def test_exit_codes(case, tmp_path):
    with pytest.raises(talus.FileError, match="no such file"):
        talus.run(tmp_path / "none.json", tmp_path / "a")
    with pytest.raises(talus.DivergedError, match="particle"):
        talus.run(case, tmp_path / "b", changes={"time.fixed_step_s": 0.05, "time.end_s": 100})
    with pytest.raises(talus.UsageError):
        talus.run(case, tmp_path / "c", realization=-1)


def test_a_run_that_takes_too_long_is_stopped_and_continued(case, tmp_path):
    long = {"particle_spacing_m": 0.15, "time.end_s": 30, "time.snapshot_times_s": []}
    with pytest.raises(talus.TimeLimitError) as caught:
        talus.run(case, tmp_path / "out", changes=long, timeout_s=1.0)
    assert isinstance(caught.value, TimeoutError) and caught.value.exit_code == 6
    run = talus.open(tmp_path / "out")
    assert not run.finished and "not finished" in repr(run) and (run.path / "checkpoint.h5").exists()
    with pytest.raises(talus.FileError, match="no result yet"):
        run.result
    with pytest.raises(ValueError, match="allowed: > 0"):
        talus.run(case, tmp_path / "out", timeout_s=0.0)


def script(directory, text):
    path = directory / "talus"
    path.write_text("#!/bin/sh\n" + text)
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


def test_a_killed_program(case, tmp_path, monkeypatch):
    monkeypatch.setenv("TALUS", script(tmp_path, "echo last words >&2; kill -KILL $$"))
    with pytest.raises(talus.KilledError, match="signal 9.*\n.*last words") as caught:
        talus.run(case, tmp_path / "out")
    assert caught.value.exit_code == -signal.SIGKILL


def test_a_program_that_does_not_stop_is_killed(case, tmp_path, monkeypatch):
    monkeypatch.setenv("TALUS", script(tmp_path, "trap '' TERM; sleep 60 & echo $! > child; wait; sleep 60"))
    monkeypatch.setattr("talus.program.GRACE_S", 0.2)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(talus.TimeLimitError):
        talus.run(case, tmp_path / "out", timeout_s=0.5)
    child = int((tmp_path / "child").read_text())
    for _ in range(100):
        state = pathlib.Path(f"/proc/{child}/stat")
        if not state.exists() or state.read_text().split()[2] == "Z":
            break
        time.sleep(0.05)
    else:
        raise AssertionError("its child lives")


def test_interrupt_stops_the_program(case, tmp_path):
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        talus.run(case, tmp_path / "out", changes={"particle_spacing_m": 0.15, "time.end_s": 30})
    assert (tmp_path / "out/checkpoint.h5").exists()


def test_a_program_that_is_not_there(case, monkeypatch):
    for path in ("/nowhere/talus", ""):
        monkeypatch.setenv("TALUS", path)
        monkeypatch.setenv("PATH", "/nowhere")
        with pytest.raises(talus.ProgramNotFoundError, match="install the Debian package"):
            talus.validate(case)


def test_internal_errors_and_unknown_codes(case, tmp_path, monkeypatch):
    for code, kind in ((1, talus.InternalError), (6, talus.StoppedError), (99, talus.TalusError)):
        monkeypatch.setenv("TALUS", script(tmp_path, f"echo why >&2; exit {code}"))
        with pytest.raises(kind, match="why") as caught:
            talus.validate(case)
        assert caught.value.exit_code == code


def test_a_case_as_a_mapping_leaves_nothing_behind(case, tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    assert talus.validate(json.loads(json.dumps(case)))["valid"]
    assert list(tmp_path.iterdir()) == []
