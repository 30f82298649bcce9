#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/download_tum.sh with a local file server that can resume downloads."""

import hashlib
import io
import os
import pathlib
import random
import subprocess
import tarfile
import tempfile
import unittest

import file_server

DOWNLOAD = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "download_tum.sh"
FOLDER = "rgbd_dataset_freiburg1_floor"
STAMPS = "# color images\n1.0 rgb/1.0.png\n2.0 rgb/2.0.png\n"
LISTS = {name: STAMPS for name in ("rgb.txt", "depth.txt", "groundtruth.txt")}


def archive(files, links=()):
    """The bytes of a tgz file. Random data make it long enough to be cut short in tests."""
    noise = random.Random(1).randbytes(4000)
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w:gz") as tar:
        for name, text in {**files, f"{FOLDER}/rgb/1.0.png": noise}.items():
            body = text if isinstance(text, bytes) else text.encode()
            info = tarfile.TarInfo(name)
            info.size = len(body)
            tar.addfile(info, io.BytesIO(body))
        for name, target in links:
            info = tarfile.TarInfo(name)
            info.type = tarfile.SYMTYPE
            info.linkname = target
            tar.addfile(info)
    return data.getvalue()


def sequence(**changes):
    return {f"{FOLDER}/{name}": text for name, text in {**LISTS, **changes}.items()}


class DownloadTumTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.served = self.root / "served" / "freiburg1"
        self.served.mkdir(parents=True)
        self.to = self.root / "to"
        self.server = file_server.start(self, self.root / "served")

    def serve(self, data):
        (self.served / f"{FOLDER}.tgz").write_bytes(data)

    def download(self, name="freiburg1_floor", *options, to=None, **settings):
        base = f"http://127.0.0.1:{self.server.server_port}/"
        return subprocess.run([DOWNLOAD, "--to", to or self.to, "--base", base, *options, name],
                              capture_output=True, text=True, check=False, timeout=60, **settings)

    def assert_whole(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 colour images", result.stdout)
        self.assertEqual([path.name for path in self.to.iterdir()], [FOLDER])
        self.assertEqual((self.to / FOLDER / "rgb.txt").read_text(), STAMPS)

    def assert_refused(self, result, message):
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn(message, result.stderr)
        self.assertFalse((self.to / FOLDER).exists())
        self.assertFalse((self.to / f"{FOLDER}.unpacking").exists())

    def assert_refused_and_kept(self, result, message):
        """The message says that the archive was kept, and what to do about it."""
        self.assert_refused(result, message)
        self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assertIn(f"{FOLDER}.tgz", result.stderr)
        self.assertIn("not unpacked. The archive is kept: delete it to download", result.stderr)
        self.assertTrue((self.to / f"{FOLDER}.tgz").exists())

    def test_downloads_and_unpacks(self):
        self.serve(archive(sequence()))
        self.assert_whole(self.download())

    def test_every_accepted_form_of_a_name(self):
        self.serve(archive(sequence()))
        for name in ("fr1/floor", "fr1_floor", FOLDER):
            with self.subTest(name):
                self.assertEqual(self.download(name).returncode, 0)
        self.assertEqual(len(self.server.requests), 1, "downloaded only once")

    def test_resumes_an_interrupted_download(self):
        data = archive(sequence())
        self.serve(data)
        self.to.mkdir()
        (self.to / f"{FOLDER}.tgz.part").write_bytes(data[:1000])
        self.assert_whole(self.download())
        self.assertEqual([span for _, span in self.server.requests], ["bytes=1000-"])

    def test_starts_again_if_the_server_cannot_resume(self):
        data = archive(sequence())
        self.serve(data)
        self.server.resumes = False
        self.to.mkdir()
        (self.to / f"{FOLDER}.tgz.part").write_bytes(data[:1000])
        self.assert_whole(self.download())

    def test_part_file_that_is_already_complete(self):
        data = archive(sequence())
        self.serve(data)
        self.to.mkdir()
        (self.to / f"{FOLDER}.tgz.part").write_bytes(data)
        self.assert_whole(self.download())

    def test_broken_connection_keeps_the_part_file(self):
        self.to.mkdir()
        part = self.to / f"{FOLDER}.tgz.part"
        part.write_bytes(b"half")
        self.assert_refused(self.download(), "interrupted")
        self.assertEqual(part.read_bytes(), b"half")

    def test_missing_on_the_server(self):
        self.assert_refused(self.download(), "cannot download http://127.0.0.1")

    def test_damaged_archive_is_deleted(self):
        self.serve(archive(sequence())[:1500])
        self.assert_refused(self.download(), "damaged")
        self.assertEqual(list(self.to.iterdir()), [])

    def test_files_outside_the_folder(self):
        for name in ("elsewhere/rgb.txt", "/tmp/rgb.txt", f"{FOLDER}/../rgb.txt", f"{FOLDER}x/a"):
            with self.subTest(name):
                (self.to / f"{FOLDER}.tgz").unlink(missing_ok=True)
                self.serve(archive({**sequence(), name: "bad"}))
                self.assert_refused_and_kept(self.download(), "outside")

    def test_links(self):
        self.serve(archive(sequence(), links=[(f"{FOLDER}/link", "/etc")]))
        self.assert_refused_and_kept(self.download(), "contains links")

    def test_no_sequence_inside(self):
        self.serve(archive(sequence(**{"depth.txt": ""})))
        self.assert_refused_and_kept(self.download(), f"no {FOLDER}/depth.txt")

    def test_an_archive_that_would_be_too_large(self):
        self.serve(archive(sequence(**{"big.txt": "x" * 3_000_000})))
        self.assert_refused_and_kept(self.download("fr1_floor", "--max-size", "0.002"),
                                     "it would take more than 0.002 GB")
        self.assertEqual(self.download("fr1_floor", "--max-size", "0.004").returncode, 0)
        for size in ("-1", "x", "1e3", ""):
            with self.subTest(size):
                self.assertEqual(self.download("fr1_floor", "--max-size", size).returncode, 2)

    def test_names_with_blanks(self):
        self.serve(archive(sequence(**{"a b  c.txt": "x", "elsewhere x.txt": "x"})))
        self.assert_whole(self.download())
        self.to.joinpath(FOLDER).rename(self.root / "old")
        self.serve(archive({**sequence(), f"x {FOLDER}/a.txt": "bad"}))
        self.assert_refused_and_kept(self.download(), "outside")

    def test_an_empty_archive(self):
        data = io.BytesIO()
        tarfile.open(fileobj=data, mode="w:gz").close()
        self.serve(data.getvalue())
        self.assert_refused_and_kept(self.download(), "empty")

    def test_known_checksums_are_compared(self):
        data = archive(sequence())
        sums = self.root / "sums"
        self.serve(data)
        sums.write_text(f"{'0' * 64}  {FOLDER}.tgz\n")
        self.assert_refused_and_kept(self.download("fr1_floor", "--checksums", sums),
                                     f"SHA-256 is {hashlib.sha256(data).hexdigest()}, but {sums}")
        sums.write_text(f"# a comment\n{hashlib.sha256(data).hexdigest()}  {FOLDER}.tgz\n")
        self.assert_whole(self.download("fr1_floor", "--checksums", sums))

    def test_archives_with_a_known_sum_are_compared_without_an_option(self):
        data = archive({})
        (self.served / "rgbd_dataset_freiburg1_xyz.tgz").write_bytes(data)
        result = self.download("fr1_xyz")
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"SHA-256 is {hashlib.sha256(data).hexdigest()}, but", result.stderr)

    def test_no_network(self):
        for base in ("http://no-such-host.invalid", "http://127.0.0.1:1"):
            result = subprocess.run([DOWNLOAD, "--to", self.to, "--base", base, "fr1_floor"],
                                    capture_output=True, text=True, check=False, timeout=60)
            self.assert_refused(result, "is there a network connection?")

    def test_unknown_checksums_are_recorded(self):
        data = archive(sequence())
        self.serve(data)
        result = self.download("fr1_floor", "--checksums", "sums", cwd=self.root)
        self.assert_whole(result)
        line = f"{hashlib.sha256(data).hexdigest()}  {FOLDER}.tgz\n"
        self.assertEqual((self.root / "sums").read_text(), line)
        self.assertIn("No checksum", result.stdout)

    def test_cdpath_does_not_change_the_folder(self):
        self.serve(archive(sequence()))
        (self.root / "other" / "to").mkdir(parents=True)
        environment = {**os.environ, "CDPATH": str(self.root / "other")}
        self.assert_whole(self.download("fr1_floor", to="to", cwd=self.root, env=environment))

    def test_bad_names(self):
        for name in ("kitti_00", "freiburg9_floor", "../freiburg1_floor", "freiburg1_floor;true", "--x"):
            with self.subTest(name):
                result = self.download(name)
                self.assertEqual(result.returncode, 2)
                self.assertIn(name, result.stderr)
        self.assertEqual(self.server.requests, [])


if __name__ == "__main__":
    unittest.main()
