# SPDX-License-Identifier: GPL-3.0-or-later
"""The sequences of experiments: recorded ones, where they are and whether they are complete, and those
that make_synthetic renders."""

import dataclasses
import hashlib
import json
import pathlib
import re
import sys
import tempfile

from support import InputError, call, hash_file, one_line, read_json, read_text, try_read_json
from tum_and_icl import read_rows

PNG_END, JPEG_END = b"IEND\xaeB`\x82", b"\xff\xd9"
IMAGES = {".png", ".jpg", ".jpeg"}
LISTS = {"tum": [("rgb.txt", [0]), ("depth.txt", [0])],  # and which words after the stamp are paths
         "icl": [("associations.txt", [0, 2])]}
PATTERNS = {"tum": ("rgb/*", "depth/*"), "icl": ("scene_00_*",), "kitti": ("image_0/*", "image_1/*"),
            "euroc": ("mav0/cam0/data/*", "mav0/cam1/data/*")}
PAIRS = ("euroc", "kitti")  # data sets of stereo cameras
PREFIX = "rgbd_dataset_"  # of the folders of TUM RGB-D
FRAMES = 300  # of a sequence of the suite, unless --frames says otherwise
RENDERING_DIGITS = 12  # of the hash in the name of a rendering
LISTING_FRAMES = "2"  # enough to learn which sequences there are


@dataclasses.dataclass
class Sequence:
    """A sequence. The paths of a rendered one are relative to the output folder and contain {seed}."""
    name: str
    dataset: str  # tum, icl, euroc or kitti
    paper: str = None  # the sequence of the paper that it is, or whose part it plays
    folder: str = None
    masks: str = None
    objects: str = None  # file of the true objects
    note: str = ""
    modes: tuple = ("rgbd", "mono")
    frames: int = 0
    settings: str = None  # the file that a run takes; None: the run finds it
    has_rolling_shutter: bool = False
    fingerprint: str = ""  # of all that a run reads but the masks
    masks_fingerprint: str = ""
    rendered: dict = None  # the suite's folder and the options of make_synthetic; None: recorded

    def path(self, name, seed):
        """The path of folder, masks or objects for a seed; None if there is none."""
        path = getattr(self, name)
        return path.replace("{seed}", str(seed)) if self.rendered and path else path


def short_name(folder):
    """The name of the sequence in a folder, without the prefix that TUM gives to all of them."""
    name = pathlib.Path(folder).resolve().name.removeprefix(PREFIX)
    return re.sub(r"[^\w.+-]", "_", name) or "sequence"


def paper_name(name, paper_sequences):
    """The sequence of the paper with this name, such as freiburg1_desk or fr1_desk."""
    return next((paper for paper, original in paper_sequences.items()
                 if name in (original, paper, paper.replace("-", "_"))), None)


# ---- what is in a folder


def find_dataset(folder):
    """The data set by the files in the folder: tum, icl, or pairs of euroc or kitti; None for others.

    Only ICL-NUIM has associations.txt or numbered images without rgb.txt.
    """
    if (folder / "rgb.txt").is_file():
        return "tum"
    for name, mark in (("euroc", "mav0/cam1"), ("kitti", "image_1")):
        if (folder / mark).is_dir():
            return name
    if (folder / "associations.txt").is_file() or any(folder.glob("scene_00_*.png")):
        return "icl"
    return "tum" if any(path.suffix.lower() in IMAGES for path in folder.glob("rgb/*")) else None


def listed_images(folder, dataset):
    """(list, path) of each image that a list of the sequence names; without lists (folder, path)."""
    found = []
    for name, places in LISTS.get(dataset, ()):
        for _, words in read_rows(folder / name) if (folder / name).is_file() else ():
            if len(words) <= places[-1]:
                raise InputError(f"{folder / name}: expected lines: index depth index rgb")
            found += [(folder / name, folder / words[i]) for i in places]
    return found or [(folder, path) for pattern in PATTERNS[dataset] for path in sorted(folder.glob(pattern))
                     if path.suffix.lower() in IMAGES]


