# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the objects of a finished run from objects.json and draws them for plot_run.py."""

import json
import pathlib

import matplotlib.pyplot as plt
import numpy as np

from object_entries import attach_observations

TURN = np.linspace(0.0, 2.0 * np.pi, 65)
CIRCLE = np.stack([np.cos(TURN), np.sin(TURN)])


class InputError(Exception):
    """An error that the user can correct. The message names the file."""


def rotation(quaternion):
    """Rotation matrix of a quaternion qx, qy, qz, qw, which need not be normalised."""
    x, y, z, w = np.asarray(quaternion, dtype=float) / np.linalg.norm(quaternion)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def colour_of(label):
    """The colour that the class has in objects.ply; its hue is a hash (FNV-1a) of the name."""
    number = 2166136261
    for byte in label.encode("utf-8", "surrogateescape"):
        number = (number ^ byte) * 16777619 % 2**32
    hue = 6 * ((number >> 16) % 360) / 360
    away = [abs((hue - 2 * channel + 3) % 6 - 3) for channel in range(3)]
    return tuple((40 + 200 * min(max(2 - distance, 0), 1)) / 255 for distance in away)


def ellipse_points(centre, shape):
    """A closed polygon (65 x 2) on the ellipse (p - centre)^T shape^-1 (p - centre) = 1."""
    return centre + (np.linalg.cholesky(shape) @ CIRCLE).T


class Object:
    """An ellipsoid in the world frame; `shape` is R diag(a^2, b^2, c^2) R^T."""

    def __init__(self, entry):
        pose = np.array(entry["world_from_object"], dtype=float)
        axes = rotation(pose[3:]) @ np.diag(np.array(entry["half_axes"], dtype=float))
        self.name, self.label = f"{entry['class']} {entry['id']}", entry["class"]
        self.is_mapped = entry["state"] == "mapped"
        self.centre, self.shape = pose[:3], axes @ axes.T
        self.views = {float(view["timestamp"]): view for view in entry["observations"]}
        if not (np.isfinite(self.shape).all() and np.linalg.det(self.shape) > 0):
            raise ValueError(f"half_axes of object {entry['id']}")

    def move(self, turn, shift):
        self.centre = turn @ self.centre + shift
        self.shape = turn @ self.shape @ turn.T

    def seen_along(self, axes):
        """The ellipse of its parallel projection onto two axes of the world."""
        return ellipse_points(self.centre[axes], self.shape[np.ix_(axes, axes)])

    def seen_from(self, camera, cam_from_world):
        """Its projected ellipse, undistorted px; None unless all of it is in front of the camera."""
        turn = rotation(cam_from_world[3:])
        centre = turn @ self.centre + cam_from_world[:3]
        shape = turn @ self.shape @ turn.T
        if centre[2] <= np.sqrt(shape[2, 2]):
            return None
        k = np.array([[camera["fx"], 0, camera["cx"]], [0, camera["fy"], camera["cy"]], [0, 0, 1]])
        conic = k @ (shape - np.outer(centre, centre)) @ k.T
        conic /= -conic[2, 2]
        middle = -conic[:2, 2]
        return ellipse_points(middle, conic[:2, :2] + np.outer(middle, middle))


def read_objects(path):
    """The camera and the objects of objects.json; ({}, []) if the file does not exist."""
    if not path.exists():
        return {}, []
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        attach_observations(path, content)
        return content["camera"], [Object(entry) for entry in content["objects"]]
    except (OSError, ValueError, KeyError, TypeError, IndexError, np.linalg.LinAlgError) as error:
        reason = f"no key {error}" if isinstance(error, KeyError) else error
        raise InputError(f"{path}: not a valid objects.json: {reason}") from error


def draw_from_afar(plot, objects, axes):
    """Draws the mapped objects as they look along the third axis."""
    for item in objects:
        if item.is_mapped:
            colour = colour_of(item.label)
            plot.plot(*item.seen_along(axes).T, color=colour, linewidth=1.4)
            plot.text(*item.centre[axes], item.name, fontsize=7, ha="center", va="center",
                      bbox={"color": "white", "alpha": 0.5, "pad": 0.5}, clip_on=True)


