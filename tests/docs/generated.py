#!/usr/bin/env python3
"""The parts of the documentation that follow from the programs: options in the man pages from --help, keys of a case in
solver/README.md from its schema, the rate dependence of types of soil in solver/material/README.md from `validate`.

usage: generated.py TALUS TALUSD [--write]     compares (exit 1 and the first difference), or writes the parts
Where it goes lies between two lines that contain `begin generated` and `end generated`.
"""
import difflib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
HELP_COLUMN = 30  # CLI11 begins descriptions here


def help_of(*command):
    return subprocess.run([*command, "--help"], check=True, capture_output=True, text=True).stdout


def sections(text):
    """Heading in lower case -> pairs (left column, description) of a --help."""
    found, entries, lines = {}, [], text.splitlines()
    for line, following in zip(lines, lines[1:] + [""]):
        if re.match(r"\w[\w ]*:$", line):
            entries = found.setdefault(line[:-1].lower(), [])
        elif line.startswith(" " * HELP_COLUMN):
            entries[-1][1] = line.strip()
        elif re.match(r"  \S", line):
            alone = following.startswith(" " * HELP_COLUMN)  # too long to have its description beside it
            entries.append([line.strip(), ""] if alone else [line[:HELP_COLUMN].strip(), line[HELP_COLUMN:].strip()])
    return found


def spoken(spec):
    """(argument, remarks): `INT:INT in [1 - 64]=1` becomes INT and ["1 to 64", "default 1"]."""
    remarks = []

    def take(pattern, remark):
        nonlocal spec
        if found := re.search(pattern, spec):
            spec = spec[:found.start()] + spec[found.end():]
            if remark:
                remarks.append(remark.format(*found.groups()))
        return bool(found)

    take(r"\s*Excludes: (\S+)", "not with {0}")
    take(r"\s*\(Env:(\S+)\)", "or {0} in the environment")
    take(r"\s*REQUIRED", "required")
    take(r"\s* x \d+", "")
    many = take(r"\s*\.\.\.", "")
    take(r":\w+ in \[(\S+) - (\S+)\]", "{0} to {1}")
    take(r":NONNEGATIVE", "0 or more")
    if found := re.search(r":\{(.*)\}", spec):
        take(r":\{(.*)\}", "one of " + ", ".join(found[1].split(",")))
    take(r"(?:=| \[)(?![A-Z]+$)([^\]\s]+)\]?", "default {0}")  # but KEY=VALUE is a metavariable
    return spec.strip() + (" ..." if many else ""), remarks[::-1]


def roff(text):
    return re.sub(r"^\.", r"\\&.", text.replace("\\", "\\\\").replace("-", "\\-").replace("'", "\\(aq"))


def entry(left, description):
    found = re.match(r"(?:-\w,\s*)?(--[\w-]+)?\s*(.*)", left)
    name, (argument, remarks) = found[1], spoken(found[2])
    shown = " ".join(([f"\\fB{roff(name)}\\fR"] if name else []) + ([f"\\fI{roff(argument)}\\fR"] if argument else []))
    remarks = f" ({'; '.join(remarks)})" if remarks else ""
    return [".TP", shown, roff(f"{description}{remarks}")]


def options(help_text):
    lines = []
    for kind in ("positionals", "options"):
        for left, description in sections(help_text).get(kind, []):
            if "--help" not in left and "--version" not in left:
                lines += entry(left, description)
    return lines


def talus_commands(talus):
    lines = []
    found = sections(help_of(talus))
    for verb, _ in found["commands"] + found["commands for a talusd server"]:
        text = help_of(talus, verb)
        usage = re.search(r"^Usage: (.*)$", text, re.M)[1]
        lines += [f".SS {roff(usage)}", roff(text.split("\n")[0].strip()) + "."] + options(text)
    return lines


def one_line(schema):
    """Description of a key, safe in a table."""
    return schema.get("description", "").replace("|", "\\|")


def case_keys(schema, prefix=""):
    lines = []
    for key, value in schema.get("properties", {}).items():
        name = f"{prefix}{key}"
        items = value.get("items", {})
        if "properties" in value or "properties" in items:
            inner, deeper = (value, f"{name}.") if "properties" in value else (items, f"{name}[].")
            lines += [f"| **`{name}`** | {one_line(value)} |", *case_keys(inner, deeper)]
        else:
            text = one_line(value)
            if any(choice not in text for choice in value.get("enum", [])):
                text = "One of " + ", ".join(f"`{choice}`" for choice in value["enum"]) + f". {text}"
            lines.append(f"| `{name}` | {text} |")
    return lines


