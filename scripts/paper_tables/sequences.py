# SPDX-License-Identifier: GPL-3.0-or-later
"""The recorded sequences that the user has: where they are, and whether they are complete."""

import dataclasses
import hashlib
import pathlib
import re

from leave_and_return import read_rows
from run_errors import InputError
from run_statistics import hash_file

PNG_END, JPEG_END = b"IEND\xaeB`\x82", b"\xff\xd9"
IMAGES = {".png", ".jpg", ".jpeg"}
PREFIX = "rgbd_dataset_"  # of the folders of TUM RGB-D


@dataclasses.dataclass
class Sequence:
    """A sequence. The paths of a rendered one are relative to the output folder and contain
    {seed}."""
    name: str
    dataset: str  # tum or icl
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
    for paper, original in paper_sequences.items():
        if name in (original, paper, paper.replace("-", "_")):
            return paper
    return None


# ---- what is in a folder


def find_dataset(folder):
    """tum or icl by the files in the folder; None if it has no sequence of either.

    Only ICL-NUIM has associations.txt or numbered images without rgb.txt.
    """
    if (folder / "rgb.txt").is_file():
        return "tum"
    if (folder / "associations.txt").is_file() or any(folder.glob("scene_00_*.png")):
        return "icl"
    rgb = folder / "rgb"
    if rgb.is_dir() and any(path.suffix.lower() in IMAGES for path in rgb.iterdir()):
        return "tum"
    return None


def listed_images(folder, dataset):
    """(list, number of the line or None, path) of each image that a list of the sequence names."""
    found = []
    if dataset == "tum":
        for name in ("rgb.txt", "depth.txt"):
            path = folder / name
            if path.is_file():
                found += [(path, folder / words[0]) for _, words in read_rows(path)]
    elif (folder / "associations.txt").is_file():
        path = folder / "associations.txt"
        for _, words in read_rows(path):
            if len(words) < 3:
                raise InputError(f"{path}: expected lines: index depth index rgb")
            found += [(path, folder / words[0]), (path, folder / words[2])]
    patterns = ("rgb/*", "depth/*") if dataset == "tum" else ("scene_00_*",)
    return found or [(folder, path) for pattern in patterns for path in sorted(folder.glob(pattern))
                     if path.suffix.lower() in IMAGES]


def is_whole(path):
    """Whether an image file is there and ends as its format demands."""
    try:
        with path.open("rb") as file:
            file.seek(0, 2)
            size = file.tell()
            file.seek(max(0, size - 1024))
            end = file.read()
    except OSError:
        return False
    return end.endswith(PNG_END) if path.suffix.lower() == ".png" else JPEG_END in end


def check_images(folder, dataset):
    """Refuses a sequence whose images are missing or cut short. Returns the images."""
    try:
        images = listed_images(folder, dataset)
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{folder}: cannot be read: {error}") from error
    missing = [(source, path) for source, path in images if not path.is_file()]
    cut = [(source, path) for source, path in images if path.is_file() and not is_whole(path)]
    for faults, what in ((missing, "are missing"), (cut, "are cut short")):
        if faults:
            source, path = faults[0]
            raise InputError(
                f"{folder}: is not complete: {len(faults)} of the {len(images)} images of the "
                f"sequence {what}, the first one is {path.relative_to(folder)} (in {source.name}); "
                "download it again")
    return [path for _, path in images]


def has_depth(folder, dataset):
    return dataset == "icl" or (folder / "depth.txt").is_file() or (folder / "depth").is_dir()


def find_masks(folder, wanted, name):
    """The masks of a sequence: `wanted` is a path, in which {name} is the sequence, or the name of
    an entry of the folder. Without it they are `masks`, or the only entry that begins so."""
    if wanted:
        path = pathlib.Path(wanted.replace("{name}", name))
        path = path if path.is_absolute() or "{name}" in wanted else folder / path
        if not path.exists():
            raise InputError(f"{path}: does not exist; --masks is '{wanted}'")
        return path
    if (folder / "masks").exists():
        return folder / "masks"
    found = sorted(folder.glob("masks*"))
    if len(found) > 1:
        raise InputError(f"{folder}: has {' and '.join(path.name for path in found)}; say by "
                         "--masks which of them to use")
    return found[0] if found else None


