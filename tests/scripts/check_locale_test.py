#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/check_locale.py on small trees; most of them break one rule."""

import pathlib
import sys
import unittest

from small_tree import faults_in

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_locale  # noqa: E402


def faults_of(files):
    return faults_in(check_locale.check_tree, files)


class CheckLocaleTest(unittest.TestCase):
    def assert_fault(self, line, *parts, file="src/util/a.cc"):
        faults = faults_of({file: "\n" + line + "\n"})
        self.assertEqual(len(faults), 1, f"{line}: {faults}")
        for part in (f"{file}:2: ", *parts):
            self.assertIn(part, faults[0])

    def test_accepts_what_asks_no_locale(self):
        self.assertEqual(faults_of({
            "src/util/a.cc": 'std::from_chars(a, b, value); // not strtod()\n'
                             'fmt::format("{:.3f}", x); std::to_string(3);\n'
                             '/* std::stringstream */ my_atof(x); options.stod(x);\n'
                             'std::snprintf(text, 3, "%s %d%%", name, 3);\n'
                             'std::ifstream file(path); file.read(bytes, 3); x << 3;\n',
            "Examples/a.cc": 'std::printf("%.3f m\\n", x);\n',
            "tools/synthetic/tests/a_test.cc": "std::istringstream stream(text);\n",
            "python/src/a.cc": 'x = node.as<std::string>();\n',
        }), [])

    def test_numbers_by_the_locale(self):
        for name in ("std::strtod", "strtof", "strtold", "std::atof", "atoi", "std::stod", "std::stof",
                     "sscanf", "std::sscanf", "fscanf", "scanf"):
            self.assert_fault(f"value = {name}(text);", name, "reads a number")
        self.assert_fault("value = node.as<double>();", "as<double>")
        self.assert_fault("cv::FileStorage file(path, 0);", "cv::FileStorage")

    def test_all_folders_of_the_code(self):
        for file in ("include/hullslam/util/a.h", "Examples/a.cc", "tools/synthetic/a.cc",
                     "python/src/a.cc"):
            self.assert_fault("value = std::strtod(text, nullptr);", "std::strtod", file=file)

    def test_kinds_of_characters(self):
        self.assert_fault("return std::isspace(c);", "std::isspace")
        self.assert_fault("std::transform(a, b, c, std::tolower);", "std::tolower")

    def test_locales(self):
        self.assert_fault('std::setlocale(LC_ALL, "");', "setlocale")
        self.assert_fault("text << std::put_time(&time, form);", "put_time")
        self.assert_fault("std::locale::global(other);", "std::locale")

    def test_streams(self):
        self.assert_fault("std::ostringstream text;", "std::ostringstream")
        self.assert_fault('std::cerr << "error";', "std::cerr")
        self.assert_fault("std::ifstream file(path); file >> x;", "file >>")
        self.assert_fault("std::ofstream out(path); out << x;", "out <<")

    def test_printing_of_numbers(self):
        self.assert_fault('std::snprintf(text, 20, "%d %6.3f", n, x);', "prints a number")
        self.assert_fault('std::fprintf(stderr, "%lg", x);', "prints a number", file="tools/a.cc")

    def test_a_tree_without_files_is_a_fault(self):
        self.assertEqual(len(faults_of({"docs/a.md": "text"})), 1)


if __name__ == "__main__":
    unittest.main()
