#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs HullSLAM as a baseline of VSLAM-LAB (docs/benchmarks.md). The names of its links,
vslamlab_hullslam_mono and vslamlab_hullslam_rgbd, choose the mode.

Usage: vslamlab_hullslam_rgbd KEY:VALUE...

Writes the lists of images and the camera in TUM's format into EXP_FOLDER/EXP_ID_hullslam_input, starts
rgbd_tum or mono_tum, which writes all results into EXP_FOLDER/EXP_ID_hullslam, and writes the keyframes as
EXP_FOLDER/EXP_ID_KeyFrameTrajectory.csv. Exit codes: 0 done, 1 the run failed, 2 bad usage or input.
"""

import bisect
import csv
import math
import pathlib
import shutil
import subprocess
import sys

from support import InputError, exit_code, programs_folder, read_text, read_trajectory, require, write

NEEDED = {
    "sequence_path": "folder of the sequence",
    "calibration_yaml": "its calibration",
    "rgb_csv": "list of its images, relative to sequence_path",
    "exp_folder": "folder for the results",
    "exp_id": "name of the run, which the names of its files begin with",
}
OPTIONAL = {
    "settings_yaml": "settings of HullSLAM, and cam_mono or cam_rgbd (rgb_0)",
    "verbose": "0: print only errors (1)",
    "mode": "mono or rgbd, the mode of the program",
    "masks": "masks of the images, as --masks of rgbd_tum",
    "preset": "as --preset of rgbd_tum",
    "seed": "of the random numbers (0)",
}
LENSES = {"pinhole": [], "radtan4": ["k1", "k2", "p1", "p2"],
          "radtan5": ["k1", "k2", "p1", "p2", "k3"]}


def parse_values(words, mode):
    values = {"mode": mode, "verbose": "1", "seed": "0"}
    for word in words:
        key, colon, value = word.partition(":")
        if not colon or key not in {**NEEDED, **OPTIONAL}:
            raise InputError(f"'{word}': expected key:value with one of the keys: "
                             f"{', '.join([*NEEDED, *OPTIONAL])}")
        if value:
            values[key] = value
    for key, meaning in NEEDED.items():
        if key not in values:
            raise InputError(f"{key}: is not given, expected {key}:VALUE, {meaning}")
    if values["mode"] != mode:
        raise InputError(f"mode is '{values['mode']}', expected '{mode}' (the other mode has a program of "
                         "its own)")
    if values["verbose"] not in ("0", "1"):
        raise InputError(f"verbose is '{values['verbose']}', expected 0 or 1")
    if "/" in values["exp_id"]:
        raise InputError(f"exp_id is '{values['exp_id']}', expected a name without '/'")
    return values


def read_yaml(path, expected):
    """The map in a YAML file, with texts as values. OpenCV's first line %YAML:1.0 is no YAML."""
    import yaml
    text = read_text(path)
    if text.startswith("%YAML"):
        text = "#" + text
    try:
        content = yaml.load(text, Loader=yaml.BaseLoader)
    except yaml.YAMLError as error:
        raise InputError(f"{path}: not valid YAML: {' '.join(str(error).split())}") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected {expected}")
    return content


def numbers(where, entry, key, count):
    """The list of `count` numbers of a key; a single number is not in a list."""
    found = entry.get(key)
    words = found if isinstance(found, list) else [found]
    try:
        values = [float(word) for word in words]
    except (TypeError, ValueError):
        values = []
    if len(values) != count or not all(map(math.isfinite, values)):
        raise InputError(f"{where}: {key} is '{found}', expected {count} number{'s' * (count > 1)}")
    return values


class Camera:
    """A camera of a calibration.yaml."""

    def __init__(self, path, name):
        entries = read_yaml(path, "a calibration.yaml of VSLAM-LAB with a list 'cameras'").get("cameras")
        if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
            raise InputError(f"{path}: expected a list 'cameras'")
        found = [entry for entry in entries if entry.get("cam_name") == name]
        if not found:
            names = ", ".join(str(entry.get("cam_name")) for entry in entries)
            raise InputError(f"{path}: has no camera '{name}', expected one of: {names}")
        entry, where = found[0], f"{path}: camera '{name}'"
        fx, fy = numbers(where, entry, "focal_length", 2)
        cx, cy = numbers(where, entry, "principal_point", 2)
        width, height = numbers(where, entry, "image_dimension", 2)
        # A negative fy (ICL-NUIM) means a left-handed world.
        self.is_mirrored = fy < 0.0
        self.settings = {"fx": fx, "fy": abs(fy), "cx": cx, "cy": cy,
                         "width": int(width), "height": int(height), "fps": numbers(where, entry, "fps", 1)[0]}
        model = entry.get("distortion_type", entry.get("cam_model"))
        if model not in LENSES:
            raise InputError(f"{where}: cam_model is '{model}', expected one of: {', '.join(LENSES)}; HullSLAM "
                             "has no other model")
        if lens := LENSES[model]:
            self.settings |= zip(lens, numbers(where, entry, "distortion_coefficients", len(lens)))
        self.depth_name = entry.get("depth_name")
        self.depth_factor = numbers(where, entry, "depth_factor", 1)[0] if self.depth_name else None

    def format(self):
        lines = [f"Camera.{key}: {value!r}" for key, value in self.settings.items()]
        if self.depth_factor:
            lines.append(f"DepthMapFactor: {self.depth_factor!r}")
        return "\n".join([*lines, ""])


