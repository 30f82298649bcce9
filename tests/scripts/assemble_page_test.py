#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/assemble_page.py: the order of modules, and sources that cannot be joined."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = TOP / "scripts" / "assemble_page.py"
sys.path.insert(0, str(SCRIPT.parent))
import assemble_page  # noqa: E402

PAGE = "<style>@STYLE@</style>@DATA@<script>@THREE@</script>@CONTROLS@ @MODULES@"


class AssemblePage(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.web = pathlib.Path(self.folder.name)
        self.write(**{"index.html": PAGE, "style.css": "p {}", "three.js": "three",
                      "controls.js": "controls",
                      "a.js": "export function a() {}\nexport const A = 1;\n",
                      "b.js": "import { a } from './a.js';\nexport class B {}\na();\n",
                      "main.js": "import { B } from './b.js';\nimport { a, A } from './a.js';\n"
                                 "new B(a, A);\n"})

    def write(self, **files):
        for name, text in files.items():
            (self.web / name).write_text(text, encoding="utf-8")

    def assemble(self):
        return assemble_page.assemble(self.web, self.web / "three.js", self.web / "controls.js")

    def expect_error(self, part):
        with self.assertRaises(assemble_page.InputError) as caught:
            self.assemble()
        self.assertIn(part, str(caught.exception))

    def test_modules_come_after_those_that_they_import(self):
        page = self.assemble()
        self.assertEqual(page, "<style>p {}</style>@DATA@<script>three</script>controls "
                         "function a() {}\nconst A = 1;\n\nclass B {}\na();\n\nnew B(a, A);")

    def test_a_name_must_be_unique(self):
        self.write(**{"b.js": "import { a } from './a.js';\nexport class B {}\nconst A = 2;\n"})
        self.expect_error("A is also in a.js")

    def test_an_import_must_be_exported(self):
        self.write(**{"a.js": "function a() {}\nexport const A = 1;\n"})
        self.expect_error("imports a, which a.js does not export")

    def test_a_circle_is_refused(self):
        self.write(**{"a.js": "import { B } from './b.js';\nexport function a() {}\n"})
        self.expect_error("imports itself")

    def test_other_kinds_of_imports_and_exports_are_refused(self):
        for line in ("import * as a from './a.js';", "export default 1;", "export { a };"):
            self.write(**{"main.js": line + "\n"})
            self.expect_error("expected import { a } from")

    def test_a_missing_module_is_named(self):
        self.write(**{"main.js": "import { c } from './c.js';\n"})
        self.expect_error("c.js")

    def test_a_place_may_not_be_missing(self):
        self.write(**{"index.html": PAGE.replace("@DATA@", "")})
        self.expect_error("@DATA@ 0 times")

    def test_no_text_may_end_its_element(self):
        self.write(**{"three.js": "'</script>'"})
        self.expect_error("end of its element")

    def test_the_cpp_file_has_the_page_in_pieces(self):
        text = assemble_page.as_cpp("x" * 20000)
        self.assertEqual(text.count('R"hullslam_page('), 3)
        self.assertEqual(text.count("x" * 8000), 2)

    def test_the_program_writes_a_file_or_an_error(self):
        arguments = [sys.executable, "-B", str(SCRIPT), str(self.web), "--three",
                     str(self.web / "three.js"), "--controls", str(self.web / "controls.js"),
                     "--output", str(self.web / "out" / "page.html")]
        subprocess.run(arguments, check=True)
        self.assertTrue((self.web / "out" / "page.html").read_text().startswith("<style>"))
        (self.web / "style.css").unlink()
        result = subprocess.run(arguments, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn("style.css", result.stderr)

    def test_the_page_of_the_project_can_be_joined(self):
        assemble_page.join_modules(TOP / "web")


if __name__ == "__main__":
    unittest.main()
