# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans the runs of the tables: one for each different sequence, mode, seed and set of arguments.

A plan is a JSON object. Its paths are relative to the output folder, or absolute outside of it:

    runs       {name: sequence, mode, seed, command, fingerprint, ...}; the name is the run's folder
               below runs/
    folders    {name: command, fingerprint, ...} of sequences that must be rendered or degraded
               first; the name is the sequence's folder
"""

import dataclasses
import hashlib
import json
import re
import subprocess

from run_errors import InputError
from run_statistics import hash_file

DIGITS = 16  # of a fingerprint in the name of a file
RESULT_VERSION = 1  # of the files that runs leave; a new one repeats all runs
PROGRAM = {("tum", "rgbd"): "rgbd_tum", ("tum", "mono"): "mono_tum",
           ("icl", "rgbd"): "rgbd_icl", ("icl", "mono"): "mono_icl"}


def digest(*parts):
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


@dataclasses.dataclass
class Request:
    """What the user asks for."""
    definitions: object
    sequences: list
    tables: tuple  # names
    modes: tuple
    seeds: range
    frames: int = None  # None: all
    is_quick: bool = False
    timeout: float = 3600.0


class Tools:
    """The programs and files of HullSLAM that runs depend on."""

    def __init__(self, programs, scripts, config):
        self.programs, self.scripts, self.config = programs, scripts, config
        self.hashes = {}

    def path(self, name):
        path = self.programs / name
        if not path.is_file():
            raise InputError(f"{path}: no such program; build it (cmake --build --preset release) "
                             "or give its folder by --programs")
        return path

    def hash(self, path):
        """The hash of a file; of a program, also that of the libraries of HullSLAM that it loads."""
        if path not in self.hashes:
            self.hashes[path] = digest([hash_file(file) for file in (path, *libraries(path))])
        return self.hashes[path]

    def preset_file(self, name):
        """The file of a preset: one of those of HullSLAM, or a path."""
        path = self.config / "presets" / f"{name}.yaml"
        if not path.is_file() and name.endswith(".yaml"):
            path = type(path)(name)
        if not path.is_file():
            known = sorted(file.stem for file in (self.config / "presets").glob("*.yaml"))
            raise InputError(f"unknown preset '{name}', expected one of: "
                             f"{', '.join(known) or 'none'} (in {self.config / 'presets'})")
        return path

    def preset_hash(self, arguments):
        """The hashes of the files of the presets among the arguments, and of those that they are
        based on."""
        names = [name for option, name in zip(arguments, arguments[1:]) if option == "--preset"]
        files = []
        for name in names:  # grows while it is read
            path = self.preset_file(name)
            if path not in files:
                files.append(path)
                names += re.findall(r"^preset\.base:\s*(\S+)", path.read_text(encoding="utf-8"),
                                    re.MULTILINE)
        return [self.hash(path) for path in files]

    def script_hash(self, script):
        """The hashes of a script and of the other scripts that it imports."""
        files = [script]
        for path in files:  # grows while it is read
            for name in re.findall(r"^(?:from|import) (\w+)", path.read_text(encoding="utf-8"),
                                   re.MULTILINE):
                other = self.scripts / f"{name}.py"
                if other.is_file() and other not in files:
                    files.append(other)
        return [self.hash(path) for path in files]

    def vocabulary_hash(self):
        path = self.config.parent / "Vocabulary" / "hullslam.bow"
        return self.hash(path) if path.is_file() else None


def libraries(program):
    """The shared libraries of HullSLAM that a program loads."""
    with program.open("rb") as file:
        if file.read(4) != b"\x7fELF":
            return []
    found = subprocess.run(["ldd", program], capture_output=True, text=True, check=False).stdout
    return [type(program)(path) for path in re.findall(r"=> (\S*/libhullslam\S*)", found)]


# ---- one run


class Planner:
    def __init__(self, request, tools):
        self.request, self.tools = request, tools
        self.runs, self.folders = {}, {}
        self.names = {}  # what makes a run different from others -> its name

    def add(self, sequence, mode, variant, seed, degradation=None, level=None):
        """The name of the run; None if there is none, with the reason."""
        variants = self.request.definitions.variants
        if variant.same_as and not sequence.has_rolling_shutter:
            variant = variants[variant.same_as]
        if mode not in sequence.modes:
            return None, ("the sequence has no depth" if mode == "rgbd" else
                          "a quick run has this sequence only with depth")
        if mode not in variant.modes:
            return None, f"{variant.label} does not run in this mode"
        if variant.masks and sequence.masks is None:
            return None, "the sequence has no masks"
        key = json.dumps([sequence.name, mode, seed, variant.arguments, variant.masks,
                          degradation.name if degradation else "", level])
        if key not in self.names:
            self.names[key] = self.make(sequence, mode, variant, seed, degradation, level)
        return self.names[key], ""

    def make(self, sequence, mode, variant, seed, degradation, level):
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
        arguments = [*variant.arguments, *extra, *self.frame_arguments(sequence, seed),
                     "--seed", str(seed)]
        if variant.masks:
            inputs.append(sequence.masks_fingerprint)
        program = PROGRAM[sequence.dataset, mode]
        name = "/".join((sequence.name + (suffix if is_other_sequence else ""), mode,
                         variant.name + ("" if is_other_sequence else suffix), f"seed-{seed}"))
        self.runs[name] = {
            "sequence": sequence.name, "mode": mode, "variant": variant.name, "seed": seed,
            "degradation": degradation and degradation.name, "level": level,
            "folder": source, "frames": self.frames(sequence),
            "command": [str(self.tools.path(program)), folder, *settings, *arguments,
                        *(("--masks", masks) if variant.masks else ()), "--quiet"],
            "groundtruth": f"{folder}/groundtruth.txt" if sequence.dataset == "tum" else None,
            "objects": sequence.path("objects", seed),
            "fingerprint": digest(RESULT_VERSION, program, arguments, variant.masks, inputs,
                                  self.tools.hash(self.tools.path(program)),
                                  self.tools.hash(self.tools.path("evaluate")),
                                  self.tools.preset_hash(arguments),
                                  self.tools.vocabulary_hash())}
        return name

    def frame_arguments(self, sequence, seed):
        """Runs of a recorded sequence differ by their first frame."""
        if sequence.rendered is not None:
            return []
        last = ["--last", str(seed + self.request.frames - 1)] if self.request.frames else []
        return ["--first", str(seed), *last]

    def frames(self, sequence):
        return min(sequence.frames, self.request.frames or sequence.frames)

    def add_rendering(self, sequence, seed):
        """The name of the folder that must be rendered first; None for a recorded sequence."""
        if sequence.rendered is None:
            return None
        name = sequence.rendered["suite"].replace("{seed}", str(seed))
        if name not in self.folders:
            program = self.tools.path("make_synthetic")
            options = ["--seed", str(seed), *sequence.rendered["options"]]
            self.folders[name] = {
                "kind": "rendered", "frames": sequence.frames,
                "command": [str(program), "--suite", "{folder}", *options, "--threads", "1",
                            "--quiet"],
                "source": None, "fingerprint": digest(RESULT_VERSION, self.tools.hash(program),
                                                      options)}
        return name

    def add_degraded(self, sequence, seed, folder, masks, degradation, level):
        """The name of the folder with a degraded sequence. Recorded sequences have one for all
        first frames."""
        rendering = self.add_rendering(sequence, seed)
        seed = seed if rendering else 0
        script = self.tools.scripts / "degrade_sequence.py"
        options = [*(item.format(level=level) for item in degradation.options), "--seed", str(seed)]
        source = self.folders[rendering]["fingerprint"] if rendering else sequence.fingerprint
        made_of = digest(RESULT_VERSION, self.tools.script_hash(script), options, source,
                         sequence.masks_fingerprint)
        # The folder is removed after its runs, so its name tells what it was made from.
        name = (f"degraded/{sequence.name}+{degradation.name}-{level}/seed-{seed}-"
                f"{made_of[:DIGITS]}")
        self.folders[name] = {
            "kind": "degraded", "frames": sequence.frames, "source": rendering,
            "command": [str(script), folder, "{folder}", *options,
                        *(("--masks", masks) if masks else ())],
            "fingerprint": made_of}
        return name


# ---- the runs of the tables


def sequences_of(table, request):
    """The sequences that a table shows."""
    found = [sequence for sequence in request.sequences
             if table.only is None or sequence.paper is None or sequence.paper in table.only]
    return found[:table.sequences]


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
                found = {seed: (None, "the masks of objects do not matter")
                         for seed in request.seeds}
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
    planner = Planner(request, tools)
    cells = {}
    for name in request.tables:
        table = request.definitions.tables[name]
        for mode in table.modes:
            if mode in request.modes:
                for sequence in sequences_of(table, request):
                    cells[name, mode, sequence.name] = cell_runs(table, request, planner, sequence,
                                                                 mode)
    plan = {"version": RESULT_VERSION, "config": str(tools.config),
            "evaluate": str(tools.path("evaluate")), "timeout": request.timeout,
            "runs": planner.runs, "folders": planner.folders}
    return plan, cells


def result_file(name, run):
    """Where the result of a run is. A changed input gives another name, so the run is repeated."""
    return f"runs/{name}/result-{run['fingerprint'][:DIGITS]}.json"


def folder_output(name, folder):
    """The path that shows that a folder is complete and was made from the present inputs."""
    return name if folder["kind"] == "degraded" else f"{name}.made-{folder['fingerprint'][:DIGITS]}"
