# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans the runs of experiments: one for each different sequence, mode, seed and set of arguments.

A plan is a JSON object. Its paths are relative to the output folder, or absolute outside of it:

    runs       {name: sequence, mode, seed, command, fingerprint, ...}; the name is the run's folder
               below runs/
    folders    {name: command, fingerprint, ...} of sequences that must be rendered or degraded
               first; the name is the sequence's folder
"""

import dataclasses
import hashlib
import json
import os
import pathlib
import re

from paper_tables.definitions import MODES
from paper_tables.engine import DIGITS, RESULT_VERSION
from support import SCRIPTS, InputError, call, hash_file, number, programs_folder, reachable, read_text

# The estimators of the modes and data sets.
ESTIMATORS = {("rgbd", "tum"): "rgbd_tum", ("mono", "tum"): "mono_tum", ("rgbd", "icl"): "rgbd_icl",
              ("mono", "icl"): "mono_icl", ("stereo", "tum"): "stereo_folder",
              ("stereo", "euroc"): "stereo_euroc", ("stereo", "kitti"): "stereo_kitti"}


def digest(*parts):
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


@dataclasses.dataclass
class Request:
    """What the user asks for."""
    definitions: object
    sequences: list
    tables: tuple = ()  # names
    modes: tuple = MODES
    seeds: range = range(1)
    frames: int = None  # None: all
    is_quick: bool = False
    timeout: float = 3600.0


def chosen(text, known, option):
    """The names in a text like a,b, in the order of `known`; all without a text."""
    names = list(known) if text is None else [name.strip() for name in text.split(",") if name.strip()]
    for name in names or [""]:
        if name not in known:
            raise InputError(f"{option}: '{name}' is unknown, expected some of: {', '.join(known)}")
    return tuple(name for name in known if name in names)


def add_work_options(parser, timeout):
    """Adds the options of scripts that make runs."""
    parser.add_argument("--programs", type=pathlib.Path, default=programs_folder(), metavar="FOLDER",
                        help="the programs that are run (default: those of this installation or of "
                             "build/release/bin)")
    parser.add_argument("--jobs", type=number(1, kind=int), metavar="N",
                        help="runs at once (default: one per core)")
    parser.add_argument("--timeout", type=number(1e-3, 1e9), default=timeout, metavar="S",
                        help=f"longest time of a run (default {timeout:g} s)")
    parser.add_argument("--list", action="store_true", help="print what would be run, and end")
    parser.add_argument("--so-far", action="store_true", help="run nothing; take the runs that are done")
    parser.add_argument("--quiet", action="store_true", help="show no progress")


class Tools:
    """The programs and files of HullSLAM that runs depend on. `others` has the programs that evaluate
    and render, which should be the same for all builds that are compared."""

    def __init__(self, programs, scripts=SCRIPTS, config=None, others=None):
        self.programs, self.scripts, self.others = programs, scripts, others or programs
        # The settings that belong to a build are those of its checkout, if it is one.
        own = programs.parents[2] / "config" if others and len(programs.parents) > 2 else None
        default = own if own and own.is_dir() else SCRIPTS.parent / "config"
        self.config = pathlib.Path(config or os.environ.get("HULLSLAM_CONFIG") or default).resolve()
        self.hashes = {}

    def path(self, name):
        path = (self.programs if name in ESTIMATORS.values() else self.others) / name
        if not path.is_file():
            raise InputError(f"{path}: no such program; build it (cmake --build --preset release) "
                             "or give its folder by --programs")
        return path

    def hash(self, path):
        """The hash of a file; of a program, also that of the libraries of HullSLAM that it loads."""
        if path not in self.hashes:
            self.hashes[path] = digest([hash_file(file) for file in (path, *libraries(path))])
        return self.hashes[path]

    def hash_with_others(self, files, others):
        """The hashes of files and of the files others(text of a file), and so on."""
        return list(map(self.hash, reachable(files, lambda path: others(read_text(path)))))

    def preset_file(self, name):
        """The file of a preset: one of those of HullSLAM, or a path."""
        path = self.config / "presets" / f"{name}.yaml"
        if not path.is_file() and name.endswith(".yaml"):
            path = pathlib.Path(name)
        if not path.is_file():
            known = sorted(file.stem for file in (self.config / "presets").glob("*.yaml"))
            raise InputError(f"unknown preset '{name}', expected one of: "
                             f"{', '.join(known) or 'none'} (in {self.config / 'presets'})")
        return path

    def preset_hash(self, arguments):
        """The hashes of the files of the presets among the arguments, and of those that they are
        based on."""
        names = [name for option, name in zip(arguments, arguments[1:]) if option == "--preset"]
        bases = re.compile(r"^preset\.base:\s*(\S+)", re.MULTILINE)
        return self.hash_with_others(map(self.preset_file, names),
                                     lambda text: map(self.preset_file, bases.findall(text)))

    def script_hash(self, script):
        """The hashes of a script and of the other scripts that it imports."""
        imports = re.compile(r"^(?:from|import) (\w+)", re.MULTILINE)
        return self.hash_with_others([script], lambda text: [
            path for name in imports.findall(text) if (path := self.scripts / f"{name}.py").is_file()])

    def vocabulary_hash(self):
        path = self.config.parent / "Vocabulary" / "hullslam.bow"
        return self.hash(path) if path.is_file() else None


def libraries(program):
    """The shared libraries of HullSLAM that a program loads."""
    with program.open("rb") as file:
        if file.read(4) != b"\x7fELF":
            return []
    return list(map(pathlib.Path, re.findall(r"=> (\S*/libhullslam\S*)", call("ldd", program).stdout)))


# ---- one run


class Planner:
    def __init__(self, request, tools):
        self.request, self.tools = request, tools
        self.runs, self.folders = {}, {}
        self.names = {}  # what makes a run different from others -> its name

    def plan(self):
        return {"version": RESULT_VERSION, "config": str(self.tools.config),
                "hullslam": str(self.tools.path("hullslam")), "timeout": self.request.timeout,
                "runs": self.runs, "folders": self.folders}

    def add(self, sequence, mode, variant, seed, degradation=None, level=None, last=None):
        """The name of the run; None if there is none, with the reason."""
        if variant.same_as and not sequence.has_rolling_shutter:
            variant = self.request.definitions.variants[variant.same_as]
        if mode not in sequence.modes:
            return None, ("the sequence has no depth" if mode == "rgbd" else
                          "the sequence has no pairs" if mode == "stereo" else
                          "a quick run has this sequence only with depth")
        if mode not in variant.modes:
            return None, f"{variant.label} does not run in this mode"
        if variant.masks and sequence.masks is None:
            return None, "the sequence has no masks"
        if last is None and self.request.frames:
            last = seed + self.request.frames - 1
        key = json.dumps([sequence.name, mode, seed, variant.arguments, variant.masks,
                          degradation.name if degradation else "", level, last])
        if key not in self.names:
            self.names[key] = self.make(sequence, mode, variant, seed, degradation, level, last)
        return self.names[key], ""

    def make(self, sequence, mode, variant, seed, degradation, level, last):
        # A degraded sequence is another sequence, whereas other arguments are another variant.
        suffix = f"+{degradation.name}-{level}" if degradation else ""
        is_other_sequence, settings = bool(degradation and degradation.options), []
        folder, source = sequence.path("folder", seed), self.add_rendering(sequence, seed)
        masks = sequence.path("masks", seed)
        inputs = [sequence.fingerprint, source and self.folders[source]["fingerprint"]]
        if is_other_sequence:
            folder = source = self.add_degraded(sequence, seed, folder, masks, degradation, level)
            masks = masks and f"{folder}/masks"
            inputs = [self.folders[source]["fingerprint"]]
            # The name of the new folder does not tell the camera, as that of the recording may.
            settings = ["--settings", sequence.settings] if sequence.settings else []
        extra = [item.format(level=level) for item in degradation.arguments] if degradation else []
        # Runs of a recorded sequence differ by their first frame.
        part = [] if sequence.rendered else ["--first", str(seed), *(["--last", str(last)] if last else [])]
        arguments = [*variant.arguments, *extra, *part, "--seed", str(seed)]
        if variant.masks:
            inputs.append(sequence.masks_fingerprint)
        program = ESTIMATORS[mode, sequence.dataset]
        name = "/".join((sequence.name + (suffix if is_other_sequence else ""), mode,
                         variant.name + ("" if is_other_sequence else suffix), f"seed-{seed}"))
        self.runs[name] = {
            "sequence": sequence.name, "mode": mode, "variant": variant.name, "seed": seed,
            "degradation": degradation and degradation.name, "level": level, "folder": source,
            "frames": min(sequence.frames, last - seed + 1 if last else sequence.frames),
            "command": [str(self.tools.path(program)), folder, *settings, *arguments,
                        *(("--masks", masks) if variant.masks else ()), "--quiet"],
            "groundtruth": f"{folder}/groundtruth.txt" if sequence.dataset != "icl" else None,
            "objects": sequence.path("objects", seed),
            "fingerprint": digest(RESULT_VERSION, program, arguments, variant.masks, inputs,
                                  *(self.tools.hash(self.tools.path(tool))
                                    for tool in (program, "hullslam")),
                                  self.tools.preset_hash(arguments), self.tools.vocabulary_hash())}
        return name

    def add_rendering(self, sequence, seed):
        """The name of the folder that must be rendered first; None for a recorded sequence."""
        if sequence.rendered is None:
            return None
        name = sequence.rendered["suite"].replace("{seed}", str(seed))
        program = self.tools.path("make_synthetic")
        options = ["--seed", str(seed), *sequence.rendered["options"]]
        self.folders[name] = {
            "kind": "rendered", "frames": sequence.frames, "source": None,
            "command": [str(program), "--suite", "{folder}", *options, "--threads", "1", "--quiet"],
            "fingerprint": digest(RESULT_VERSION, self.tools.hash(program), options)}
        return name

    def add_degraded(self, sequence, seed, folder, masks, degradation, level):
        """The name of the folder with a degraded sequence. Recorded sequences have one for all
        first frames."""
        rendering, script = self.add_rendering(sequence, seed), self.tools.scripts / "degrade_sequence.py"
        seed = seed if rendering else 0
        options = [*(item.format(level=level) for item in degradation.options), "--seed", str(seed)]
        source = self.folders[rendering]["fingerprint"] if rendering else sequence.fingerprint
        made_of = digest(RESULT_VERSION, self.tools.script_hash(script), options, source,
                         sequence.masks_fingerprint)
        # The folder is removed after its runs, so its name tells what it was made from.
        name = f"degraded/{sequence.name}+{degradation.name}-{level}/seed-{seed}-{made_of[:DIGITS]}"
        self.folders[name] = {
            "kind": "degraded", "frames": sequence.frames, "source": rendering,
            "command": [str(script), folder, "{folder}", *options, *(("--masks", masks) if masks else ())],
            "fingerprint": made_of}
        return name


# ---- the runs of tables and cases


def levels_of(table, request, mode):
    """(degradation, level) of the blocks of rows of a table; (None, None) first, or at its place
    in a scale."""
    found = [(None, None)]
    for name in table.degradations:
        degradation = request.definitions.degradations[name]
        if mode in degradation.modes:
            levels = degradation.levels[:1] if request.is_quick else degradation.levels
            found += [(degradation, level) for level in levels]
            if degradation.unchanged is not None:
                found.sort(key=lambda item: float(item[1] or degradation.unchanged))
    return found


def cell_runs(table, request, planner, sequence, mode):
    """For each (degradation, level) and row: {seed: name of the run}, and why there are none."""
    cells = []
    for degradation, level in levels_of(table, request, mode):
        for row in table.rows:
            variant = request.definitions.variants[row.variant]
            if degradation and degradation.only_with_objects and not variant.objects:
                found = dict.fromkeys(request.seeds, (None, "the masks of objects do not matter"))
            else:
                found = {seed: planner.add(sequence, mode, variant, seed, degradation, level)
                         for seed in request.seeds}
            cells.append({"row": row.variant, "degradation": degradation and degradation.name,
                          "level": level,
                          "runs": {seed: name for seed, (name, _) in found.items() if name},
                          "reason": next((why for name, why in found.values() if not name), "")})
    return cells


def make_plan(request, tools):
    """(plan, cells): cells has for each table name, mode and sequence name its cells."""
    planner, cells = Planner(request, tools), {}
    for name in request.tables:
        table = request.definitions.tables[name]
        shown = [sequence for sequence in request.sequences
                 if None in (table.only, sequence.paper) or sequence.paper in table.only]
        for mode in table.modes if shown else ():
            if mode in request.modes:
                for sequence in shown[:table.sequences]:
                    cells[name, mode, sequence.name] = cell_runs(table, request, planner, sequence, mode)
    return planner.plan(), cells


def add_case(planner, case, sequence, firsts):
    """Adds the runs of a case of the gate with these first frames. Each run also tells its case."""
    known, former = planner.request.definitions, set(planner.runs)
    degradation = case.degradation and known.degradations[case.degradation]
    planner.names.clear()  # the same run in two cases is a mistake, as it would count twice
    runs, planner.runs = planner.runs, {}
    for first in firsts:
        for mode in case.modes:
            for variant in case.variants:
                planner.add(sequence, mode, known.variants[variant], first, degradation,
                            degradation.levels[0] if degradation else None, case.last)
    for name, run in planner.runs.items():
        if name in former:
            raise InputError(f"the cases {runs[name]['case']} and {case.name} have the same run {name}")
        runs[name] = {**run, "case": case.name, "input": sequence.fingerprint[:DIGITS]}
    planner.runs = runs
