# SPDX-License-Identifier: GPL-3.0-or-later
"""Visual SLAM with objects as dual quadrics.

System tracks images and builds a map, KnownPoseMapper maps objects from known poses, Settings has all
options, and Masks are the objects in one image. docs/python.md explains how they work together.

Poses are 4x4 matrices; `cam_from_world` maps points of the world frame to the camera frame (x right,
y down, z forward). Lengths are in metres, in monocular runs in units of the map. Time stamps are in
seconds.
"""

try:
    import numpy as _  # the module below would only say that it cannot be loaded
except ImportError as error:
    import sys
    raise ImportError(f"hullslam needs numpy, which {sys.executable} does not have: install python3-numpy "
                      "and use /usr/bin/python3") from error

from ._core import (ImageSequence, InputError, KnownPoseMapper, Map, MapEvent, MapObject, MaskFiles,
                    Masks, Run, SeenObject, Segmenter, SequenceFrame, System, TrackResult, Trajectory,
                    TrajectoryErrors, __version__, default_settings, evaluate_trajectory, export,
                    open_euroc, open_icl, open_images, open_masks, open_run, open_stored_images, open_tum,
                    preset_names, read_map, read_trajectory, report, scene)
from ._open import open  # noqa: A004
from ._settings import Settings

InputError.__doc__ = """A file, a setting or an argument is wrong.

The message names the file and line, or the argument and its value, and says what was expected.
"""

__all__ = ["ImageSequence", "InputError", "KnownPoseMapper", "Map", "MapEvent", "MapObject",
           "MaskFiles", "Masks", "Run", "SeenObject", "Segmenter", "SequenceFrame", "Settings", "System",
           "TrackResult", "Trajectory", "TrajectoryErrors", "__version__", "default_settings",
           "evaluate_trajectory", "export", "open", "open_euroc", "open_icl", "open_images", "open_masks",
           "open_run", "open_stored_images", "open_tum", "preset_names", "read_map",
           "read_trajectory", "report", "scene"]
