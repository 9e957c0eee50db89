"""Bash completion against the programs themselves. usage: test_completion.py TALUSD SOURCE_DIR"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

TALUSD, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
TALUS = str(pathlib.Path(TALUSD).with_name("talus"))
CASES = SOURCE / "solver/cases"

# As bash does at a TAB: the function that `complete` names, with the command, the word and the one before it.
DRIVER = """
. "$1"; shift
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
function=$(complete -p "${1##*/}" | sed 's/.*-F \\([^ ]*\\).*/\\1/')
"$function" "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\\n' "${COMPREPLY[@]}"
"""


def complete(*words, cwd="."):
    done = subprocess.run(["bash", "-c", DRIVER, "bash", str(SOURCE / "deploy/completion.bash"), *words], cwd=cwd,
                          text=True, capture_output=True, check=True,
                          env={"PATH": "/usr/bin:/bin", "TALUS_CASES": str(CASES)})
    assert not done.stderr, done.stderr
    return done.stdout.split()


def help_of(*command):
    return subprocess.run([*command, "--help"], check=True, capture_output=True, text=True).stdout


def options_of(*command):
    return sorted(set(re.findall(r"^  (?:-\w, *)?(--[\w-]+)", help_of(*command), re.M)))


def verbs():
    return re.findall(r"^  (\w+) ", help_of(TALUS).split("Commands:")[1], re.M)


class Completion(unittest.TestCase):
    def test_every_verb(self):
        self.assertGreater(len(verbs()), 10)
        self.assertEqual(complete(TALUS, ""), verbs())
        self.assertEqual(complete(TALUS, "st"), [v for v in verbs() if v.startswith("st")])

    def test_every_option_of_every_verb(self):
        for verb in verbs():
            self.assertEqual(sorted(complete(TALUS, verb, "-")), options_of(TALUS, verb), verb)
        self.assertEqual(complete(TALUS, "study", "x.json", "--real"), ["--realizations"])

    def test_options_of_talus_and_of_talusd(self):
        self.assertEqual(sorted(complete(TALUS, "--")), ["--help", "--version"])
        self.assertEqual(sorted(complete(TALUSD, "--")), options_of(TALUSD))
        self.assertEqual(complete(TALUSD, "--data", "x", "--work"), ["--workers"])

    def test_cases_here_and_installed_ones(self):
        with tempfile.TemporaryDirectory() as here:
            for name in ("illegal.json", "notes.txt"):
                (pathlib.Path(here) / name).touch()
            self.assertEqual(complete(TALUS, "run", "il", cwd=here), ["illegal.json", str(CASES / "illustrative.json")])
            installed = {str(f) for f in CASES.glob("*.json")}
            self.assertEqual(set(complete(TALUS, "study", "", cwd=here)), {"illegal.json"} | installed)
            self.assertEqual(complete(TALUS, "bench", "n", cwd=here), [])

    def test_directories_schemas_and_choices(self):
        with tempfile.TemporaryDirectory() as here:
            (pathlib.Path(here) / "study").mkdir()
            (pathlib.Path(here) / "study.json").touch()
            self.assertEqual(complete(TALUS, "profile", "st", cwd=here), ["study"])
            self.assertEqual(sorted(complete(TALUS, "plot", "st", cwd=here)), ["study", "study.json"])
            self.assertEqual(complete(TALUS, "stud", cwd=here), ["study"])
        self.assertEqual(complete(TALUS, "schema", ""), ["case", "result", "study"])
        self.assertEqual(complete(TALUS, "bench", "--yields", "e"), ["elastic"])
        self.assertEqual(complete(TALUS, "stats", "--quantity", "inf"), ["influence_zone_m"])
        self.assertEqual(complete(TALUS, "study", "--seed", ""), [])

    def test_jobs_of_the_server(self):
        with tempfile.TemporaryDirectory() as here:
            program = pathlib.Path(here) / "talus"  # a server with two jobs
            program.write_text('#!/bin/sh\n[ "$1" = status ] && printf "%s  running  50 %%  \\n" 0a1b 0a2c\n')
            program.chmod(0o755)
            for verb in ("status", "watch", "results", "cancel"):
                self.assertEqual(complete(str(program), verb, "0a"), ["0a1b", "0a2c"], verb)
                self.assertEqual(complete(str(program), verb, "0a2"), ["0a2c"], verb)
        self.assertEqual(complete(TALUS, "watch", ""), [])  # no server answers

    def test_keys_of_a_case_and_their_choices(self):
        document = json.loads((CASES / "illustrative.json").read_text())
        keys = complete(TALUS, "run", "x.json", "--set", "")
        self.assertGreater(len(keys), 80)
        self.assertEqual(len(keys), len(set(keys)))
        for section in ("material", "time"):
            for key in document[section]:
                self.assertIn(f"{section}.{key}=", keys)
        self.assertEqual(complete(TALUS, "study", "--set", "numerics.ke"), ["numerics.kernel="])
        # bash parts words at the equals sign
        self.assertEqual(complete(TALUS, "study", "--set", "numerics.kernel", "="), ["cubic_spline", "wendland_c2"])
        self.assertEqual(complete(TALUS, "study", "--set", "numerics.kernel", "=", "w"), ["wendland_c2"])
        self.assertEqual(complete(TALUS, "study", "--set", "numerics.cfl", "=", ""), [])
        self.assertEqual(complete(TALUS, "help", "st"), complete(TALUS, "st"))

    def test_words_it_lists_itself_are_known_to_the_programs(self):
        text = (SOURCE / "deploy/completion.bash").read_text()
        known = {option for command in [(TALUS, v) for v in verbs()] + [(TALUSD,)] for option in options_of(*command)}
        body = re.search(r"_talus_argument_of\(\) \{(.*?)^\}", text, re.M | re.S)[1]
        listed = set(re.findall(r"--[a-z][\w-]*", body))
        self.assertGreater(len(listed), 15)
        self.assertEqual(listed - known, set())
        flags = {o for v in verbs() for o in re.findall(r"^  (--[\w-]+)(?: {2,}|$)", help_of(TALUS, v), re.M)}
        self.assertEqual(set(re.search(r"(--json.*)\) return 1", body)[1].split(" | ")), flags)


unittest.main(argv=sys.argv[:1], verbosity=2)