def is_whole(path):
    """Whether an image file ends as its format demands."""
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - 1024))
        end = file.read()
    return end.endswith(PNG_END) if path.suffix.lower() == ".png" else JPEG_END in end


def check_images(folder, dataset):
    """Refuses a sequence whose images are missing or cut short. Returns the images."""
    try:
        images = listed_images(folder, dataset)
        missing = [(source, path) for source, path in images if not path.is_file()]
        cut = [] if missing else [(source, path) for source, path in images if not is_whole(path)]
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{folder}: cannot be read: {error}") from error
    for faults, what in ((missing, "are missing"), (cut, "are cut short")):
        if faults:
            source, path = faults[0]
            raise InputError(
                f"{folder}: is not complete: {len(faults)} of the {len(images)} images of the "
                f"sequence {what}, the first one is {path.relative_to(folder)} (in {source.name}); "
                "download it again")
    return [path for _, path in images]


def find_masks(folder, wanted, name):
    """The masks of a sequence: `wanted` is a path, in which {name} is the sequence, or the name of
    an entry of the folder. Without it they are `masks`, or the only entry that begins so."""
    if wanted:
        path = pathlib.Path(wanted.replace("{name}", name))
        path = path if path.is_absolute() or "{name}" in wanted else folder / path
        if not path.exists():
            raise InputError(f"{path}: does not exist; --masks is '{wanted}'")
        return path
    found = [folder / "masks"] if (folder / "masks").exists() else sorted(folder.glob("masks*"))
    if len(found) > 1:
        raise InputError(f"{folder}: has {' and '.join(path.name for path in found)}; say by "
                         "--masks which of them to use")
    return found[0] if found else None


def settings_file(folder, dataset, config):
    """The settings that a run takes without --settings (docs/settings.md); None without any."""
    match = re.search(r"fr(?:eiburg)?([123])", folder.resolve().name)
    name = "ICL.yaml" if dataset == "icl" else f"TUM{match[1]}.yaml" if match else None
    name = {"euroc": folder / "mav0" / "cam0" / "sensor.yaml",
            "kitti": folder / "calib.txt"}.get(dataset, name and config / name)
    path = folder / "camera.yaml" if (folder / "camera.yaml").is_file() else name
    return path if path and path.is_file() else None


def has_rolling_shutter(settings):
    """Whether a settings file has a Camera.readout_time other than 0."""
    text = settings.read_text(encoding="utf-8", errors="replace")
    match = re.search(r"^\s*Camera\.readout_time\s*:\s*(\S+)", text, re.MULTILINE)
    return match is not None and float(match[1]) != 0.0


def hash_lines(lines):
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def hash_masks(path):
    """The hash of a file, or of the names and the contents of the files in a folder."""
    if path.is_file():
        return hash_file(path)
    return hash_lines(f"{file.relative_to(path)}\0{hash_file(file)}\n" for file in sorted(path.rglob("*"))
                      if file.is_file())


def fingerprint(folder, images, settings):
    """A hash of the lists, the settings, and the names and sizes of the images.

    The contents of images are not read, because those of a large sequence take minutes.
    """
    texts = sorted(path for path in folder.iterdir()
                   if path.suffix in (".txt", ".freiburg", ".yaml") and path.is_file())
    return hash_lines([*(f"{path.name}\0{hash_file(path)}\n" for path in [*texts, settings]),
                       *(f"{path.relative_to(folder)}\0{path.stat().st_size}\n" for path in images)])


# ---- recorded sequences


