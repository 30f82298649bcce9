#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes instance masks for the colour images of a sequence, as Yu et al. 2025 did: a YOLO network
finds the objects, and SAM (segment anything) refines the mask within each box.

    scripts/make_masks.py SEQUENCE
    hullslam check-masks SEQUENCE SEQUENCE/masks --output pictures

SEQUENCE is a folder with rgb.txt (TUM RGB-D), associations.txt (ICL-NUIM), a folder rgb, or the images
themselves; a sequence of EuRoC or KITTI, or stereo pairs, of which the left images are used; or a
video. For each image a text file in the format yolo-seg is written to SEQUENCE/masks
(VIDEO_masks beside a video), and classes.txt with the names of the classes. Images that have a file
already are left out, so an interrupted call goes on where it stopped. Images that EXIF data turn are
shown to the networks as a viewer shows them; their masks are those of the stored pixels, which
HullSLAM reads.

Both networks are those of the Python package ultralytics (pip install ultralytics), which downloads
their weights when they are used first. Start this script with the Python that has the package; it
also needs numpy and contourpy, which come with it. --refine none keeps the masks of YOLO.

Exit codes: 0 done, 1 interrupted or failed, 2 bad usage or input.
"""

import json
import pathlib
import sys
import time

from support import exit_code, InputError, one_line, parser_of
import run_frames
from run_frames import VideoFrames, colour_images, orientation_of, turn, turn_back

# Where EuRoC, KITTI and folders of stereo pairs have the left images.
LEFT_FOLDERS = ("mav0/cam0/data", "cam0/data", "image_0", "image_2", "left")
SETTINGS = "make_masks.json"  # beside the masks: the networks that made them
MIN_AREA = 100.0  # px^2, of a mask that is written


# ---- images


def list_images(sequence):
    """The colour images of a sequence, in the order of its list."""
    for name, column in (("rgb.txt", 1), ("associations.txt", 3)):
        path = sequence / name
        if path.is_file():
            return [image for line in read_lines(path)
                    for image in [sequence / word_of(path, *line, column)]]
    left = next((sequence / name for name in LEFT_FOLDERS if (sequence / name).is_dir()), None)
    images = run_frames.list_images(left) if left else colour_images(sequence)
    if not images:
        raise InputError(f"{sequence}: is no sequence, expected a video, a sequence of EuRoC or KITTI, "
                         "stereo pairs, or a folder with rgb.txt, associations.txt, a folder rgb, or "
                         "PNG or JPEG images")
    return images


def frames_of_video(path):
    """(name, function that gives the image) of each frame; the names are those that mono_video has."""
    video, number = VideoFrames(path), 0
    while video.skip():
        yield f"{number:06d}", video.image
        number += 1
    if number == 0:
        raise InputError(f"{path}: no frame of the video can be decoded")


def frames_of_folder(images):
    for path in images:
        yield path.stem, lambda path=path: path


def read_lines(path):
    """(number, words) of the lines that are no comments."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot read {path}: {error}") from error
    return [(number, line.split()) for number, line in enumerate(lines, 1)
            if line.strip() and not line.lstrip().startswith("#")]


def word_of(path, number, words, column):
    if len(words) <= column:
        raise InputError(f"{path}:{number}: expected {column + 1} columns")
    return words[column]


# ---- outlines


def outline_of(mask):
    """The outline (n x 2, pixels) of the largest part of a mask (height x width, 0 or 1), and its
    area.

    The centres of pixels have integer coordinates. The outline runs halfway between the centres of
    the pixels inside and outside, so it is an unbiased silhouette (docs/masks.md).
    """
    import contourpy
    import numpy as np
    padded = np.pad(np.asarray(mask, dtype=float), 1)  # a mask may touch the border of the image
    best, largest = None, 0.0
    for line in contourpy.contour_generator(z=padded).lines(0.5):
        x, y = line[:-1, 0], line[:-1, 1]
        area = 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))
        if area > largest:
            best, largest = line[:-1] - 1.0, area
    return best, largest


def without_straight_points(outline):
    """The outline without the points that lie on the line between their neighbours."""
    import numpy as np
    before, after = outline - np.roll(outline, 1, axis=0), np.roll(outline, -1, axis=0) - outline
    turn = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return outline[np.abs(turn) > 1e-9]


