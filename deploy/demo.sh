#!/usr/bin/env bash
# demo.sh: installs what is missing, builds, runs a small study of the illustrative slope and shows its histogram.
# About two minutes on two cores; the first time, downloading packages and building come on top.
#   OUT=DIR        where the study goes (default out/demo beside the sources)
#   REALIZATIONS=N how many runs (default 16)
set -euo pipefail
cd "$(dirname "$0")/.."

deploy/install-packages.sh build
cmake --preset release -DTALUS_TESTS=OFF >/dev/null
cmake --build --preset release --target talus

out=${OUT:-out/demo}
build/release/bin/talus study solver/cases/illustrative.json \
  --set particle_spacing_m=0.4 --set random_field.terms=200 --set study.noise_floor_replicates=3 \
  --realizations "${REALIZATIONS:-16}" --seed 2020 --threads 1 --out "$out"
echo
echo "the study:   $out/study.json, $out/realizations.csv"
echo "its figures: $out/figures/"
ls "$out/figures/" | sed 's/^/             /'