def case_reference():
    schema = json.loads((SOURCE / "schemas/case.schema.json").read_text())
    return ["", "| key | meaning |", "|---|---|"] + case_keys(schema) + [""]


def plain(number):
    return f"{number:.6g}"


def soil_types(talus):
    """What `talus validate` proposes for a slope that states no rate dependence, and what it knows of strengths."""
    case = {"title": "slope", "particle_spacing_m": 0.5, "terrain": {"bed_m": [[0, 4], [8, 0], [60, 0]]},
            "slide": {"outlines": [{"outline_m": [[0, 4], [8, 0], [10, 0], [4, 7], [0, 7]]}]},
            "material": {"density_kg_m3": 2000, "friction_angle_deg": 25}, "time": {"end_s": 3}}
    with tempfile.TemporaryDirectory() as directory:
        path = pathlib.Path(directory) / "case.json"
        path.write_text(json.dumps(case))
        done = subprocess.run([talus, "validate", path, "--json"], check=True, capture_output=True, text=True)
    lines = ["", "| soil | value | range | source |", "|---|---|---|---|"]
    report = json.loads(done.stdout)
    for soil in report["rate_dependence_by_soil"]:
        if "mu_i" in soil:
            mu_i = soil["mu_i"]
            value = (f"mu(I), mu_2 - mu_s = {plain(mu_i['friction_rise'])}, "
                     f"I_0 = {plain(mu_i['reference_inertial_number'])}")
            spread = "-"
        else:
            low, high = soil["range_Pa_s"]
            value = f"{plain(soil['viscosity_Pa_s'])} Pa s"
            spread = f"{plain(low)} to {plain(high)} Pa s" if low < high else "one value"
        lines.append(f"| {soil['soil']} | {value} | {spread} | {soil['source']} |")
    lines += ["", "| soil | key | value | source |", "|---|---|---|---|"]
    for soil in report["strength_by_soil"]:
        low, high = soil["range"]
        value = f"{plain(low)} to {plain(high)}" if low < high else plain(low)
        lines.append(f"| {soil['soil']} | `{soil['key']}` | {value} | {soil['source']} |")
    return lines + [""]


def with_part(text, part):
    """The text with what lies between its two marks replaced."""
    lines = text.splitlines()
    begin, end = ([i for i, line in enumerate(lines) if mark in line] for mark in ("begin generated", "end generated"))
    if len(begin) != 1 or len(end) != 1 or begin > end:
        sys.exit("needs one line with `begin generated`, and one with `end generated` after it")
    return "\n".join(lines[:begin[0] + 1] + part + lines[end[0]:]) + "\n"


def exit_codes_differ(page, help_text):
    told = set(re.findall(r"(\d+) [a-z]", re.search(r"Exit codes: (.*)", help_text)[1]))
    section = re.search(r"^\.SH EXIT STATUS$(.*?)^\.SH", page, re.M | re.S)[1]
    shown = set(re.findall(r"^\.TP\n\.B (\d+)$", section, re.M))
    return sorted(told ^ shown)


def main():
    talus, talusd, *mode = sys.argv[1:]
    parts = {"deploy/man/talus.1": talus_commands(talus), "deploy/man/talusd.8": options(help_of(talusd)),
             "solver/README.md": case_reference(), "solver/material/README.md": soil_types(talus)}
    bad = 0
    for name, part in parts.items():
        path = SOURCE / name
        now, wanted = path.read_text(), with_part(path.read_text(), part)
        if mode == ["--write"]:
            path.write_text(wanted)
        elif now != wanted:
            bad += 1
            diff = difflib.unified_diff(now.splitlines(), wanted.splitlines(), name, "as generated", lineterm="", n=1)
            print(*diff, sep="\n")
    for program, name in ((talus, "deploy/man/talus.1"), (talusd, "deploy/man/talusd.8")):
        if codes := exit_codes_differ((SOURCE / name).read_text(), help_of(program)):
            bad += 1
            print(f"{name} and --help disagree about the exit codes {', '.join(codes)}")
    if bad:
        sys.exit(f"{bad} parts of the documentation are out of date; tests/docs/generated.py TALUS TALUSD --write")


main()