def read_sequence(text, masks, paper_sequences, config):
    """The sequence in a folder [tum=|icl=]FOLDER, after a check that it is complete."""
    match = re.fullmatch(r"(tum|icl)=(.*)", text, re.DOTALL)
    folder = pathlib.Path(match[2] if match else text)
    if not folder.is_dir():
        raise InputError(f"{folder}: is no folder")
    dataset = match[1] if match else find_dataset(folder)
    if dataset is None:
        raise InputError(f"{folder}: is no sequence, expected rgb.txt (TUM RGB-D) or "
                         "associations.txt (ICL-NUIM)")
    images = check_images(folder, dataset)
    if not images:
        raise InputError(f"{folder}: has no images")
    settings = settings_file(folder, dataset, config)
    if settings is None:
        raise InputError(f"{folder}: its camera is not known; put its settings into camera.yaml in "
                         "this folder (docs/settings.md)")
    name, is_pairs, objects = short_name(folder), dataset in PAIRS, folder / "groundtruth_objects.json"
    path = find_masks(folder, masks, name)
    has_depth = dataset == "icl" or (folder / "depth.txt").is_file() or (folder / "depth").is_dir()
    modes = {"rgbd": has_depth, "mono": not is_pairs, "stereo": is_pairs or (folder / "right").is_dir()}
    return Sequence(name, dataset, paper_name(name, paper_sequences), str(folder.resolve()),
                    str(path.resolve()) if path else None,
                    str(objects.resolve()) if objects.is_file() else None,
                    modes=tuple(mode for mode, is_there in modes.items() if is_there),
                    frames=len(images) // 2 if has_depth or is_pairs else len(images),
                    settings=None if is_pairs else str(settings.resolve()),
                    has_rolling_shutter=has_rolling_shutter(settings),
                    fingerprint=fingerprint(folder, images, settings),
                    masks_fingerprint=hash_masks(path) if path else "")


def find_sequences(data):
    """The folders of --data DIR that have a sequence, by name, and what has none: other folders and
    unfinished downloads."""
    if not data.is_dir():
        raise InputError(f"--data is '{data}': is no folder")
    folders = sorted(path for path in data.iterdir() if path.is_dir())
    found = [path for path in folders if find_dataset(path)]
    if not found:
        raise InputError(f"--data is '{data}': none of its {len(folders)} folders is a sequence, "
                         "expected rgb.txt (TUM RGB-D) or associations.txt (ICL-NUIM) in them")
    return found, [path for path in folders if path not in found] + sorted(data.glob("*.part"))


def read_list(path):
    """The sequences that a text file lists, one [tum=|icl=]FOLDER per line, relative to the file; #
    begins a comment."""
    found = []
    for number, line in enumerate(read_text(path).splitlines(), 1):
        dataset, equals, folder = line.split("#")[0].strip().rpartition("=")
        if folder:
            if not (path.parent / folder).is_dir():
                raise InputError(f"{path}:{number}: {path.parent / folder} is no folder")
            found.append(f"{dataset}{equals}{path.parent / folder}")
    if not found:
        raise InputError(f"{path}: lists no sequence")
    return found


def in_order(sequences, paper_sequences):
    """The sequences in the order of the paper, then the others. Each needs a name of its own."""
    known = {}
    for sequence in sequences:
        other = known.setdefault(sequence.name, sequence)
        if other is not sequence:
            raise InputError(f"{other.folder} and {sequence.folder} have the same name '{sequence.name}'")
    order = list(paper_sequences)
    return sorted(sequences, key=lambda s: order.index(s.paper) if s.paper else len(order))


# ---- rendered sequences


def call_renderer(program, options):
    """Renders a sequence or a suite. make_synthetic leaves a folder only when it is complete."""
    result = call(program, *options)
    if result.returncode != 0:
        raise InputError(f"{program} {' '.join(map(str, options))}: "
                         f"{one_line(result.stderr.strip() or 'has failed', 300)}")


def suite_file(program, cache):
    """The content of suite.json: that of the file `cache`, else from a rendering of very few frames."""
    if (known := try_read_json(cache)) is not None:
        return known
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder) / "suite"
        call_renderer(program, ["--suite", str(target), "--frames", LISTING_FRAMES, "--quiet"])
        return read_json(target / "suite.json")


def read_suite(content, paper_sequences, frames):
    """The sequences that a suite.json lists. Each is rendered by itself, for each seed."""
    found = []
    try:
        for entry in content["sequences"]:
            name, paper = entry["name"], entry["plays"]
            suite = f"sequences/{name}/seed-{{seed}}{'' if frames is None else f'-frames-{frames}'}"
            found.append(Sequence(
                name, entry["dataset"], paper if paper in paper_sequences else None,
                *(f"{suite}/{entry[key]}" for key in ("folder", "masks", "objects")),
                note=entry["special"], frames=frames or FRAMES,
                has_rolling_shutter=entry["readout_time"] != 0.0,
                rendered={"suite": suite, "options": ["--only", name, *(
                    ["--frames", str(frames)] if frames else [])]}))
    except (KeyError, TypeError, AttributeError) as error:
        reason = f"no key {error}" if isinstance(error, KeyError) else one_line(error)
        raise InputError(f"suite.json of make_synthetic: not as expected: {reason}") from error
    return found


