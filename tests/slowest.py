#!/usr/bin/env python3
"""slowest.py RESULTS.xml...: the twenty slowest tests of ctest's JUnit files, and those that failed or skipped themselves.

Ends with 1 when there is no test at all or when one failed.
"""
import pathlib
import sys
import xml.etree.ElementTree


def main(files):
    tests, bad = [], []
    for file in map(pathlib.Path, files):
        for case in xml.etree.ElementTree.parse(file).getroot().iter("testcase"):
            tests.append((float(case.get("time", 0)), f"{file.stem}: {case.get('name')}"))
            skipped = case.find("skipped")
            if case.find("failure") is not None:
                bad.append(("failed", tests[-1][1]))
            elif case.get("status") in ("notrun", "disabled") or skipped is not None:
                bad.append(("not run", f"{tests[-1][1]}: {skipped.get('message', '') if skipped is not None else ''}"))
    print("\nthe twenty slowest of", len(tests), "tests")
    for seconds, name in sorted(tests, reverse=True)[:20]:
        print(f"{seconds:8.1f} s  {name}")
    for what, name in bad:
        print(f"{what:>8}    {name}")
    return 0 if tests and not any(what == "failed" for what, _ in bad) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
