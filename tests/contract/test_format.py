#!/usr/bin/env python3
"""The whole tree is as clang-format 14 leaves it, at most 120 columns wide, and no statement is chained by the comma operator.

usage: test_format.py SOURCE_DIR CLANG_FORMAT
"""
import pathlib
import re
import subprocess
import sys

COLUMNS = 120
CONTROL = re.compile(r"(?:(?:if|for|while|switch)\s*(?:constexpr\s*)?\(\)|else|do|case\s[^:?]*:|default\s*:)\s*")
# An expression, collapsed: a name with members, calls and indices, perhaps assigned to. A declaration has a type before.
EXPRESSION = re.compile(r"(?:\+\+|--|\*|::)*\w+(?:(?:\.|->|::)\w+|<[\w:, ]*>\(\)|\(\)|\[\])*\s*(?:\+\+|--|[-+*/%&|^]?=(?!=)|<<|>>|\?|,|$)")


def bare(text):
    """The code without comments, strings, characters and preprocessor lines; lines keep their numbers."""
    keep_lines = lambda found: "\n" * found[0].count("\n")  # noqa: E731
    text = re.sub(r'R"(\w*)\(.*?\)\1"', lambda found: '""' + keep_lines(found), text, flags=re.S)
    text = re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'',
                  lambda found: keep_lines(found) if found[0].startswith("/") else "0", text, flags=re.S)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", keep_lines, text, flags=re.M)


def comma_operators(text):
    """Line numbers of statements that hold a comma outside parentheses and are no declaration."""
    found, line = [], 1
    levels = [["{", "", 0]]  # of brackets: which, the text in it since the last statement, line where that begins
    for c in bare(text):
        line += c == "\n"
        top = levels[-1]
        if c in "([{":
            before = top[1].rstrip()
            block = c == "{" and (before == "" or re.search(r"(?:[)\]]|\b(?:else|do|try|const|noexcept|override|mutable)|->\s*[\w:<>]+)$", before))
            levels.append(["{" if block else "-", "", line])
        elif c in ")]}":
            if len(levels) > 1:
                levels.pop()
            top = levels[-1]
            top[1] = top[1] + {")": "()", "]": "[]", "}": "{}"}[c]
            if c == "}" and top[0] == "{" and not re.search(r"[=,(]\s*[^;]*\{\}$", top[1]):
                top[1] = ""
        elif c == ";":
            statement = top[1].strip()
            while control := CONTROL.match(statement):
                statement = statement[control.end():]
            statement = re.sub(r"<[\w:, ]*>", "", statement)  # template arguments
            if top[0] == "{" and "," in statement and len(levels) > 1 and EXPRESSION.match(statement):
                found.append(top[2])
            top[1] = ""
        else:
            if not top[1].strip() and not c.isspace():
                top[2] = line
            top[1] += c
    return found


def main(source, clang_format):
    files = sorted(file for part in ("solver", "service", "tests") for file in (source / part).rglob("*.[ch]pp"))
    assert len(files) > 200, f"only {len(files)} files; is {source} the source?"
    faults = []
    for file in files:
        text = file.read_text()
        faults += [f"{file}:{number}: {len(row)} columns" for number, row in enumerate(text.splitlines(), 1) if len(row) > COLUMNS]
        faults += [f"{file}:{number}: comma operator" for number in comma_operators(text)]
    done = subprocess.run([clang_format, "--dry-run", "--Werror", *files], capture_output=True, text=True)
    faults += [row for row in done.stderr.splitlines() if "error:" in row]
    assert done.returncode in (0, 1), done.stderr
    print(*faults, f"{len(faults)} faults in {len(files)} files", sep="\n")
    return 1 if faults or done.returncode else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), sys.argv[2]))
