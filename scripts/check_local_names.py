#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that no two files of a target define the same name in anonymous namespaces; fails if two do.

The release build compiles several files of a target together (CMAKE_UNITY_BUILD). There, equal names
of two anonymous namespaces are one name that is defined twice. A file that is added changes which
files are compiled together, so all names of a target must differ. Functions may have the same name
if their parameters differ, and aliases may be equal if they stand for the same text.

The .cc files of one folder make a target; src/run is one target with its folders. The targets of
Examples and bench have one file each.

The reader knows no macros. It removes comments and literals and then takes the name from the text of
each declaration: the word after struct, class, union, enum or using, the word before the first
parenthesis, or the last word before `=`, `{` or `;`. A test counts as Suite_Test, as in GoogleTest.
"""

import argparse
import pathlib
import re
import sys

from check_function_length import closing_brace, hide, line_of, without_brackets, without_template

FOLDERS = ("src", "tests", "tools")
SEPARATE = ("tests/consumer",)
JOINED = "src/run"

NAMESPACE = re.compile(r"(?:inline\s+)?namespace\b\s*([\w:]*)$")
TYPE = re.compile(r"(?:typedef\s+)?(?:struct|class|union|enum(?:\s+class)?)\s+(\w+)\s*(:.*|final.*)?$",
                  re.DOTALL)
ALIAS = re.compile(r"using\s+(\w+)\s*=(.*)", re.DOTALL)
TEST = re.compile(r"[A-Z_]+\s*\(\s*(\w+)\s*,\s*(\w+)\s*[,)]")
NO_DEFINITION = re.compile(r"(using|namespace|static_assert|template|friend|extern)\b")
ATTRIBUTE = re.compile(r"\[\[.*?\]\]|\balignas\s*\(.*?\)")
ASSIGNMENT = re.compile(r"(?<![=!<>])=(?!=)")
TEMPLATE_ARGUMENTS = re.compile(r"<[^<>]*>")
CONSTANT = re.compile(r"k[A-Z]")


def parameters_of(text):
    """The types of the parameters of a function, given the text that begins with its parenthesis."""
    depth, types = 0, [""]
    for char in re.sub(r"\s+", " ", text):
        depth += {"(": 1, "<": 1, "{": 1, ")": -1, ">": -1, "}": -1}.get(char, 0)
        if depth == 0:
            break
        if char == "," and depth == 1:
            types.append("")
        else:
            types[-1] += char
    types = [ASSIGNMENT.split(parameter.lstrip("( "))[0].strip() for parameter in types]
    return [re.sub(r"(?<=[\w&*>\]]) ?\b\w+$", "", parameter).strip() for parameter in types]


def definition_of(head):
    """The name that a declaration defines, and what else two definitions must differ in.

    `head` is the text of the declaration before `{` or `;`. The second part is a text for aliases, the
    parameters for functions, and None for all others. Returns None if nothing is defined.
    """
    head = ATTRIBUTE.sub(" ", without_template(head)).strip()
    if match := TYPE.match(head):
        return match[1], None
    if match := ALIAS.match(head):
        return match[1], re.sub(r"\s+", " ", match[2]).strip()
    if match := TEST.match(head):
        return f"{match[1]}_{match[2]}", None
    if NO_DEFINITION.match(head) or "operator" in head:
        return None
    left = ASSIGNMENT.split(without_brackets(head))[0]
    while TEMPLATE_ARGUMENTS.search(left):
        left = TEMPLATE_ARGUMENTS.sub(" ", left)
    match = re.search(r"(::\s*)?\b(\w+)\s*$", re.sub(r"\[[^\]]*\]", " ", left).partition("(")[0])
    is_member = match and match[1]
    if not match or is_member:
        return None
    is_function = "(" in left and not CONSTANT.match(match[2])
    after_name = re.search(rf"\b{match[2]}\s*(\(.*)", head, re.DOTALL)
    return match[2], parameters_of(after_name[1]) if is_function and after_name else None


def clash(first, second):
    """Whether two definitions of one name in one namespace are an error."""
    if isinstance(first, str) and isinstance(second, str):
        return first != second
    if isinstance(first, list) and isinstance(second, list):
        return first == second
    return True


def local_names(text):
    """Yields (name, rest of the definition, number of its line) for what anonymous namespaces define.

    The name of something in a named namespace begins with the namespaces' names.
    """
    text = hide(text)
    scopes, begin, position, brackets = [], 0, 0, 0
    token = re.compile(r"[{};()]")
    while match := token.search(text, position):
        char, position = match[0], match.end()
        if char in "()":
            brackets += 1 if char == "(" else -1
        if char in "()" or brackets:
            continue
        head = text[begin:match.start()].strip()
        namespace = NAMESPACE.match(head) if char == "{" else None
        if namespace:
            scopes.append(namespace[1])
        elif char == "}":
            if not scopes:
                raise ValueError(f"line {line_of(text, match.start())}: a brace without an opening")
            scopes.pop()
        else:
            if "" in scopes and (definition := definition_of(head)):
                name = "::".join([*filter(None, scopes), definition[0]])
                yield name, definition[1], line_of(text, match.start())
            if char == "{":
                end = closing_brace(text, match.start())
                if end is None:
                    raise ValueError(f"line {line_of(text, match.start())}: the brace is not closed")
                # The rest of the declaration of a type or variable ends with a semicolon.
                rest = re.compile(r"\s*;|").match(text, end + 1)
                position = rest.end()
        begin = position


def targets(root):
    """(name, its .cc files) of each target with several files."""
    found = {}
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.cc")):
            name = path.parent.relative_to(root).as_posix()
            if f"{name}/".startswith(tuple(f"{separate}/" for separate in SEPARATE)):
                continue
            found.setdefault(JOINED if name.startswith(f"{JOINED}/") else name, []).append(path)
    return found


def check_target(paths, root):
    known, faults = {}, []
    for path in paths:
        where = path.relative_to(root).as_posix()
        try:
            for name, rest, line in local_names(path.read_text(encoding="utf-8")):
                others = known.setdefault(name, [])
                clashing = [other for other, of_other in others
                            if other != where and clash(rest, of_other)]
                if clashing:
                    faults.append(f"{where}:{line}: {name} is also in {clashing[0]}")
                others.append((where, rest))
        except ValueError as error:
            faults.append(f"{where}: {error}")
    return faults


def check_tree(root):
    """The faults of the tree at `root`, one line per fault. Finding no files is a fault too."""
    root = pathlib.Path(root).resolve()
    found = targets(root)
    if not found:
        return [f"{root}: no .cc files in {', '.join(FOLDERS)}"]
    return [fault for paths in found.values() for fault in check_target(paths, root)]


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
