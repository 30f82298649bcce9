# SPDX-License-Identifier: GPL-3.0-or-later
"""Opening a sequence of any kind."""

import os
import warnings

from . import _core
from ._settings import Settings, overrides_of


def open(path, settings=None, *, mode=None, preset=None, choices=None, **values):  # noqa: A001
    """Opens a sequence of any kind and finds its camera: (ImageSequence, Settings).

        sequence, settings = hullslam.open("MH_01_easy")
        slam = hullslam.System(settings, sequence.mode)

    path: a sequence of TUM, ICL-NUIM, EuRoC or KITTI, stereo pairs, a recording of ROS, a video or a
        folder of images (docs/datasets.md).
    settings: a settings file; None: the camera of the sequence. A video has none.
    mode: 'rgbd', 'mono' or 'stereo'; None: the one with the most information.
    preset: as in Settings. Keyword arguments: settings, as in Settings.
    choices: options of `hullslam run` that only some data sets have, by their names with
        underscores: {"image_topic": "/left/image", "frames_per_second": 10}.

    Images of a stereo camera are rectified, and open_masks() moves masks with them. Raises InputError
    for whatever is wrong with the files.
    """
    sequence, table = _core.open_dataset(
        path, settings, mode, "" if preset is None else os.fspath(preset), overrides_of(values),
        {key: str(value) for key, value in (choices or {}).items()})
    for warning in sequence.warnings:
        warnings.warn(warning, stacklevel=2)
    return sequence, Settings(table)
