#!/usr/bin/env bash
# install-packages.sh [build] [test] [tsan] [container]: installs the Debian packages that Talus needs and that are missing.
# Needs root or sudo only if something is missing.
set -euo pipefail

build=(cmake ninja-build g++ pkg-config libeigen3-dev libhdf5-dev libboost-dev nlohmann-json3-dev libcli11-dev libhwy-dev
       librandom123-dev libsqlitecpp-dev libsqlite3-dev libssl-dev gnuplot-nox fonts-dejavu-core curl
       dpkg-dev file)
test=(libgtest-dev libbenchmark-dev libvalijson-dev python3-venv ca-certificates nginx openssl systemd python3-seccomp
      sqlite3 e2fsprogs slurm-wlm munge wrk)
container=(debootstrap buildah netavark iproute2 systemd-container)
. /etc/os-release
llvm=$([ "${VERSION_ID%%.*}" = 12 ] && echo 16 || echo 19)  # Debian 12 and 13 share no version
tsan=("clang-$llvm" "llvm-$llvm" "libclang-rt-$llvm-dev" "libomp-$llvm-dev")

wanted=()
for group in "${@:-build}"; do
  case $group in
    build) wanted+=("${build[@]}") ;;
    test) wanted+=("${test[@]}") ;;
    tsan) wanted+=("${tsan[@]}") ;;
    container) wanted+=("${container[@]}") ;;
    *) echo "install-packages.sh: no group '$group' (build, test, tsan, container)" >&2; exit 2 ;;
  esac
done

missing=()
for package in "${wanted[@]}"; do
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if [ "$(id -u)" -eq 0 ]; then
  as_root=()
elif command -v sudo >/dev/null; then
  as_root=(sudo)
else
  echo "install-packages.sh: not root and no sudo; ask for: apt-get install ${missing[*]}" >&2
  exit 1
fi
echo "installing ${missing[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq >&2
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
