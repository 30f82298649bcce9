#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/setup.sh with replacements for dpkg-query, apt-get, id and sudo, so that nothing
is installed."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SETUP = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "setup.sh"
TOOLS = ("bash", "sed", "awk", "wc", "dirname", "env", "cat")


class SetupTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bin = pathlib.Path(folder.name)
        self.log = self.bin / "log"
        for tool in TOOLS:
            (self.bin / tool).symlink_to(f"/usr/bin/{tool}")

    def stand_in(self, name, body):
        path = self.bin / name
        path.write_text(f'#!/bin/bash\n{body}\n')
        path.chmod(0o755)

    def run_setup(self, *arguments, missing=(), root=True, apt="exit 0"):
        cases = "".join(f"{name}) printf '[not-installed]' ;; " for name in missing)
        self.stand_in("dpkg-query", f"case \"$3\" in {cases}*) printf '[installed]' ;; esac")
        self.stand_in("apt-get", f'echo "apt-get $*" >>{self.log}; {apt}')
        self.stand_in("id", f"echo {0 if root else 1000}")
        return subprocess.run([SETUP, *arguments], env={**os.environ, "PATH": str(self.bin)},
                              capture_output=True, text=True, check=False)

    def calls(self):
        return self.log.read_text().splitlines() if self.log.exists() else []

    def test_does_nothing_if_all_packages_are_installed(self):
        result = self.run_setup(root=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("packages are installed", result.stdout)
        self.assertEqual(self.calls(), [])

    def test_installs_only_missing_packages(self):
        result = self.run_setup(missing=("ccache", "libceres-dev"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.calls()[0], "apt-get update")
        self.assertEqual(self.calls()[1],
                         "apt-get install -y --no-install-recommends ccache libceres-dev")

    def test_uses_sudo_when_not_root(self):
        self.stand_in("sudo", f'echo "sudo" >>{self.log}; exec "$@"')
        result = self.run_setup(missing=("ccache",), root=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.calls()[:2], ["sudo", "apt-get update"])

    def test_neither_root_nor_sudo(self):
        result = self.run_setup(missing=("ccache",), root=False)
        self.assertEqual(result.returncode, 1)
        self.assertIn("run as root: apt-get install", result.stderr)
        self.assertIn("ccache", result.stderr)
        self.assertEqual(self.calls(), [])

    def test_failing_apt_is_an_error(self):
        result = self.run_setup(missing=("ccache",), apt="exit 100")
        self.assertEqual(result.returncode, 1)
        self.assertIn("apt-get update failed", result.stderr)

    def test_unknown_argument(self):
        result = self.run_setup("--nonsense")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--nonsense", result.stderr)


if __name__ == "__main__":
    unittest.main()
