#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a test program with the C++ examples of documents, so that they are compiled and run.

Each block that begins with ```cpp becomes the body of one test. Blocks of a page use names that the
page explains before, such as `options` and `system`; the class DocsExample of tests/docs/given.h has
them. Errors of the compiler name the document and its line.
"""

import pathlib
import re
import sys

from support import exit_code, InputError, parser_of, read_text

BLOCK = re.compile(r"^[ \t]*```cpp[ \t]*\n(.*?)(^[ \t]*```[ \t]*$|\Z)", re.MULTILINE | re.DOTALL)
HEAD = """// SPDX-License-Identifier: GPL-3.0-or-later
// Written by scripts/docs_examples.py.
#include "docs/given.h"

namespace {
"""


def blocks_of(text):
    """The line number of the first line of code and the code, of each C++ block."""
    for match in BLOCK.finditer(text):
        begin = text.count("\n", 0, match.start(1)) + 1
        if not match[2]:
            raise InputError(f"line {begin - 1}: the block has no end")
        yield begin, match[1].rstrip("\n")


def program(documents):
    """`documents` are pairs of a path and its text."""
    parts = [HEAD]
    for path, text in documents:
        name = re.sub(r"\W", "_", path.stem)
        for line, code in blocks_of(text):
            parts.append(f"TEST_F(DocsExample, {name}_line_{line}) {{\n#line {line} \"{path}\"\n"
                         f"{code}\n}}\n")
    return "\n".join([*parts, "}  // namespace", ""])


def run(arguments):
    text = program([(path, read_text(path)) for path in arguments.documents])
    arguments.output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    parser = parser_of(__doc__)
    parser.add_argument("documents", nargs="+", type=pathlib.Path, metavar="DOCUMENT")
    parser.add_argument("--output", required=True, type=pathlib.Path, metavar="FILE.cc")
    sys.exit(exit_code(run, parser.parse_args()))
