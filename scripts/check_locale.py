#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that no code depends on the locale, which a program of a user may set: with a decimal comma
strtod reads "0.5" as 0. Fails if a C++ file of the library, the programs, the tools or the Python module

1. calls a function that reads numbers by the locale (strtod, stod, sscanf and their like; as<double>() of
   yaml-cpp, cv::FileStorage), asks for the kind of a character (std::isalpha and its like), or sets a
   locale;
2. uses a stream of strings or of the terminal, or >> or << of a file;
3. prints a floating-point number with a function like printf (the programs in Examples may: nothing sets
   their locale).

std::from_chars, ParseFinite(), fmt and util/text.h do the same without a locale. Comments, and files
in folders called tests, are not checked.
"""

import pathlib
import re
import sys

from support import check_program

FOLDERS = ("src", "include", "Examples", "tools", "python")
PROGRAMS = "Examples"
SUFFIXES = {".h", ".cc", ".hpp", ".cpp"}
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
NUMBER = r"(?:strto(?:d|f|ld)|ato[fil]|atoll|sto(?:d|f|ld)|v?[sf]?scanf)"
KIND = (r"std::(?:is(?:alpha|digit|alnum|space|blank|upper|lower|punct|print|xdigit|cntrl|graph)"
        r"|to(?:lower|upper))")
RULES = (
    (re.compile(rf"(?<![\w.>])(?:std::)?{NUMBER}\s*\("), "reads a number by the locale"),
    (re.compile(rf"{KIND}\b"), "asks the locale about a character"),
    (re.compile(r"\b(?:setlocale\s*\(|std::locale\b|imbue\s*\(|put_time\b|get_time\b)"), "uses a locale"),
    (re.compile(r"\bas<\s*(?:float|double)\s*>|\bcv::FileStorage\b"), "reads numbers by the locale"),
    (re.compile(r"std::w?[io]?stringstream\b|std::w?(?:cin|cout|cerr|clog)\b"),
     "is a stream that uses the locale"),
)
PRINTING = re.compile(r"printf\s*\([^;]*?%[-+ #0-9.*]*l?[efgaEFGA]", re.DOTALL)
FILE_STREAM = re.compile(r"std::[io]?fstream\s+(\w+)")


def blank(match):
    """As many lines as the text of the match."""
    return "\n" * match[0].count("\n")


def check_text(text, may_print):
    """The faults of a file: (line, what)."""
    code = COMMENT.sub(blank, text)
    rules = list(RULES)
    rules += [(re.compile(rf"\b{name}\s*(?:>>|<<)"), "reads or writes by the locale of a stream")
              for name in sorted(set(FILE_STREAM.findall(code)))]
    if not may_print:
        rules.append((PRINTING, "prints a number by the locale"))
    return sorted((code.count("\n", 0, match.start()) + 1, f"{match[0].split('(')[0].strip()} {what}")
                  for rule, what in rules for match in rule.finditer(code))


def check_tree(root):
    """The faults of the tree at `root`, one line per fault. Finding no files is a fault too."""
    root = pathlib.Path(root).resolve()
    files = [path for folder in FOLDERS for path in sorted((root / folder).rglob("*"))
             if path.suffix in SUFFIXES and "tests" not in path.relative_to(root).parts]
    if not files:
        return [f"{root}: no C++ files in {', '.join(FOLDERS)}"]
    return [f"{path.relative_to(root)}:{line}: {what}" for path in files
            for line, what in check_text(path.read_text(encoding="utf-8"),
                                         path.relative_to(root).parts[0] == PROGRAMS)]


if __name__ == "__main__":
    sys.exit(check_program(__doc__, check_tree))
