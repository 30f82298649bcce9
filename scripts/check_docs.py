#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the documents of HullSLAM (README.md, docs/ and the other Markdown files) by these rules:

1. Every key of a setting or of summary.json that a document names in code exists. Keys are the names
   in the first column of the tables of docs/settings.md (settings, names of ORB-SLAM3) and of
   docs/outputs.md (summary.json), and earlier names of settings, which src pairs with the new ones.
   `objects.pose.*` stands for all keys that begin with `objects.pose.`; there must be one. A name is
   taken for a key if it has the same first part as a key of a table whose first column is called
   key or name.
2. The target of every link to a file, an image or a heading of this repository exists.
3. Every file of this repository that a document names in code exists, for example `scripts/demo.sh`
   or `map/map.h`, which may be in src or in include/hullslam. `costs/quadric_*.h` needs one such
   file. Names with a placeholder, such as `src/<module>` or `tests/MODULE`, are not checked.
4. A line has at most 140 characters, unless it is a row of a table or a single word.
5. README.md has at most 120 lines.
6. docs/programs.md or docs/library.md names in code every program whose source is in Examples.
7. The pages in docs/ are at most 26, with at most 36600 words together.
"""

import itertools
import pathlib
import re
import sys

from support import check_program

MAX_COLUMNS = 140
MAX_README_LINES = 120
MAX_PAGES = 26
MAX_WORDS = 36600
# Files whose tables define keys, and the suffixes that tell that a name such as objects.json is a file.
KEY_TABLES = ("docs/settings.md", "docs/outputs.md")
FILE_SUFFIXES = {"json", "csv", "ply", "txt", "png", "md", "yaml", "h", "cc", "py", "sh"}
DOCUMENTS = ("README.md", "docs/**/*.md", "config/**/*.md", "Vocabulary/*.md", "Thirdparty/*.md",
             "Examples/**/*.md", "python/**/*.md", "tools/**/*.md")
FOLDERS = ("src", "include", "scripts", "config", "docs", "tests", "Examples", "tools", "bench",
           "python", "web", "Vocabulary", "Thirdparty", "packaging")

EARLIER_NAME = re.compile(r'\{\s*"([\w.]+)",\s*"([\w.]+)"\s*\}')
FENCE = re.compile(r"^\s*(```|~~~)")
INLINE_CODE = re.compile(r"(`+)(?!`)(.+?)(?<!`)\1(?!`)")
KEY = re.compile(r"(?<![\w./-])[A-Za-z_]\w*(?:\.\w+)*(?:\.\w+|\.\*|\.(?=<))")
SETTING = re.compile(r"--set[ =][\"']?([\w.]+)(?==)")
SETTING_IN_FILE = re.compile(r"^(\w+(?:\.\w+)+):(?=\s)")
KEY_COLUMN = re.compile(r"\b(key|name)s?\b", re.IGNORECASE)
FILE = re.compile(r"(?<![\w./<>$}-])(?:\./)?((?:[\w.*+-]|<\w+>)+(?:/(?:[\w.*+-]|<\w+>)*)+)")
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)\s*#*\s*$")
ANCHOR = re.compile(r"<a\s+(?:id|name)=\"([^\"]+)\"")
PLACEHOLDER = re.compile(r"(^|[./])[A-Z_]+($|[./])|^key$")
PATH_END = ".,:;"


class Document:
    """A Markdown file: its lines, and which of them are text and code: lists of (number, line)."""

    def __init__(self, path, root):
        self.path, self.name = path, str(path.relative_to(root))
        self.lines = path.read_text(encoding="utf-8").splitlines()
        self.text, self.code = [], []
        is_code = False
        for number, line in enumerate(self.lines, 1):
            if FENCE.match(line):
                is_code = not is_code
            else:
                (self.code if is_code else self.text).append((number, line))
        self.inline_code = [(number, match[2]) for number, line in self.text
                            for match in INLINE_CODE.finditer(line)]
        self.all_code = self.inline_code + self.code

    def anchors(self):
        """The names by which links reach the headings, as GitHub makes them."""
        found, slugs = set(), []
        for _, line in self.text:
            found.update(ANCHOR.findall(line))
            if heading := HEADING.match(line):
                slugs.append(slug_of(heading[1]))
                count = slugs.count(slugs[-1]) - 1
                found.add(f"{slugs[-1]}-{count}" if count else slugs[-1])
        return found


def slug_of(heading):
    heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def is_row(line):
    return line.lstrip().startswith("|")


def tables(document):
    """For each table of the document: the first cell of each of its rows, the header first."""
    groups = itertools.groupby(document.text, lambda numbered: is_row(numbered[1]))
    return [[line.split("|")[1] for _, line in group] for is_table, group in groups if is_table]


def keys_in(cells):
    """The keys in the first cells of a table.

    A cell with several, such as `map.keyframes`, `loops`, gives the first part to all of them.
    """
    keys = set()
    for cell in cells:
        names = [match[2] for match in INLINE_CODE.finditer(cell)]
        prefix = names[0].rpartition(".")[0] if names else ""
        keys |= {name if "." in name or not prefix else f"{prefix}.{name}" for name in names}
    return {key for key in keys if re.fullmatch(r"[\w.]+(\.\*)?", key)}


class Keys:
    """The keys that exist, and the first parts by which a name is taken for a key."""

    def __init__(self, documents, root):
        self.keys, self.first_parts = set(), set()
        for document in documents:
            for cells in tables(document) if document.name in KEY_TABLES else []:
                keys = keys_in(cells[1:])
                self.keys |= keys
                if KEY_COLUMN.search(cells[0]):
                    self.first_parts |= {key.partition(".")[0] for key in keys if "." in key}
        self.keys |= {earlier for path in (root / "src").rglob("*.cc")
                      for earlier, key in EARLIER_NAME.findall(path.read_text(encoding="utf-8"))
                      if key in self.keys}

    def exists(self, name):
        if name.endswith(".*"):
            return any(key.startswith(name[:-1]) for key in self.keys)
        parts = name.split(".")
        families = {".".join(parts[:i]) + ".*" for i in range(1, len(parts))}
        return name in self.keys or bool(families & self.keys) \
            or any(key.startswith(name + ".") for key in self.keys)

    def names_in(self, code):
        """The words of a piece of code that are taken for keys."""
        for match in KEY.finditer(code):
            name, following = match[0], code[match.end():match.end() + 1]
            is_file = name.rpartition(".")[2] in FILE_SUFFIXES or following == "/"
            is_call, has_placeholder = following == "(", name.endswith(".")
            if name.partition(".")[0] in self.first_parts and not (is_file or is_call or has_placeholder):
                yield name


def key_faults(document, keys):
    named = [(number, name) for number, text in document.inline_code for name in keys.names_in(text)]
    named += [(number, name) for number, text in document.all_code
              for name in SETTING.findall(text) if not PLACEHOLDER.search(name)]
    named += [(number, name) for number, text in document.code
              for setting in SETTING_IN_FILE.findall(text) for name in keys.names_in(setting)]
    for number, name in sorted(set(named)):
        if not keys.exists(name):
            yield number, f'there is no key "{name}"'


def link_faults(document, documents, root):
    for number, line in document.text:
        without_code = INLINE_CODE.sub(lambda match: " " * len(match[0]), line)
        for target in LINK.findall(without_code):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            path = (document.path.parent / name).resolve() if name else document.path
            if not path.is_relative_to(root) or not path.exists():
                yield number, f"the link leads to no file: {target}"
            elif anchor and path in documents and anchor not in documents[path].anchors():
                yield number, f"the link leads to no heading: {target}"


def files_in(code, modules):
    """The words of a piece of code that name a file of the repository."""
    for match in FILE.finditer(code):
        name = match[1].rstrip(PATH_END)
        top, _, rest = name.partition("/")
        if "<" in name or code[match.end():match.end() + 1] in tuple("<{$"):
            continue
        is_source = name.endswith((".h", ".cc"))
        if top in FOLDERS and rest or top in modules | {"hullslam"} and is_source:
            yield name


def file_faults(document, modules, root):
    folders = [root / top for top in ("", "src", "include/hullslam", "include")]
    for number, text in document.all_code:
        for name in files_in(text, modules):
            exists = any(any(top.glob(name)) if "*" in name else (top / name).exists() for top in folders)
            if not exists and not PLACEHOLDER.search(name):
                yield number, f"there is no file {name}"


def length_faults(document):
    for number, line in enumerate(document.lines, 1):
        if len(line) > MAX_COLUMNS and not is_row(line) and " " in line.strip():
            yield number, f"{len(line)} characters, at most {MAX_COLUMNS}"
    if document.name == "README.md" and len(document.lines) > MAX_README_LINES:
        yield len(document.lines), f"{len(document.lines)} lines, at most {MAX_README_LINES}"


def program_faults(documents, root):
    pages = [document for document in documents if document.name in ("docs/programs.md", "docs/library.md")]
    named = " ".join(code for page in pages for _, code in page.all_code)
    for path in sorted((root / "Examples").rglob("*.cc")):
        if not re.search(rf"\b{path.stem}\b", named):
            yield f"docs/programs.md: lacks the program {path.stem}"


def size_faults(documents):
    pages = [document for document in documents if document.name.startswith("docs/")]
    words = sum(len(line.split()) for page in pages for line in page.lines)
    if len(pages) > MAX_PAGES:
        yield f"docs: {len(pages)} pages, at most {MAX_PAGES}"
    if words > MAX_WORDS:
        yield f"docs: {words} words, at most {MAX_WORDS}"


def check_tree(root):
    """The faults of the tree at `root`, one line per fault. Finding no documents is a fault too."""
    root = pathlib.Path(root).resolve()
    paths = sorted({path for pattern in DOCUMENTS for path in root.glob(pattern)})
    documents = {path: Document(path, root) for path in paths}
    if not documents:
        return [f"{root}: no documents"]
    keys = Keys(documents.values(), root)
    modules = {path.name for top in ("src", "include/hullslam") for path in (root / top).glob("*")
               if path.is_dir()}
    faults = []
    for document in documents.values():
        found = [*key_faults(document, keys), *link_faults(document, documents, root),
                 *file_faults(document, modules, root), *length_faults(document)]
        faults += [f"{document.name}:{number}: {what}" for number, what in sorted(found)]
    return [*faults, *program_faults(documents.values(), root), *size_faults(documents.values())]


if __name__ == "__main__":
    sys.exit(check_program(__doc__, check_tree))
