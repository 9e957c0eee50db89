"""Every command in the README files works: their `sh` blocks are run, one file after the other, in a scratch directory.

usage: test_commands.py TALUSD SOURCE_DIR

A block marked `sh elsewhere` installs, needs root, or takes hours: each of its lines is run by what ELSEWHERE says.
Subcommands and options named in running text (`talus ...`, `--option`) must exist; links must lead somewhere.
"""
import itertools
import json
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest

TALUSD, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
BIN = TALUSD.parent

# What makes them quick, and keeps them off a port that may be taken. Each must occur.
IN_TEST = {
    "--realizations 1000": "--realizations 12",
    "--realizations 200": "--realizations 2 --set particle_spacing_m=0.8 --set time.end_s=0.5",
    "particle_spacing_m=0.2": "particle_spacing_m=0.8",
    "$(seq 9)": "3 6",
    "table4-case$k.json": "table4-case$k.json --realizations 2 --set particle_spacing_m=1 --set time.end_s=0.1 --set time.snapshot_times_s=[]",
    "/usr/share/talus/cases": str(SOURCE / "solver/cases"),
    '\\"realizations\\": 1000': '\\"realizations\\": 12',
    "--range 0 499": "--range 0 5",
    "--range 500 999": "--range 6 11",
    "--workers 8": "--workers 2",
    "talus bench ": "talus bench --seconds 0.01 --sizes 1000 --threads 1 ",
    "http://127.0.0.1:8080": "$TALUS_SERVER",
    "talusd --data data": "start_talusd --data data",
}
ELSEWHERE = {
    "mv data old && cp -r backup data": "tests/service/test_keeping.py",
    "mkdir -p data/orphans && cp -r old/jobs/ID data/orphans/": "tests/service/test_keeping.py",
    "talusd --data data --adopt": "tests/service/test_keeping.py",
    "talus stats road --at 45 --at name=road": "tests/solver/cli/test_targets.py",
    "talus compare without with": "tests/solver/cli/test_targets.py",
    "deploy/demo.sh": "tests/deploy/test_package.py",
    "pip install ./deploy/python": "tests/python/test_package.py",
    "ctest --preset release -R python_": "tests/python/CMakeLists.txt",
    "tests/run.sh": ".ci/run",
    "cmake --build --preset release && (cd build/release && cpack -G DEB)": "deploy/Dockerfile",
    "apt-get install ./build/release/talus_0.1.0_amd64.deb": "tests/deploy/test_package.py",
    "systemctl enable --now talusd": "tests/deploy/test_booted.py",
    "talus study case.json --realizations 100000 --seed 1 --out /shared/study --executor slurm --slurm slurm.json":
    "tests/slurm/test_slurm.py",
    "talusd --config talusd.conf": "tests/slurm/test_slurm.py",
    "docker build -f deploy/Dockerfile -t talusd .": "tests/deploy/test_image.py",
    "docker run -d --init --ulimit core=0 --pids-limit 4096 --memory 16g -p 127.0.0.1:8080:8080 -v talusd:/var/lib/talusd"
    " -v $PWD/tokens:/run/secrets/talusd-tokens:ro talusd --workers 8": "tests/deploy/test_image.py",
}
PREAMBLE = """
set -euo pipefail
talusd_id=
stop_talusd() {
  [ -z "$talusd_id" ] || { kill "$talusd_id"; wait "$talusd_id"; }
}
trap stop_talusd EXIT
start_talusd() {  # instead of `talusd ... &`: the one before ends first, and it answers when this returns
  stop_talusd
  talusd "$@" --listen "${TALUS_SERVER#http://}" --min-disk 0 >>talusd.log 2>&1 &
  talusd_id=$!
  for _ in $(seq 200); do
    curl -sf "$TALUS_SERVER/healthz" >/dev/null && return
    sleep 0.05
  done
  cat talusd.log
  false
}
PS4='+ '
set -x
"""


def pages():
    ours = ("", "deploy", "schemas", "service", "solver", "tests")
    return sorted({page for part in ours for page in (SOURCE / part).glob("**/*.md" if part else "*.md")})


def blocks(page):
    """(information, text) of every fenced block."""
    return re.findall(r"^```([^\n]*)\n(.*?)^```$", page.read_text(), re.M | re.S)


def shell_blocks(page, kind):
    return [text for information, text in blocks(page) if information == kind]


def commands(text):
    """The lines of a block without their comments."""
    return [line for line in (re.sub(r"(^|\s+)# .*", "", each) for each in text.splitlines()) if line.strip()]


def help_of(*command):
    return subprocess.run([str(c) for c in command] + ["--help"], check=True, capture_output=True, text=True).stdout


def options(text):
    return set(re.findall(r"--[a-z][\w-]*", text))


