# SPDX-License-Identifier: GPL-3.0-or-later
"""Replacements of the programs of HullSLAM for tests of scripts: they take the same arguments and
write the same files, but compute nothing. Sequences of a few images for them."""

import json
import pathlib
import struct
import zlib

# A run. Its ATE is 10 mm plus 1 mm per seed, twice that with objects.residual=bad, and three times
# that if it behaves "worse". It writes its
# arguments to the file `calls` beside the program, and behaves as `behaviour` there demands.
SLAM = r"""#!/usr/bin/python3
import json, os, pathlib, sys, time
here, arguments = pathlib.Path(__file__).resolve().parent, sys.argv[1:]
value = lambda name, other=None: arguments[arguments.index(name) + 1] if name in arguments else other
behaviour = (here / "behaviour").read_text().split() if (here / "behaviour").exists() else []
with (here / "calls").open("a") as calls:
    calls.write(" ".join([pathlib.Path(__file__).name, *arguments]) + "\n")
out, seed = pathlib.Path(value("--output")), int(value("--seed"))
if "slow" in behaviour:
    time.sleep(0.3)
if "wait" in behaviour:
    (here / f"began-{os.getpid()}").touch()
    time.sleep(600)
if "refuse" in behaviour:
    print("error: camera.yaml:3: Camera.fx is 'x', expected a number", file=sys.stderr)
    sys.exit(2)
if "abort" in behaviour:
    os.abort()
sequence = pathlib.Path(arguments[0])
if not sequence.is_dir() or ("--masks" in arguments and not pathlib.Path(value("--masks")).exists()):
    print(f"error: {sequence} is no sequence", file=sys.stderr)
    sys.exit(2)
out.mkdir(parents=True)
lost = "lost" in behaviour and seed == 0
bad = "objects.residual=bad" in arguments
error = (0.010 + 0.001 * seed) * (2 if bad else 1) * (3 if "worse" in behaviour else 1) * (1.5 if "mono" in __file__ else 1)
lines = "".join(f"{1 + 0.1 * i:.6f} {0.1 * i + (error if i % 2 else -error):.9f} {0.01 * i * i:.9f} 0 0 0 0 1\n"
                for i in range(20))
if "fill" in behaviour:
    lines *= 20000
for name in ("trajectory.txt", "keyframes.txt"):
    (out / name).write_text("" if lost else lines)
if "icl" in __file__:
    (out / "groundtruth.txt").write_text("".join(
        f"{1 + 0.1 * i:.6f} {0.1 * i:.9f} {0.01 * i * i:.9f} 0 0 0 0 1\n" for i in range(20)))
objects = None
if "--masks" in arguments and "objects.enabled=false" not in arguments:
    objects = {"count": 6, "siou_mean": 0.6 if bad else 0.8, "siou_mask_mean": 0.7,
               "mtd_mean_m2": 1e-3}
(out / "summary.json").write_text(json.dumps({
    "trajectory": {"ate_rmse_m": error, "tracked": 0 if lost else 20, "frames": 20},
    "objects": objects, "map": {"keyframes": 5, "loops": 0},
    "provenance": {"git": (here / "git").read_text() if (here / "git").exists() else "abc1234", "preset": value("--preset"), "settings_hash": "0",
                   "interrupted": False}}))
if lost:
    print("error: no map could be made from 20 frames", file=sys.stderr)
    sys.exit(1)
"""

# `hullslam evaluate`: the error is that which a run has written into its trajectory.
EVALUATE = r"""#!/usr/bin/python3
import json, pathlib, sys
arguments = sys.argv[2:]
if arguments[0] == "trajectory":
    lines = pathlib.Path(arguments[2]).read_text().split("\n")
    if len(lines) < 2:
        print("error: has no poses", file=sys.stderr)
        sys.exit(2)
    error = -float(lines[0].split()[1])
    align = arguments[arguments.index("--align") + 1]
    print(json.dumps({"ate_m": {"rmse": error * (0.9 if align == "sim3" else 1.0)}, "scale": 2.0}))
else:
    print(json.dumps({"groundtruth": {"visible": 8, "once": 5, "more": 1, "each": [
        {"mapped": [{"center_share": 0.1}]}, {"mapped": []}, {"mapped": [{"center_share": 0.3}]}]}}
        if "--truth" not in arguments else {"truth": {"boxes": {"25": {"ap": 0.6, "ar": 0.7}}, "errors": {
            "center_m": 0.02, "axes_median": 0.1}}}))
"""

