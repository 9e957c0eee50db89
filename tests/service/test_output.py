#!/usr/bin/env python3
"""Output that cannot be written is an error: every command of talus, and every option of talusd that prints."""

import json
import re
import subprocess

from daemon import TALUS, TALUSD, ServiceTest, case, main, study


class Output(ServiceTest):
    def into_full_device(self, *command):
        with open("/dev/full", "w") as full:
            return subprocess.run([*map(str, command)], stdout=full, stderr=subprocess.PIPE, text=True, timeout=120)

    def test_every_command_of_talus(self):
        slope, run, out = self.dir / "slope.json", self.dir / "run", self.dir / "study"
        slope.write_text(json.dumps(case()))
        self.start()
        job = self.daemon.submit(study(1, noise_floor_replicates=0))
        self.daemon.wait_for(job)
        server = ["--server", self.daemon.url]
        commands = {
            "validate": [["validate", slope], ["validate", slope, "--json"]],
            "field": [["field", slope, "--out", self.dir / "field.csv"],
                      ["field", slope, "--out", self.dir / "field.csv", "--json"]],
            "run": [["run", slope, "--out", run], ["run", slope, "--out", self.dir / "other", "--json"]],
            "profile": [],  # prints nothing
            "study": [["study", slope, "--out", out, "--realizations", 2, "--no-figures"],
                      ["study", slope, "--out", out, "--realizations", 2, "--no-figures", "--json"]],
            "stats": [["stats", out], ["stats", out, "--json"], ["stats", out, "--at", 30]],
            "compare": [["compare", out, out], ["compare", out, out, "--json"]],
            "plot": [["plot", out], ["plot", out, "--json"], ["plot", slope, "--out", self.dir / "slope.svg"]],
            "schema": [["schema"], ["schema", "case"]],
            "bench": [["bench", "--sizes", 1000, "--threads", 1, "--seconds", 0.1],
                      ["bench", "--sizes", 1000, "--threads", 1, "--seconds", 0.1, "--json"]],
            "submit": [["submit", slope, "--realizations", 1, *server], ["submit", slope, "--json", *server]],
            "status": [["status", *server], ["status", job, *server], ["status", job, "--json", *server]],
            "watch": [["watch", job, *server, "--json"]],
            "results": [["results", job, *server], ["results", job, "--json", *server]],
            "cancel": [["cancel", job, *server]],
            "help": [["help"], ["--help"], ["--version"], ["help", "run"], ["run", "--help"]],
        }
        listed = re.findall(r"^  ([a-z]+) {3,}", subprocess.check_output([TALUS, "--help"], text=True), re.MULTILINE)
        self.assertEqual(set(listed) | {"help"}, set(commands))
        for command in (command for all in commands.values() for command in all):
            done = self.into_full_device(TALUS, *command)
            self.assertEqual(done.returncode, 5, (command, done.stderr))
            self.assertIn("talus: the output cannot be written", done.stderr)
        closed = subprocess.run(["/bin/sh", "-c", f'exec "{TALUS}" schema case >&-'], stderr=subprocess.PIPE)
        self.assertEqual(closed.returncode, 5, closed.stderr)
        self.assertEqual(subprocess.run([TALUS, "schema"], stdout=subprocess.PIPE).returncode, 0)

    def test_every_option_of_talusd_that_prints(self):
        self.start()
        self.daemon.submit(study(1))
        data = self.daemon.data
        (data / "orphans/notes").mkdir(parents=True)
        backup = ["--data", data, "--backup", self.dir / "backup"]
        tasks = [["--help"], ["--version"], ["--new-token", "submit", "anna"], backup, ["--data", data, "--adopt"]]
        for task in tasks:
            if task[-1] == "--adopt":
                self.assertEqual(self.daemon.stop(), 0)
            done = self.into_full_device(TALUSD, *task)
            self.assertEqual(done.returncode, 5, (task, done.stderr))
            self.assertIn("talusd: the output cannot be written", done.stderr)


if __name__ == "__main__":
    main({"Output": Output})