class Commands(unittest.TestCase):
    def test_blocks_are_of_a_known_kind(self):
        kinds = {(page.relative_to(SOURCE).as_posix(), kind) for page in pages() for kind, _ in blocks(page)}
        self.assertEqual(kinds, {("README.md", "sh elsewhere"), ("README.md", "sh"), ("README.md", "json"),
                                 ("tests/validation/PAPER.md", "sh"),
                                 ("service/README.md", "sh elsewhere"), ("service/README.md", "sh"), ("deploy/slurm/README.md", "sh elsewhere"),
                                 ("deploy/python/README.md", "sh elsewhere"), ("deploy/python/README.md", "python"),
                                 ("tests/python/README.md", "sh elsewhere")})

    def test_links_lead_somewhere(self):
        seen = 0
        for page in pages():
            for target, anchor in re.findall(r"\]\((?!https?:)([^)#\s]*)(?:#([^)]*))?\)", page.read_text()):
                there = (page.parent / target).resolve() if target else page
                self.assertTrue(there.exists(), f"{page.relative_to(SOURCE)}: {target}")
                if anchor:
                    headings = re.findall(r"^#+ (.*)$", there.read_text(), re.M)
                    known = {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
                    self.assertIn(anchor, known, f"{page.relative_to(SOURCE)}: {target}#{anchor}")
                seen += 1
        self.assertGreater(seen, 40)

    def test_the_case_of_the_readme_is_the_shipped_one(self):
        (shown,) = shell_blocks(SOURCE / "README.md", "json")
        shipped = json.loads((SOURCE / "solver/cases/road-slope.json").read_text())
        shipped.pop("description")
        self.assertEqual(json.loads(shown), shipped)

    def test_the_paper_page_shows_the_committed_results(self):
        results = json.loads((SOURCE / "tests/validation/results/paper_study.json").read_text())
        rows = re.findall(r"^\| (\d) \|(.*)\|$", (SOURCE / "tests/validation/PAPER.md").read_text(), re.M)
        self.assertEqual([int(case) for case, _ in rows], list(range(1, 10)))
        for case, row in rows:
            cells = [cell.strip() for cell in row.split("|")][3:]
            for cell, (group, truncation) in zip(cells, itertools.product(("studies", "fine"), ("sorted", "share")), strict=True):
                found = [s["influence_zone_m"] for s in results[group]
                         if s["case"] == int(case) and s["truncation"] == truncation]
                wanted = f"{found[0]['mean']:.2f}, {found[0]['stdev']:.2f}" if found else "-"
                self.assertEqual(cell, wanted, f"case {case}, {group}, {truncation}")

    def test_what_is_run_elsewhere(self):
        lines = {line for page in pages() for text in shell_blocks(page, "sh elsewhere") for line in commands(text)}
        self.assertEqual(lines, set(ELSEWHERE))
        for place in ELSEWHERE.values():
            self.assertTrue((SOURCE / place).is_file(), place)
        print(f"{len(lines)} lines are run elsewhere, ", end="", flush=True)

    def test_blocks(self):
        used, count = set(), 0
        for page in pages():
            text = "\n".join(shell_blocks(page, "sh"))
            if not text:
                continue
            count += len(commands(text))
            for old, new in IN_TEST.items():
                if old in text:
                    used.add(old)
                    text = text.replace(old, new)
            self.run_script(page, re.sub(r"^(start_talusd .*) &$", r"\1", text, flags=re.M))
        self.assertEqual(used, set(IN_TEST))
        print(f"{count} lines are run here, ", end="", flush=True)

    def run_script(self, page, text):
        with socket.create_server(("127.0.0.1", 0)) as s:
            port = s.getsockname()[1]
        directory = pathlib.Path(tempfile.mkdtemp(prefix="talus-docs-"))
        self.addCleanup(shutil.rmtree, directory, ignore_errors=True)
        case = json.loads((SOURCE / "solver/cases/illustrative.json").read_text())
        case.update(particle_spacing_m=1, time={"end_s": 0.5})
        (directory / "case.json").write_text(json.dumps(case))
        (directory / "data").mkdir()
        environment = {"PATH": f"{BIN}:/usr/bin:/bin", "HOME": str(directory), "OMP_NUM_THREADS": "1",
                       "TALUS_SERVER": f"http://127.0.0.1:{port}"}
        if page.parent.name == "service":  # its pages speak of a talusd that runs already
            text = "start_talusd --data data\n" + text
        done = subprocess.run(["bash", "-c", PREAMBLE + text], cwd=directory, env=environment, text=True, timeout=600,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, f"{page}\n{done.stdout[-3000:]}")
        self.assertNotIn("urn:talus:problem", done.stdout, f"{page}\n{done.stdout[-3000:]}")

    def test_verbs_and_options_in_running_text(self):
        talus = help_of(BIN / "talus")
        verbs = re.findall(r"^  (\w+) ", talus.split("Commands:")[1].split("Exit codes:")[0], re.M) + ["array-task", "help"]  # not listed there
        of_verb = {verb: options(help_of(BIN / "talus", verb)) for verb in verbs}
        of_talusd = options(help_of(TALUSD))
        everything = of_talusd.union(*of_verb.values(), options(talus))
        seen = 0
        for page in pages():
            text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.M | re.S)
            for span in re.findall(r"`([^`\n]+)`", text):
                where = f"{page.relative_to(SOURCE)}: `{span}`"
                if re.match(r"talus \w", span):
                    for verb in span.split()[1].split("|"):
                        self.assertIn(verb, verbs, where)
                        self.assertLessEqual(options(span), of_verb[verb], where)
                    seen += 1
                elif span.startswith("talusd "):
                    self.assertLessEqual(options(span), of_talusd, where)
                    seen += 1
                elif span.startswith("--") and page.parent.name in ("service", "", SOURCE.name):
                    self.assertLessEqual(options(span), everything, where)
                    seen += 1
        self.assertGreater(seen, 20)


unittest.main(argv=sys.argv[:1], verbosity=2)