def yolo_line(number, outline, score, size):
    """A line of a yolo-seg file: class, x and y as shares of width and height, confidence."""
    width, height = size
    numbers = [f"{min(1.0, max(0.0, value)):.6g}"
               for x, y in outline for value in (x / width, y / height)]
    return f"{number} {' '.join(numbers)} {min(1.0, max(0.0, score)):.4f}\n"


def yolo_text(detections):
    """The content of a file for [(class, confidence, mask)] of an image."""
    lines = []
    for number, score, mask in detections:
        outline, area = outline_of(mask)
        if outline is None or area < MIN_AREA:
            continue
        outline = without_straight_points(outline)
        if len(outline) >= 3:
            lines.append(yolo_line(number, outline, score, (mask.shape[1], mask.shape[0])))
    return "".join(lines)


# ---- networks


def load_networks(arguments):
    """YOLO, and SAM or None."""
    try:
        from ultralytics import SAM, YOLO
    except ImportError as error:
        raise InputError(f"{sys.executable} has no package ultralytics ({one_line(error)}); install it "
                         "(pip install ultralytics) and start this script with that Python") \
            from error
    return YOLO(arguments.model), None if arguments.refine == "none" else SAM(arguments.refine)


def as_array(tensor):
    """A tensor of a network as an array."""
    return tensor.cpu().numpy() if hasattr(tensor, "cpu") else tensor


