"""Client and AsyncClient with a talusd, and with servers that refuse."""

import asyncio
import http.server
import json
import os
import shutil
import subprocess
import threading

import httpx
import pytest

import talus
from conftest import SOURCE, Daemon


@pytest.fixture(scope="module")
def job(daemon, case):
    with talus.Client(daemon.url) as client:
        job = client.submit(case, realizations=5)
        job.wait(timeout_s=60)
        yield job


def test_results_are_those_of_a_local_study(job, study):
    status = job.status
    assert status.ended and (status.state, status.done, status.planned, status.progress) == ("successful", 5, 5, 100)
    table = job.realizations()
    assert list(table["digest"]) == list(study.measures["digest"]) and set(table["verdict"]) == set(
        study.measures["verdict"]
    )
    assert job.results()["summary"]["quantities"] == study.summary["quantities"]
    x = float(table["front_mass_99_m"].sort_values().iloc[2])
    assert (job.exceedance(x, quantity="front_mass_99_m")["k"], job.exceedance(x, quantity="front_mass_99_m")["n"]) == (
        2,
        5,
    )
    assert sum(job.histogram("front_mass_99_m", edges=[0, x, 100])["histogram"]["counts"]) == 5
    assert job.realization(3)["command"].startswith("talus run")
    field = job.field(3)
    assert len(field) == json.loads((study.path / "runs/000003.json").read_text())["particles"]["soil"]
    assert {"x_m", "y_m"} <= set(job.profile(3).columns)


def test_pages_of_realizations(job, monkeypatch):
    monkeypatch.setattr("talus.api.PAGE", 2)
    assert list(job.realizations().index) == [0, 1, 2, 3, 4]


def test_jobs_and_life_of_a_job(daemon, case):
    with talus.Client(daemon.url) as client:
        job = client.submit(case, realizations=1, noise_floor_replicates=0)
        assert job.id in [status.id for status in client.jobs()] and repr(client.job(job.id)) == repr(job)
        job.wait()
        assert job.extend(1).planned == 2
        assert job.wait(timeout_s=60).done == 2
        assert job.dismiss().state == "dismissed"
        with pytest.raises(talus.JobFailedError, match="dismissed"):
            job.wait()


def test_faults_of_a_request_have_their_pointer(daemon, case):
    with talus.Client(daemon.url) as client:
        with pytest.raises(talus.ServiceError) as caught:
            client.submit({**case, "material": {"density_kg_m3": -5, "friction_angle_deg": 25}})
        assert caught.value.status in (400, 422)
        assert caught.value.faults[0].pointer.endswith("/material/density_kg_m3") and "allowed" in str(caught.value)


def test_a_case_with_csv_files_is_sent_whole(daemon, tmp_path):
    for file in (SOURCE / "solver/cases").glob("road-slope*"):
        shutil.copy(file, tmp_path)
    document = json.loads((tmp_path / "road-slope.json").read_text())
    document.update(particle_spacing_m=1.5, time={"end_s": 0.1})
    (tmp_path / "road-slope.json").write_text(json.dumps(document))
    with talus.Client(daemon.url) as client:
        job = client.submit(tmp_path / "road-slope.json", realizations=1, noise_floor_replicates=0)
        assert job.wait(timeout_s=60).planned == 1
        job.dismiss()
        with pytest.raises(talus.CaseError, match="give its path"):
            client.submit(document)


def test_the_async_client(daemon, case, study):
    async def both():
        async with talus.AsyncClient(daemon.url) as client:
            jobs = await asyncio.gather(*(client.submit(case, realizations=2, seed=5) for _ in range(2)))
            seen = []
            ends = await asyncio.gather(*(job.wait(timeout_s=60, progress=seen.append) for job in jobs))
            tables = [await job.realizations() for job in jobs]
            await jobs[0].dismiss()
            with pytest.raises(talus.TimeLimitError):
                slow = await client.submit({**case, "particle_spacing_m": 0.15, "time": {"end_s": 10}}, realizations=1)
                try:
                    await slow.wait(timeout_s=0.3)
                finally:
                    await slow.dismiss()
            return ends, tables, seen

    ends, tables, seen = asyncio.run(both())
    assert [end.state for end in ends] == ["successful"] * 2 and seen[-1].ended
    assert all(list(table["digest"]) == list(study.measures["digest"][:2]) for table in tables)


