#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of packaging/completion.bash with a small program in place of those of HullSLAM."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

COMPLETION = pathlib.Path(__file__).resolve().parents[2] / "packaging" / "completion.bash"
PROGRAM = r"""#!/bin/bash
if [ "$1" = objects ]; then
  printf 'Options:\n  --groundtruth FILE  the true objects\n'
else
  printf 'Options:\n  --json  as JSON\n\nSubcommands:\n  objects  of a run\n  trajectory  of a run\n\nEnd.\n'
fi
"""


class CompletionTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        program = self.dir / "hullslam-evaluate"
        program.write_text(PROGRAM)
        program.chmod(0o755)
        (self.dir / "completions").mkdir()
        shutil.copy(COMPLETION, self.dir / "completions" / program.name)

    def complete(self, *words):
        """What bash offers for the last word."""
        quoted = " ".join(f"'{word}'" for word in ("hullslam-evaluate", *words))
        script = (f"PATH={self.dir}:$PATH; . {self.dir}/completions/hullslam-evaluate; compopt() {{ :; }}; "
                  f"COMP_WORDS=({quoted}); COMP_CWORD={len(words)}; cd {self.dir}; "
                  f"_hullslam hullslam-evaluate '{words[-1]}'; printf '%s\\n' \"${{COMPREPLY[@]}}\"; "
                  "complete -p hullslam-evaluate >&2")
        result = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout.split()

    def test_options_subcommands_and_files(self):
        self.assertEqual(self.complete("--"), ["--json"])
        self.assertEqual(self.complete("tr"), ["trajectory"])
        self.assertEqual(self.complete("objects", "--g"), ["--groundtruth"])
        self.assertEqual(self.complete("objects", "comp"), ["completions"])


if __name__ == "__main__":
    unittest.main()
