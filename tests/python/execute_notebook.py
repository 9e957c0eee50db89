#!/usr/bin/env python3
"""Runs a notebook of deploy/python/notebooks and compares what its cells print and show with what is stored in it.

usage: execute_notebook.py NOTEBOOK [--write]    with --write the outputs are stored
Text is compared, numbers as far as they are printed; of pictures only that they are there, since fonts differ.
Needs $TALUS, and the package on the path.
"""

import os
import pathlib
import re
import sys

import nbclient
import nbformat

os.environ["PYTHONHASHSEED"] = "0"
os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"


def shown(cell):
    """What a cell shows: texts, and "picture" for a picture."""
    found = []
    for output in cell.get("outputs", ()):
        if output["output_type"] == "stream":
            found.append(output["text"])
        elif "image/png" in output.get("data", {}):
            found.append("picture")
        else:
            found.append(re.sub(r"0x[0-9a-f]+|/tmp/\S+", "...", output.get("data", {}).get("text/plain", "")))
    return found


def main(path, write):
    stored = nbformat.read(path, as_version=4)
    fresh = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(
        fresh,
        timeout=300,
        kernel_name="python3",
        resources={"metadata": {"path": str(path.parent)}},
        record_timing=False,
    ).execute()
    if write:
        nbformat.write(fresh, path)
        return 0
    faults = []
    for old, new in zip(stored.cells, fresh.cells, strict=True):
        if shown(old) != shown(new):
            faults.append(f"cell {old['id']}: stored\n{shown(old)}\nnow\n{shown(new)}")
    pictures = sum(shown(cell).count("picture") for cell in stored.cells)
    print(
        *faults,
        f"{len(fresh.cells)} cells, {pictures} pictures, {len(faults)} differ; --write stores the outputs anew",
        sep="\n",
    )
    return 1 if faults or not pictures else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), "--write" in sys.argv))
