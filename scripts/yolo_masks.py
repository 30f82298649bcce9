# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and prints masks in the format yolo-seg (docs/masks.md)."""

import numpy as np

from support import InputError, one_line


def read_masks(path):
    """The masks of an image: class (text), outline (n x 2, shares of the size), score or None."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is no text file; expected masks in the format yolo-seg") from error
    return [read_mask(line.split(), f"{path}:{count}") for count, line in enumerate(lines, 1) if line.strip()]


def read_mask(words, where):
    if not words[0].isdigit():
        raise InputError(f"{where}: '{one_line(words[0], 40)}' is not the number of a class, "
                         "expected a line of the format yolo-seg: class x1 y1 ... xn yn [score]")
    try:
        values = np.array(words[1:], dtype=float)
    except ValueError as error:
        raise InputError(f"{where}: expected a class and numbers") from error
    if len(values) < 6:
        raise InputError(f"{where}: expected an outline of three points or more; boxes and other "
                         "formats than yolo-seg are not read")
    if not ((values >= 0.0) & (values <= 1.0)).all():
        raise InputError(f"{where}: expected shares of the image's size from 0 to 1, and a score "
                         "from 0 to 1; other formats than yolo-seg are not read")
    outline = values[:len(values) // 2 * 2].reshape(-1, 2)
    return words[0], outline, values[-1] if len(values) % 2 else None


def print_masks(masks, digits=9):
    """The content of the file of an image with these masks."""
    lines = []
    for number, outline, score in masks:
        numbers = [*outline.flat, *([] if score is None else [score])]
        lines.append(" ".join([number, *(f"{value:.{digits}g}" for value in numbers)]) + "\n")
    return "".join(lines)


def mask_files(folder, stems):
    """The file of each image that has one. A folder that has no file for any of these images must
    be empty."""
    files = {stem: folder / f"{stem}.txt" for stem in stems if (folder / f"{stem}.txt").is_file()}
    others = [] if files else sorted(path.name for path in folder.iterdir())
    if others:
        raise InputError(f"{folder}: has no file {stems[0]}.txt but {others[0]}; expected masks in "
                         "the format yolo-seg, one text file per image (--no-masks leaves them "
                         "out)")
    return files