def upright(image):
    """An image for the networks, and how it was turned: a number of EXIF. `image` is a path or, of a
    video, the pixels."""
    orientation = orientation_of(image) if isinstance(image, pathlib.Path) else 1
    if orientation == 1:
        return (str(image) if isinstance(image, pathlib.Path) else image), orientation
    import cv2
    import numpy as np
    stored = cv2.imread(str(image), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    if stored is None:
        raise InputError(f"{image}: cannot be decoded, expected a PNG or JPEG image")
    return np.ascontiguousarray(turn(stored, orientation)), orientation


def detect(networks, image, arguments):
    """[(class, confidence, mask)] of an image; masks have the height and width of its pixels as
    stored."""
    detector, refiner = networks
    shown, orientation = upright(image)
    options = {"verbose": False, **({"device": arguments.device} if arguments.device else {})}
    # retina_masks asks for masks of the size of the image instead of that of the network.
    found = detector(shown, conf=arguments.confidence, retina_masks=True, **options)[0]
    boxes = found.boxes
    if boxes is None or len(boxes) == 0:
        return []
    if refiner is not None:
        arrays = refine(refiner, found.orig_img, boxes.xyxy, options)
    elif found.masks is not None:
        arrays = list(as_array(found.masks.data))
    else:
        raise InputError(f"--model is '{arguments.model}': it gives boxes but no masks; use a model "
                         "whose name ends in -seg, or --refine with a model of SAM")
    size = tuple(found.orig_img.shape[:2])
    wrong = [tuple(array.shape) for array in arrays if array is not None and array.shape != size]
    if wrong or len(arrays) != len(boxes):
        raise InputError(f"{image}: the networks gave {len(arrays)} masks of {wrong or size} pixels "
                         f"for {len(boxes)} boxes in an image of {size} pixels")
    return [(int(number), float(score), turn_back(array > 0.5, orientation)) for number, score, array in
            zip(as_array(boxes.cls), as_array(boxes.conf), arrays) if array is not None]


def refine(refiner, image, boxes, options):
    """The mask of SAM for each box; None where it finds none.

    SAM drops masks of which it is not sure, so if some are missing, each box is asked for by itself.
    """
    masks = refiner(image, bboxes=boxes, **options)[0].masks
    arrays = [] if masks is None else list(as_array(masks.data))
    if len(arrays) == len(boxes):
        return arrays
    alone = [refiner(image, bboxes=boxes[i:i + 1], **options)[0].masks for i in range(len(boxes))]
    return [None if one is None or len(one.data) == 0 else as_array(one.data)[0] for one in alone]


# ---- the work


def describe(arguments):
    return {"model": arguments.model, "refine": arguments.refine,
            "confidence": arguments.confidence}


def prepare(out, arguments):
    """Makes the folder. Refuses one with masks of other networks, because they would be mixed."""
    out.mkdir(parents=True, exist_ok=True)
    path = out / SETTINGS
    if path.exists():
        try:
            former = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise InputError(f"{path}: cannot be read: {one_line(error)}") from error
        if former != describe(arguments):
            raise InputError(f"{out}: has masks that were made with {json.dumps(former)}; choose "
                             "another --out, or delete them")
    elif any(out.iterdir()):
        raise InputError(f"{out}: contains files, but none of this script; choose another --out")
    write(path, json.dumps(describe(arguments)) + "\n")


def write(path, text):
    """Writes a file by renaming a temporary one, so that an interrupted call leaves no half file."""
    temporary = path.with_name(f".{path.name}.tmp")
    temporary.write_text(text, encoding="utf-8")
    temporary.replace(path)


def show(done, count, begin, at_begin):
    seconds = time.monotonic() - begin
    rest = seconds / max(1, done - at_begin) * (count - done)
    is_terminal = sys.stderr.isatty()
    if is_terminal or done % 50 == 0 or done == count:
        print(f"{chr(13) if is_terminal else ''}{done}/{count} images, {rest:.0f} s left ",
              end="" if is_terminal and done < count else "\n", file=sys.stderr, flush=True)


def find_frames(sequence):
    """The number of frames, and a function that gives (name, function for the image) of each."""
    if sequence.suffix in (".bag", ".db3", ".mcap") or (sequence / "metadata.yaml").is_file():
        raise InputError(f"{sequence}: is a recording of ROS, expected images or a video; "
                         "`hullslam segment` makes masks of recordings")
    if sequence.is_file():
        return sum(1 for _ in frames_of_video(sequence)), lambda: frames_of_video(sequence)
    images = list_images(sequence)
    missing = [image for image in images if not image.is_file()]
    if missing:
        raise InputError(f"{missing[0]}: is missing, as are {len(missing) - 1} other images of the "
                         "sequence; download it again")
    return len(images), lambda: frames_of_folder(images)


def default_folder(sequence):
    return sequence.with_name(sequence.stem + "_masks") if sequence.is_file() else sequence / "masks"


def make_masks(arguments):
    count, frames = find_frames(arguments.sequence)
    out = arguments.out or default_folder(arguments.sequence)
    prepare(out, arguments)
    networks, new = None, 0
    begin = time.monotonic()
    for done, (name, read) in enumerate(frames(), 1):
        path = out / f"{name}.txt"
        if path.exists():
            continue
        if networks is None:
            networks = load_networks(arguments)
            names = networks[0].names
            write(out / "classes.txt", "".join(f"{names[number]}\n" for number in range(len(names))))
            begin = time.monotonic()
        write(path, yolo_text(detect(networks, read(), arguments)))
        new += 1
        if not arguments.quiet:
            show(done, count, begin, done - new)
    print(f"{out}: masks of {count} images, {new} of them new")


def parse_arguments(words):
    parser = parser_of(__doc__)
    parser.add_argument("sequence", type=pathlib.Path, metavar="SEQUENCE")
    parser.add_argument("--out", type=pathlib.Path,
                        help="folder for masks (default: SEQUENCE/masks, or VIDEO_masks)")
    parser.add_argument("--model", default="yolov8x-seg.pt",
                        help="weights of YOLO (default yolov8x-seg.pt)")
    parser.add_argument("--refine", default="sam_b.pt", metavar="MODEL",
                        help="weights of SAM, or none (default sam_b.pt)")
    parser.add_argument("--confidence", type=float, default=0.25, metavar="C",
                        help="least confidence of a detection (default 0.25)")
    parser.add_argument("--device", help="where the networks run, such as cpu or 0 (default: theirs)")
    parser.add_argument("--quiet", action="store_true", help="no progress")
    arguments = parser.parse_args(words)
    if not 0.0 <= arguments.confidence <= 1.0:
        parser.error(f"--confidence is {arguments.confidence}, expected a number from 0 to 1")
    return arguments


def main(words=None):
    arguments = parse_arguments(words)
    return exit_code(make_masks, arguments)


if __name__ == "__main__":
    sys.exit(main())
