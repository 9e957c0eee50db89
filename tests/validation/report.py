"""Runs the experiments and writes the report.

report.py WORK [--coarse] [--only NAME ...] [--from-numbers] [--out DIR]

Runs are kept in WORK and not repeated. Numbers are written to DIR/results/NAME.json, figures to DIR/figures, the page to DIR/REPORT.md. With
--from-numbers the page is written from the existing numbers, without any run.
"""

import argparse
import importlib
import json
import pathlib
import time

HERE = pathlib.Path(__file__).resolve().parent
EXPERIMENTS = ["dam_break", "rest", "stress_at_rest", "sliding_slab", "sliding_block", "bingham_incline", "bingham_slump", "bingham_dam", "aluminium_rods", "columns", "softening", "yangbaodi", "noise_floor", "convergence", "numerics_budget", "paper_study"]


def measure(name, work, coarse):
    module = importlib.import_module(name)
    start = time.monotonic()
    numbers = module.measure(work, coarse)
    print(f"{name}: {time.monotonic() - start:.0f} s", flush=True)
    for criterion in module.criteria(numbers):
        print(f"  {'met    ' if criterion.met else 'NOT MET'} {criterion.what}: {criterion.value:.4g} ({span(criterion)})", flush=True)
    return numbers


def span(criterion):
    low, high = criterion.low, criterion.high
    return f"at most {high:.4g}" if low is None else f"at least {low:.4g}" if high is None else f"{low:.4g} to {high:.4g}"


def page(results, out):
    """Markdown of all experiments that have numbers."""
    modules = {name: importlib.import_module(name) for name in results}
    found = [c for name, numbers in results.items() for c in modules[name].criteria(numbers)]
    unmet = ", ".join(f"{modules[name].TITLE[0].lower()}{modules[name].TITLE[1:]} ({count})" for name, numbers in results.items() if (count := sum(not c.met for c in modules[name].criteria(numbers))))
    summary = (HERE / "summary.md").read_text().replace("@COUNT@", str(len(found))).replace("@FAILED@", str(sum(not c.met for c in found))).replace("@UNMET@", unmet)
    lines = ["# Validation", "", "Written by `tests/validation/report.sh`, which repeats every run behind the tables. Where a number in a remark comes from another run, the remark says so.", "",
             summary, "## All criteria", "",
             "| experiment | criterion | value | acceptance limit | origin of the limit | |", "|---|---|---|---|---|---|"]
    for name, numbers in results.items():
        for c in modules[name].criteria(numbers):
            lines.append(f"| [{modules[name].TITLE}](#{anchor(modules[name].TITLE)}) | {c.what} | {c.value:.3g} | {span(c)} | {c.why} | {'met' if c.met else '**not met**'} |")
    for name, numbers in results.items():
        module = modules[name]
        lines += ["", f"## {module.TITLE}", "", f"Source: {module.SOURCE}.", "", module.section(numbers, out / "figures").rstrip()]
        if remarks := getattr(module, "REMARKS", ""):
            lines += ["", remarks]
    tail = HERE / "breakages.md"
    return "\n".join(lines) + "\n" + ("\n" + tail.read_text() if tail.exists() else "")


def anchor(title):
    return "".join(c for c in title.lower().replace(" ", "-") if c.isalnum() or c == "-")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("work", type=pathlib.Path)
    options.add_argument("--coarse", action="store_true")
    options.add_argument("--only", nargs="+", choices=EXPERIMENTS, default=EXPERIMENTS)
    options.add_argument("--from-numbers", action="store_true")
    options.add_argument("--out", type=pathlib.Path, default=HERE)
    chosen = options.parse_args()
    numbers_of = lambda name: chosen.out / "results" / f"{name}.json"
    numbers_of("").parent.mkdir(parents=True, exist_ok=True)
    if not chosen.from_numbers:
        for name in chosen.only:
            numbers_of(name).write_text(json.dumps(measure(name, chosen.work, chosen.coarse), indent=1) + "\n")
    results = {name: json.loads(numbers_of(name).read_text()) for name in EXPERIMENTS if numbers_of(name).exists()}
    (chosen.out / "REPORT.md").write_text(page(results, chosen.out))
    print(chosen.out / "REPORT.md")


if __name__ == "__main__":
    main()
