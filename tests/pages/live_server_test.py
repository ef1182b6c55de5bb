#!/usr/bin/python3
"""live_server_test.py BIN: answers of the server of `peclet serve`, refusals, and costs."""

import json
import re
import socket
import subprocess
import time
import unittest

from campaign_page import Folder, campaign
from page_case import Stage, main


class ServerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Stage.folder.serve("curve.json")

    @classmethod
    def tearDownClass(cls):
        cls.server.end()

    def raw(self, text):
        """Returns the answer to these bytes, until the server closes the connection."""
        with socket.create_connection(("127.0.0.1", self.server.port), timeout=30) as connection:
            connection.sendall(text)
            answer = b""
            while data := connection.recv(1 << 16):
                answer += data
        return answer


class Answers(ServerTest):
    def test_there_is_a_page_a_state_and_a_point(self):
        status, headers, page = self.server.ask()
        self.assertEqual((status, headers["Content-Type"]), (200, "text/html; charset=utf-8"))
        self.assertEqual(int(headers["Content-Length"]), len(page.encode()))
        data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])
        status, headers, text = self.server.ask("state?since=")
        self.assertEqual((status, headers["Content-Type"]), (200, "application/json"))
        state = json.loads(text)
        self.assertEqual([state["points"][str(i)] for i in range(state["count"])], data["points"])
        self.assertEqual({**state["head"], "points": data["points"], "live": state["live"]}, data)
        self.assertEqual(self.server.ask("state?since=" + data["live"]["token"])[0], 204)
        status, _, text = self.server.ask("point?hash=" + data["points"][0]["hash"])
        self.assertEqual(status, 200)
        self.assertGreaterEqual(json.loads(text)["seeds"], 8)

    def test_nothing_else_is_there(self):
        for path in ("x", "point?hash=../../etc/passwd", "point", "campaign.db", "..%2fcampaign.db", "state/"):
            self.assertEqual(self.server.ask(path)[0], 404, path)

    def test_only_looking_is_allowed(self):
        for method in ("POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE"):
            status, headers, _ = self.server.ask("", method, b"x" * 100000 if method == "POST" else None)
            self.assertEqual((status, headers["Allow"]), (405, "GET, HEAD"))
        status, headers, text = self.server.ask("", "HEAD")
        self.assertEqual((status, text), (200, ""))
        self.assertGreater(int(headers["Content-Length"]), 10000)

    def test_every_answer_is_as_strict(self):
        for path, method in (("", "GET"), ("state", "GET"), ("x", "GET"), ("favicon.ico", "GET"), ("", "POST")):
            _, headers, _ = self.server.ask(path, method)
            self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
            self.assertEqual(headers["Cache-Control"], "no-store")
            self.assertEqual(headers["Cross-Origin-Resource-Policy"], "same-origin")
            self.assertEqual(headers["X-Frame-Options"], "DENY")
            self.assertEqual(headers["Referrer-Policy"], "no-referrer")
            policy = dict(part.strip().split(" ", 1) for part in headers["Content-Security-Policy"].split(";"))
            self.assertEqual((policy["default-src"], policy["frame-ancestors"]), ("'none'", "'none'"))
            self.assertNotIn("unsafe", headers["Content-Security-Policy"])
            self.assertNotIn("Access-Control-Allow-Origin", headers)
        page = self.server.ask()[1]["Content-Security-Policy"]
        self.assertRegex(page, r"script-src 'sha256-[^' ]+';")
        self.assertIn("connect-src 'self'", page)

    def test_whoever_calls_it_by_another_name_is_refused(self):
        for host, expected in (
            ("127.0.0.1", 200),
            ("localhost:1234", 200),
            ("LOCALHOST", 200),
            ("[::1]:80", 200),
            ("evil.example", 403),
            ("127.0.0.1.evil.example", 403),
            ("localhost.evil.example:7325", 403),
            ("evil.example:127.0.0.1", 403),
            ("", 403),
        ):
            self.assertEqual(self.server.ask("state", Host=host)[0], expected, host)

    def test_what_is_no_request_is_refused(self):
        for text, expected in (
            (b"GET / HTTP/1.1\r\n\r\n", 400),
            (b"GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n", 400),
            (b"GET http://localhost/ HTTP/1.1\r\nHost: localhost\r\n\r\n", 400),
            (b"GET / HTTP/1.1\r\nHost localhost\r\n\r\n", 400),
            (b"GET /\0 HTTP/1.1\r\nHost: localhost\r\n\r\n", 400),
            (b"\x16\x03\x01\x02\x00\r\n\r\n", 400),
            (b"GET / HTTP/2.0\r\nHost: localhost\r\n\r\n", 505),
            (b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"x" * 9000, 431),
        ):
            answer = self.raw(text)
            self.assertTrue(answer.startswith(b"HTTP/1.1 %d " % expected), (text[:60], answer[:60]))
        self.assertTrue(self.raw(b"GET / HTTP/1.0\r\nHost: localhost\r\n\r\n").startswith(b"HTTP/1.1 200 "))

    def test_connections_that_say_nothing_are_in_nobody_s_way(self):
        silent = [socket.create_connection(("127.0.0.1", self.server.port)) for _ in range(60)]
        self.assertEqual(self.server.ask()[0], 200)
        for one in silent:
            one.settimeout(30)
            self.assertEqual(one.recv(1), b"")  # closed by the server
            one.close()

    def test_connections_that_say_little_make_no_other_wait(self):
        slow = []
        for number in range(200):
            slow.append(socket.create_connection(("127.0.0.1", self.server.port)))
            slow[-1].sendall(b"GET / HTTP/1.1\r\nHost: local")
        begun = time.monotonic()
        for _ in range(5):
            self.assertEqual(self.server.ask()[0], 200)
        self.assertLess(time.monotonic() - begun, 5)  # a stalled connection is closed after 10 s
        for one in slow:
            one.close()

    def test_it_listens_on_this_machine_only(self):
        with open(f"/proc/{self.server.process.pid}/net/tcp", encoding="ascii") as file:
            places = [line.split()[1] for line in file.readlines()[1:]]
        mine = [place for place in places if place.endswith(f":{self.server.port:04X}")]
        self.assertTrue(mine and all(place.startswith("0100007F:") for place in mine), mine)


