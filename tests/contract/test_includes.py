#!/usr/bin/env python3
"""Who may include whom: the tables of solver/README.md and service/README.md against every #include line.

usage: test_includes.py SOURCE_DIR
"""
import pathlib
import re
import sys

# A module may include itself and what stands before it.
ORDER = ["math", "material", "random_field", "particles", "neighbours", "sph", "integrate", "simulation", "case", "io", "run", "figures", "cli"]
MAY = {module: set(ORDER[:k + 1]) for k, module in enumerate(ORDER)}
for module in ("particles", "neighbours", "sph", "integrate", "simulation", "material"):
    MAY[module].discard("random_field")  # joins at case, where it is declared, and at run
MAY["random_field"] = {"math", "random_field"}
MAY["executor"] = {"executor"}  # apart: talusd uses it too, and it knows nothing of the solver
MAY["cli"].add("executor")
# The ground, free of the solver: talusd stands on it too.
GROUND = {"support": {"support"}, "statistics": {"statistics"}, "study": {"support", "statistics", "executor", "study"}}
for module in MAY:
    MAY[module] |= set(GROUND)
MAY["executor"] -= {"statistics", "study"}
MAY |= GROUND

# The service runs the solver's program and reads its files; of solver/ it includes what is free of the solver.
SERVICE_ORDER = ["base", "queue", "process", "jobs", "http"]
SERVICE_MAY = {module: set(SERVICE_ORDER[:k + 1]) for k, module in enumerate(SERVICE_ORDER)}
SERVICE_MAY["process"].discard("queue")
for module in SERVICE_MAY:
    SERVICE_MAY[module] |= set(GROUND)
for module in ("process", "jobs"):
    SERVICE_MAY[module].add("executor")


def faults_in(root, may):
    faults, lines = [], 0
    for path in sorted(root.rglob("*.[ch]pp")):
        parts = path.relative_to(root).parts
        if len(parts) == 1:
            allowed = set(may) | set(GROUND) | {"executor"}  # main and its options may see everything
        else:
            allowed = may[parts[0]]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            include = re.match(r'#include "([a-z_]+)/', line)
            if include:
                lines += 1
                if include[1] not in allowed:
                    faults.append(f"{path}:{number}: {parts[0]}/ must not include {include[1]}/")
    return faults, lines


source = pathlib.Path(sys.argv[1])
faults, lines = faults_in(source / "solver", MAY)
service_faults, service_lines = faults_in(source / "service", SERVICE_MAY)
faults += service_faults
print("\n".join(faults) or f"{lines} + {service_lines} includes, all downwards")
sys.exit(bool(faults) or 0 in (lines, service_lines))
