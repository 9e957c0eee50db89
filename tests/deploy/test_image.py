"""deploy/Dockerfile as service/README.md says, without a daemon: built, run by its user with a volume, healthy, demo.

usage: test_image.py TALUSD SOURCE_DIR BINARY_DIR
"""
import ctypes
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from container import Buildah, with_a_root  # noqa: E402

TALUSD, SOURCE, BINARY = map(pathlib.Path, sys.argv[1:4])
CLONE_NEWNET = 0x40000000
URL = "http://127.0.0.1:8080"


def documented(verb):
    """The words behind `docker VERB` in service/README.md."""
    return shlex.split(re.search(rf"^docker {verb} (.*)$", (SOURCE / "service/README.md").read_text(), re.M)[1])


def network_of_our_own():
    """Port 8080 is used by this container only."""
    if ctypes.CDLL(None, use_errno=True).unshare(CLONE_NEWNET) != 0:
        raise OSError(ctypes.get_errno(), "unshare")
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)


def talusd_processes():
    """Those of our network."""
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if (entry / "comm").read_text() == "talusd\n" and (entry / "ns/net").samefile("/proc/self/ns/net"):
                yield int(entry.name)
        except OSError:
            pass  # it has ended


class Image(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.buildah = Buildah(BINARY)
        cls.buildah("bud", "--isolation", "chroot", "--format", "docker", "--pull-never", "--layers",
                    *cls.buildah.limits, "--build-arg", f"BASE={cls.buildah.base}", *documented("build"), cwd=SOURCE)
        cls.image = json.loads(cls.buildah("inspect", "--type", "image", "talusd").stdout)["Docker"]["config"]
        cls.container = cls.buildah.container("talusd")
        cls.addClassCleanup(cls.buildah, "rm", cls.container)
        # Else this buildah takes now the volume that we give, now one of its own.
        cls.buildah("config", "--volume", "/var/lib/talusd-", cls.container)
        network_of_our_own()

    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="talus-image-"))
        self.addCleanup(shutil.rmtree, self.dir)
        self.dir.chmod(0o755)
        made = subprocess.check_output([TALUSD, "--new-token", "submit", "anna"], text=True)
        self.token = re.search(r"^token: (.*)$", made, re.M)[1]
        (self.dir / "tokens").write_text(re.search(r"^line for the tokens file: (.*)$", made, re.M)[1] + "\n")
        self.volume = self.new_volume()
        self.running = None

    def tearDown(self):
        if self.running and self.running.poll() is None:
            self.stop()

    def new_volume(self):
        """As a named volume: empty, its owner and rights those of the directory in the image."""
        there = pathlib.Path(self.buildah("mount", self.container).stdout.strip()) / "var/lib/talusd"
        volume = self.dir / "volume"
        volume.mkdir()
        os.chown(volume, there.stat().st_uid, there.stat().st_gid)
        volume.chmod(there.stat().st_mode & 0o777)
        self.buildah("umount", self.container)
        return volume

    def start(self):
        words = documented("run")
        mounts = [words[i + 1] for i, word in enumerate(words) if word == "-v"]
        mounts = [each.replace("$PWD/", f"{self.dir}/").replace("talusd:/", f"{self.volume}:/", 1) for each in mounts]
        options = [o for mount in mounts for o in ("--volume", mount)]
        arguments = words[words.index("talusd") + 1:]
        command = self.buildah.run_command(self.container, *self.image["Entrypoint"], *arguments, "--min-disk", "0",
                                           options=options)
        with open(self.dir / "log", "ab") as log:
            self.running = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=log,
                                            text=True)
        self.assertIn("listens on http://0.0.0.0:8080", self.running.stdout.readline(), (self.dir / "log").read_text())

    def stop(self):
        for process in talusd_processes():
            os.kill(process, signal.SIGTERM)
        code = self.running.wait(60)
        self.running.stdout.close()
        return code

    def healthy(self):
        kind, command = self.image["Healthcheck"]["Test"]
        self.assertEqual(kind, "CMD-SHELL")
        return self.buildah.run(self.container, "sh", "-c", command, check=False).returncode == 0

    def test_configuration(self):
        self.assertEqual(self.image["User"], "talusd")
        self.assertIn("/var/lib/talusd", self.image["Volumes"])
        self.assertIn("8080/tcp", self.image["ExposedPorts"])
        self.assertEqual(self.buildah.run(self.container, "id", "-u").stdout.strip(), "10001")
        self.assertEqual(self.buildah.run(self.container, "test", "-w", "/usr/bin", check=False).returncode, 1)
        tools = "for f in /src /tmp/talus.deb /usr/bin/g++ /usr/bin/cmake; do test ! -e $f || echo $f; done"
        self.assertEqual(self.buildah.run(self.container, "sh", "-c", tools).stdout, "")

    def test_without_tokens_it_does_not_start(self):
        done = self.buildah.run(self.container, *self.image["Entrypoint"], check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("talusd-tokens", done.stdout)

    def test_healthy_demo_and_restart(self):
        self.assertFalse(self.healthy())
        self.start()
        self.assertTrue(self.healthy())
        self.assertTrue((self.volume / "queue.sqlite").exists())
        owners = {entry.stat().st_uid for entry in [self.volume, *self.volume.rglob("*")]}
        self.assertEqual(owners, {10001})
        environment = dict(os.environ, BIN=str(TALUSD.parent), REALIZATIONS="4",
                           TALUS_SERVER=URL, TALUS_TOKEN=self.token)
        done = subprocess.run([SOURCE / "deploy/demo.sh"], env=environment, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        histogram = json.loads(done.stdout[done.stdout.index("\n{"):])
        self.assertEqual(sum(histogram["histogram"]["counts"]), 4, histogram)
        self.assertEqual(self.stop(), 0)
        self.assertFalse(self.healthy())
        self.start()
        self.assertTrue(self.healthy())
        said = subprocess.run([TALUSD.with_name("talus"), "status"], env=environment, capture_output=True, text=True)
        self.assertIn("successful", said.stdout, said.stderr)
        self.assertEqual(self.stop(), 0)


if __name__ == "__main__":
    with_a_root()
    unittest.main(argv=sys.argv[:1], verbosity=2)
