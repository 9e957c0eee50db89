"""Containers without a daemon: buildah with chroot isolation, on a Debian that debootstrap made; needs root.

As a program, container.py BINARY_DIR makes that Debian, once.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


def suite():
    """The tests' Debian is that of this machine: its package is built for that."""
    return re.search(r"^VERSION_CODENAME=(\w+)$", pathlib.Path("/etc/os-release").read_text(), re.M)[1]


def with_a_root():
    """In a chroot / is no mount, which buildah and systemd-nspawn want it to be, and there may be no control groups: starts
    the program over with the same / as one, and with them."""
    mounts = pathlib.Path("/proc/self/mountinfo").read_text().splitlines()
    if any(line.split()[4] == "/" for line in mounts):
        return
    script = ('mount --rbind / /mnt && { mountpoint -q /mnt/sys/fs/cgroup || mount -t cgroup2 cgroup2 /mnt/sys/fs/cgroup; }'
              ' && exec chroot /mnt env -C "$0" TALUS_IN_CHROOT=1 "$@"')
    os.execvp("unshare", ["unshare", "--mount", "--propagation", "unchanged", "sh", "-c", script, os.getcwd(), sys.executable, "-B", *sys.argv])


def pack(binary_dir, directory):
    """The Debian package of what is built."""
    done = subprocess.run(["cpack", "-G", "DEB", "--config", "CPackConfig.cmake", "-B", str(directory)],
                          capture_output=True, text=True, cwd=binary_dir)
    assert done.returncode == 0, done.stdout + done.stderr
    (package,) = directory.glob("talus_*.deb")
    return package


class Buildah:
    """Images and containers of ours, apart from those of this machine."""

    def __init__(self, binary_dir):
        self.dir = pathlib.Path(binary_dir) / "containers"
        self.dir.mkdir(exist_ok=True)
        self.command = ["buildah", "--root", str(self.dir / "storage"), "--runroot", str(self.dir / "run"),
                        "--storage-driver", "overlay"]
        # Newer buildahs would raise them to a million, which root without CAP_SYS_RESOURCE cannot.
        self.limits = ["--ulimit=nofile=1024:1024", "--ulimit=nproc=1024:1024"]
        self.base = f"localhost/talus-test-debian:{suite()}"

    def __call__(self, *arguments, check=True, **more):
        done = subprocess.run([*self.command, *map(str, arguments)], stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **more)
        if check and done.returncode != 0:
            raise AssertionError(f"buildah {' '.join(map(str, arguments))}: {done.returncode}\n{done.stdout[-6000:]}")
        return done

    def container(self, image):
        return self("from", "--pull-never", "--isolation", "chroot", *self.limits, image).stdout.split()[-1]

    def run_command(self, container, *command, options=()):
        return [*self.command, "run", "--isolation", "chroot", *map(str, options), container, "--", *map(str, command)]

    def run(self, container, *command, options=(), check=True):
        return self("run", "--isolation", "chroot", *options, container, "--", *command, check=check)

    def bootstrap(self):
        if self("inspect", "--type", "image", self.base, check=False).returncode == 0:
            return
        with tempfile.TemporaryDirectory(dir=self.dir) as root:
            done = subprocess.run(["debootstrap", "--variant=minbase", suite(), root], capture_output=True, text=True)
            assert done.returncode == 0, done.stdout[-3000:] + done.stderr
            container = self("from", "scratch").stdout.split()[-1]
            self("add", "--quiet", container, root, "/")
            self("commit", "--quiet", "--rm", container, self.base)


if __name__ == "__main__":
    if os.geteuid() != 0 or not shutil.which("buildah"):
        sys.exit("needs root, buildah and debootstrap")
    with_a_root()
    Buildah(sys.argv[1]).bootstrap()
