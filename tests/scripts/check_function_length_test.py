#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/check_function_length.py: which functions it finds, and how long they are."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_function_length  # noqa: E402


def functions_of(text):
    return list(check_function_length.functions(text))


def long_function(lines):
    """A function of so many lines."""
    return "int Long() {\n" + "  Step();\n" * (lines - 2) + "}\n"


def faults_of(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_function_length.check_tree(root)


class FunctionsTest(unittest.TestCase):
    def assert_functions(self, text, *expected):
        self.assertEqual(functions_of(text), list(expected))

    def test_functions_in_namespaces(self):
        self.assert_functions("namespace a::b {\nnamespace {\nint F() { return 1; }\n}  // namespace\n"
                              "void G(int a,\n       int b) {\n  F();\n}\n\n}  // namespace a::b\n",
                              ("F", 3, 1), ("G", 5, 4))

    def test_members_of_classes(self):
        self.assert_functions(
            "class A final : public B {\n public:\n  int x() const { return x_; }\n"
            "  struct C {\n    void D() noexcept override {\n    }\n  };\n\n private:\n  int x_ = 0;\n"
            "};\nint A::y() const {\n  return 2;\n}\n",
            ("x", 3, 1), ("D", 5, 2), ("A::y", 12, 3))

    def test_declarations_are_no_functions(self):
        self.assert_functions("namespace ceres {\nclass Problem;\n}\nint F(int a = 3);\n"
                              "enum class Kind : uint8_t {\n  kA,\n  kB,\n};\n"
                              "using G = void (*)(int);\n")

    def test_values_in_braces_are_no_functions(self):
        self.assert_functions(
            "constexpr std::array kNames = {Name(1), Name(2),\n  Name(3)};\n"
            "const std::map<int, int> kMap{{1, 2}, {3, 4}};\n"
            "std::array<int, static_cast<size_t>(kA * kB)> cells_{\n  1,\n};\n"
            "const Table kTable = MakeTable({1, 2}, [] {\n  return 3;\n});\n"
            "struct Options {\n  Sigmas sigmas = {\n    .log_axes = F(0.5)};\n  int a{};\n};\n")

    def test_constructors_with_initialiser_lists(self):
        self.assert_functions("A::A(int a)\n    : x_(a),\n      y_{1, 2},\n      z_{} {\n  F();\n}\n",
                              ("A::A", 1, 6))
        self.assert_functions("A::A() : x_{1} {}\nint F() { return 1; }\n",
                              ("A::A", 1, 1), ("F", 2, 1))
        self.assert_functions("A::A()\n    : thread_([this] {\n        Run();\n      }) {}\n",
                              ("A::A", 1, 4))

    def test_default_arguments_in_braces(self):
        self.assert_functions("void F(const Options& options = {},\n       int a = {}) {\n}\n",
                              ("F", 1, 3))

    def test_a_lambda_belongs_to_the_function_around_it(self):
        self.assert_functions("void F() {\n  const auto g = [&](int a) {\n    return a;\n  };\n}\n",
                              ("F", 1, 5))

    def test_a_lambda_outside_of_functions_counts(self):
        self.assert_functions("const auto kF = [](int a) -> int {\n  return a;\n};\n"
                              "const auto kG = [] {\n};\n", ("kF", 1, 3), ("kG", 4, 2))

    def test_operators(self):
        self.assert_functions(
            "bool operator==(const A& a, const A& b) { return true; }\n"
            "A& A::operator=(A&& other) noexcept {\n}\nbool operator()(int a) const {\n}\n"
            "bool operator<=(A a, A b) {\n}\n",
            ("operator==", 1, 1), ("A::operator=", 2, 2), ("operator()", 4, 2),
            ("operator<=", 6, 2))

    def test_templates(self):
        self.assert_functions(
            "template <class T, typename U = std::vector<int>>\nauto F(T t) -> std::vector<U> {\n}\n"
            "template <typename T>\nclass A {\n  T x() { return {}; }\n};\n"
            "template <typename T>\nT G(T t) requires std::integral<T> {\n}\n",
            ("F", 1, 3), ("x", 6, 1), ("G", 8, 3))

    def test_test_macros(self):
        self.assert_functions("TEST(IdTest, Orders) {\n  EXPECT_EQ(1, 1);\n}\n", ("TEST", 1, 3))

    def test_braces_that_do_not_count(self):
        self.assert_functions(
            'void F() {\n  // }\n  /* } */\n  Print("}\\"}");\n  Put(\'}\');\n  Put(\'\\\'\');\n'
            '  const char* text = R"json(\n}\n")"}})json";\n  const int million = 1\'000\'000;\n}\n',
            ("F", 1, 11))
        self.assert_functions("#define BLOCK(x) { \\\n  { x\n#if A\nvoid F() {\n#endif\n}\n",
                              ("F", 4, 3))

    def test_comments_before_a_function_do_not_count(self):
        self.assert_functions("// Adds.\n// { twice }\n\nint F() {\n}\n", ("F", 4, 2))

    def test_the_first_line_is_that_of_the_return_type(self):
        self.assert_functions("const std::vector<std::string>&\nLongName(int a,\n         int b) {\n}\n",
                              ("LongName", 1, 4))

    def test_braces_that_do_not_match(self):
        for text in ("void F() {\n", "namespace a {\n", "}\n", "void F() {\n}\n}\n"):
            with self.subTest(text), self.assertRaises(ValueError):
                functions_of(text)


class CheckTreeTest(unittest.TestCase):
    def test_the_limit(self):
        self.assertEqual(faults_of({"src/a/b.cc": long_function(60)}), [])
        self.assertEqual(faults_of({"src/a/b.cc": "\n" + long_function(61)}),
                         ["src/a/b.cc:2: Long has 61 lines, at most 60"])

    def test_folders(self):
        text = long_function(61)
        for name in ("src/a.h", "include/hullslam/util/a.h", "Examples/a.cc", "tools/a.cc",
                     "bench/a.cc", "tests/support/a.h", "python/a.cc"):
            with self.subTest(name):
                self.assertEqual(len(faults_of({name: text})), 1)
        self.assertEqual(faults_of({"src/a.cc": "", "tests/util/a_test.cc": text, "src/a.py": text}),
                         [])

    def test_a_file_that_cannot_be_read_is_a_fault(self):
        self.assertEqual(faults_of({"src/a.cc": "void F() {\n"}),
                         ["src/a.cc: line 1: the brace is not closed"])

    def test_empty_tree_fails(self):
        self.assertEqual(len(faults_of({})), 1)


if __name__ == "__main__":
    unittest.main()