# ---- settings and fingerprints


def settings_file(folder, dataset, config):
    """The settings that a run takes without --settings (docs/settings.md); None without any."""
    if (folder / "camera.yaml").is_file():
        return folder / "camera.yaml"
    if dataset == "icl":
        return config / "ICL.yaml"
    match = re.search(r"fr(?:eiburg)?([123])", folder.resolve().name)
    return config / f"TUM{match[1]}.yaml" if match else None


def has_rolling_shutter(settings):
    """Whether a settings file has a Camera.readout_time other than 0."""
    text = settings.read_text(encoding="utf-8", errors="replace")
    match = re.search(r"^\s*Camera\.readout_time\s*:\s*(\S+)", text, re.MULTILINE)
    return match is not None and float(match[1]) != 0.0


def hash_masks(path):
    """The hash of a file, or of the names and the contents of the files in a folder."""
    if path.is_file():
        return hash_file(path)
    digest = hashlib.sha256()
    for file in sorted(path.rglob("*")):
        if file.is_file():
            digest.update(f"{file.relative_to(path)}\0{hash_file(file)}\n".encode())
    return digest.hexdigest()


def fingerprint(folder, images, settings):
    """A hash of the lists, the settings, and the names and sizes of the images.

    The contents of images are not read, because those of a large sequence take minutes.
    """
    digest = hashlib.sha256()
    texts = sorted(path for path in folder.iterdir()
                   if path.suffix in (".txt", ".freiburg", ".yaml") and path.is_file())
    for path in [*texts, *([settings] if settings else [])]:
        digest.update(f"{path.name}\0{hash_file(path)}\n".encode())
    for path in images:
        digest.update(f"{path.relative_to(folder)}\0{path.stat().st_size}\n".encode())
    return digest.hexdigest()


# ---- the sequences of a table run


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
    if settings is None or not settings.is_file():
        raise InputError(f"{folder}: its camera is not known; put its settings into camera.yaml in "
                         "this folder (docs/settings.md)")
    name = short_name(folder)
    path = find_masks(folder, masks, name)
    objects = folder / "groundtruth_objects.json"
    depth = has_depth(folder, dataset)
    return Sequence(name, dataset, paper_name(name, paper_sequences), str(folder.resolve()),
                    str(path.resolve()) if path else None,
                    str(objects.resolve()) if objects.is_file() else None,
                    modes=("rgbd", "mono") if depth else ("mono",),
                    frames=len(images) // 2 if depth else len(images),
                    settings=str(settings.resolve()),
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
    """The sequences that a text file lists, one [tum=|icl=]FOLDER per line; # begins a comment.

    Folders are relative to the file.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot read {path}: {error}") from error
    found = []
    for number, line in enumerate(lines, 1):
        line = line.split("#")[0].strip()
        if line:
            dataset, equals, folder = line.rpartition("=")
            folder = path.parent / folder
            if not folder.is_dir():
                raise InputError(f"{path}:{number}: {folder} is no folder")
            found.append(f"{dataset}{equals}{folder}")
    if not found:
        raise InputError(f"{path}: lists no sequence")
    return found


def in_order(sequences, paper_sequences):
    """The sequences in the order of the paper, then the others. Each needs a name of its own."""
    known = {}
    for sequence in sequences:
        other = known.setdefault(sequence.name, sequence)
        if other is not sequence:
            raise InputError(f"{other.folder} and {sequence.folder} have the same name "
                             f"'{sequence.name}'")
    order = list(paper_sequences)
    return sorted(sequences, key=lambda s: order.index(s.paper) if s.paper else len(order))
