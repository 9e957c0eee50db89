#!/usr/bin/env bash
# report.sh [WORK] [options of report.py]: builds, runs every experiment in full and writes REPORT.md. Takes hours; after an interruption the same command continues.
set -euo pipefail
cd "$(dirname "$0")/../.."
deploy/install-packages.sh build test
cmake --preset release -DTALUS_TESTS=ON >/dev/null
cmake --build --preset release --target talus
sh tests/support/python_env.sh build/release/python
work=${1:-build/validation}
shift || true
export TALUS=${TALUS:-$PWD/build/release/bin/talus}
python=build/release/python/bin/python
case " $* " in
  *" --coarse "* | *" --only "* | *" --from-numbers "*) ;;
  *) "$python" tests/validation/paper_study.py "$work" ;;
esac
exec "$python" tests/validation/report.py "$work" "$@"
