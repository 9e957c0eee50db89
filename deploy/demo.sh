#!/usr/bin/env bash
# demo.sh: installs what is missing, builds, runs a small study of the illustrative slope and shows its histogram; then
# the same over HTTP: starts talusd on a free port of this machine, submits the study, prints the histogram as JSON.
# About two minutes on two cores, plus downloading packages and building the first time.
#   OUT=DIR           directory of the study (default out/demo in the sources)
#   REALIZATIONS=N    number of realizations (default 16)
#   BIN=DIR           directory of installed talus and talusd; nothing is installed or built
#   CASE=FILE         another case (default: the illustrative slope, of the sources or installed beside BIN)
#   TALUS_SERVER=URL  a running talusd (its token in TALUS_TOKEN): only the part over HTTP
set -euo pipefail
cd "$(dirname "$0")/.."

bin=${BIN:-build/release/bin}
if [ -z "${BIN:-}" ]; then
  deploy/install-packages.sh build
  # Files joined into few units compile in a third of the time when all of them have to be.
  [ -f build/release/build.ninja ] || cmake --preset release -DTALUS_TESTS=OFF -DCMAKE_UNITY_BUILD=ON >/dev/null
  cmake --build --preset release --target talus talusd
fi
case=solver/cases/illustrative.json
[ -f "$case" ] || case=$bin/../share/talus/cases/illustrative.json
study=("${CASE:-$case}"
       --set particle_spacing_m=0.4 --set random_field.terms=200 --set study.noise_floor_replicates=3
       --realizations "${REALIZATIONS:-16}" --seed 2020)

if [ -z "${TALUS_SERVER:-}" ]; then
  out=${OUT:-out/demo}
  "$bin/talus" study "${study[@]}" --threads 1 --out "$out"
  echo
  echo "the study:   $out/study.json, $out/realizations.csv"
  echo "its figures: $out/figures/"
  find "$out/figures/" -type f | sort | sed 's/^/             /'

  data=$(mktemp -d)
  "$bin/talusd" --data "$data" --listen 127.0.0.1:0 --workers "$(nproc)" --min-disk 100 >"$data/stdout" 2>"$data/log" &
  talusd=$!
  trap 'kill $talusd 2>/dev/null; wait $talusd 2>/dev/null || true; rm -rf "$data"' EXIT
  for _ in $(seq 100); do
    [ -s "$data/stdout" ] && break
    sleep 0.1
  done
  TALUS_SERVER=$(sed -n 's/.*listens on //p' "$data/stdout")
  [ -n "$TALUS_SERVER" ] || { cat "$data/log" >&2; exit 1; }
fi
export TALUS_SERVER

echo
echo "the same over HTTP, by $TALUS_SERVER:"
job=$("$bin/talus" submit "${study[@]}")
"$bin/talus" watch "$job"
curl -s ${TALUS_TOKEN:+-H "Authorization: Bearer $TALUS_TOKEN"} "$TALUS_SERVER/jobs/$job/histogram"
echo
