#!/usr/bin/env bash
# run.sh [everyday]: installs what is missing, builds, runs every test; with `everyday` the release build without the slow ones.
set -euo pipefail
cd "$(dirname "$0")/.."
export OMP_WAIT_POLICY=passive
jobs=$(nproc)

# Presets and what ctest leaves out of each; the sanitized builds repeat only what they are good for.
deploy/install-packages.sh build test
cmake --preset release -DTALUS_TESTS=ON >/dev/null
cmake --build --preset release
if [ "${1:-all}" = everyday ]; then
  exec ctest --preset release -j "$jobs" -LE slow
fi

deploy/install-packages.sh tsan container
TALUS_CLANG=-$(printf '%s\n' /usr/bin/clang++-[0-9]* | sed 's/.*-//' | sort -n | tail -1)  # -16: as the presets want it
export TALUS_CLANG
cmake --preset dev >/dev/null
cmake --build --preset dev
cmake --preset tsan >/dev/null
cmake --build --preset tsan --target test_simulation test_sph test_integrate talusd test_service
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target fuzz_request fuzz_case

status=0
# talusd with the thread sanitizer; the runs that it starts need none.
TALUS=$PWD/build/release/bin/talus ctest --preset tsan -R 'Determinism|RightHandSide|VectorisedFlow|Integrator|StoreTest|service_(Ours|Load|Crash)$' || status=1
ctest --preset fuzz || status=1
ctest --preset dev -j "$jobs" -LE 'slow|long' || status=1
ctest --preset release -j "$jobs" || status=1
exit $status
