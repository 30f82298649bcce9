#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/download_icl.sh with a local file server that can resume downloads."""

import hashlib
import io
import pathlib
import random
import subprocess
import sys
import tarfile
import tempfile
import unittest

import file_server

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
DOWNLOAD = SCRIPTS / "download_icl.sh"
sys.path.insert(0, str(SCRIPTS))
from paper_tables.sequences import find_dataset  # noqa: E402

FOLDER = "traj2_frei_png"
TRUTH = "1 0 0 0 0 0 0 1\n"
PAIRS = "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n"
FILES = {"associations.txt": PAIRS, "rgb/0.png": random.Random(1).randbytes(4000),
         "depth/0.png": b"depth", "traj2.gt.freiburg": TRUTH}


def archive(files):
    """The bytes of an archive. Like the original ones it has no folder of its own."""
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w:gz") as tar:
        for name, content in files.items():
            body = content if isinstance(content, bytes) else content.encode()
            info = tarfile.TarInfo(name)
            info.size = len(body)
            tar.addfile(info, io.BytesIO(body))
    return data.getvalue()


class DownloadIclTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.served = self.root / "served"
        (self.served / "VaFRIC").mkdir(parents=True)
        self.to = self.root / "to"
        self.server = file_server.start(self, self.served)

    def serve(self, files, name=FOLDER):
        data = archive(files)
        (self.served / f"{name}.tar.gz").write_bytes(data)
        return data

    def download(self, *arguments):
        base = f"http://127.0.0.1:{self.server.server_port}"
        return subprocess.run([DOWNLOAD, "--to", self.to, "--base", base, *arguments],
                              capture_output=True, text=True, check=False, timeout=60)

    def assert_whole(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{FOLDER}: 2 pairs of images", result.stdout)
        self.assertEqual([path.name for path in self.to.iterdir()], [FOLDER])
        self.assertEqual((self.to / FOLDER / "associations.txt").read_text(), PAIRS)
        self.assertEqual((self.to / FOLDER / "traj2.gt.freiburg").read_text(), TRUTH)
        self.assertEqual(find_dataset(self.to / FOLDER), "icl")

    def assert_refused(self, result, message, code=1):
        self.assertEqual(result.returncode, code, result.stdout)
        self.assertIn(message, result.stderr)
        self.assertFalse((self.to / FOLDER).exists())
        self.assertFalse((self.to / f"{FOLDER}.unpacking").exists())

    def test_every_form_of_a_name(self):
        self.serve(FILES)
        for name in ("office_traj2", "traj2", FOLDER):
            self.assert_whole(self.download(name)) if not self.to.exists() else self.assertIn(
                "exists already", self.download(name).stdout)
        self.assertEqual(len(self.server.requests), 1, "downloaded only once")

    def test_the_living_room_with_noise(self):
        self.serve({**FILES, "livingRoom1n.gt.freiburg": TRUTH}, "living_room_traj1n_frei_png")
        self.assertEqual(self.download("living_room_traj1n").returncode, 0)
        self.assertTrue((self.to / "living_room_traj1n_frei_png" / "rgb" / "0.png").exists())

    def test_an_archive_without_the_true_trajectory(self):
        self.serve({name: data for name, data in FILES.items() if "freiburg" not in name})
        (self.served / "VaFRIC" / "traj2.gt.freiburg").write_text(TRUTH)
        self.assert_whole(self.download("office_traj2"))

    def test_the_true_trajectory_is_nowhere(self):
        self.serve({name: data for name, data in FILES.items() if "freiburg" not in name})
        result = self.download("office_traj2")
        self.assertEqual(result.returncode, 1)
        self.assertIn("the server does not have this file", result.stderr)
        self.assertFalse((self.to / FOLDER).exists())

    def test_resumes_an_interrupted_download(self):
        data = self.serve(FILES)
        self.to.mkdir()
        (self.to / f"{FOLDER}.tar.gz.part").write_bytes(data[:1000])
        self.assert_whole(self.download("office_traj2"))
        self.assertEqual([span for _, span in self.server.requests], ["bytes=1000-"])

    def test_a_damaged_archive_is_downloaded_again(self):
        data = archive(FILES)
        (self.served / f"{FOLDER}.tar.gz").write_bytes(data[:-500])
        self.assert_refused(self.download("office_traj2"), "was damaged and has been deleted")
        self.serve(FILES)
        self.assert_whole(self.download("office_traj2"))

    def test_archives_that_are_no_sequences(self):
        self.serve({"rgb/0.png": b"", "depth/0.png": b""})
        self.assert_refused(self.download("office_traj2"), "as it has no associations.txt")
        self.to.joinpath(f"{FOLDER}.tar.gz").unlink()
        for name in ("../evil", "/evil"):
            self.serve({**FILES, name: "x"})
            self.assert_refused(self.download("office_traj2"),
                                "it contains files outside its own folder")
            self.to.joinpath(f"{FOLDER}.tar.gz").unlink()
            self.assertFalse((self.root / "evil").exists())

    def test_known_checksums_are_compared(self):
        data = self.serve(FILES, "living_room_traj0_frei_png")
        self.assert_refused(self.download("living_room_traj0"),
                            f"SHA-256 is {hashlib.sha256(data).hexdigest()}, but")

    def test_no_network(self):
        result = subprocess.run([DOWNLOAD, "--to", self.to, "--base", "http://127.0.0.1:1", "traj0"],
                                capture_output=True, text=True, check=False, timeout=60)
        self.assert_refused(result, "is there a network connection?")

    def test_bad_usage(self):
        for name in ("traj4", "kitchen_traj0", "../traj0", "traj0;true", "--x"):
            with self.subTest(name):
                self.assert_refused(self.download(name), name, code=2)
        self.assert_refused(self.download(), "no SEQUENCE", code=2)
        self.assertEqual(self.server.requests, [])


if __name__ == "__main__":
    unittest.main()
