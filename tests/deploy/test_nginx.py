"""deploy/nginx.conf in front of a talusd, both really started: TLS, sizes, rates, streams, tokens.

usage: test_nginx.py TALUSD SOURCE_DIR       needs nginx and openssl
"""
import http.client
import os
import pathlib
import re
import socket
import ssl
import subprocess
import sys
import time
import unittest

SOURCE = pathlib.Path(sys.argv[2])
sys.path.insert(0, str(SOURCE / "tests/service"))
import daemon  # noqa: E402

NAME = "talus.example.org"
NGINX = "/usr/sbin/nginx"


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


def run(*command, **more):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, **more)


class Proxy:
    """nginx with the shipped file and a throw-away certificate; ports and paths are put in place of the real ones."""

    def __init__(self, directory, backend_port):
        self.dir = directory
        self.certificate = directory / "fullchain.pem"
        made = run("openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", f"/CN={NAME}",
                   "-addext", f"subjectAltName=DNS:{NAME},IP:127.0.0.1", "-keyout", directory / "privkey.pem",
                   "-out", self.certificate)
        assert made.returncode == 0, made.stderr
        self.plain_port, self.port = free_ports(2)
        site = (SOURCE / "deploy/nginx.conf").read_text()
        for old, new, times in (("listen 80;", f"listen 127.0.0.1:{self.plain_port};", 1),
                                ("listen 443 ssl;", f"listen 127.0.0.1:{self.port} ssl;", 1),
                                ("/etc/ssl/talus/", f"{directory}/", 2),
                                ("http://127.0.0.1:8080;", f"http://127.0.0.1:{backend_port};", 2)):
            assert site.count(old) == times, old
            site = site.replace(old, new)
        (directory / "site.conf").write_text(site)
        temporary = "\n".join(f"{kind}_temp_path {directory}/{kind};" for kind in
                              ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
        (directory / "nginx.conf").write_text(
            ("user root;\n" if os.geteuid() == 0 else "") + f"pid {directory}/pid;\nerror_log {directory}/error.log;\n"
            f"daemon off;\nevents {{}}\nhttp {{\naccess_log off;\n{temporary}\ninclude {directory}/site.conf;\n}}\n")
        self.command = [NGINX, "-e", directory / "error.log", "-p", directory, "-c", directory / "nginx.conf"]
        self.process = None

    def check(self):
        return run(*self.command, "-t", "-q")

    def start(self):
        self.process = subprocess.Popen(self.command)
        for _ in range(200):
            try:
                socket.create_connection(("127.0.0.1", self.port), timeout=1).close()
                return
            except OSError:
                time.sleep(0.05)
        raise AssertionError((self.dir / "error.log").read_text())

    def stop(self):
        if self.process:
            self.process.terminate()
            self.process.wait(20)

    def connection(self, timeout=30):
        context = ssl.create_default_context(cafile=str(self.certificate))
        connection = http.client.HTTPSConnection("127.0.0.1", self.port, timeout=timeout, context=context)
        connection.sock = context.wrap_socket(socket.create_connection(("127.0.0.1", self.port), timeout=timeout),
                                              server_hostname=NAME)
        return connection

    def request(self, method, path, body=None, token=None, headers=()):
        headers = {"Host": NAME, **dict(headers)}
        if token:
            headers["Authorization"] = f"Bearer {token}"
        connection = self.connection()
        try:
            connection.request(method, path, body=body, headers=headers)
            answer = connection.getresponse()
            return daemon.Reply(answer.status, answer.headers, answer.read())
        finally:
            connection.close()


class Nginx(daemon.ServiceTest):
    def setUp(self):
        super().setUp()
        said = run(daemon.TALUSD, "--new-token", "submit", "anna").stdout
        self.token = re.search(r"^token: (\S+)$", said, re.M)[1]
        (self.dir / "tokens").write_text(re.search(r"^line for the tokens file: (.*)$", said, re.M)[1] + "\n")
        self.start("--tokens", self.dir / "tokens", "--public-url", f"https://{NAME}")
        self.proxy = Proxy(self.dir, self.daemon.port)
        self.addCleanup(self.proxy.stop)
        checked = self.proxy.check()
        self.assertEqual((checked.returncode, checked.stdout + checked.stderr), (0, ""))
        self.proxy.start()

    def submit(self, **options):
        body = daemon.json.dumps(daemon.study(**options))
        reply = self.proxy.request("POST", "/processes/influence-zone/execution", body, self.token,
                                   {"Content-Type": "application/json"})
        self.assertEqual(reply.status, 201, reply.body)
        return reply

    def test_a_wrong_line_is_seen(self):
        site = self.dir / "site.conf"
        site.write_text(site.read_text().replace("ssl_protocols", "ssl_protocol"))
        self.assertNotEqual(self.proxy.check().returncode, 0)

    def test_tls_only_and_tokens_pass(self):
        alive = self.proxy.request("GET", "/healthz")
        self.assertEqual(alive.status, 200)
        self.assertRegex(alive.headers["X-Request-Id"], "^[0-9a-f]{32}$")  # nginx's: a line in both logs has the same
        self.assertEqual(self.proxy.request("GET", "/jobs").status, 401)
        self.assertEqual(self.proxy.request("GET", "/jobs", token="wrong").status, 401)
        self.assertEqual(self.proxy.request("GET", "/jobs", token=self.token).status, 200)
        plain = http.client.HTTPConnection("127.0.0.1", self.proxy.plain_port, timeout=10)
        plain.request("GET", "/jobs?limit=2", headers={"Host": NAME})
        answer = plain.getresponse()
        self.assertEqual((answer.status, answer.headers["Location"]), (301, f"https://{NAME}/jobs?limit=2"))
        plain.close()

    def test_sizes(self):
        big = b'{"inputs": "' + b"x" * (5 << 20) + b'"}'
        reply = self.proxy.request("POST", "/processes/influence-zone/execution", big, self.token)
        self.assertEqual((reply.status, reply.body[:6]), (413, b"<html>"))  # by nginx, not by talusd
        self.assertNotIn(b"nginx/", reply.body)  # and without its version
        fits = b'{"inputs": "' + b"x" * (3 << 20) + b'"}'
        self.problem(self.proxy.request("POST", "/processes/influence-zone/execution", fits, self.token,
                                        {"Content-Type": "application/json"}), 400)

    def test_job_and_its_stream(self):
        reply = self.submit(realizations=12, spacing=0.5, end=2.0)
        location = reply.headers["Location"]
        self.assertTrue(location.startswith(f"https://{NAME}/jobs/"), location)
        job = reply.json["jobID"]
        connection = self.proxy.connection()
        connection.request("GET", f"/jobs/{job}/events",
                           headers={"Host": NAME, "Authorization": f"Bearer {self.token}"})
        stream = connection.getresponse()
        self.assertEqual((stream.status, stream.headers["Content-Type"]), (200, "text/event-stream"))
        states = []
        while not states or states[-1]["status"] in ("accepted", "running"):
            line = stream.readline()
            self.assertTrue(line, "the stream ended early")
            if line.startswith(b"data:"):
                states.append(daemon.json.loads(line[5:]))
                if len(states) == 1:  # it came at once, not with the end
                    now = self.daemon.get(f"/jobs/{job}", token=self.token).json
                    self.assertIn(now["status"], ("accepted", "running"))
        connection.close()
        self.assertEqual(states[-1]["status"], "successful")
        self.assertGreater(len(states), 2)

    def test_long_poll(self):
        job = self.submit(realizations=8, spacing=0.5, end=2.0).json["jobID"]
        version, changes, state = 0, 0, "accepted"
        while state in ("accepted", "running"):
            info = self.proxy.request("GET", f"/jobs/{job}/events?wait=20&since={version}", token=self.token).json
            self.assertGreater(info["version"], version)
            version, state, changes = info["version"], info["status"], changes + 1
            time.sleep(0.1)  # within the rate
        self.assertEqual(state, "successful")
        self.assertGreater(changes, 2)

    def test_talus_speaks_through_it(self):
        case = self.dir / "case.json"
        case.write_text(daemon.json.dumps(daemon.case()))
        environment = dict(os.environ, TALUS_SERVER=f"https://127.0.0.1:{self.proxy.port}", TALUS_TOKEN=self.token,
                           SSL_CERT_FILE=str(self.proxy.certificate))
        done = run(daemon.TALUS, "submit", case, "--realizations", 3, "--seed", 1, "--watch", env=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        done = run(daemon.TALUS, "results", done.stdout.strip(), env=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("run-out distance", done.stdout)
        del environment["SSL_CERT_FILE"]
        self.assertEqual(run(daemon.TALUS, "status", env=environment).returncode, 5)  # a certificate nobody vouches for

    def test_rates(self):
        connection, counts = self.proxy.connection(), {}
        for _ in range(120):
            connection.request("GET", "/healthz", headers={"Host": NAME})
            answer = connection.getresponse()
            answer.read()
            counts[answer.status] = counts.get(answer.status, 0) + 1
        connection.close()
        self.assertEqual(set(counts), {200, 429}, counts)
        self.assertGreaterEqual(counts[200], 41)  # the burst and one more


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
