# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the objects of a finished run from objects.json and draws them for plot_run.py."""

import matplotlib.pyplot as plt
import numpy as np

from object_entries import attach_observations
from plot_labels import Label, class_colours, draw_labels
from run_files import LARGEST, InputError, number, numbers, one_line, pose, read_json

TURN = np.linspace(0.0, 2.0 * np.pi, 65)
CIRCLE = np.stack([np.cos(TURN), np.sin(TURN)])


def rotation(quaternion):
    """Rotation matrix of a quaternion qx, qy, qz, qw, which need not be normalised."""
    x, y, z, w = np.asarray(quaternion, dtype=float) / np.linalg.norm(quaternion)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def ellipse_points(centre, shape):
    """A closed polygon (65 x 2) on the ellipse (p - centre)^T shape^-1 (p - centre) = 1."""
    squares, axes = np.linalg.eigh(shape)
    return centre + (axes @ (np.sqrt(np.maximum(squares, 0.0))[:, None] * CIRCLE)).T


class Object:
    """An ellipsoid in the world frame; `shape` is R diag(a^2, b^2, c^2) R^T."""

    def __init__(self, entry):
        """`entry` is an element of `objects` in objects.json. It is checked."""
        number(entry["id"], "id", 0, 2**53)
        if not isinstance(entry["class"], str) or not isinstance(entry["state"], str):
            raise ValueError("class and state: expected texts")
        self.label, self.is_mapped = entry["class"], entry["state"] == "mapped"
        self.name = f"{self.label} {entry['id']}"
        world_from_object = pose(entry["world_from_object"], "world_from_object")
        half_axes = numbers(entry["half_axes"], 3, "half_axes", 1e-9)
        axes = rotation(world_from_object[3:]) @ np.diag(half_axes)
        self.centre, self.shape = world_from_object[:3], axes @ axes.T
        self.colour = (0.0, 0.0, 0.0)
        if not isinstance(entry["observations"], list):
            raise ValueError("observations: expected a list")
        self.views = {}  # by stamp: pose of the camera and hull
        for view in entry["observations"]:
            stamp = number(view["timestamp"], "timestamp", 0, 1e12)
            hull = [numbers(corner, 2, "hull") for corner in view["hull"]]
            if len(hull) < 3:
                raise ValueError("hull: expected three or more corners")
            self.views[stamp] = (pose(view["cam_from_world"], "cam_from_world"), np.array(hull))

    def move(self, scale, turn, shift):
        self.centre = scale * turn @ self.centre + shift
        self.shape = scale**2 * turn @ self.shape @ turn.T

    def seen_along(self, axes):
        """The ellipse of its parallel projection onto two axes of the world."""
        return ellipse_points(self.centre[axes], self.shape[np.ix_(axes, axes)])

    def seen_from(self, camera, cam_from_world):
        """Its projected ellipse, undistorted px; None unless all of it is in front of the camera."""
        turn = rotation(cam_from_world[3:])
        centre = turn @ self.centre + cam_from_world[:3]
        shape = turn @ self.shape @ turn.T
        if centre[2] <= 1.001 * np.sqrt(shape[2, 2]):
            return None
        k = np.array([[camera["fx"], 0, camera["cx"]], [0, camera["fy"], camera["cy"]], [0, 0, 1]])
        conic = k @ (shape - np.outer(centre, centre)) @ k.T
        conic /= -conic[2, 2]
        middle = -conic[:2, 2]
        return ellipse_points(middle, conic[:2, :2] + np.outer(middle, middle))


def read_camera(entry):
    camera = {key: number(entry[key], f"camera.{key}", 1.0) for key in ("fx", "fy")}
    camera.update({key: number(entry[key], f"camera.{key}") for key in ("cx", "cy")})
    camera.update({key: number(entry[key], f"camera.{key}", -1e3, 1e3)
                   for key in ("k1", "k2", "p1", "p2", "k3") if key in entry})
    return camera


