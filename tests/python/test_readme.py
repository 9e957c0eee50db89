"""The Python blocks of deploy/python/README.md run, on a coarse and short slope."""

import json
import re
import shutil

import matplotlib

import talus
from conftest import SOURCE


def test_the_blocks_run(daemon, tmp_path, monkeypatch, capsys):
    matplotlib.use("Agg")
    for file in (SOURCE / "solver/cases").glob("road-slope*"):
        shutil.copy(file, tmp_path)
    document = json.loads((tmp_path / "road-slope.json").read_text())
    document.update(particle_spacing_m=1.2, time={"end_s": 2})
    document["study"] = {"realizations": 9, "seed": 1, "noise_floor_replicates": 0}
    (tmp_path / "road-slope.json").write_text(json.dumps(document))
    monkeypatch.chdir(tmp_path)
    text = (SOURCE / "deploy/python/README.md").read_text()
    blocks = re.findall(r"^```python\n(.*?)^```$", text, re.M | re.S)
    assert len(blocks) == 3
    names = {"token": None}
    for block in blocks:
        for old, new in (
            ('"https://talus.example"', repr(daemon.url)),
            ("realizations=1000", "realizations=2"),
            ("realizations=200, seed=1, workers=8", "realizations=9, seed=1, workers=1, figures=False"),
        ):
            block = block.replace(old, new)
        if "other" in block:
            changes = {"time.snapshot_interval_s": 1, "time.snapshots_exact": True}
            names["other"] = names["study"].run(8, "eighth", changes=changes)
        exec(compile(block, "README.md", "exec"), names)
    assert isinstance(names["study"], talus.Study) and names["study"].complete
    assert "100 %" in capsys.readouterr().out
    with talus.Client(daemon.url) as client:
        assert client.job(names["job"].id).status.done == 2
