"""Runs a command under the system-call filter of a systemd unit, as systemd would set it.

usage: under_filter.py UNIT COMMAND...      needs Debian's python3-seccomp, so run it with /usr/bin/python3
"""
import errno
import os
import subprocess
import sys

import seccomp


def members(name):
    """System calls of a group (@system-service), or the one of this name."""
    if not name.startswith("@"):
        return {name}
    done = subprocess.run(["systemd-analyze", "syscall-filter", name], check=True, capture_output=True, text=True)
    lines = [line.strip() for line in done.stdout.splitlines()[1:]]
    inside = [line for line in lines if line and not line.startswith("#")]
    return set().union(*(members(each) for each in inside))


def allowed(unit):
    """Lines add to the list or, with a tilde, take away; the first one must add."""
    calls = set(members("@default"))
    lists = [line.strip().split("=", 1)[1] for line in open(unit) if line.startswith("SystemCallFilter=")]
    if not lists or lists[0].startswith("~"):
        sys.exit(f"{unit}: no list of allowed system calls")
    for line in lists:
        for name in line.lstrip("~").split():
            calls = calls - members(name) if line.startswith("~") else calls | members(name)
    return calls | {"execve"}  # systemd itself needs it to start the service


def main():
    unit, *command = sys.argv[1:]
    bpf = seccomp.SyscallFilter(seccomp.ERRNO(errno.EPERM))
    known = 0
    for name in sorted(allowed(unit)):
        try:
            bpf.add_rule(seccomp.ALLOW, name)
            known += 1
        except (RuntimeError, ValueError):
            pass  # of another architecture
    if known < 100:
        sys.exit(f"only {known} system calls allowed; is the list understood?")
    bpf.load()
    os.execvp(command[0], command)


main()
