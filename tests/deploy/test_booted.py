"""The unit of the Debian package under a real systemd, booted by systemd-nspawn: a study as a dynamic user without
rights; then with the options and the token that the unit's head shows.

usage: test_booted.py TALUSD SOURCE_DIR BINARY_DIR
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from container import Buildah, pack, with_a_root  # noqa: E402

SOURCE, BINARY = map(pathlib.Path, sys.argv[2:4])

# Runs inside as root once the machine is up; what it prints comes back.
INSIDE = r"""
exec > /opt/said 2>&1
answers() {
  for _ in $(seq 100); do
    curl -sf http://127.0.0.1:8080/healthz >/dev/null && return
    sleep 0.2
  done
  false
}
answers && echo "answers" || journalctl --no-pager -u talusd
grep -E '^(Uid|CapEff|NoNewPrivs|Seccomp):' "/proc/$(systemctl show talusd -p MainPID --value)/status"
job=$(talus submit /usr/share/talus/cases/illustrative.json --realizations 4 --set particle_spacing_m=1 --seed 1)
talus watch "$job"
curl -s "http://127.0.0.1:8080/jobs/$job/realizations/1/field?format=svg" | grep -o '<svg'
stat -c 'data of %u, mode %a' /var/lib/private/talusd

mkdir -p /etc/talusd /etc/systemd/system/talusd.service.d
sed -n 's/^#   //p' /lib/systemd/system/talusd.service > /etc/systemd/system/talusd.service.d/own.conf
talusd --new-token submit anna > /opt/new
sed -n 's/^line for the tokens file: //p' /opt/new > /etc/talusd/tokens
chmod 600 /etc/talusd/tokens
systemctl daemon-reload
systemctl restart talusd
echo "ended with $(systemctl show talusd -p Result --value)"
answers
curl -s -o /dev/null -w 'nobody: %{http_code}\n' http://127.0.0.1:8080/jobs
export TALUS_TOKEN=$(sed -n 's/^token: //p' /opt/new)
talus status && echo "anna: known"
systemctl show talusd -p ExecMainStatus
"""
UNIT = """
[Unit]
After=multi-user.target talusd.service
[Service]
ExecStart=bash /opt/inside.sh
ExecStopPost=systemctl --no-block poweroff
TimeoutStartSec=200
[Install]
WantedBy=multi-user.target
"""
# Of the control groups it sees the second version alone: a machine that has both, and no systemd to keep them in step, would
# let systemd-nspawn fail at the first one.
BOOT = """umount --lazy --recursive /sys/fs/cgroup
mount -t cgroup2 cgroup2 /sys/fs/cgroup &&
exec timeout -k 5 300 systemd-nspawn -D "$0" --private-network --boot --register=no --keep-unit
"""


class Booted(unittest.TestCase):
    def test_unit(self):
        buildah, directory = Buildah(BINARY), pathlib.Path(tempfile.mkdtemp(prefix="talus-booted-"))
        self.addCleanup(shutil.rmtree, directory)
        container = buildah.container(buildah.base)
        self.addCleanup(buildah, "rm", container)
        buildah("copy", "--quiet", container, pack(BINARY, directory), "/opt/talus.deb")
        buildah.run(container, "sh", "-c", "apt-get update -qq && apt-get install -y -qq --no-install-recommends"
                    " systemd systemd-sysv dbus curl gnuplot-nox fonts-dejavu-core /opt/talus.deb"
                    " && systemctl enable talusd", options=["--env", "DEBIAN_FRONTEND=noninteractive"])
        root = pathlib.Path(buildah("mount", container).stdout.strip())
        self.addCleanup(buildah, "umount", container)
        (root / "opt/inside.sh").write_text(INSIDE)
        (root / "etc/systemd/system/inside.service").write_text(UNIT)
        wanted = root / "etc/systemd/system/multi-user.target.wants"
        (wanted / "inside.service").symlink_to("/etc/systemd/system/inside.service")
        if "TALUS_IN_CHROOT" in os.environ:
            print("without PrivateUsers=, since the kernel makes no user namespaces in a chroot", file=sys.stderr)
            (root / "etc/systemd/system/talusd.service.d").mkdir()
            (root / "etc/systemd/system/talusd.service.d/chroot.conf").write_text("[Service]\nPrivateUsers=no\n")
        (root / "etc/resolv.conf").unlink(missing_ok=True)
        boot = subprocess.run(["unshare", "--mount", "sh", "-c", BOOT, root], stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
        self.assertTrue((root / "opt/said").exists(), boot.stdout[-3000:])
        said = (root / "opt/said").read_text()
        for line in (r"^answers$", r"^Uid:\t(6[1-5]\d{3})\t\1\t\1\t\1$", r"^CapEff:\t0+$", r"^NoNewPrivs:\t1$",
                     r"^Seccomp:\t2$", r"successful +100 % +4 realizations", r"^<svg$",
                     r"^data of 6[1-5]\d{3}, mode 750$",
                     r"^ended with success$", r"^nobody: 401$", r"^anna: known$", r"^ExecMainStatus=0$"):
            self.assertRegex(said, re.compile(line, re.M))


if __name__ == "__main__":
    with_a_root()
    unittest.main(argv=sys.argv[:1], verbosity=2)
