# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the programs are that the scripts start."""

import pathlib

SCRIPTS = pathlib.Path(__file__).resolve().parent


def programs_folder():
    """The folder of the programs of the installation, in which the scripts are in
    share/hullslam/scripts, or of the build."""
    top = SCRIPTS.parent
    installed = top.parent.parent / "libexec" / "hullslam"
    return installed if (installed / "rgbd_tum").is_file() else top / "build" / "release" / "bin"