def read_images(path, folder, name):
    """The stamps (ns) and paths of the images `name` in a rgb.csv."""
    rows = list(csv.reader(read_text(path).splitlines(), skipinitialspace=True))
    header = [cell.strip() for cell in rows[0]] if rows else []
    columns = []
    for column in (f"ts_{name} (ns)", f"path_{name}"):
        if column not in header:
            raise InputError(f"{path}:1: has no column '{column}', expected one of: {', '.join(header)}")
        columns.append(header.index(column))
    images = []
    for line, row in enumerate(rows[1:], 2):
        if not row:
            continue
        if len(row) != len(header):
            raise InputError(f"{path}:{line}: {len(row)} columns, expected those of the first line")
        stamp, image = (row[column].strip() for column in columns)
        if not stamp.isdecimal():
            raise InputError(f"{path}:{line}: the time stamp is '{stamp}', expected nanoseconds")
        image = (folder / image).resolve()
        if not image.is_file() or any(map(str.isspace, str(image))):
            raise InputError(f"{path}:{line}: {image}: expected a file whose path has no blanks")
        images.append((int(stamp), image))
    return images


def format_list(images):
    return "".join(f"{stamp // 10**9}.{stamp % 10**9:09} {image}\n" for stamp, image in images)


def format_keyframes(path, stamps, is_mirrored):
    """keyframes.txt in the format of VSLAM-LAB. The stamps are those of the list, exactly."""
    y = -1.0 if is_mirrored else 1.0
    lines = ["ts (ns),tx (m),ty (m),tz (m),qx,qy,qz,qw"]
    for stamp, pose in zip(*read_trajectory(path)):
        at = bisect.bisect_left(stamps, stamp * 1e9)
        nearest = min(stamps[max(0, at - 1):at + 1], key=lambda known: abs(known - stamp * 1e9))
        pose = [value * sign for value, sign in zip(pose, (1.0, y, 1.0, y, 1.0, y, 1.0))]
        lines.append(",".join([str(nearest), *(f"{value:.9f}" for value in pose)]))
    return "\n".join([*lines, ""])


class Run:
    """A run of VSLAM-LAB: its input, and where its results are."""

    def __init__(self, mode, values):
        self.mode, self.values = mode, values
        paths = {key: pathlib.Path(values.get(key, "")) for key in [*NEEDED, "settings_yaml"]}
        self.folder, self.name = paths["exp_folder"], values["exp_id"]
        self.settings = {}
        if "settings_yaml" in values:
            self.settings = read_yaml(paths["settings_yaml"], "settings, one 'key: value' per line")
        camera = self.settings.get(f"cam_{mode}", "rgb_0")
        self.camera = Camera(paths["calibration_yaml"], camera)
        lists = {"rgb": camera}
        if mode == "rgbd":
            lists["depth"] = self.camera.depth_name
            if not lists["depth"]:
                raise InputError(f"{paths['calibration_yaml']}: the camera '{camera}' has no depth_name, "
                                 "expected one for RGB-D")
        self.images = {kind: read_images(paths["rgb_csv"], paths["sequence_path"], name)
                       for kind, name in lists.items()}
        self.input = self.folder / f"{self.name}_hullslam_input"
        self.output = self.folder / f"{self.name}_hullslam"

    def results(self):
        """VSLAM-LAB gives the number of the run, and since 2025 it looks for a name with five digits."""
        names = {self.name, self.name.zfill(5) if self.name.isdecimal() else self.name}
        return [self.folder / f"{name}_KeyFrameTrajectory.csv" for name in sorted(names)]

    def write_input(self):
        self.input.mkdir(parents=True, exist_ok=True)
        for kind, images in self.images.items():
            write(self.input / f"{kind}.txt", format_list(images))
        write(self.input / "camera.yaml", self.camera.format())

    def command(self):
        words = [programs_folder() / f"{self.mode}_tum", self.input, "--output", self.output,
                 "--settings", self.input / "camera.yaml", "--seed", self.values["seed"]]
        for key in ("masks", "preset"):
            if key in self.values:
                words += [f"--{key}", self.values[key]]
        for key, value in self.settings.items():
            if not key.startswith("cam_"):
                words += ["--set", f"{key}={value}"]
        return words + ["--quiet"] * (self.values["verbose"] == "0")

    def write_results(self):
        stamps = sorted(stamp for stamp, _ in self.images["rgb"])
        text = format_keyframes(self.output / "keyframes.txt", stamps, self.camera.is_mirrored)
        for result in self.results():
            write(result, text)


def run(mode, words):
    require("numpy", "yaml")
    job = Run(mode, parse_values(words, mode))
    made = [folder for folder in (job.folder, *job.folder.parents) if not folder.exists()]
    for result in job.results():
        result.unlink(missing_ok=True)  # a run that fails must not leave an older result
    job.write_input()
    code = subprocess.run(job.command(), check=False).returncode
    if code == 0:
        job.write_results()
    elif not job.output.exists():  # it was refused, so that nothing is left of it
        shutil.rmtree(job.input)
        for folder in made:
            folder.rmdir()
    return code


def main(words=None, program=None):
    words = sys.argv[1:] if words is None else words
    mode = "mono" if "mono" in pathlib.Path(program or sys.argv[0]).name else "rgbd"
    if not words or "--help" in words or "-h" in words:
        print(__doc__.strip() + "\n\nKeys:")
        for key, meaning in {**NEEDED, **OPTIONAL}.items():
            print(f"  {key + ':':18}{meaning}{'' if key in NEEDED else ' [optional]'}")
        return 0 if words else 2
    return exit_code(lambda given: run(mode, given), words)


if __name__ == "__main__":
    sys.exit(main())
