#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/check_docs.py on small trees; most of them break one rule."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_docs  # noqa: E402

SETTINGS = """# Settings

| ORB-SLAM3 | here |
|---|---|
| `Stereo.b`, `Camera.type` | `Camera.fx` |

## Keys

| key | default | expected | meaning |
|---|---|---|---|
| `Camera.fx` | none | a number | focal length, px |
| `ThDepth` | 40 | a number | depth |
| `objects.pose.sigma` | 0.5 | a number | sigma |
"""
OUTPUTS = """| key | meaning |
|---|---|
| `map.keyframes`, `loops` | counts |
| `objects.rejections` | by reason |
"""
BASE = {"docs/settings.md": SETTINGS, "docs/outputs.md": OUTPUTS, "src/map/map.cc": "",
        "src/map/names.cc": '    {"objects.sigma", "objects.pose.sigma"},\n'
                            '    {"objects.other", "no key"},\n',
        "include/hullslam/map/map.h": "", "scripts/demo.sh": ""}


def faults_of(readme, files=None):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in {**BASE, **(files or {}), "README.md": readme}.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_docs.check_tree(root)


class CheckDocsTest(unittest.TestCase):
    def assert_good(self, readme, files=None):
        self.assertEqual(faults_of(readme, files), [])

    def assert_fault(self, readme, *parts, files=None):
        faults = faults_of(readme, files)
        self.assertEqual(len(faults), 1, faults)
        for part in parts:
            self.assertIn(part, faults[0])


class KeysTest(CheckDocsTest):
    def test_keys_that_exist(self):
        for code in ("Camera.fx", "Camera.type", "objects.pose.sigma", "objects.sigma", "map.keyframes",
                     "map.loops", "objects.pose.*", "objects.*", "objects.rejections",
                     "--set ThDepth=35", "objects.pose.sigma=0.5",
                     "objects.pose.sigma / objects.sigma"):
            with self.subTest(code):
                self.assert_good(f"The key `{code}`.\n")

    def test_keys_that_do_not_exist(self):
        for code, name in (("objects.pose.sigme", "objects.pose.sigme"),
                           ("Camera.bf", "Camera.bf"),
                           ("objects.start.*", "objects.start.*"),
                           ("--set objects.all=0", "objects.all"),
                           ("--set ThDepht=35", "ThDepht"),
                           ("objects.other", "objects.other"),
                           ("map.keyframe", "map.keyframe")):
            with self.subTest(code):
                self.assert_fault(f"\nThe key `{code}`.\n", "README.md:2:", f'no key "{name}"')

    def test_rows_of_tables_are_checked(self):
        self.assert_fault("| setting | effect |\n|---|---|\n| `objects.gone` | none |\n",
                          "README.md:3:", "objects.gone")

    def test_commands_and_settings_files_in_blocks(self):
        self.assert_good("```\nrgbd_tum --set objects.pose.sigma=1 --set ThDepth=3\n```\n")
        self.assert_fault("```\nrgbd_tum --set objects.gone=1\n```\n", "README.md:2:")
        self.assert_good("```\n%YAML:1.0\nCamera.fx: 500\n```\n")
        self.assert_fault("```\n%YAML:1.0\nCamera.fz: 500\n```\n", "README.md:3:", "Camera.fz")

    def test_names_that_only_look_like_keys(self):
        for code in ("objects.json", "map.ply", "Stereo.b", "std.map", "system.map()->objects()",
                     "map.keyframes().At(id)", "report.objects", "--set KEY=VALUE",
                     "--set key=value", "objects.<use>.sigma", "data/map.keyframe"):
            with self.subTest(code):
                self.assert_good(f"The word `{code}`.\n")
        self.assert_good("In plain text, objects.gone is no key.\n")
        self.assert_good("```\nconst auto& objects = map.gone;\n```\n")

    def test_a_key_in_the_last_column_of_a_table_defines_nothing(self):
        self.assert_fault("`objects.pose.gone`\n", "objects.pose.gone", files={
            "docs/outputs.md": OUTPUTS + "| `map.sessions` | as objects.pose.gone |\n"})


