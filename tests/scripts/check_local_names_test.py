#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/check_local_names.py: which names it finds, and which of them clash."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_local_names  # noqa: E402


def local(text):
    return "namespace hullslam {\nnamespace {\n\n" + text + "\n}  // namespace\n}  // namespace hullslam\n"


def names_of(text):
    return [name for name, _, _ in check_local_names.local_names(text)]


def faults_of(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_local_names.check_tree(root)


class LocalNamesTest(unittest.TestCase):
    def test_definitions(self):
        for text, name in (("struct Seen {\n  int a;\n};", "Seen"),
                           ("struct Seen;", "Seen"),
                           ("class Seen final : public Base<int> {\n};", "Seen"),
                           ("enum class Kind { kA, kB };", "Kind"),
                           ("using Json = nlohmann::json;", "Json"),
                           ("constexpr double kPi = 3.0;  // rad", "kPi"),
                           ("constexpr double kPi{3.0};", "kPi"),
                           ("const std::array<std::pair<int, int>, 2> kPairs = {{{1, 2}, {3, 4}}};",
                            "kPairs"),
                           ("const char* const kText = \"struct A {\";", "kText"),
                           ("const Rigid3 kPose(Turn(1), {1.0});", "kPose"),
                           ("double values[2] = {1, 2};", "values"),
                           ("std::function<void(int)> Make(int a, double b = 2.0) {\n  F();\n}", "Make"),
                           ("[[nodiscard]] bool Is(const std::map<int, int>& a) { return !a.empty(); }",
                            "Is"),
                           ("template <typename T, int N = 2>\nT Sum(T a) {\n}", "Sum"),
                           ("TEST(Id, Orders) {\n}", "Id_Orders"),
                           ("TEST_F(IdTest, Orders) {\n}", "IdTest_Orders"),
                           ("INSTANTIATE_TEST_SUITE_P(All, IdTest, Values(1));", "All_IdTest")):
            with self.subTest(text):
                self.assertEqual(names_of(local(text)), [f"hullslam::{name}"])

    def test_what_defines_no_name(self):
        for text in ("namespace fs = std::filesystem;", "using std::string;",
                     "using namespace std::literals;", "static_assert(sizeof(int) == 4);",
                     "Seen::Seen() : a_(1), b_{2} {}", "bool Seen::Is() const {\n}",
                     "bool operator==(const Seen& a, const Seen& b) { return true; }",
                     "// int a;", "#define A int a;"):
            with self.subTest(text):
                self.assertEqual(names_of(local(text)), [])

    def test_only_anonymous_namespaces_count(self):
        text = "namespace a {\nint F() {\n}\nstruct S {\n  int b;\n};\nnamespace {\nint G() {\n  int c;\n}\n" \
               "}\nint H() {\n}\n}\nnamespace {\nint I;\n}\n"
        self.assertEqual(names_of(text), ["a::G", "I"])

    def test_braces_that_do_not_match(self):
        for text in ("namespace {\nvoid F() {\n}\n}\n}\n", "namespace {\nvoid F() {\n"):
            with self.subTest(text), self.assertRaises(ValueError):
                names_of(text)


class CheckTreeTest(unittest.TestCase):
    def assert_clash(self, first, second, expected):
        faults = faults_of({"src/map/a.cc": local(first), "src/map/b.cc": local(second)})
        self.assertEqual(len(faults), expected, faults)

    def test_equal_names(self):
        self.assertEqual(
            faults_of({"src/map/a.cc": local("struct Seen {};"),
                       "src/map/b.cc": local("int c;\nclass Seen {};")}),
            ["src/map/b.cc:5: hullslam::Seen is also in src/map/a.cc"])
        self.assert_clash("constexpr int kA = 1;", "constexpr int kA = 1;", 1)
        self.assert_clash("const Pose kA(1);", "const Pose kA(1, 2);", 1)
        self.assert_clash("int F(int a) { return a; }", "struct F {};", 1)
        self.assert_clash("TEST(A, B) {\n}", "TEST_F(A, B) {\n}", 1)

    def test_other_namespaces_and_other_names(self):
        self.assert_clash("struct Seen {};", "struct Unseen {};", 0)
        self.assertEqual(faults_of({"src/map/a.cc": "namespace a {\nnamespace {\nint F;\n}\n}\n",
                                    "src/map/b.cc": "namespace b {\nnamespace {\nint F;\n}\n}\n"}), [])

    def test_functions_differ_by_their_parameters(self):
        self.assert_clash("int F(int a, const std::vector<int>& b = {1, 2});",
                          "int F(int c,\n      const std::vector<int>& d) {\n}", 1)
        self.assert_clash("int F() {\n}", "double F() {\n}", 1)
        self.assert_clash("int F(int a) {\n}", "int F(double a) {\n}", 0)
        self.assert_clash("int F(std::map<int, int> a) {\n}", "int F(std::map<int, bool> a) {\n}", 0)
        self.assert_clash("int F(const Id& a) {\n}", "int F(const Id& a, int b) {\n}", 0)

    def test_aliases_may_be_equal(self):
        self.assert_clash("using Json = nlohmann::json;", "using Json = nlohmann::json;", 0)
        self.assert_clash("using Json = nlohmann::json;", "using Json = other::json;", 1)
        self.assert_clash("using Json = nlohmann::json;", "struct Json {};", 1)

    def test_a_folder_is_a_target(self):
        text = local("struct Seen {};")
        for first, second, expected in (
                ("src/map/a.cc", "src/optim/a.cc", 0), ("src/run/a.cc", "src/run/tools/a.cc", 1),
                ("tests/map/a_test.cc", "tests/map/b_test.cc", 1),
                ("tests/map/a_test.cc", "src/map/b.cc", 0),
                ("tests/integration/a_test.cc", "tests/integration/b_test.cc", 0),
                ("tools/synthetic/a.cc", "tools/synthetic/b.cc", 1),
                ("tools/synthetic/a.cc", "tools/synthetic/tests/b.cc", 0),
                ("bench/a.cc", "bench/b.cc", 0)):
            with self.subTest(first + " " + second):
                self.assertEqual(len(faults_of({"src/a/a.cc": "", first: text, second: text})),
                                 expected)

    def test_a_file_that_cannot_be_read_is_a_fault(self):
        self.assertEqual(faults_of({"src/a/a.cc": "namespace {\nvoid F() {\n"}),
                         ["src/a/a.cc: line 2: the brace is not closed"])

    def test_empty_tree_fails(self):
        self.assertEqual(len(faults_of({})), 1)


if __name__ == "__main__":
    unittest.main()