# `make_synthetic FOLDER`, and with --suite two sequences, one of each data set.
MAKE_SYNTHETIC = r"""#!/usr/bin/python3
import json, pathlib, sys
here, arguments = pathlib.Path(__file__).resolve().parent, sys.argv[1:]
value = lambda name, other=None: arguments[arguments.index(name) + 1] if name in arguments else other
with (here / "renderings").open("a") as calls:
    calls.write(" ".join(arguments) + "\n")
sys.path.insert(0, FOLDER)
import fake_slam
if "--suite" not in arguments:
    fake_slam.write_tum(pathlib.Path(arguments[0]))
    sys.exit()
out, only = pathlib.Path(value("--suite")), value("--only")
entries = []
for name, dataset, plays in (("desk1", "tum", "fr1-desk"), ("icl0", "icl", "office-traj0")):
    if only in (None, name):
        (out / name).mkdir(parents=True)
        (fake_slam.write_tum if dataset == "tum" else fake_slam.write_icl)(out / name)
        entries.append({"name": name, "folder": name, "dataset": dataset, "masks": f"{name}/masks",
                        "objects": f"{name}/groundtruth_objects.json", "plays": plays,
                        "readout_time": 0.0, "special": "a desk"})
(out / "suite.json").write_text(json.dumps({"sequences": entries}))
"""


def png(value):
    """A grey image of 4 x 4 pixels."""
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    rows = (b"\0" + bytes([value] * 4)) * 4
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 4, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_masks(folder, names):
    (folder / "masks").mkdir()
    for name in names:
        (folder / "masks" / f"{name}.txt").write_text("41 0.1 0.1 0.5 0.1 0.5 0.5 0.9\n")


def write_truth(folder):
    (folder / "groundtruth.txt").write_text("".join(
        f"{1 + 0.1 * i:.6f} {0.1 * i:.9f} {0.01 * i * i:.9f} 0 0 0 0 1\n" for i in range(20)))
    (folder / "groundtruth_objects.json").write_text('{"objects": []}')


def write_tum(folder, count=20, with_depth=True):
    """A sequence in TUM's format, with masks and true objects."""
    folder.mkdir(parents=True, exist_ok=True)
    stamps = [f"{1 + 0.1 * i:.6f}" for i in range(count)]
    for kind in ("rgb", "depth") if with_depth else ("rgb",):
        (folder / kind).mkdir()
        for index, stamp in enumerate(stamps):
            (folder / kind / f"{stamp}.png").write_bytes(png(index))
        (folder / f"{kind}.txt").write_text(
            "# list\n" + "".join(f"{stamp} {kind}/{stamp}.png\n" for stamp in stamps))
    (folder / "camera.yaml").write_text("%YAML:1.0\nCamera.fx: 500\n")
    write_masks(folder, stamps)
    write_truth(folder)
    return folder


def write_icl(folder, count=20):
    """A sequence in the layout of ICL-NUIM's package of PNG images."""
    folder.mkdir(parents=True, exist_ok=True)
    for kind in ("rgb", "depth"):
        (folder / kind).mkdir()
        for index in range(count):
            (folder / kind / f"{index}.png").write_bytes(png(index))
    (folder / "associations.txt").write_text("".join(
        f"{i} depth/{i}.png {i} rgb/{i}.png\n" for i in range(count)))
    (folder / "traj0.gt.freiburg").write_text("1 0 0 0 0 0 0 1\n")
    write_masks(folder, range(count))
    write_truth(folder)
    (folder / "groundtruth.txt").unlink()
    return folder


def write_programs(folder):
    """The replacements of all programs that scripts/reproduce_tables.py starts."""
    folder.mkdir(parents=True)
    renderer = MAKE_SYNTHETIC.replace("FOLDER", json.dumps(str(pathlib.Path(__file__).parent)))
    for name, text in (("rgbd_tum", SLAM), ("stereo_folder", SLAM), ("mono_tum", SLAM), ("rgbd_icl", SLAM),
                       ("mono_icl", SLAM), ("hullslam", EVALUATE),
                       ("make_synthetic", renderer)):
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)
    return folder
