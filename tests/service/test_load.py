#!/usr/bin/env python3
"""Reads while a study runs."""
import concurrent.futures
import http.client
import re
import subprocess
import time

from daemon import ServiceTest, main, study

CLIENTS = 8
SECONDS = 4
WRK_CONNECTIONS = 64
WRK_SECONDS = 2


class Load(ServiceTest):
    def setUp(self):
        super().setUp()
        self.start()
        job = self.job = self.daemon.submit(study(4000, spacing=0.8, end=1.5))
        self.daemon.wait_for(job, ("running",))
        self.paths = [f"/jobs/{job}", "/jobs", f"/jobs/{job}/realizations?limit=20", f"/jobs/{job}/histogram"]

    def check_that_it_runs_on(self):
        deadline = time.monotonic() + 60  # a busy machine may not have ended one run yet
        while (info := self.daemon.get(f"/jobs/{self.job}").json)["realizations"]["done"] == 0:
            self.assertLess(time.monotonic(), deadline, info)
            time.sleep(0.1)
        self.assertEqual(info["status"], "running")

    def say(self, path, rate, p50, p99):
        name = path.replace(self.job, "ID")
        print(f"{name:30} {rate:6.0f} a second: p50 {p50:6.1f} ms, p99 {p99:6.1f} ms", flush=True)

    def read(self, paths):
        """Reads the paths in turn over one connection. @return (path, seconds, what went wrong) of each"""
        connection = http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=20)
        made, end = [], time.monotonic() + SECONDS
        while time.monotonic() < end:
            path, wrong, begin = paths[len(made) % len(paths)], None, time.monotonic()
            try:
                connection.request("GET", path)
                answer = connection.getresponse()
                answer.read()
                wrong = None if answer.status == 200 else answer.status
            except OSError as e:
                wrong = e
                connection.close()
            made.append((path, time.monotonic() - begin, wrong))
        return made

    def test_reads_while_a_study_runs(self):
        with concurrent.futures.ThreadPoolExecutor(CLIENTS) as pool:
            made = [read for reads in pool.map(self.read, [self.paths] * CLIENTS) for read in reads]
        print()
        for path in self.paths:
            times = sorted(1000 * seconds for where, seconds, _ in made if where == path)
            p50, p99 = (times[int(share * (len(times) - 1))] for share in (0.5, 0.99))
            self.say(path, len(times) / SECONDS, p50, p99)
        self.assertEqual([read for read in made if read[2]], [])
        self.check_that_it_runs_on()

    def test_reads_by_wrk_while_a_study_runs(self):
        """The same from a client that is never the slower side, over many more connections."""
        milliseconds, requests = {"us": 1e-3, "ms": 1.0, "s": 1e3}, 0
        print()
        for path in self.paths:
            command = ["wrk", "--threads", "2", "--connections", str(WRK_CONNECTIONS), "--duration", f"{WRK_SECONDS}s",
                       "--timeout", "30s", "--latency", self.daemon.url + path]
            said = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120).stdout
            p50, p99 = (
                float(number) * milliseconds[unit]
                for number, unit in re.findall(r"^ +(?:50|99)% +([0-9.]+)(us|ms|s) *$", said, re.MULTILINE)
            )
            self.say(path, float(re.search(r"Requests/sec: +([0-9.]+)", said)[1]), p50, p99)
            requests += int(re.search(r"([0-9]+) requests in", said)[1])
            for error in ("Socket errors", "Non-2xx or 3xx responses"):
                self.assertNotIn(error, said)
        self.assertGreater(requests, 0)  # of all: on a busy machine the first histogram may take longer than wrk
        self.check_that_it_runs_on()


if __name__ == "__main__":
    main({"Load": Load})