def distort(points, camera):
    """Raw pixels of undistorted pixels (n x 2) by Brown's distortion model."""
    x = (points[:, 0] - camera["cx"]) / camera["fx"]
    y = (points[:, 1] - camera["cy"]) / camera["fy"]
    k1, k2, p1, p2, k3 = (camera.get(key, 0.0) for key in ("k1", "k2", "p1", "p2", "k3"))
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return np.stack([u * camera["fx"] + camera["cx"], v * camera["fy"] + camera["cy"]], axis=1)


def image_list(sequence):
    """Stamps and paths of the images that are listed in rgb.txt of the sequence."""
    path = pathlib.Path(sequence) / "rgb.txt"
    try:
        rows = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
        rows = [row for row in rows if row and not row[0].startswith("#")]
        stamps = np.array([float(row[0]) for row in rows])
        files = [path.parent / row[1] for row in rows]
    except (OSError, ValueError, IndexError) as error:
        raise InputError(f"{path}: not a list of images with one line `stamp file` per image: "
                         f"{error}; give the folder of the images by --sequence") from error
    if not files:
        raise InputError(f"{path}: lists no images")
    return stamps, files


def choose_evenly(stamps, count):
    """`count` evenly chosen stamps, with the first and the last; all if there are fewer."""
    stamps = sorted(stamps)
    picks = np.linspace(0, len(stamps) - 1, min(count, len(stamps)))
    return [stamps[int(round(pick))] for pick in picks]


def draw_overlay(plot, image, stamp, camera, objects):
    """Draws the projected ellipses of the mapped objects and the observed hulls on one image."""
    plot.imshow(image, cmap="gray")
    pose = next(np.array(item.views[stamp]["cam_from_world"], dtype=float) for item in objects
                if stamp in item.views)
    for item in objects:
        ellipse = item.seen_from(camera, pose) if item.is_mapped else None
        view, colour = item.views.get(stamp), colour_of(item.label)
        if view:
            hull = distort(np.array(view["hull"] + view["hull"][:1], dtype=float), camera)
            plot.plot(*hull.T, color="white", linewidth=2.0)
            plot.plot(*hull.T, color=colour, linewidth=1.0, linestyle=":")
        if ellipse is not None:
            ellipse = distort(ellipse, camera)
            plot.plot(*ellipse.T, color=colour, linewidth=1.6, linestyle="-" if view else "--")
            plot.text(*ellipse.mean(axis=0), item.name, color="white", fontsize=7, ha="center",
                      bbox={"color": colour, "alpha": 0.6, "pad": 1}, clip_on=True)
    height, width = image.shape[:2]
    plot.set_xlim(-0.5, width - 0.5)
    plot.set_ylim(height - 0.5, -0.5)
    plot.set_title(f"{stamp:.6f}", fontsize=9)
    plot.axis("off")


def draw_overlays(path, sequence, camera, objects, count):
    """Draws `count` evenly chosen keyframes with objects into one picture.

    Returns the number of keyframes that were drawn.
    """
    chosen = choose_evenly({stamp for item in objects for stamp in item.views}, count)
    if not chosen:
        return 0
    stamps, files = image_list(sequence)
    columns = min(3, len(chosen))
    rows = -(-len(chosen) // columns)
    figure, plots = plt.subplots(rows, columns, figsize=(6.4 * columns, 5.1 * rows), squeeze=False,
                                 constrained_layout=True)
    for plot in plots.flat[len(chosen):]:
        plot.axis("off")
    for plot, stamp in zip(plots.flat, chosen):
        nearest = int(np.argmin(np.abs(stamps - stamp)))
        if abs(stamps[nearest] - stamp) > 1e-3:
            raise InputError(f"{sequence}/rgb.txt: no image of {stamp:.6f}; "
                             "is it the sequence of the run?")
        try:
            image = plt.imread(files[nearest])
        except (OSError, SyntaxError, ValueError) as error:
            raise InputError(f"{files[nearest]}: not an image: {error}") from error
        draw_overlay(plot, image, stamp, camera, objects)
    figure.savefig(path, dpi=100)
    plt.close(figure)
    return len(chosen)
