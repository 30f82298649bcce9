# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of a program with --view, for tests of the live view. The programs are in $HULLSLAM_BIN."""

import http.client
import json
import os
import pathlib
import re
import subprocess
import urllib.parse

BIN = pathlib.Path(os.environ.get("HULLSLAM_BIN", "build/release/bin"))
PATIENCE = 300  # s; other tests run at the same time
ADDRESS = re.compile(r"open this address in a browser: (http://\S+)")


def command_of(name):
    """The words of a program, such as rgbd_tum, or of a command of one, such as `hullslam view`."""
    program_name, *command = name.split()
    return [str(BIN / program_name), *command]


def program(name, *arguments, code=0):
    """Runs a program to its end and returns its texts on stdout and stderr."""
    result = subprocess.run([*command_of(name), *map(str, arguments)], capture_output=True, text=True,
                            check=False, timeout=PATIENCE)
    if result.returncode != code:
        raise AssertionError(f"{name}: exit code {result.returncode}, expected {code}: "
                             f"{result.stderr}")
    return result.stdout, result.stderr


class LiveRun:
    """A program that serves a page at an address that it prints."""

    def __init__(self, name, *arguments):
        self.process = subprocess.Popen([*command_of(name), *map(str, arguments)],
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.lines = []
        for line in self.process.stdout:
            self.lines.append(line)
            match = ADDRESS.search(line)
            if match:
                self.url = match[1]
                break
        else:
            raise AssertionError(f"no address: {''.join(self.lines)}")
        parts = urllib.parse.urlsplit(self.url)
        self.port = parts.port
        self.token = urllib.parse.parse_qs(parts.query)["token"][0]

    def ask(self, method, path, **headers):
        """The status and the text of the reply to a request."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        connection.request(method, path, headers={key.replace("_", "-"): value
                                                  for key, value in headers.items()})
        reply = connection.getresponse()
        result = reply.status, reply.read().decode("utf-8")
        connection.close()
        return result

    def control(self, command):
        return self.ask("POST", f"/control/{command}", X_Hullslam_Token=self.token)

    def events(self):
        """The messages of the stream, one after the other, until it ends."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        connection.request("GET", "/stream")
        reply = connection.getresponse()
        try:
            while line := reply.readline():
                if line.startswith(b"data: "):
                    yield json.loads(line[6:])
        finally:
            connection.close()

    def wait(self):
        """Waits for the end of the program; returns the exit code and all that it has printed."""
        rest = self.process.communicate(timeout=PATIENCE)[0]
        return self.process.returncode, "".join(self.lines) + rest

    def kill(self):
        """Ends the program if it still runs."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.process.stdout.close()
