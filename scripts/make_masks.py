#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes instance masks for the colour images of a sequence, as Yu et al. 2025 did: a YOLO network
finds the objects, and SAM (segment anything) refines the mask within each box.

    scripts/make_masks.py SEQUENCE
    hullslam check-masks SEQUENCE SEQUENCE/masks --output pictures

SEQUENCE is a sequence of any data set (docs/datasets.md), of a stereo camera its left images, or a
recording, a video or a folder of images. For each image a text file in the format yolo-seg is written
to SEQUENCE/masks (VIDEO_masks beside a video), and classes.txt with the names of the classes. Images
that have a file already are left out, so an interrupted call goes on where it stopped. Images that EXIF
data turn are shown to the networks as a viewer shows them; their masks are those of the stored pixels,
which HullSLAM reads.

Both networks are those of the Python package ultralytics (pip install ultralytics), which downloads
their weights when they are used first. Start this script with the Python that has the package; it
also needs HullSLAM's module (docs/python.md), and numpy, which comes with ultralytics.
--refine none keeps the masks of YOLO.

Exit codes: 0 done, 1 interrupted or failed, 2 bad usage or input.
"""

import json
import pathlib
import sys
import time

from support import exit_code, hullslam_module, InputError, number, one_line, parser_of, read_json, write

SETTINGS = "make_masks.json"  # beside the masks: the networks that made them
MIN_AREA = 100.0  # px^2, of a mask that is written


# ---- images


def open_images(path):
    """The images of whatever is at a path."""
    hullslam = hullslam_module()
    try:
        return hullslam.open_stored_images(path)
    except hullslam.InputError as error:
        raise InputError(error) from error


def orientation_of(path):
    """The orientation in the EXIF data of a JPEG, 1 to 8; 1 is as stored."""
    if path.suffix.lower() not in (".jpg", ".jpeg"):
        return 1
    from PIL import Image
    try:
        with Image.open(path) as image:
            number = image.getexif().get(0x0112, 1)
    except (OSError, SyntaxError, ValueError):
        return 1  # who reads the pixels will report it
    return number if number in range(1, 9) else 1


def turn(image, orientation):
    """A stored image (height, width, ...) as a viewer shows it."""
    if orientation in (5, 6, 7, 8):
        image = image.swapaxes(0, 1)
    across, down = orientation in (2, 3, 6, 7), orientation in (3, 4, 7, 8)
    return image[::-1 if down else 1, ::-1 if across else 1]


def turn_back(image, orientation):
    """The inverse of turn()."""
    return turn(image, {6: 8, 8: 6}.get(orientation, orientation))


def area_of(outline):
    """The area within an outline (n x 2)."""
    import numpy as np
    x, y = outline.T
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def yolo_text(detections):
    """The content of a file for [(class, confidence, mask)] of an image: of each mask the outline of its
    largest part, as shares of the image's size.

    The outline runs halfway between the centres of the pixels inside and outside, so it is an unbiased
    silhouette (docs/masks.md).
    """
    import numpy as np
    from yolo_masks import print_masks
    if not detections:
        return ""
    numbers, scores, arrays = zip(*detections)
    masks = hullslam_module().Masks(np.stack(arrays), list(map(str, numbers)), np.clip(scores, 0.0, 1.0))
    size = np.array(arrays[0].shape[::-1])
    return print_masks([(number, np.clip(parts[0] / size, 0.0, 1.0), score) for number, parts, score
                        in zip(masks.classes, masks.outlines, masks.scores)
                        if area_of(parts[0]) >= MIN_AREA], digits=6)


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


def upright(images, index):
    """An image for the networks, which is its file if they need not turn it, and how it was turned."""
    import numpy as np
    path = images.files[index]
    orientation = orientation_of(path)
    if orientation == 1 and path.is_file():
        return str(path), orientation
    return np.ascontiguousarray(turn(images.colour(index), orientation)), orientation


def detect(networks, images, index, arguments):
    """[(class, confidence, mask)] of an image; masks have the height and width of its pixels as
    stored."""
    detector, refiner = networks
    shown, orientation = upright(images, index)
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
        raise InputError(f"{images.files[index]}: the networks gave {len(arrays)} masks of {wrong or size} "
                         f"pixels for {len(boxes)} boxes in an image of {size} pixels")
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


def prepare(out, arguments):
    """Makes the folder. Refuses one with masks of other networks, because they would be mixed."""
    out.mkdir(parents=True, exist_ok=True)
    path = out / SETTINGS
    made_by = {key: getattr(arguments, key) for key in ("model", "refine", "confidence")}
    if path.exists():
        if (former := read_json(path)) != made_by:
            raise InputError(f"{out}: has masks that were made with {json.dumps(former)}; choose "
                             "another --out, or delete them")
    elif any(out.iterdir()):
        raise InputError(f"{out}: contains files, but none of this script; choose another --out")
    write(path, json.dumps(made_by) + "\n")


def show(done, count, begin, at_begin):
    seconds = time.monotonic() - begin
    rest = seconds / max(1, done - at_begin) * (count - done)
    is_terminal = sys.stderr.isatty()
    if is_terminal or done % 50 == 0 or done == count:
        print(f"{chr(13) if is_terminal else ''}{done}/{count} images, {rest:.0f} s left ",
              end="" if is_terminal and done < count else "\n", file=sys.stderr, flush=True)


def make_masks(arguments):
    images, sequence = open_images(arguments.sequence), arguments.sequence
    count, networks, new = len(images), None, 0
    out = arguments.out or (sequence.with_name(sequence.stem + "_masks") if sequence.is_file() else
                            sequence / "masks")
    prepare(out, arguments)
    begin = time.monotonic()
    for done, name in enumerate(images.names, 1):
        path = out / f"{name}.txt"
        if path.exists():
            continue
        if networks is None:
            networks = load_networks(arguments)
            names = networks[0].names
            write(out / "classes.txt", "".join(f"{names[number]}\n" for number in range(len(names))))
            begin = time.monotonic()
        write(path, yolo_text(detect(networks, images, done - 1, arguments)))
        new += 1
        if not arguments.quiet:
            show(done, count, begin, done - new)
    print(f"{out}: masks of {count} images, {new} of them new")


def main(words=None):
    parser = parser_of(__doc__)
    parser.add_argument("sequence", type=pathlib.Path, metavar="SEQUENCE")
    parser.add_argument("--out", type=pathlib.Path,
                        help="folder for masks (default: SEQUENCE/masks, or VIDEO_masks)")
    parser.add_argument("--model", default="yolov8x-seg.pt", help="weights of YOLO (default yolov8x-seg.pt)")
    parser.add_argument("--refine", default="sam_b.pt", metavar="MODEL",
                        help="weights of SAM, or none (default sam_b.pt)")
    parser.add_argument("--confidence", type=number(0.0, 1.0), default=0.25, metavar="C",
                        help="least confidence of a detection (default 0.25)")
    parser.add_argument("--device", help="where the networks run, such as cpu or 0 (default: theirs)")
    parser.add_argument("--quiet", action="store_true", help="no progress")
    return exit_code(make_masks, parser.parse_args(words))


if __name__ == "__main__":
    sys.exit(main())