def read_objects(path):
    """The camera and the objects of objects.json; ({}, []) if the file does not exist."""
    if not path.exists():
        return {}, []
    content, position = read_json(path), ""
    try:
        camera = read_camera(content["camera"])
        if not isinstance(content["objects"], list):
            raise ValueError("objects: expected a list")
        attach_observations(path, content)
        objects = []
        for i, entry in enumerate(content["objects"]):
            position = f"objects[{i}]: "
            objects.append(Object(entry))
    except (ValueError, KeyError, TypeError) as error:
        reason = f"no key {error}" if isinstance(error, KeyError) else error
        raise InputError(f"{path}: not a valid objects.json: {position}{one_line(reason)}") from error
    colours = class_colours(item.label for item in objects)
    for item in objects:
        item.colour = colours[item.label]
    return camera, objects


def draw_from_afar(plot, objects, axes):
    """Draws the mapped objects as they look along the third axis. Returns their labels."""
    mapped = [item for item in objects if item.is_mapped]
    for item in mapped:
        plot.plot(*item.seen_along(axes).T, color=item.colour, linewidth=1.4)
    return [Label(item.name, item.centre[axes], item.colour) for item in mapped]


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


def choose_evenly(stamps, count):
    """`count` evenly chosen stamps, with the first and the last; all if there are fewer."""
    stamps = sorted(stamps)
    picks = np.linspace(0, len(stamps) - 1, min(count, len(stamps)))
    return [stamps[int(round(pick))] for pick in picks]


def draw_overlay(plot, image, stamp, camera, objects):
    """Draws the projected ellipses of the mapped objects and the observed hulls on one image.

    Returns the labels of the ellipses.
    """
    plot.imshow(image, cmap="gray")
    camera_pose = next(item.views[stamp][0] for item in objects if stamp in item.views)
    labels = []
    for item in objects:
        ellipse = item.seen_from(camera, camera_pose) if item.is_mapped else None
        if stamp in item.views:
            hull = item.views[stamp][1]
            hull = distort(np.vstack([hull, hull[:1]]), camera)
            plot.plot(*hull.T, color="white", linewidth=2.0)
            plot.plot(*hull.T, color=item.colour, linewidth=1.0, linestyle=":")
        if ellipse is not None and np.abs(ellipse).max() < LARGEST:
            ellipse = distort(ellipse, camera)
            plot.plot(*ellipse.T, color=item.colour, linewidth=1.6,
                      linestyle="-" if stamp in item.views else "--")
            labels.append(Label(item.name, ellipse.mean(axis=0), item.colour))
    height, width = image.shape[:2]
    plot.set_xlim(-0.5, width - 0.5)
    plot.set_ylim(height - 0.5, -0.5)
    plot.set_title(f"{stamp:.6f}", fontsize=9)
    plot.axis("off")
    return labels


def draw_overlays(path, open_images, camera, objects, count):
    """Draws `count` evenly chosen keyframes with objects into one picture. `open_images` gives
    what run_images.open_images() does.

    Returns the number of keyframes that were drawn.
    """
    chosen = choose_evenly({stamp for item in objects for stamp in item.views}, count)
    if not chosen:
        return 0
    images = open_images()
    columns, labels = min(3, len(chosen)), []
    rows = -(-len(chosen) // columns)
    figure, plots = plt.subplots(rows, columns, figsize=(6.4 * columns, 5.1 * rows), squeeze=False,
                                 constrained_layout=True, dpi=100)
    for plot in plots.flat[len(chosen):]:
        plot.axis("off")
    for plot, stamp in zip(plots.flat, chosen):
        labels.append(draw_overlay(plot, images.at(stamp), stamp, camera, objects))
    figure.canvas.draw()
    figure.set_layout_engine("none")
    for plot, of_plot in zip(plots.flat, labels):
        draw_labels(plot, of_plot)
    figure.savefig(path)
    plt.close(figure)
    return len(chosen)
