#!/bin/sh
# python_env.sh DIR: makes DIR a Python environment with the packages of requirements.txt, unless it is one already (then no network is needed).
# Needs python3 with venv (Debian: python3-venv).
set -eu
directory=$1
requirements=$(dirname "$0")/requirements.txt
done_mark=$directory/installed-requirements.txt

if cmp -s "$requirements" "$done_mark" && "$directory/bin/python" -c "import vtkmodules, h5py, jsonschema, matplotlib.pyplot, schemathesis, owslib, umbridge, xarray, nbclient, mypy, openapi_python_client"; then
  exit 0
fi
rm -f "$done_mark"
python3 -m venv --clear "$directory" || { echo "python_env.sh: cannot make a Python environment; apt-get install python3-venv" >&2; exit 1; }
# --no-deps: the list is whole.
"$directory/bin/pip" install --quiet --disable-pip-version-check --no-deps -r "$requirements" ||
  { echo "python_env.sh: cannot install $requirements; is there a network?" >&2; exit 1; }
cp "$requirements" "$done_mark"
