#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/reproduce_tables.py with a profile of Snakemake for a cluster."""

import os
import unittest

from fake_tables import TablesTest


class ClusterTest(TablesTest):
    """Snakemake's profile for Slurm, with an sbatch that starts the job on this machine."""

    def setUp(self):
        super().setUp()
        tools = self.dir / "tools"
        tools.mkdir()
        (tools / "sbatch").write_text(f'#!/bin/bash\necho "$*" >>{self.dir}/submitted\n'
                                      'bash "${@: -1}" </dev/null >/dev/null 2>&1 &\necho 17\n')
        (tools / "sbatch").chmod(0o755)
        former = os.environ["PATH"]
        os.environ["PATH"] = f"{tools}:{former}"
        self.addCleanup(os.environ.__setitem__, "PATH", former)

    def test_dry_run(self):
        result = self.succeed("--seeds", 1, "--profile", "slurm", "--dry-run")
        self.assertRegex(result.stdout, r"run +11")
        self.assertFalse((self.dir / "submitted").exists())

    def test_jobs_are_submitted(self):
        arguments = ("--seeds", 1, "--tables", "I", "--modes", "rgbd")
        self.succeed(*arguments, "--profile", "slurm")
        submitted = (self.dir / "submitted").read_text().splitlines()
        self.assertEqual(len(submitted), 3)
        self.assertIn("--job-name=hullslam-run --cpus-per-task=1 --mem=2000 --time=60", submitted[0])
        self.succeed(*arguments, out=self.dir / "local")
        self.assertEqual(self.files(), self.files(self.dir / "local"))


if __name__ == "__main__":
    unittest.main()
