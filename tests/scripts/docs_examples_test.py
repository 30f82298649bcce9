#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/docs_examples.py."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import docs_examples  # noqa: E402

PAGE = """# A page
```cpp
int a = 1;
```
```bash
rm a
```
1. A list:
   ```cpp
   int b = 2;
   ```
"""


class DocsExamplesTest(unittest.TestCase):
    def test_every_cpp_block_becomes_a_test_with_its_line(self):
        text = docs_examples.program([(pathlib.Path("docs/own-data.md"), PAGE)])
        self.assertIn('TEST_F(DocsExample, own_data_line_3) {\n#line 3 "docs/own-data.md"\n'
                      'int a = 1;\n}', text)
        self.assertIn("own_data_line_10", text)
        self.assertEqual(text.count("TEST_F"), 2)
        self.assertNotIn("rm a", text)

    def test_a_block_without_end_is_an_error(self):
        with self.assertRaisesRegex(docs_examples.InputError, "line 2.*no end"):
            docs_examples.program([(pathlib.Path("a.md"), "\n```cpp\nint a;\n")])

    def test_no_other_spelling_of_cpp_hides_an_example(self):
        for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
            for line in page.read_text(encoding="utf-8").splitlines():
                language = line.strip()[3:] if line.strip().startswith("```") else ""
                self.assertNotIn(language.lower(), ("c++", "cc", "cxx"), f"{page}: {line}")


if __name__ == "__main__":
    unittest.main()
