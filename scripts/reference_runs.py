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

import hashlib
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

from support import exit_code, InputError, parser_of, programs_folder, read_json

HASHED = ("trajectory.txt", "keyframes.txt", "map.ply", "objects.json", "saved.map")


def known_pose_run(folder, masks):
    return ["hullslam", "map-objects", folder, "--poses", folder / "groundtruth.txt", "--masks", masks]


def list_runs(desk, sequence, masks, saved_map):
    """The command of each run by its name, without --output. A later run may need an earlier one."""
    runs = {
        "desk": ["rgbd_tum", desk],
        "desk_masks": ["rgbd_tum", desk, "--masks", desk / "masks"],
        "desk_objects": known_pose_run(desk, desk / "masks"),
        "desk_saved": ["rgbd_tum", desk, "--masks", desk / "masks", "--last", 149, "--save-map",
                       saved_map],
        "desk_loaded": ["rgbd_tum", desk, "--masks", desk / "masks", "--first", 150, "--load-map",
                        saved_map],
    }
    if sequence is not None:
        runs["rgbd"] = ["rgbd_tum", sequence]
        runs["mono"] = ["mono_tum", sequence]
    if sequence is not None and masks is not None:
        runs["rgbd_masks"] = ["rgbd_tum", sequence, "--masks", masks]
        runs["mono_masks"] = ["mono_tum", sequence, "--masks", masks]
        runs["objects"] = known_pose_run(sequence, masks)
    return runs


def run_program(command, program_folder, log):
    """Runs one program. Its messages go to the file `log`."""
    arguments = [str(program_folder / command[0]), *map(str, command[1:])]
    with open(log, "w", encoding="utf-8") as messages:
        try:
            code = subprocess.run(arguments, stdout=messages, stderr=messages, check=False).returncode
        except OSError as error:
            raise InputError(f"cannot run {arguments[0]}: {error.strerror}") from error
    return code


def hash_file(path, work):
    """The hash of a file's content. It does not depend on the path of the folder of the runs."""
    content = path.read_bytes().replace(str(work).encode(), b"WORK")
    return hashlib.sha256(content).hexdigest()


def make_desk(folder, program_folder):
    """The synthetic desk in `folder`. It is rendered unless it exists."""
    desk = folder / "sequences" / "desk"
    if not desk.exists():
        desk.parent.mkdir(exist_ok=True)
        partial = desk.parent / "partial"
        shutil.rmtree(partial, ignore_errors=True)
        log = desk.parent / "desk.log"
        if run_program(["make_synthetic", partial, "--scene", "desk"], program_folder, log) != 0:
            raise InputError(f"make_synthetic failed, see {log}")
        partial.rename(desk)
    return desk


def run_all(arguments, work):
    """The hashes of the files of all runs: {run: {file: hash}}."""
    desk = make_desk(work, arguments.programs)
    saved_map = work / "saved.map"
    hashes = {}
    runs = list_runs(desk, arguments.sequence, arguments.masks, saved_map)
    for name in arguments.only or ():
        if name not in runs:
            raise InputError(f"--only is '{name}', expected some of: {', '.join(runs)}")
    for name, command in runs.items():
        if arguments.only and name not in arguments.only:
            continue
        output = work / name
        shutil.rmtree(output, ignore_errors=True)
        log = work / f"{name}.log"
        code = run_program([*command, "--output", output, "--quiet"], arguments.programs, log)
        if code == 2:
            raise InputError(f"{name}: {command[0]} refused its input, see {log}")
        files = {file: output / file for file in HASHED}
        files["saved.map"] = saved_map if "--save-map" in command else output / "saved.map"
        hashes[name] = {file: hash_file(path, work)
                        for file, path in files.items() if path.exists()}
        hashes[name]["exit code"] = str(code)
        print(f"{name}: exit code {code}, {len(hashes[name]) - 1} files", flush=True)
    return hashes


def describe_differences(before, after):
    """One line per file that differs or that only one side has."""
    lines = []
    for name in sorted({*before, *after}):
        if name not in before or name not in after:
            lines.append(f"{name}: only {'before' if name in before else 'after'}")
            continue
        files = sorted({*before[name], *after[name]})
        lines += [f"{name}/{file} differs" for file in files
                  if before[name].get(file) != after[name].get(file)]
    return lines


def read_reference(path):
    reference = read_json(path)
    if not all(isinstance(hashes, dict) for hashes in reference.values()):
        raise InputError(f"{path}: expected hashes by run and file, as `store` writes them")
    return reference


def parse_arguments():
    parser = parser_of(__doc__)
    parser.add_argument("action", choices=("store", "compare"))
    parser.add_argument("reference", type=pathlib.Path, help="JSON file with the hashes")
    parser.add_argument("--sequence", type=pathlib.Path, help="RGB-D sequence in TUM's format")
    parser.add_argument("--masks", type=pathlib.Path, help="masks of this sequence")
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
    if arguments.work is not None:
        arguments.work.mkdir(parents=True, exist_ok=True)
        after = run_all(arguments, arguments.work)
    else:
        with tempfile.TemporaryDirectory() as folder:
            after = run_all(arguments, pathlib.Path(folder))
    if before is None:
        arguments.reference.write_text(json.dumps(after, indent=1) + "\n", encoding="utf-8")
        print(f"{len(after)} runs are stored in {arguments.reference}")
        return 0
    if arguments.only:
        before = {name: before[name] for name in arguments.only if name in before}
    differences = describe_differences(before, after)
    for line in differences:
        print(line)
    print("no difference" if not differences else f"{len(differences)} differences")
    return 1 if differences else 0


def main():
    return exit_code(execute, parse_arguments(), failure=2)


if __name__ == "__main__":
    sys.exit(main())
