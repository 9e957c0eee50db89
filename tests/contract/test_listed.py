#!/usr/bin/env python3
"""Every test file, and every source file, is named in a CMakeLists.txt: one that is in no build passes silently. Every
source file is named, with or without its ending, in backquotes in the README of its module.

usage: test_listed.py SOURCE_DIR
"""
import pathlib
import re
import sys


def names(file):
    """What a CMakeLists.txt may call it; functions and loops there make NAME.cpp and test_NAME.py of NAME."""
    if file.suffix == ".cpp" and file.name.startswith("test_"):
        return {file.name}
    return {file.name, file.stem, file.stem.removeprefix("test_")}


def undocumented(source):
    """Source files that the README beside them does not name."""
    for readme in sorted(readme for part in ("solver", "service") for readme in (source / part).rglob("README.md")):
        words = set(re.findall(r"[\w-]+", " ".join(re.findall("`([^`\n]+)`", readme.read_text()))))
        for file in sorted(readme.parent.glob("*.?pp")):
            if not words & {file.stem, file.stem.removesuffix("-inl")}:
                yield f"{file}: not named in {readme}"


def main(source):
    parts = [source / part for part in ("solver", "service", "tests")]
    lists = [re.sub("#.*", "", file.read_text()) for part in parts for file in part.rglob("CMakeLists.txt")]
    words = set(re.findall(r"\w+(?:\.cpp|\.py)?", "\n".join(lists)))
    files = [file for part in parts for file in sorted(part.rglob("*.cpp"))]
    files += sorted((source / "tests").rglob("test_*.py"))
    assert len(files) > 150, f"only {len(files)} files; is {source} the source?"
    missing = [file for file in files if not words & names(file)]
    faults = [f"{file}: in no CMakeLists.txt" for file in missing] + list(undocumented(source))
    print(*faults, f"{len(files)} files, {len(faults)} faults", sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
