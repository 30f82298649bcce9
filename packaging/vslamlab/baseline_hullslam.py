# SPDX-License-Identifier: GPL-3.0-or-later
import shutil

from Baselines.BaselineVSLAMLAB import BaselineVSLAMLAB


class HULLSLAM_baseline(BaselineVSLAMLAB):
    """HullSLAM, installed on this computer."""

    def __init__(self):
        super().__init__("hullslam", "HullSLAM", {"verbose": 0, "mode": "mono", "preset": "hullslam", "seed": 0})
        self.color = "green"
        self.modes = ["mono", "rgbd", "stereo"]
        self.cam_models = ["pinhole", "radtan4", "radtan5", "equid4"]
        self.command_style = "cpp"

    def has_source(self):
        return True

    def is_installed(self):
        found = shutil.which("hullslam-vslamlab_hullslam_mono") is not None
        return found, "is installed" if found else "not found; install HullSLAM's package"
