# SPDX-License-Identifier: GPL-3.0-or-later
"""Small trees of files for the tests of scripts that check the repository."""

import pathlib
import tempfile


def faults_in(check_tree, files):
    """The faults that check_tree() finds in a folder with these files, {name: text}."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_tree(root)
