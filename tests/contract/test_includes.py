#!/usr/bin/env python3
"""Who may include whom: the table of solver/README.md against every #include line.  usage: test_includes.py SOLVER_DIR"""
import pathlib
import re
import sys

ORDER = ["math", "material", "random_field", "particles", "neighbours", "sph", "integrate", "simulation", "monte_carlo", "case", "io", "figures",
         "study", "cli"]
MAY = {module: set(ORDER[:k + 1]) for k, module in enumerate(ORDER)}
for module in ("particles", "neighbours", "sph", "integrate", "simulation", "material"):
    MAY[module].discard("random_field")  # joins at monte_carlo
MAY["random_field"] = {"math", "random_field"}
MAY["study"].discard("figures")

solver, faults, lines = pathlib.Path(sys.argv[1]), [], 0
for path in sorted(solver.rglob("*.[ch]pp")):
    module = path.relative_to(solver).parts[0]
    for number, line in enumerate(path.read_text().splitlines(), 1):
        include = re.match(r'#include "([a-z_]+)/', line)
        if include:
            lines += 1
            if include[1] not in MAY[module]:
                faults.append(f"{path}:{number}: {module}/ must not include {include[1]}/")
print("\n".join(faults) or f"{lines} includes, all downwards")
sys.exit(bool(faults) or lines == 0)