# ---- sequences of the cases of the gate

RENDERER_SOURCES = "tools/synthetic"  # of a checkout
PROBE = ["--scene", "desk", "--frames", "2", "--seed", "0", "--fisheye", "150", "--stereo", "0.12",
         "--readout-time", "0.02", "--quiet"]


def probe_hash(program):
    """The hash of all files of a very short rendering, which feels the camera models, too. Figures of
    rendered scenes can only be made again by a renderer with the same one."""
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder) / "probe"
        call_renderer(program, [str(target), *PROBE])
        return hash_masks(target)


def renderer_hash(program):
    """A hash of the probe and of the sources of a make_synthetic in the build folder of a checkout,
    which must not be newer than the program; without sources, of the program itself."""
    folders = program.resolve().parents
    top = folders[3] if len(folders) > 3 else folders[0]
    sources = sorted((top / RENDERER_SOURCES).glob("*.cc")) + sorted((top / RENDERER_SOURCES).glob("*.h"))
    newest = max(sources, key=lambda path: path.stat().st_mtime, default=program)
    if newest.stat().st_mtime > program.stat().st_mtime:
        raise InputError(f"{program}: is older than {newest}; build it (cmake --build --preset release)")
    lines = [f"{path.name}\0{hash_file(path)}\n" for path in sources or [program]]
    return hash_lines([*lines, probe_hash(program)])


class Renderings:
    """The rendered sequences of the gate below a folder. The name of each ends with a hash of the
    renderer and of its options, so another renderer or other options never use it."""

    def __init__(self, folder, program, definitions):
        self.folder, self.program, self.definitions = folder, program, definitions
        self.renderer = None

    def options(self, case, seed):
        """The options of make_synthetic, without the folder."""
        scene = ["--only", case.sequence] if case.source == "suite" \
            else self.definitions.renderings[case.sequence]
        return [*scene, "--seed", str(seed), "--quiet"]

    def path(self, case, seed):
        self.renderer = self.renderer or renderer_hash(self.program)
        name = hash_lines(json.dumps([self.renderer, case.source, self.options(case, seed)]))
        return self.folder / f"{case.sequence}-{seed}-{name[:RENDERING_DIGITS]}"

    def make(self, cases):
        """Makes the renderings of the cases that are not there."""
        wanted = {self.path(case, seed): (case, seed) for case in cases if case.source != "recorded"
                  for seed in case.seeds}
        missing = [folder for folder in wanted if not folder.exists()]
        for index, folder in enumerate(missing, 1):
            print(f"rendering {index} of {len(missing)}: {folder}", file=sys.stderr, flush=True)
            folder.parent.mkdir(parents=True, exist_ok=True)
            target = ["--suite", folder] if wanted[folder][0].source == "suite" else [folder]
            call_renderer(self.program, [*target, *self.options(*wanted[folder])])


def find_sequence(case, seed, data, renderings, config):
    """The sequence of a case; None if a recorded one is absent."""
    if case.source == "recorded":
        folder = data / case.sequence
        return read_sequence(str(folder), None, {}, config) if folder.is_dir() else None
    top, name = renderings.path(case, seed), f"{case.sequence}-{seed}"
    if case.source == "rendering":
        return dataclasses.replace(read_sequence(str(top), None, {}, config), name=name)
    entry = next((entry for entry in read_json(top / "suite.json").get("sequences", [])
                  if entry["name"] == case.sequence), None)
    if entry is None:
        raise InputError(f"{top}: has no sequence {case.sequence}")
    sequence = read_sequence(f"{entry['dataset']}={top / entry['folder']}",
                             str((top / entry["masks"]).resolve()), {}, config)
    return dataclasses.replace(sequence, name=name, objects=str((top / entry["objects"]).resolve()))
