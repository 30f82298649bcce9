#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the programs on fixed inputs and stores hashes of what they write.

Use it to check a change that must not alter results: store the hashes before the change, and compare
them after it. All runs are sequential, so equal programs give equal bytes.

    scripts/reference_runs.py store reference.json --sequence rgbd_dataset_freiburg1_xyz --masks MASKS
    scripts/reference_runs.py compare reference.json --sequence rgbd_dataset_freiburg1_xyz --masks MASKS

The runs are RGB-D and monocular SLAM on SEQUENCE, each with and without masks; RGB-D SLAM on the
synthetic desk; objects with known poses, on both; and a session that saves a map and one that goes on
with it. Without --sequence only the runs on the desk are made. Exit codes: 0 done or equal; 1 a
file differs or a run failed; 2 bad usage or input.
"""

import json
import pathlib
import shutil
import sys
import tempfile

from support import (exit_code, hash_file, InputError, parser_of, programs_folder, read_json, run_program,
                     write)

HASHED = ("trajectory.txt", "keyframes.txt", "map.ply", "objects.json")
SAVED_MAP = "saved.map"


def list_runs(desk, sequence, masks):
    """The command of each run by its name, without --output. A later run may need an earlier one."""
    def known_poses(folder, masks):
        return ["hullslam", "map-objects", folder, "--poses", folder / "groundtruth.txt", "--masks", masks]
    with_masks = ["rgbd_tum", desk, "--masks", desk / "masks"]
    runs = {"desk": ["rgbd_tum", desk], "desk_masks": with_masks,
            "desk_objects": known_poses(desk, desk / "masks"),
            "desk_saved": [*with_masks, "--last", 149, "--save-map", SAVED_MAP],
            "desk_loaded": [*with_masks, "--first", 150, "--load-map", SAVED_MAP]}
    if sequence is not None:
        runs |= {"rgbd": ["rgbd_tum", sequence], "mono": ["mono_tum", sequence]}
    if masks is not None:
        runs |= {f"{mode}_masks": [*runs[mode], "--masks", masks] for mode in ("rgbd", "mono")}
        runs["objects"] = known_poses(sequence, masks)
    return runs


def make_desk(work, programs):
    """Renders the synthetic desk unless it exists. Returns its path from the folder `work`."""
    desk, partial = work / "sequences" / "desk", work / "sequences" / "partial"
    if not desk.exists():
        desk.parent.mkdir(exist_ok=True)
        shutil.rmtree(partial, ignore_errors=True)
        log = desk.parent / "desk.log"
        if run_program([programs / "make_synthetic", partial, "--scene", "desk"], log) != 0:
            raise InputError(f"make_synthetic failed, see {log}")
        partial.rename(desk)
    return desk.relative_to(work)


def run_all(arguments, work):
    """The hashes of the files of all runs: {run: {file: hash}}. The programs see only paths from the
    folder `work`, so that they write the same in another one."""
    hashes, programs = {}, arguments.programs.resolve()
    runs = list_runs(make_desk(work, programs), arguments.sequence, arguments.masks)
    for name in arguments.only or runs:
        if name not in runs:
            raise InputError(f"--only is '{name}', expected some of: {', '.join(runs)}")
    for name, (program, *words) in runs.items():
        if arguments.only and name not in arguments.only:
            continue
        shutil.rmtree(work / name, ignore_errors=True)
        log = work / f"{name}.log"
        code = run_program([programs / program, *words, "--output", name, "--quiet"], log, cwd=work)
        if code == 2:
            raise InputError(f"{name}: {program} refused its input, see {log}")
        files = [work / name / file for file in HASHED] + [work / SAVED_MAP] * ("--save-map" in words)
        hashes[name] = {path.name: hash_file(path) for path in files if path.exists()}
        hashes[name]["exit code"] = str(code)
        print(f"{name}: exit code {code}, {len(hashes[name]) - 1} files", flush=True)
    return hashes


def describe_differences(before, after):
    """One line per file that differs or that only one side has."""
    for name in sorted({*before, *after}):
        if name not in before or name not in after:
            yield f"{name}: only {'before' if name in before else 'after'}"
            continue
        for file in sorted({*before[name], *after[name]}):
            if before[name].get(file) != after[name].get(file):
                yield f"{name}/{file} differs"


def read_reference(path):
    reference = read_json(path)
    if not all(isinstance(hashes, dict) for hashes in reference.values()):
        raise InputError(f"{path}: expected hashes by run and file, as `store` writes them")
    return reference


def absolute_path(text):
    return pathlib.Path(text).resolve()


def parse_arguments():
    parser = parser_of(__doc__)
    parser.add_argument("action", choices=("store", "compare"))
    parser.add_argument("reference", type=pathlib.Path, help="JSON file with the hashes")
    parser.add_argument("--sequence", type=absolute_path, help="RGB-D sequence in TUM's format")
    parser.add_argument("--masks", type=absolute_path, help="masks of this sequence")
    parser.add_argument("--programs", type=pathlib.Path, default=programs_folder(),
                        help="folder of the programs (default: build/release/bin)")
    parser.add_argument("--only", metavar="RUN", nargs="+", help="make only these runs")
    parser.add_argument("--work", type=pathlib.Path,
                        help="folder for the runs, kept (default: a temporary one)")
    arguments = parser.parse_args()
    if arguments.masks is not None and arguments.sequence is None:
        parser.error("--masks needs --sequence")
    return arguments


def execute(arguments):
    before = read_reference(arguments.reference) if arguments.action == "compare" else None
    with tempfile.TemporaryDirectory() as folder:
        work = (arguments.work or pathlib.Path(folder)).resolve()
        work.mkdir(parents=True, exist_ok=True)
        after = run_all(arguments, work)
    if before is None:
        write(arguments.reference, json.dumps(after, indent=1) + "\n")
        print(f"{len(after)} runs are stored in {arguments.reference}")
        return 0
    if arguments.only:
        before = {name: before[name] for name in arguments.only if name in before}
    differences = list(describe_differences(before, after))
    print("\n".join([*differences, f"{len(differences)} differences" if differences else "no difference"]))
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(exit_code(execute, parse_arguments(), failure=2))
