#!/usr/bin/env python3
"""talus against servers that are no talusd: it bounds what they may send, and says so."""

import contextlib
import json
import os
import resource
import shutil
import socket
import ssl
import subprocess
import threading

from daemon import TALUS, ServiceTest, main

JOB = "0123456789abcdef0123456789abcdef"
OK = b"HTTP/1.1 200 OK\r\n"
PIECE = b"a" * 65536


def endless(head, piece):
    def serve(connection):
        connection.sendall(head)
        while True:
            connection.sendall(piece)

    return serve


def answering(document, head=OK):
    body = document if isinstance(document, bytes) else json.dumps(document).encode()
    return lambda connection: connection.sendall(head + b"Content-Length: %d\r\n\r\n" % len(body) + body)


class HostileServer(ServiceTest):
    def serve(self, how, context=None):
        """A server that answers each connection with `how`. @return its port"""
        listening = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(listening.close)

        def one(connection):
            with contextlib.suppress(OSError):
                if context:
                    connection = context.wrap_socket(connection, server_side=True)
                connection.recv(65536)
                how(connection)
                connection.shutdown(socket.SHUT_WR)
                connection.recv(1)
            connection.close()

        def accept():
            with contextlib.suppress(OSError):
                while True:
                    threading.Thread(target=one, args=(listening.accept()[0],), daemon=True).start()

        threading.Thread(target=accept, daemon=True).start()
        return listening.getsockname()[1]

    def talus(self, server, *arguments, **environment):
        done = subprocess.run([TALUS, *arguments, "--server", server], capture_output=True, text=True, timeout=100,
                              env=dict(os.environ, **environment))
        return done.returncode, done.stderr

    def check(self, how, said, *arguments):
        code, text = self.talus(f"http://127.0.0.1:{self.serve(how)}", *(arguments or ("status",)))
        self.assertEqual(code, 5, text)
        self.assertIn(said, text)

    def test_endless_heads(self):
        self.check(endless(OK + b"X: ", PIECE), "sends more than 64 KiB as the head")
        self.check(endless(OK, b"X: y\r\n" * 1000), "sends more than 64 KiB as the head")
        self.check(endless(b"HTTP/1.1 200 ", PIECE), "sends more than 64 KiB as the head")

    def test_endless_bodies(self):
        for head, piece in ((b"Content-Length: 999999999999\r\n\r\n", PIECE), (b"\r\n", PIECE),
                            (b"Transfer-Encoding: chunked\r\n\r\n", b"10000\r\n" + PIECE + b"\r\n")):
            self.check(endless(OK + head, piece), "sends more than 65536 KiB as the body", "watch", JOB)
        used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1000
        self.assertLess(used, 400)

    def test_what_is_no_http(self):
        for said in (b"SSH-2.0-OpenSSH_9.2\r\n", b"\0" * 100, b"HTTP/9.9 200 OK\r\n\r\n"):
            self.check(lambda connection, said=said: connection.sendall(said), "answered, but not as talusd")
        self.check(lambda connection: None, "broke")
        self.check(lambda connection: connection.sendall(OK + b"Content-Length: 9\r\n\r\n{"), "broke")

    def test_json_of_something_else(self):
        for document in ({}, [], None, 7, {"jobs": 7}, {"jobs": [{}]}, {"jobs": [{"jobID": 1}]}, b"{", b"<html>"):
            self.check(answering(document), "answered, but not as talusd")
        for document in ({}, {"version": 1}, {"version": "x"}, {"version": 1, "status": 7}):
            self.check(answering(document), "answered, but not as talusd", "watch", JOB)
        for document in ({"detail": 7}, [], {"errors": 7}, {"errors": [7]}):
            self.check(answering(document, b"HTTP/1.1 400 Bad Request\r\n"), "answered, but not as talusd")

    def test_tls(self):
        """A certificate must be valid for the name."""
        if not shutil.which("openssl"):
            self.skipTest("no openssl to make a certificate with")
        key, certificate = self.dir / "key.pem", self.dir / "certificate.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", certificate,
                        "-days", "2", "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"],
                       check=True, capture_output=True)
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate, key)
        port = self.serve(answering({"jobs": []}), context)
        self.assertEqual(self.talus(f"https://localhost:{port}", "status", SSL_CERT_FILE=str(certificate))[0], 0)
        self.assertEqual(self.talus(f"https://localhost:{port}", "status")[0], 5)
        self.assertEqual(self.talus(f"https://127.0.0.1:{port}", "status", SSL_CERT_FILE=str(certificate))[0], 5)

    def test_urls(self):
        port = self.serve(answering({"jobs": []}))
        for url in (f"http://127.0.0.1:{port}", f"http://localhost:{port}/"):
            self.assertEqual(self.talus(url, "status")[0], 0, url)
        for url in ("127.0.0.1", "ftp://a", "http://", "http://a:b", "http://a:99999", "http://a/b", "http://u@a", "http://:80"):
            code, text = self.talus(url, "status")
            self.assertEqual(code, 3, url)
            self.assertIn("is not a URL", text)


if __name__ == "__main__":
    main({"HostileServer": HostileServer})