def test_tokens(tmp_path, case):
    made = subprocess.run(
        [os.environ["TALUSD"], "--new-token", "submit", "anna"], capture_output=True, text=True, check=True
    )
    token, line = (text.split(": ", 1)[1] for text in made.stdout.splitlines())
    (tmp_path / "tokens").write_text(line + "\n")
    daemon = Daemon(tmp_path, "--tokens", tmp_path / "tokens")
    try:
        with talus.Client(daemon.url, token=token) as client, talus.Client(daemon.url, token="wrong") as other:
            assert client.jobs() == [] and token not in repr(client)
            with pytest.raises(talus.ServiceError) as caught:
                other.jobs()
            assert caught.value.status == 401
    finally:
        daemon.stop()


class Refusing(http.server.BaseHTTPRequestHandler):
    """Answers 503 twice, then as talusd would; keeps what came."""

    seen: list = []

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.seen.append((self.headers["Idempotency-Key"], self.headers.get("Authorization"), body))
        status = 503 if len(self.seen) <= 2 else 201
        text = {503: {"title": "busy", "status": 503}, 201: {"jobID": "j", "status": "accepted"}}[status]
        answer = json.dumps(text).encode()
        self.send_response(status)
        self.send_header("Content-Length", str(len(answer)))
        self.send_header("Retry-After", "1")
        self.end_headers()
        self.wfile.write(answer)

    def log_message(self, *_):
        pass


def test_a_submission_is_sent_again_with_its_key(case, monkeypatch):
    pauses = []
    monkeypatch.setattr("talus.client.time.sleep", pauses.append)
    server = http.server.HTTPServer(("127.0.0.1", 0), Refusing)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        with talus.Client(f"http://127.0.0.1:{server.server_port}", token="secret") as client:
            assert client.submit(case).id == "j"
    finally:
        server.shutdown()
        server.server_close()
    keys, tokens, bodies = map(set, zip(*Refusing.seen))
    assert len(Refusing.seen) == 3 and len(keys) == 1 and tokens == {"Bearer secret"} and len(bodies) == 1
    assert len(pauses) == 2 and all(1.0 <= pause <= 1.5 for pause in pauses)


def test_pauses_grow_and_end(monkeypatch):
    assert all(0.25 * 2**k <= talus.api.pause(k) <= 0.375 * 2**k for k in range(5))
    assert talus.api.pause(50) <= 15.0
    pauses = []
    monkeypatch.setattr("talus.client.time.sleep", pauses.append)
    with talus.Client("http://127.0.0.1:1") as client:
        with pytest.raises(talus.ConnectError, match="does talusd run there"):
            client.jobs()
    assert len(pauses) == talus.client.TRIES - 1


def test_waiting_asks_seldom(daemon, case, monkeypatch):
    """While nothing changes the client waits for talusd, or pauses; it does not ask in a loop."""
    asked = []
    send = httpx.Client.request
    monkeypatch.setattr(
        httpx.Client, "request", lambda self, **request: asked.append(request["url"]) or send(self, **request)
    )
    with talus.Client(daemon.url) as client:
        job = client.submit(
            {**case, "particle_spacing_m": 0.15, "time": {"end_s": 10}}, realizations=1, noise_floor_replicates=0
        )
        with pytest.raises(talus.TimeLimitError, match="can be called again"):
            job.wait(timeout_s=1.5)
        assert len(asked) <= 6, asked
        asked.clear()
        threading.Timer(1.0, job.dismiss).start()
        with pytest.raises(talus.JobFailedError, match="dismissed"):
            job.wait()
        assert len(asked) <= 8, asked