class Cost(ServerTest):
    def test_a_database_that_does_not_change_costs_next_to_nothing(self):
        token = json.loads(self.server.ask("state?since=")[2])["live"]["token"]
        self.server.ask("state?since=" + token)
        before, begun = self.server.seconds(), time.monotonic()
        for _ in range(1000):
            self.assertEqual(self.server.ask("state?since=" + token)[0], 204)
        took = self.server.seconds() - before
        # Measured: 0.1 s for 1000 requests. Ten pages make ten requests a second.
        self.assertLess(took, 1, f"{time.monotonic() - begun:.1f} s on the wall")

    def test_tokens_that_were_made_up_take_no_memory(self):
        process, count = json.loads(self.server.ask("state?since=")[2])["live"]["token"].rsplit(".", 1)
        everything = self.server.ask(f"state?since={process}.{int(count) + 1}")
        self.assertEqual(everything[0], 200)
        before = self.server.memory()
        for made_up in range(1000):
            self.server.ask(f"state?since={process}.{(-1) ** made_up * (1000 + made_up)}")
        # A token that was kept would take the length of the whole state.
        self.assertLess(self.server.memory() - before, 100 * len(everything[2]))

    def test_a_report_reads_what_a_server_has_left(self):
        self.assertIn("9 points", Stage.folder.peclet("status", "curve.json"))


class Faults(unittest.TestCase):
    def refused(self, *words):
        return subprocess.run(
            ["peclet", "serve", *words],
            cwd=Stage.folder.path,
            env=Stage.folder.environment,
            capture_output=True,
            text=True,
            timeout=60,
        )

    def test_a_port_that_is_in_use_is_an_error_with_a_cure(self):
        with socket.socket() as other:
            other.bind(("127.0.0.1", 0))
            other.listen()
            port = other.getsockname()[1]
            done = self.refused("curve.json", "--port", str(port))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn(f"port {port} is in use; `--port 0` takes one that is free", done.stderr)

    def test_bad_words_are_usage(self):
        for words in (("none.json",), ("curve.json", "--port", "65536"), ("curve.json", "--port", "x"), ()):
            done = self.refused(*words)
            self.assertEqual((done.returncode, done.stdout), (2, ""), words)

    def test_a_faulty_campaign_is_not_waited_for(self):
        document = campaign("faulty", {"/peclet": [1]}, tolerance=-1)
        Folder.write(Stage.folder, document)
        self.assertEqual(self.refused("faulty.json").returncode, 2)


if __name__ == "__main__":
    main()
