# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours of classes and labels for the pictures of plot_run.py."""

import colorsys

import numpy as np

# Any two colours differ by 31 or more in CIE Lab, and all are dark enough for white paper. The first
# ones differ most.
PALETTE = ("#e62600", "#0000e6", "#00e600", "#00bfe6", "#e65cb8", "#666600", "#002266", "#660011",
           "#00e699", "#e6bf00", "#e68a5c", "#735ce6", "#006655", "#e600e6", "#53a600", "#e6004d",
           "#5c8ae6", "#660055", "#006611", "#664729", "#294766", "#a64263", "#e67300", "#8a00a6")
MAX_CHARACTERS = 40  # of a text in a picture


def class_colours(names):
    """A different colour for every class: {name: (red, green, blue), 0 to 1}."""
    colours = {}
    for i, name in enumerate(sorted(set(names))):
        if i < len(PALETTE):
            colours[name] = tuple(int(PALETTE[i][k:k + 2], 16) / 255 for k in (1, 3, 5))
        else:  # the golden ratio never gives the same hue twice
            colours[name] = colorsys.hsv_to_rgb(0.618034 * i % 1.0, 0.75, 0.75)
    return colours


def ink_on(colour):
    """Black or white, whichever is easier to read on the colour."""
    return "black" if np.dot(colour, (0.3, 0.59, 0.11)) > 0.5 else "white"


def plain(text):
    """The text in the form in which matplotlib draws exactly these characters.

    A `$` would start a formula. Characters that cannot be drawn become question marks.
    """
    text = "".join(c if c.isprintable() else "?" for c in str(text))
    if len(text) > MAX_CHARACTERS:
        text = text[:MAX_CHARACTERS - 1] + "…"
    return text.replace("$", "\\$")


class Label:
    """A text that belongs to a point of a plot. If it has a colour, it is drawn in a box of it."""

    def __init__(self, text, point, colour=None):
        self.text, self.point, self.colour = plain(text), np.asarray(point, dtype=float), colour


def offsets(step):
    """Shifts to try, the shortest first: none, then twelve directions on growing ellipses."""
    yield np.zeros(2)
    for radius in np.arange(1.0, 13.0):
        for angle in np.arange(12) * np.pi / 6:
            yield radius * step * (np.cos(angle), np.sin(angle))


def overlaps(box, others):
    """Whether the box (x0, y0, x1, y1) overlaps one of the others."""
    return any(box[0] < other[2] and other[0] < box[2] and box[1] < other[3] and other[1] < box[3]
               for other in others)


def find_centre(point, size, inside, taken):
    """The centre of a free box of this size near the point; None if there is no free box."""
    for offset in offsets(np.array([0.35 * size[0], 0.75 * size[1]])):
        centre = point + offset
        box = (*(centre - size / 2), *(centre + size / 2))
        fits = (box[0] >= inside[0] and box[1] >= inside[1] and box[2] <= inside[2]
                and box[3] <= inside[3])
        if fits and not overlaps(box, taken):
            taken.append(box)
            return centre
    return None


def draw_labels(plot, labels):
    """Draws labels near their points. They do not overlap.

    A line leads from a label that was moved to its point. Labels of points outside the plot and
    labels without room are left out. The layout of the figure must be final. Returns the number of
    labels that were drawn.
    """
    renderer = plot.figure.canvas.get_renderer()
    frame = plot.get_window_extent(renderer)
    inside = (frame.x0, frame.y0, frame.x1, frame.y1)
    taken, count = [], 0
    to_share = plot.transAxes.inverted()
    for label in labels:
        point = plot.transData.transform(label.point)
        if not np.isfinite(point).all() or not frame.contains(*point):
            continue
        colour = label.colour
        text = plot.text(0, 0, label.text, fontsize=7, ha="center", va="center_baseline",
                         transform=plot.transAxes, color=ink_on(colour) if colour else "black",
                         bbox={"color": colour or "white", "alpha": 0.6, "pad": 1}, zorder=5)
        extent = text.get_window_extent(renderer)
        centre = find_centre(point, np.array([extent.width, extent.height]) + 6, inside, taken)
        if centre is None:
            text.remove()
            continue
        text.set_position(to_share.transform(centre))
        if np.linalg.norm(centre - point) > extent.height:
            plot.plot(*to_share.transform([point, centre]).T, transform=plot.transAxes,
                      color=colour or "black", linewidth=0.6, zorder=4)
        count += 1
    return count
