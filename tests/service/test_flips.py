#!/usr/bin/env python3
"""Single flipped bits over all files of a study: the same command and `talus stats` give the same numbers, or say what is
damaged. More of them: tests/service/README.md."""

import collections
import json
import os
import random
import subprocess

from daemon import TALUS, ServiceTest, case, main

FLIPS = int(os.environ.get("TALUS_FLIPS", "200"))


class Flips(ServiceTest):
    """One bit at a time."""

    def talus(self, *arguments):
        return subprocess.run([TALUS, *map(str, arguments)], capture_output=True, encoding="utf-8",
                              errors="replace", timeout=120)

    def numbers(self):
        """What a reader of the study takes from it: the tables and the summary without seconds."""
        tables = []
        for name in ("realizations.csv", "noise_floor.csv"):
            lines = (self.out / name).read_text(errors="replace").splitlines()
            column = lines[0].split(",").index("wall_clock_s")
            tables.append([[cell for i, cell in enumerate(line.split(",")) if i != column][:-1] for line in lines])
        summary = json.loads((self.out / "study.json").read_text(errors="replace"))
        for seconds in ("effort", "checksum"):
            summary.pop(seconds)
        return tables, summary

    def test_no_flipped_bit_changes_a_number_in_silence(self):
        self.out = self.dir / "study"
        document = self.dir / "case.json"
        document.write_text(json.dumps(case(study={"seed": 7, "realizations": 4, "noise_floor_replicates": 1})))
        again = ["study", document, "--out", self.out, "--workers", 2, "--no-figures"]
        self.assertEqual(self.talus(*again).returncode, 0)
        whole = self.numbers()
        files = {path: path.read_bytes() for path in self.out.rglob("*") if path.is_file() and path.stat().st_size}
        draw, what = random.Random(1), collections.Counter()
        for _ in range(FLIPS):
            path = draw.choice(sorted(files))
            content = bytearray(files[path])
            bit = draw.randrange(8 * len(content))
            content[bit // 8] ^= 1 << bit % 8
            path.write_bytes(content)
            place = f"{path.relative_to(self.out)}, bit {bit}"
            stats = self.talus("stats", self.out)
            if stats.returncode == 0:
                self.assertEqual(self.numbers(), whole, place)
            study = self.talus(*again)
            if study.returncode == 0:
                self.assertEqual(self.numbers(), whole, place)
            else:
                self.assertIn(path.name, study.stderr, place)
            what["refused, naming the file" if study.returncode else "repaired or unharmed"] += 1
            for file, right in files.items():
                file.write_bytes(right)
        print(f"\n{FLIPS} flipped bits, 0 wrong numbers: {dict(what)}", flush=True)


if __name__ == "__main__":
    main({"Flips": Flips})
