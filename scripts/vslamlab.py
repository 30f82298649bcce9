#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs HullSLAM as a baseline of VSLAM-LAB (docs/benchmarks.md). The names of its links,
vslamlab_hullslam_mono, vslamlab_hullslam_rgbd and vslamlab_hullslam_stereo, choose the mode.

Usage: vslamlab_hullslam_rgbd KEY:VALUE...

Writes the lists of images and the cameras as a sequence that mono_tum, rgbd_tum or stereo_euroc reads into
EXP_FOLDER/EXP_ID_hullslam_input and starts this program, which writes all results into
EXP_FOLDER/EXP_ID_hullslam. Writes the keyframes as EXP_FOLDER/EXP_ID_KeyFrameTrajectory.csv.
Exit codes: 0 done, 1 the run failed, 2 bad usage or input.
"""

import bisect
import csv
import json
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
    "settings_yaml": "settings of HullSLAM, and cam_mono, cam_rgbd (rgb_0) or cam_stereo (rgb_0 and rgb_1)",
    "verbose": "0: print only errors (1)",
    "mode": "mono, rgbd or stereo, the mode of the program",
    "masks": "masks of the images, as --masks of the other programs",
    "preset": "as --preset of the other programs",
    "seed": "of the random numbers (0)",
}
PROGRAMS = {"mono": "mono_tum", "rgbd": "rgbd_tum", "stereo": "stereo_euroc"}
# The models of VSLAM-LAB: their names in a sensor.yaml, and how many coefficients they have.
LENSES = {"pinhole": ("radial-tangential", 0), "radtan4": ("radial-tangential", 4),
          "radtan5": ("radial-tangential", 5), "equid4": ("equidistant", 4)}


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
        raise InputError(f"mode is '{values['mode']}', expected '{mode}' (the other modes have programs "
                         "of their own)")
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


class Camera:
    """A camera of a calibration.yaml."""

    def __init__(self, path, name, has_pose):
        entries = read_yaml(path, "a calibration.yaml of VSLAM-LAB with a list 'cameras'").get("cameras")
        if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
            raise InputError(f"{path}: expected a list 'cameras'")
        found = [entry for entry in entries if entry.get("cam_name") == name]
        if not found:
            names = ", ".join(str(entry.get("cam_name")) for entry in entries)
            raise InputError(f"{path}: has no camera '{name}', expected one of: {names}")
        self.entry, self.where = found[0], f"{path}: camera '{name}'"
        fx, fy = self.numbers("focal_length", 2)
        # A negative fy (ICL-NUIM) means a left-handed world.
        self.is_mirrored = fy < 0.0
        model = self.entry.get("distortion_type", self.entry.get("cam_model"))
        if model not in LENSES:
            raise InputError(f"{self.where}: cam_model is '{model}', expected one of: {', '.join(LENSES)}; "
                             "HullSLAM has no other model")
        lens, count = LENSES[model]
        self.sensor = {"camera_model": "pinhole",
                       "intrinsics": [fx, abs(fy), *self.numbers("principal_point", 2)],
                       "resolution": self.numbers("image_dimension", 2),
                       "rate_hz": self.numbers("fps", 1)[0],
                       "distortion_model": lens,
                       "distortion_coefficients":
                           self.numbers("distortion_coefficients", count) if count else [0.0] * 4}
        if has_pose:  # of the camera on the body; VSLAM-LAB has renamed its key
            key = "T_SC" if "T_SC" in self.entry else "T_BS"
            self.sensor["T_BS"] = {"cols": 4, "rows": 4, "data": self.numbers(key, 16)}

    def numbers(self, key, count):
        """The list of `count` numbers of a key; a single number is not in a list."""
        found = self.entry.get(key)
        words = found if isinstance(found, list) else [found]
        try:
            values = [float(word) for word in words]
        except (TypeError, ValueError):
            values = []
        if len(values) != count or not all(map(math.isfinite, values)):
            raise InputError(f"{self.where}: {key} is '{found}', expected {count} number{'s' * (count > 1)}")
        return values

    def depth(self):
        """The name of the depth images, and their units per metre."""
        if not self.entry.get("depth_name"):
            raise InputError(f"{self.where} has no depth_name, expected one for RGB-D")
        return self.entry["depth_name"], self.numbers("depth_factor", 1)[0]


def read_images(path, folder, names):
    """The rows of a rgb.csv: the stamp (ns) of the first of the cameras `names`, and the path of an image
    of each."""
    rows = csv.DictReader(read_text(path).lstrip("\ufeff").splitlines(), skipinitialspace=True)
    rows.fieldnames = [cell.strip() for cell in rows.fieldnames or ()]
    columns = [column for name in names for column in (f"ts_{name} (ns)", f"path_{name}")]
    for column in columns:
        if column not in rows.fieldnames:
            raise InputError(f"{path}:1: has no column '{column}', expected one of: "
                             f"{', '.join(rows.fieldnames)}")
    images = []
    for row in rows:
        where = f"{path}:{rows.line_num}"
        if None in row or None in row.values():
            raise InputError(f"{where}: other columns than those of the first line")
        cells = [row[column].strip() for column in columns]
        for stamp, image in zip(cells[::2], cells[1::2]):
            if not stamp.isdecimal():
                raise InputError(f"{where}: the time stamp is '{stamp}', expected nanoseconds")
            if not (folder / image).is_file() or any(map(str.isspace, image)):
                raise InputError(f"{where}: {folder / image}: expected a file, with a name without blanks")
        images.append((int(cells[0]), cells[1::2]))
    return images


def format_keyframes(path, stamps, is_mirrored):
    """keyframes.txt in the format of VSLAM-LAB. The stamps are those of the list, exactly."""
    y = -1.0 if is_mirrored else 1.0
    lines = ["ts (ns),tx (m),ty (m),tz (m),qx,qy,qz,qw"]
    for stamp, pose in zip(*read_trajectory(path)):
        at = bisect.bisect_left(stamps, stamp * 1e9)
        nearest = min(stamps[max(0, at - 1):at + 1], key=lambda known: abs(known - stamp * 1e9))
        lines.append(",".join([str(nearest), *(f"{value:.9f}" for value in pose * (1, y, 1, y, 1, y, 1))]))
    return "\n".join([*lines, ""])


class Run:
    """A run of VSLAM-LAB: its input, and where its results are."""

    def __init__(self, mode, values):
        self.mode, self.values = mode, values
        paths = {key: pathlib.Path(values.get(key, "")) for key in [*NEEDED, "settings_yaml"]}
        self.sequence, self.calibration = paths["sequence_path"], paths["calibration_yaml"]
        self.folder, self.name = paths["exp_folder"], values["exp_id"]
        self.settings = {}
        if "settings_yaml" in values:
            self.settings = read_yaml(paths["settings_yaml"], "settings, one 'key: value' per line")
        names = self.settings.get(f"cam_{mode}", ["rgb_0", "rgb_1"] if mode == "stereo" else "rgb_0")
        names = names if isinstance(names, list) else [names]
        if len(names) != (2 if mode == "stereo" else 1):
            raise InputError(f"{paths['settings_yaml']}: cam_{mode} is '{names}', expected "
                             f"{'the left and the right' if mode == 'stereo' else 'one'} camera")
        self.cameras = [Camera(self.calibration, name, mode == "stereo") for name in names]
        self.overrides = [f"{key}={value}" for key, value in self.settings.items()
                          if not key.startswith("cam_")]
        if mode == "rgbd":
            depth, factor = self.cameras[0].depth()
            names = [*names, depth]
            self.overrides.insert(0, f"DepthMapFactor={factor}")
        self.images = read_images(paths["rgb_csv"], self.sequence, names)
        self.input = self.folder / f"{self.name}_hullslam_input"
        self.output = self.folder / f"{self.name}_hullslam"
        # VSLAM-LAB gives the number of the run, and since 2025 it looks for a name with five digits.
        names = {self.name, self.name.zfill(5) if self.name.isdecimal() else self.name}
        self.results = [self.folder / f"{name}_KeyFrameTrajectory.csv" for name in sorted(names)]

    def write_input(self):
        """Writes the lists. All images of a row get the same stamp, so that they are found as pairs."""
        for i, camera in enumerate(self.cameras):
            folder = self.input / "mav0" / f"cam{i}" if self.mode == "stereo" else self.input
            folder.mkdir(parents=True, exist_ok=True)
            images = folder / "data"  # a link, since the path of the sequence may have blanks
            images.unlink(missing_ok=True)
            images.symlink_to(self.sequence.resolve())
            write(folder / "sensor.yaml", json.dumps(camera.sensor))
            if self.mode == "stereo":
                write(folder / "data.csv", "".join(f"{stamp},{row[i]}\n" for stamp, row in self.images))
        for i, kind in enumerate({"mono": ["rgb"], "rgbd": ["rgb", "depth"]}.get(self.mode, [])):
            write(self.input / f"{kind}.txt",
                  "".join(f"{stamp // 10**9}.{stamp % 10**9:09} {pathlib.Path('data', row[i])}\n"
                          for stamp, row in self.images))

    def command(self):
        words = [programs_folder() / PROGRAMS[self.mode], self.input, "--output", self.output,
                 "--seed", self.values["seed"]]
        if self.mode != "stereo":
            words += ["--settings", self.input / "sensor.yaml"]
        for key in ("masks", "preset"):
            words += [f"--{key}", self.values[key]] if key in self.values else []
        for override in self.overrides:
            words += ["--set", override]
        return words + ["--quiet"] * (self.values["verbose"] == "0")


def run(mode, words):
    require("numpy", "yaml")
    job = Run(mode, parse_values(words, mode))
    made = [folder for folder in (job.folder, *job.folder.parents) if not folder.exists()]
    for result in job.results:
        result.unlink(missing_ok=True)  # a run that fails must not leave an older result
    job.write_input()
    code = subprocess.run(job.command(), check=False).returncode
    if code == 0:
        stamps, is_mirrored = sorted(stamp for stamp, _ in job.images), job.cameras[0].is_mirrored
        for result in job.results:
            write(result, format_keyframes(job.output / "keyframes.txt", stamps, is_mirrored))
    elif not job.output.exists():  # it was refused, so that nothing is left of it
        print(f"error: the sequence {job.input} was made from {job.values['rgb_csv']} and {job.calibration}",
              file=sys.stderr)
        shutil.rmtree(job.input)
        for folder in made:
            folder.rmdir()
    return code if code >= 0 else 1  # 1: ended by a signal


def main(words=None, program=None):
    words = sys.argv[1:] if words is None else words
    name = pathlib.Path(program or sys.argv[0]).name
    mode = next((mode for mode in PROGRAMS if mode in name), "rgbd")
    if not words or "--help" in words or "-h" in words:
        print(__doc__.strip() + "\n\nKeys:")
        for key, meaning in {**NEEDED, **OPTIONAL}.items():
            print(f"  {key + ':':18}{meaning}{'' if key in NEEDED else ' [optional]'}")
        return 0 if words else 2
    return exit_code(lambda given: run(mode, given), words)


if __name__ == "__main__":
    sys.exit(main())
