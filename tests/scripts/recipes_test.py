#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Follows the recipes of docs/architecture.md: adds a scratch mask format, data set, export, residual
and lens to a copy of the files that they name, counts the edited files, and runs the program.

Files that a command writes are not counted: the table of docs/settings.md and the stubs of settings."""

import json
import os
import pathlib
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

from scratch_extensions import EXTENSIONS

TOP = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("HULLSLAM_BIN", TOP / "build" / "release" / "bin"))
BUILD = BIN.parent
CAMERA = """%YAML:1.0
Camera.type: Scratch
Camera.fx: 100
Camera.fy: 100
Camera.cx: 64
Camera.cy: 48
Camera.width: 128
Camera.height: 96
"""



def recipe_of(name):
    """The files that the recipe says to edit."""
    rows = [line.split("|")[1:4] for line in (TOP / "docs" / "architecture.md").read_text().splitlines()
            if line.startswith(f"| {name} |")]
    return set(re.findall(r"`([a-z_/]+/[a-z_]+\.[a-z]+)`", rows[0][2]))


def write_tree(root, extension):
    """The new and the edited files of an extension in a folder. Other extensions may have edited them."""
    for name, text in extension.new.items():
        if (TOP / name).exists():
            raise AssertionError(f"{name} is no new file")
        write(root / name, text)
    for name, edits in extension.edits.items():
        text = (root / name if (root / name).exists() else TOP / name).read_text()
        for before, inserted, behind in edits:
            if text.count(before + behind) != 1:
                raise AssertionError(f"{name}: {before + behind!r} is there {text.count(before + behind)} times")
            text = text.replace(before + behind, before + inserted + behind)
        write(root / name, text)


def write(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content)


def write_png(path, rows):
    """Writes a grey image, given as bytes for each row."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head)
                     + chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows)))
                     + chunk(b"IEND", b""))


def compiler_of(module, root):
    """The words of the command that compiles a module, without its input and output. Headers in `root`
    take the place of others."""
    commands = json.loads((BUILD / "compile_commands.json").read_text())
    command = next(entry["command"] for entry in commands if f"hullslam_{module}.dir" in entry["command"])
    words = shlex.split(command)
    first = next(i for i, word in enumerate(words) if word.startswith("-I"))
    words[first:first] = [f"-I{root}/include", f"-I{root}/src"]
    return [word for word in words[:words.index("-o")] if not word.startswith("-O")]


class RecipesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def test_the_edited_files_are_those_of_the_recipe_and_few(self):
        for extension in EXTENSIONS:
            with self.subTest(extension.recipe):
                write_tree(self.dir / extension.recipe, extension)
                self.assertLessEqual(len(extension.edits), extension.most)
                self.assertLessEqual(set(extension.edits), recipe_of(extension.recipe))

    def test_no_other_file_has_a_case_for_each_enumerator(self):
        case = re.compile(r"\bcase (LensModel|ObjectResidual)::")
        found = [path for top in ("src", "include", "tools", "python") for path in (TOP / top).rglob("*.[hc]*")
                 if path.suffix in (".h", ".cc") and case.search(path.read_text())]
        self.assertEqual(found, [], "a new enumerator would be missing there")

    def compile(self, root):
        """Compiles the new and edited sources."""
        objects = []
        for source in sorted(root.rglob("src/*/*.cc")):
            objects.append(source.with_suffix(".o"))
            self.succeed([*compiler_of(source.parent.name, root), "-O0", "-c", source, "-o", objects[-1]])
        return objects

    def link(self, objects):
        """hullslam with these objects in the place of those of the libraries."""
        commands = self.succeed(["ninja", "-C", BUILD, "-t", "commands", "bin/hullslam"]).stdout
        link, program = commands.strip().splitlines()[-1], self.dir / "hullslam"
        words = f" {shlex.join(map(str, objects))} -Wl,-z,muldefs -o {shlex.quote(str(program))} "
        self.succeed(["sh", "-c", link.replace(" -o bin/hullslam ", words)], cwd=BUILD)
        return program

    def succeed(self, command, code=0, **options):
        result = subprocess.run(command, capture_output=True, text=True, check=False, **options)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def write_sequence(self):
        """A sequence of the scratch data set with masks of the scratch format."""
        folder, noise = self.dir / "sequence", zlib.crc32(b"noise")
        (folder / "frames").mkdir(parents=True)
        rows = [bytes((noise >> (x // 8 * 5 + y // 8 * 3) % 25) % 256 for x in range(128)) for y in range(96)]
        for index in range(3):
            write_png(folder / "frames" / f"{index}.png", rows)
            write(folder / "masks" / f"{index}.txt", "41 30 20 40\n")
        write(folder / "scratch.txt", "")
        write(folder / "camera.yaml", CAMERA)
        return folder

    @unittest.skipUnless(shutil.which("ninja") and all(path.exists() for path in (
        BUILD / "build.ninja", BUILD / "compile_commands.json", BIN / "hullslam")), "needs a build with Ninja")
    def test_a_program_with_the_extensions_has_them(self):
        for extension in EXTENSIONS:
            write_tree(self.dir / "tree", extension)
        program = self.link(self.compile(self.dir / "tree"))
        sequence, out = self.write_sequence(), self.dir / "out"
        # The format of the masks is recognised. No map can be made of three equal images.
        told = self.succeed([program, "run", sequence, "--settings", sequence / "camera.yaml", "--masks",
                             sequence / "masks", "--set", "objects.residual=scratch", "--output", out], code=1)
        self.assertIn("a scratch sequence, monocular", told.stdout)
        self.assertIn("a scratch lens", told.stdout)
        summary = json.loads((out / "summary.json").read_text())
        self.assertEqual(summary["provenance"]["dataset"], "scratch")
        self.assertEqual(summary["provenance"]["masks_format"], "scratch")
        self.assertEqual(summary["objects"]["detections"], 3)
        with (out / "trajectory.txt").open("a") as file:
            file.write("0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n")
        self.succeed([program, "export", out, "--to", "scratch", "--output", self.dir / "poses"])
        self.assertEqual((self.dir / "poses").read_text(), "2")


if __name__ == "__main__":
    sys.exit(unittest.main())
