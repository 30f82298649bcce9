#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of --view and of the program view with a client that is no browser."""

import base64
import pathlib
import signal
import socket
import struct
import tempfile
import unittest

from live_run import LiveRun, program

FRAMES = 50


def number_of(array):
    """The number of values in an array of a message."""
    kind, text = next(iter(array.items()))
    return len(base64.b64decode(text)) // (1 if kind == "u8" else 4)


class LiveViewTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.desk = cls.folder / "desk"
        program("make_synthetic", cls.desk, "--scene", "desk", "--frames", FRAMES, "--quiet")
        cls.plain = cls.folder / "plain"
        program("rgbd_tum", cls.desk, "--masks", cls.desk / "masks", "--output", cls.plain,
                "--quiet")

    def start(self, name, *arguments):
        run = LiveRun(name, *arguments)
        self.addCleanup(run.kill)
        return run

    def start_slam(self, output, *arguments):
        return self.start("rgbd_tum", "--view", "0", self.desk, "--masks", self.desk / "masks",
                          "--output", output, *arguments)

    def test_a_watched_run_has_the_same_results(self):
        output = self.folder / "watched"
        run = self.start_slam(output, "--quiet")
        states, parts, last = set(), set(), {}
        for message in run.events():
            for key in ("set", "add", "patch"):
                parts.update(message.get(key, {}))
            if "live" in message.get("set", {}):
                states.add(message["set"]["live"].get("state"))
                last = message["set"]
        code, _ = run.wait()
        self.assertEqual(code, 0)
        self.assertIn("tracked", states)
        self.assertLessEqual({"run", "live", "live_image", "landmarks", "keyframes", "trajectory",
                              "objects", "groundtruth", "summary"}, parts)
        self.assertEqual(last["live"]["phase"], "ended")
        self.assertEqual(last["run"]["live"], False)
        self.assertGreater(number_of(last["landmarks"]["position"]), 300)
        self.assertIn("ate_rmse_m", last["summary"]["trajectory"])
        for name in ("trajectory.txt", "keyframes.txt", "map.ply", "objects.json"):
            self.assertEqual((output / name).read_bytes(), (self.plain / name).read_bytes(), name)

    def test_pause_step_save_and_localise(self):
        output = self.folder / "controlled"
        run = self.start_slam(output, "--realtime", "--threaded")
        events = run.events()
        frames = (message["set"]["live"] for message in events if "live" in message.get("set", {}))
        next(live for live in frames if live.get("state") == "tracked")
        self.assertEqual(run.control("pause")[0], 200)
        paused = next(live for live in frames if live["phase"] == "paused")
        self.assertEqual(run.control("step")[0], 200)
        stepped = next(live for live in frames if live["frame"] > paused["frame"])
        self.assertEqual(stepped["phase"], "paused")
        self.assertLessEqual(stepped["frame"], paused["frame"] + 2)
        self.assertEqual(run.control("save-map")[0], 202)
        saved = next(live for live in frames if " is in " in live["notice"])
        path = pathlib.Path(saved["notice"].split(" is in ")[1])
        self.assertEqual(path, self.folder / "controlled-live.map")
        self.assertGreater(path.stat().st_size, 1000)
        self.assertEqual(run.control("localise")[0], 200)
        self.assertTrue(next(live for live in frames if live["localising"])["localising"])
        self.assertEqual(run.control("map")[0], 200)
        self.assertEqual(run.control("resume")[0], 200)
        for _ in frames:
            pass
        self.assertEqual(run.wait()[0], 0)

    def test_a_hostile_client_changes_nothing(self):
        output = self.folder / "hostile"
        run = self.start_slam(output, "--quiet")
        self.assertEqual(run.ask("GET", "/", Host="evil.example")[0], 403)
        self.assertEqual(run.ask("GET", "/stream", Origin="http://evil.example")[0], 403)
        self.assertEqual(run.ask("POST", "/control/pause", X_Hullslam_Token="0" * 32)[0], 403)
        self.assertEqual(run.ask("POST", "/control/pause")[0], 403)
        sockets = []
        for text in (b"\0\xff\x16garbage\r\n\r\n", b"GET /stream HTTP/1.1\r\nHost: 127",
                     b"GET / HTTP/1.1\r\nX: " + 100000 * b"a", 300 * b"GET / HTTP/1.1\r\n"
                     b"Host: localhost\r\n\r\n", b"GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n"):
            for _ in range(4):
                connection = socket.create_connection(("127.0.0.1", run.port))
                connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
                sockets.append(connection)
                try:
                    connection.sendall(text)
                except OSError:
                    pass
        sockets[0].setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        code, text = run.wait()
        for connection in sockets:
            connection.close()
        self.assertEqual(code, 0, text)
        self.assertEqual((output / "trajectory.txt").read_bytes(),
                         (self.plain / "trajectory.txt").read_bytes())

    def test_a_taken_port_is_an_error_before_the_first_frame(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
            output = self.folder / "taken"
            _, errors = program("rgbd_tum", self.desk, "--view", port, "--output", output, code=2)
            self.assertIn(f"cannot listen on 127.0.0.1:{port}", errors)
            self.assertFalse(output.exists())
            _, errors = program("hullslam view", self.plain, "--port", port, code=2)
            self.assertIn(f"127.0.0.1:{port}", errors)
        for arguments, part in ((["--view", "99999"], "99999"), (["--view=x"], "x"),
                                (["--view", "0", "--view-address", "nowhere"], "nowhere")):
            _, errors = program("rgbd_tum", self.desk, "--output", self.folder / "bad", *arguments,
                                code=2)
            self.assertIn(part, errors)

    def test_an_interruption_ends_a_paused_run(self):
        run = self.start_slam(self.folder / "interrupted", "--realtime", "--threaded")
        events = run.events()
        frames = (message["set"]["live"] for message in events if "live" in message.get("set", {}))
        next(live for live in frames if live.get("state") == "tracked")
        run.control("pause")
        next(live for live in frames if live["phase"] == "paused")
        run.process.send_signal(signal.SIGINT)
        for _ in frames:
            pass
        code, text = run.wait()
        self.assertEqual(code, 1)
        self.assertIn("interrupted", text)

    def test_a_finished_run_and_a_map_are_served_until_ctrl_c(self):
        for path in (self.plain, self.save_map()):
            run = self.start("hullslam view", path, "--port", "0")
            status, page = run.ask("GET", "/")
            self.assertEqual(status, 200)
            self.assertIn("hullslam-data", page)
            self.assertEqual(run.ask("GET", "/", Host="evil.example")[0], 403)
            run.process.send_signal(signal.SIGINT)
            self.assertEqual(run.wait()[0], 0)
        _, errors = program("hullslam view", self.folder / "nothing", "--port", "0", code=2)
        self.assertIn("nothing", errors)

    def save_map(self):
        path = self.folder / "desk.map"
        program("rgbd_tum", self.desk, "--last", "20", "--output", self.folder / "map_run",
                "--save-map", path, "--quiet")
        return path


if __name__ == "__main__":
    unittest.main()
