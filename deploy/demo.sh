#!/usr/bin/env bash
# demo.sh: installs what is missing, builds, runs a small study of the illustrative slope and shows its histogram; then the
# same over HTTP: starts talusd on a free port of this machine, submits the study, and prints the histogram fetched as JSON.
# About two minutes on two cores; the first time, downloading packages and building come on top.
#   OUT=DIR        where the study goes (default out/demo beside the sources)
#   REALIZATIONS=N how many runs (default 16)
set -euo pipefail
cd "$(dirname "$0")/.."

deploy/install-packages.sh build
cmake --preset release -DTALUS_TESTS=OFF >/dev/null
cmake --build --preset release --target talus talusd

out=${OUT:-out/demo}
build/release/bin/talus study solver/cases/illustrative.json \
  --set particle_spacing_m=0.4 --set random_field.terms=200 --set study.noise_floor_replicates=3 \
  --realizations "${REALIZATIONS:-16}" --seed 2020 --threads 1 --out "$out"
echo
echo "the study:   $out/study.json, $out/realizations.csv"
echo "its figures: $out/figures/"
ls "$out/figures/" | sed 's/^/             /'

echo
echo "the same over HTTP:"
data=$(mktemp -d)
build/release/bin/talusd --data "$data" --listen 127.0.0.1:0 --workers "$(nproc)" --min-disk 100 >"$data/said" 2>"$data/log" &
talusd=$!
trap 'kill $talusd 2>/dev/null; wait $talusd 2>/dev/null || true; rm -rf "$data"' EXIT
for _ in $(seq 100); do
  [ -s "$data/said" ] && break
  sleep 0.1
done
cat "$data/said"
TALUS_SERVER=$(sed -n 's/.*listens on //p' "$data/said")
export TALUS_SERVER
[ -n "$TALUS_SERVER" ] || { cat "$data/log" >&2; exit 1; }
job=$(build/release/bin/talus submit solver/cases/illustrative.json \
  --set particle_spacing_m=0.4 --set random_field.terms=200 --set study.noise_floor_replicates=3 \
  --realizations "${REALIZATIONS:-16}" --seed 2020)
build/release/bin/talus watch "$job"
curl -s "$TALUS_SERVER/jobs/$job/histogram"
