#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks which headers and words the modules of HullSLAM use, and their sizes; fails if one breaks a
rule below.

1. A module includes only its own headers and headers of modules at strictly lower levels
   (modules.toml).
2. Of those modules it includes only the ones that its CMakeLists.txt names in LINKS. A module whose
   CMakeLists.txt is missing or does not call hullslam_module() is not checked for this rule.
3. A public header (in include/) includes no private header (in src/).
4. A public header includes no header of CGAL, SuiteSparse or Embree, so that users of the library do
   not need them.
5. Names of lenses, sensors and data sets stand in the code of few modules only (WORDS).
6. No folder of the library has more than MOST_FILES files, all of them together no more than ALL_FILES,
   no file more than MOST_LINES lines, and no part of PARTS and no scripts more than is given there.
"""

import dataclasses
import pathlib
import re
import sys
import tomllib

from support import check_program, SCRIPTS

MODULES = tomllib.loads((SCRIPTS / "modules.toml").read_text(encoding="utf-8"))
LEVELS = {module: int(level) for level, modules in MODULES.items() for module in modules}
PROGRAM_SIDE = {"run"}


@dataclasses.dataclass(frozen=True)
class Word:
    """A word that only some modules may use in code."""
    meaning: str
    pattern: re.Pattern
    homes: set
    # Modules that use it today. Others ask the homes in place of it, and so should these. A test
    # fails if a module is here without need.
    still: set = frozenset()


WORDS = (
    Word("lens", re.compile(r"\b(IsFisheye|LensModel|\w*Kannala\w*)\b"),
         {"camera", "files", "settings", "map_files"}),
    Word("stereo sensor", re.compile(r"\bkStereo\b"),
         {"frame", "system", "sequences", "datasets", "map_files"}, {"exports", "run"}),
    # Also names of formats: of pose files (exports, results), of calibrations (settings); and the tool
    # of TUM that pairs poses (eval, run).
    Word("data set", re.compile(r'\b\w*(?<!\bk)(Tum|Icl|Euroc|Kitti)([A-Z]\w*)?\b'
                                r'|"_?(tum|icl|euroc|kitti)(_\w+)?"'),
         {"datasets", "sequences"}, {"eval", "exports", "results", "run", "settings"}),
)

# These numbers may only become smaller. The goal of SCRIPTS is 6500.
MOST_FILES, MOST_LINES, ALL_FILES, SCRIPTS = 40, 900, 900, 7524
CORE = {module for module, level in LEVELS.items() if level <= LEVELS["system"]} - {"files", "images", "bags"}
PARTS = {  # name: (modules, lines of src; the goal of the core is 35000)
    "core": (CORE, 36500),
    "run": (PROGRAM_SIDE, 4500),
}

KEPT_PRIVATE = re.compile(
    r"CGAL/|embree\d?/|suitesparse/|Eigen/(Cholmod|SPQR|UmfPack|KLU)Support$"
    r"|(cholmod|amd|colamd|camd|ccolamd|cs|umfpack|klu|SuiteSparse)\w*\.(h|hpp)$",
    re.IGNORECASE)
COMMENT, COMMENT_IN_CODE = re.compile(r"#.*"), re.compile(r"//.*")
MODULE_CALL = re.compile(r"\bhullslam_module\(([^)]*)\)")
KEYWORD = re.compile(r"(?<!\S)(LINKS|PUBLIC|PRIVATE|WITH_\S*)(?!\S)")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def source_files(root):
    """Yields (path, module, is public header) for every C++ file of the library, sorted by path."""
    for top, public in (("include/hullslam", True), ("src", False)):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".h", ".cc"):
                inside = path.relative_to(root / top).parts
                yield path, inside[0] if len(inside) > 1 else "", public


def target_of(included, quoted, path, root):
    """The module of the header that an include names ("" if it is in none) and whether the header is
    private; (None, False) for a foreign header."""
    parts = included.split("/")
    if parts[0] == "hullslam":
        return parts[1] if len(parts) > 2 else "", False
    if len(parts) > 1 and parts[0] in LEVELS:
        return parts[0], True
    beside = (path.parent / included).resolve()
    for top, is_private in (root / "src", True), (root / "include" / "hullslam", False):
        if quoted and beside.is_relative_to(top):
            return next(iter(beside.relative_to(top).parts), ""), is_private
    return None, False


def declared_links(root):
    """For each module that calls hullslam_module(): the modules that it names in LINKS."""
    links = {}
    for module in LEVELS:
        file = root / "src" / module / "CMakeLists.txt"
        text = COMMENT.sub("", file.read_text(encoding="utf-8")) if file.exists() else ""
        if call := MODULE_CALL.search(text):
            _, *parts = KEYWORD.split(call[1])
            links[module] = {word for key, words in zip(parts[::2], parts[1::2]) if key == "LINKS"
                             for word in words.split()}
    return links


def fault(module, target, links):
    """The reason why `module` may not include a header of `target`; None if it may."""
    if target == module:
        return None
    if target not in LEVELS:
        return f'unknown module "{target}"'
    if LEVELS[target] < LEVELS[module]:
        if target in links.get(module, LEVELS):
            return None
        return f"{module} includes {target}, which src/{module}/CMakeLists.txt does not name in LINKS"
    way = "sideways" if LEVELS[target] == LEVELS[module] else "up"
    return f"{module} (level {LEVELS[module]}) includes {way}: {target} (level {LEVELS[target]})"


def check_file(path, module, public, root, links):
    where = path.relative_to(root)
    if module not in LEVELS:
        return [f'{where}: unknown module "{module}"; add it to scripts/modules.toml']
    if public and module in PROGRAM_SIDE:
        return [f"{where}: {module} belongs to the programs and may not have public headers"]
    faults = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        quoted, included = match[1] == '"', match[2]
        if public and KEPT_PRIVATE.match(included):
            faults.append(f"{where}:{number}: {included} in a public header")
        target, is_private = target_of(included, quoted, path, root)
        if public and is_private:
            faults.append(f"{where}:{number}: private header {included} in a public one")
        if target is not None and (reason := fault(module, target, links)):
            faults.append(f"{where}:{number}: {reason} ({included})")
    return faults


def words_in(text):
    """(number of the line, Word, what is written) of all words of WORDS in the code of a file."""
    for number, line in enumerate(text.splitlines(), 1):
        for word in WORDS:
            if found := word.pattern.search(COMMENT_IN_CODE.sub("", line)):
                yield number, word, found[0]


def check_words(path, module, root):
    return [f"{path.relative_to(root)}:{number}: {text} names a {word.meaning}; only "
            f"{', '.join(sorted(word.homes))} may (WORDS in check_layers.py)"
            for number, word, text in words_in(path.read_text(encoding="utf-8"))
            if module not in word.homes | word.still]


def folder_sizes(root):
    """The number of files in each folder of the library."""
    paths = [path for path, _, _ in source_files(root)]
    folders = [path.parent.relative_to(root).as_posix() for path in paths]
    return {folder: folders.count(folder) for folder in sorted(set(folders))}


def count_lines(path):
    return len(path.read_text(encoding="utf-8").splitlines())


def check_sizes(root):
    faults = [f"{folder}: {count} files, at most {MOST_FILES}"
              for folder, count in folder_sizes(root).items() if count > MOST_FILES]
    if (count := sum(folder_sizes(root).values())) > ALL_FILES:
        faults.append(f"src and include: {count} files, at most {ALL_FILES}")
    scripts = [path for path in (root / "scripts").rglob("*.*") if path.suffix in (".py", ".sh")]
    if (count := sum(map(count_lines, scripts))) > SCRIPTS:
        faults.append(f"scripts: {count} lines of Python and shell, at most {SCRIPTS}")
    lines = {path: count_lines(path) for path, _, _ in source_files(root)}
    faults += [f"{path.relative_to(root)}: {count} lines, at most {MOST_LINES}"
               for path, count in lines.items() if count > MOST_LINES]
    for name, (modules, most) in PARTS.items():
        count = sum(lines[path] for path, module, public in source_files(root)
                    if module in modules and not public)
        if count > most:
            faults.append(f"{name}: {count} lines in src, at most {most} (PARTS in check_layers.py)")
    return faults


def check_tree(root):
    """The faults of the tree at `root`, one line per fault. Finding no files is a fault too."""
    root = pathlib.Path(root).resolve()
    files = list(source_files(root))
    if not files:
        return [f"{root}: no C++ files in include/hullslam or src"]
    links = declared_links(root)
    faults = [line for path, module, public in files
              for line in [*check_file(path, module, public, root, links), *check_words(path, module, root)]]
    return [*faults, *check_sizes(root)]


if __name__ == "__main__":
    sys.exit(check_program(__doc__, check_tree))