class LinksTest(CheckDocsTest):
    FILES = {"docs/a.md": "# First title\n\n## The `y` axis, and *more*\n\n## Twice\n\n## Twice\n"
                          '<a id="mark"></a>\n\n```\n# comment\n```\n'}

    def test_links_that_lead_somewhere(self):
        for target in ("docs/a.md", "docs/a.md#first-title", "docs/a.md#the-y-axis-and-more",
                       "docs/a.md#twice", "docs/a.md#twice-1", "docs/a.md#mark", "docs",
                       "https://example.org/x.md#y", "#here", "scripts/demo.sh"):
            with self.subTest(target):
                self.assert_good(f"## Here\n[text]({target})\n", self.FILES)

    def test_links_that_lead_nowhere(self):
        for target, kind in (("docs/b.md", "no file"), ("docs/a.md#second", "no heading"),
                             ("docs/a.md#twice-2", "no heading"), ("#there", "no heading"),
                             ("docs/a.md#comment", "no heading"), ("../outside.md", "no file")):
            with self.subTest(target):
                self.assert_fault(f"## Here\nSee [text]({target}).\n", "README.md:2:", kind, target,
                                  files=self.FILES)

    def test_images(self):
        self.assert_fault("![picture](docs/gone.png)\n", "docs/gone.png")

    def test_links_are_relative_to_their_document(self):
        self.assert_good("", {**self.FILES, "docs/sub/b.md": "[a](../a.md#twice) [c](c.md)\n",
                              "docs/sub/c.md": ""})
        self.assert_fault("", "docs/sub/b.md:1:",
                          files={**self.FILES, "docs/sub/b.md": "[a](a.md)\n"})

    def test_code_holds_no_links(self):
        self.assert_good("`[a](b.md)`\n```\n[a](b.md)\n```\n")


class FilesTest(CheckDocsTest):
    def test_files_that_exist(self):
        for code in ("src/map", "src/map/map.cc", "./scripts/demo.sh --all", "scripts/*.sh",
                     "map/map.h", "map/*.h", "hullslam/map/map.h", "include/hullslam/map/map.h",
                     "src/<module>/<file>.cc", "src/MODULE", "<module>/map.h", "other/gone.h",
                     "build/src/gone", "map/gone", "docs/outputs.md"):
            with self.subTest(code):
                self.assert_good(f"The file `{code}`.\n")

    def test_files_that_do_not_exist(self):
        for code, name in (("src/gone", "src/gone"), ("python3 scripts/gone.py out", "scripts/gone.py"),
                           ("map/gone.h", "map/gone.h"), ("hullslam/map/gone.h",) * 2,
                           ("map/gone_*.h",) * 2, ("config/gone.yaml",) * 2):
            with self.subTest(code):
                self.assert_fault(f"The file `{code}`.\n", "README.md:1:", name)

    def test_blocks_of_code(self):
        self.assert_fault("```\n./scripts/gone.sh  # does nothing\n```\n", "README.md:2:",
                          "scripts/gone.sh")
        self.assert_fault('```cpp\n#include "hullslam/map/gone.h"\n```\n', "README.md:2:")

    def test_plain_text_names_no_files(self):
        self.assert_good("Either src/gone or not.\n")


class LengthsTest(CheckDocsTest):
    def test_long_lines(self):
        self.assert_good("ab " * 46 + "ab\n")
        self.assert_fault("ab " * 46 + "abc\n", "README.md:1:", "141 characters")
        self.assert_fault("```\n" + "ab " * 46 + "abc\n```\n", "README.md:2:")

    def test_rows_and_single_words_may_be_longer(self):
        self.assert_good("| " + "ab " * 50 + "|\n")
        self.assert_good("x" * 150 + "\n")

    def test_length_of_the_readme(self):
        self.assert_good("a\n" * 120)
        self.assert_fault("a\n" * 121, "README.md:121:", "121 lines")
        self.assert_good("", {"docs/long.md": "a\n" * 200})


    def test_number_and_length_of_the_pages(self):
        pages = {f"docs/{number}.md": "" for number in range(23)}  # beside the two of BASE
        self.assert_good("", pages)
        self.assert_fault("", "docs: 27 pages",
                          files={**pages, "docs/more/23.md": "", "docs/more/24.md": ""})
        self.assert_good("", {"docs/a.md": "a\n" * 34900})
        self.assert_fault("", "docs: 36", "words", files={"docs/a.md": "a\n" * 36600})


class ProgramsTest(CheckDocsTest):
    def test_every_program_is_named(self):
        files = {"Examples/rgbd_tum.cc": "", "Examples/library/01_minimal.cc": "",
                 "docs/library.md": "`01_minimal.cc`\n"}
        self.assert_good("", {**files, "docs/programs.md": "`rgbd_tum SEQUENCE`\n"})
        self.assert_fault("`rgbd_tum`\n", "docs/programs.md: lacks the program rgbd_tum",
                          files={**files, "docs/programs.md": "rgbd_tum, `rgbd_tum_more`\n"})


class TreeTest(unittest.TestCase):
    def test_empty_tree_fails(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(len(check_docs.check_tree(folder)), 1)


if __name__ == "__main__":
    unittest.main()
