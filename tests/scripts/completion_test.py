#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of packaging/completion.bash with a small program in place of those of HullSLAM."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

COMPLETION = pathlib.Path(__file__).resolve().parents[2] / "packaging" / "completion.bash"
# As the help of the programs: a line on usage, and headings above options and commands.
PROGRAM = r"""#!/bin/bash
case "$*" in
  "evaluate objects --help" | "objects --help")
    printf 'Usage: objects [OPTIONS] RUN\n\nOptions:\n  --groundtruth FILE  the true objects\n\nFormats:\n  ply  points\n' ;;
  "evaluate --help")
    printf 'Usage: evaluate [OPTIONS] SUBCOMMAND\n\nOptions:\n  --json  as JSON\n\n'
    printf 'Subcommands:\n  objects  of a run\n  trajectory  of a run\n\nEnd.\n' ;;
  "--help")
    printf 'Usage: hullslam [OPTIONS] COMMAND\n\nOptions:\n  --version  the version\n\n'
    printf 'Prepare it:\n  check-masks  checks masks\n\nMeasure it:\n  evaluate  errors\n\nEnd.\n' ;;
  *) exit 2 ;;
esac
"""


class CompletionTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        program = self.dir / "hullslam"
        program.write_text(PROGRAM)
        program.chmod(0o755)
        (self.dir / "completions").mkdir()
        shutil.copy(COMPLETION, self.dir / "completions" / program.name)

    def complete(self, *words):
        """What bash offers for the last word."""
        quoted = " ".join(f"'{word}'" for word in ("hullslam", *words))
        script = (f"PATH={self.dir}:$PATH; . {self.dir}/completions/hullslam; compopt() {{ :; }}; "
                  f"COMP_WORDS=({quoted}); COMP_CWORD={len(words)}; cd {self.dir}; "
                  f"_hullslam hullslam '{words[-1]}'; printf '%s\\n' \"${{COMPREPLY[@]}}\"; "
                  "complete -p hullslam >&2")
        result = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout.split()

    def test_commands(self):
        self.assertEqual(self.complete(""), ["check-masks", "evaluate"])
        self.assertEqual(self.complete("ch"), ["check-masks"])
        self.assertEqual(self.complete("evaluate", "tr"), ["trajectory"])

    def test_options(self):
        self.assertEqual(self.complete("--"), ["--version"])
        self.assertEqual(self.complete("evaluate", "--"), ["--json"])
        self.assertEqual(self.complete("evaluate", "objects", "--g"), ["--groundtruth"])

    def test_files_are_offered_where_no_command_is_expected(self):
        self.assertEqual(self.complete("evaluate", "objects", "comp"), ["completions"])
        self.assertEqual(self.complete("evaluate", "objects", "pl"), [], "a format is no command")
        self.assertEqual(self.complete("evaluate", "unknown", "comp"), ["completions"])


if __name__ == "__main__":
    unittest.main()
