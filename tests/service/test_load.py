#!/usr/bin/env python3
"""Reads while a study runs."""
import concurrent.futures
import http.client
import time

from daemon import ServiceTest, main, study

CLIENTS = 8
SECONDS = 4


class Load(ServiceTest):
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
        self.start()
        job = self.daemon.submit(study(4000, spacing=0.8, end=1.5))
        self.daemon.wait_for(job, ("running",))
        paths = [f"/jobs/{job}", "/jobs", f"/jobs/{job}/realizations?limit=20", f"/jobs/{job}/histogram"]
        with concurrent.futures.ThreadPoolExecutor(CLIENTS) as pool:
            made = [read for reads in pool.map(self.read, [paths] * CLIENTS) for read in reads]
        print()
        for path in paths:
            times = sorted(1000 * seconds for where, seconds, _ in made if where == path)
            p50, p99 = (times[int(share * (len(times) - 1))] for share in (0.5, 0.99))
            rate = len(times) / SECONDS
            print(f"{path.replace(job, 'ID'):30} {rate:6.0f} a second: p50 {p50:6.1f} ms, p99 {p99:6.1f} ms")
        self.assertEqual([read for read in made if read[2]], [])
        info = self.daemon.get(f"/jobs/{job}").json
        self.assertEqual(info["status"], "running")
        self.assertGreater(info["realizations"]["done"], 0)


if __name__ == "__main__":
    main({"Load": Load})
