"""The Debian package, installed into a Debian that has nothing else: programs, data, manuals, and the demo.

usage: test_package.py TALUSD SOURCE_DIR BINARY_DIR
"""
import gzip
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from container import Buildah, pack, with_a_root  # noqa: E402

SOURCE, BINARY = map(pathlib.Path, sys.argv[2:4])
CASES = "/usr/share/talus/cases"
ENVIRONMENT = ["--env", "DEBIAN_FRONTEND=noninteractive", "--env", "HOME=/tmp"]


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = pathlib.Path(tempfile.mkdtemp(prefix="talus-package-"))
        cls.addClassCleanup(shutil.rmtree, cls.dir)
        cls.package = pack(BINARY, cls.dir)
        cls.buildah = Buildah(BINARY)
        cls.container = cls.buildah.container(cls.buildah.base)
        cls.addClassCleanup(cls.buildah, "rm", cls.container)
        cls.buildah("copy", "--quiet", cls.container, cls.package, "/tmp/talus.deb")
        cls.buildah("copy", "--quiet", cls.container, SOURCE / "deploy/demo.sh", "/opt/demo/deploy/demo.sh")
        cls.shell("apt-get update -qq && apt-get install -y -qq /tmp/talus.deb")

    @classmethod
    def shell(cls, script, user="root", check=True):
        done = cls.buildah.run(cls.container, "bash", "-c", script, check=check,
                               options=["--user", user, *ENVIRONMENT])
        return done.stdout if check else done

    def test_what_it_needs_and_holds(self):
        fields = subprocess.run(["dpkg-deb", "-f", self.package], check=True, capture_output=True, text=True).stdout
        depends = fields.split("Depends: ")[1].split("\n")[0]
        for library in ("libc6", "libhdf5", "libgomp1", "libsqlite3-0", "libssl3"):
            self.assertIn(library, depends)
        newest = subprocess.run(["dpkg-parsechangelog", "-l", SOURCE / "deploy/changelog", "-S", "Version"], check=True,
                                capture_output=True, text=True).stdout
        self.assertIn(f"\nVersion: {newest}", "\n" + fields)
        held = self.shell("dpkg -L talus").split()
        cases = {f"{CASES}/{f.name}" for f in (SOURCE / "solver/cases").iterdir() if f.suffix in (".json", ".csv")}
        self.assertLess(cases | {"/usr/bin/talus", "/usr/bin/talusd", "/usr/share/talus/schemas/openapi.json",
                                 "/usr/share/man/man1/talus.1.gz", "/usr/share/man/man8/talusd.8.gz",
                                 "/usr/share/doc/talus/changelog.gz",
                                 "/usr/lib/systemd/system/talusd.service",
                                 "/usr/share/bash-completion/completions/talus"}, set(held))
        self.assertFalse([name for name in held if "test" in name or name.endswith((".a", ".hpp"))])

    def test_linkage_cannot_be_written_over(self):
        for program in ("talus", "talusd"):
            said = subprocess.run(["readelf", "-dl", BINARY / "bin" / program], check=True, capture_output=True, text=True).stdout
            self.assertRegex(said, r"\(FLAGS_1\).* NOW")
            self.assertIn("GNU_RELRO", said)

    def test_stacks_and_jumps_are_guarded(self):
        """-fstack-protector-strong calls __stack_chk_fail, -fcf-protection marks the targets of jumps."""
        for program in ("talus", "talusd"):
            path = BINARY / "bin" / program
            symbols = subprocess.run(["readelf", "--dyn-syms", "-W", path], check=True, capture_output=True, text=True).stdout
            self.assertIn("__stack_chk_fail", symbols)
            code = subprocess.run(["objdump", "-d", "--no-show-raw-insn", path], check=True, capture_output=True, text=True).stdout
            self.assertGreater(code.count("endbr64"), 100)

    def test_documents_are_those_of_the_programs(self):
        for name in ("case", "result", "study"):
            self.shell(f"talus schema {name} | cmp - /usr/share/talus/schemas/{name}.schema.json")
        page = self.shell("zcat /usr/share/man/man1/talus.1.gz")
        self.assertEqual(page, (SOURCE / "deploy/man/talus.1").read_text())
        self.assertEqual(gzip.decompress((BINARY / "deploy/talus.1.gz").read_bytes()).decode(), page)

    def test_every_case_is_valid_for_anybody(self):
        self.shell(f"cd / && for c in {CASES}/*.json; do talus validate $c || exit; done", user="nobody")

    def test_processors_of_all_ages(self):
        for simd in ("SSE4", "AVX2"):
            self.shell(f"cd /tmp && rm -rf one && TALUS_SIMD={simd} talus run {CASES}/illustrative.json --out one"
                       " --set particle_spacing_m=1 --set time.end_s=0.5 --set time.snapshot_times_s=[]", user="nobody")

    def test_completion(self):
        said = self.shell('. /usr/share/bash-completion/bash_completion; _completion_loader talus; '
                          'COMP_WORDS=(talus st); COMP_CWORD=1; _talus talus st talus; echo "${COMPREPLY[@]}"')
        self.assertEqual(said.split(), ["study", "stats", "status"])

    def test_demo(self):
        self.shell("apt-get install -y -qq --no-install-recommends curl")
        said = self.shell("export BIN=/usr/bin OUT=/tmp/demo REALIZATIONS=4;"
                          " /opt/demo/deploy/demo.sh",
                          user="nobody")
        self.assertIn("/tmp/demo/figures/histogram.svg", said)
        self.assertIn('"counts"', said.split("over HTTP")[1])

    def test_z_removed_without_a_trace(self):
        self.shell("apt-get purge -y -qq talus")
        left = self.shell("find /usr /etc /var/lib -name '*talus*' -not -path '/var/lib/dpkg/*'")
        self.assertEqual(left, "")


if __name__ == "__main__":
    with_a_root()
    unittest.main(argv=sys.argv[:1], verbosity=2)
