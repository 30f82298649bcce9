#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that no function is longer than 60 lines; fails if one is.

The lines of a function are counted from the first line of its declaration to its closing brace,
including blank lines and comments. A lambda belongs to the function around it; outside of functions it
counts as a function. All C++ files in src, include, Examples, tools, bench, python and tests/support
are read. Tests may have longer functions.

The reader knows no macros and no templates. It removes comments, literals and preprocessor lines,
and then decides by the text before each opening brace whether a scope (namespace, class, ...), a
function or an initialiser begins. A file whose braces do not match is a fault.
"""

import argparse
import pathlib
import re
import sys

MAX_LINES = 60
FOLDERS = ("src", "include", "Examples", "tools", "bench", "python", "tests/support")
SUFFIXES = {".h", ".cc", ".cpp", ".hpp"}

# Comments, string and character literals, and preprocessor lines with their continuations. A quote
# inside of a number (1'000) is no literal.
HIDDEN = re.compile(
    r'//[^\n]*|/\*.*?\*/'
    r'|R"(?P<mark>[^()\\\s]*)\(.*?\)(?P=mark)"'
    r'|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'"
    r'|^[ \t]*\#(?:\\\n|[^\n])*',
    re.DOTALL | re.MULTILINE)
SCOPE = re.compile(r"(inline\s+|typedef\s+|static\s+|const\s+)*"
                   r"(namespace|class|struct|union|enum|extern)\b")
ACCESS = re.compile(r"\b(public|protected|private)\s*:(?!:)")
TEMPLATE = re.compile(r"\btemplate\s*<")
ASSIGNMENT = re.compile(r"(?<![=!<>+\-*/%&|^])=(?!=)")
OPERATOR = re.compile(r"\boperator\s*(\(\)|\[\]|[^\s\w(]+|[\w\s:<>*&]+)")
INITIALISER_LIST = re.compile(r"\)[^)]*?(?<!:):(?!:)")
# The words that may be between the parameters and the body of a function.
QUALIFIERS = re.compile(r"(\s*(const|noexcept|override|final|mutable|&&?|(->|requires\b).*))*\s*",
                        re.DOTALL)
NAME = re.compile(r"((?:~?\w+\s*(?:<[^()]*>)?\s*::\s*)*~?\w+)\s*\(")


def hide(text):
    """Replaces comments, preprocessor lines and the contents of literals by spaces.

    The numbers of lines do not change. A literal becomes a pair of quotes and spaces.
    """
    def blank(match):
        found = match[0]
        spaces = re.sub(r"[^\n]", " ", found)
        return spaces if found.lstrip()[0] in "/#" else '""' + spaces[2:]
    return HIDDEN.sub(blank, text)


def without_template(head):
    """The head of a declaration without its `template <...>`."""
    match = TEMPLATE.search(head)
    while match:
        depth, end = 1, match.end()
        while depth and end < len(head):
            depth += {"<": 1, ">": -1}.get(head[end], 0)
            end += 1
        head = head[:match.start()] + head[end:]
        match = TEMPLATE.search(head)
    return head


def without_brackets(head):
    """The head without the text inside its outermost parentheses."""
    result, depth = [], 0
    for char in head:
        depth -= char == ")"
        if depth == 0:
            result.append(char)
        depth += char == "("
    return "".join(result)


def kind_of(head):
    """The kind of block that an opening brace after `head` begins: "scope", "function" or "value"."""
    head = without_template(head).strip()
    outline = without_brackets(head)
    has_parameters = ")" in outline
    if SCOPE.match(head) and not has_parameters:
        return "scope"
    is_assigned = ASSIGNMENT.search(OPERATOR.sub("operator", outline))
    if is_assigned:
        is_lambda = re.search(r"=\s*\[[^\]]*\]\s*(\(|$)", outline)
        return "function" if is_lambda else "value"
    if not has_parameters:
        return "value"
    # In `Point() : x_{1}, y_(2) {` only the brace that follows a closing bracket begins the body.
    if INITIALISER_LIST.search(outline):
        return "function" if outline.rstrip()[-1] in ")}" else "value"
    return "function" if QUALIFIERS.fullmatch(outline.rpartition(")")[2]) else "value"


def name_of(head):
    head = without_template(head)
    lambda_name = re.search(r"(\w+)\s*=\s*\[", head)
    match = NAME.search(head)
    if lambda_name:
        return lambda_name[1]
    if "operator" in head:
        return re.search(r"[\w:]*operator\s*(\(\)|[^(]*)", head)[0].strip()
    return re.sub(r"\s+", "", match[1]) if match else "?"


def closing_brace(text, opening):
    """The index of the brace that closes the one at `opening`; None if there is none."""
    depth = 0
    for match in re.compile(r"[{}]").finditer(text, opening):
        depth += 1 if match[0] == "{" else -1
        if depth == 0:
            return match.start()
    return None


def functions(text):
    """Yields (name, number of the first line, number of lines) for each function.

    Throws ValueError for braces that do not match.
    """
    text = ACCESS.sub(lambda match: " " * (len(match[0]) - 1) + ";", hide(text))
    position, begin, scopes, brackets = 0, 0, 0, 0
    token = re.compile(r"[{};()]")
    while match := token.search(text, position):
        char, position = match[0], match.end()
        if char in "()":
            brackets += 1 if char == "(" else -1
        elif char == ";" and brackets == 0:
            begin = position
        elif char == "}":
            scopes -= 1
            begin = position
            if scopes < 0:
                raise ValueError(f"line {line_of(text, match.start())}: a brace without an opening")
        elif char == "{":
            head = text[begin:match.start()]
            kind = "value" if brackets else kind_of(head)
            if kind == "scope":
                scopes += 1
                begin = position
                continue
            end = closing_brace(text, match.start())
            if end is None:
                raise ValueError(f"line {line_of(text, match.start())}: the brace is not closed")
            position = end + 1
            if kind == "function":
                first = line_of(text, begin + len(head) - len(head.lstrip()))
                yield name_of(head), first, line_of(text, end) - first + 1
                begin = position
            else:
                text = text[:match.start()] + blank_value(text[match.start():position]) \
                    + text[position:]
    if scopes:
        raise ValueError("a namespace or a class is not closed")


def blank_value(value):
    """A braced initialiser with spaces instead of the content of its braces."""
    return "{" + re.sub(r"[^\n]", " ", value[1:-1]) + "}"


def line_of(text, index):
    return text.count("\n", 0, index) + 1


def source_files(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SUFFIXES:
                yield path


def check_file(path, root):
    where = path.relative_to(root)
    faults = []
    try:
        for name, line, count in functions(path.read_text(encoding="utf-8")):
            if count > MAX_LINES:
                faults.append(f"{where}:{line}: {name} has {count} lines, at most {MAX_LINES}")
    except ValueError as error:
        faults.append(f"{where}: {error}")
    return faults


def check_tree(root):
    """The faults of the tree at `root`, one line per fault. Finding no files is a fault too."""
    root = pathlib.Path(root).resolve()
    files = list(source_files(root))
    if not files:
        return [f"{root}: no C++ files in {', '.join(FOLDERS)}"]
    return [fault for path in files for fault in check_file(path, root)]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", default=pathlib.Path(__file__).resolve().parent.parent,
                        help="top folder of the repository (default: the one of this script)")
    faults = check_tree(parser.parse_args().root)
    for line in faults:
        print(line, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
