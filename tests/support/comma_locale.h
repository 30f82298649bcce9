// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <locale>
#include <string>

#include "support/temporary_folder.h"

namespace hullslam {

// While it exists, the program has a locale with another decimal point, as a program of a user may
// set it: that of the functions of C, and that of the streams of C++, which also separate
// thousands. The point may have several bytes, as "<U066B>" of Persian.
class CommaLocale {
 public:
  explicit CommaLocale(const std::string& point = ",") : former_(std::locale()) {
    const auto source = folder_.Write("source", "comment_char %\nescape_char /\nLC_NUMERIC\n" +
                                                    ("decimal_point \"" + point + "\"\n") +
                                                    "thousands_sep \".\"\ngrouping 3;3\n"
                                                    "END LC_NUMERIC\n");
    const std::string made = (folder_.path() / "comma").string();
    // It warns of all other categories, and then ends with 1.
    [[maybe_unused]] const int code = std::system(
        ("localedef -c -f UTF-8 -i " + source.string() + " " + made + " > /dev/null 2>&1").c_str());
    ::setenv("LOCPATH", folder_.path().c_str(), 1);
    EXPECT_NE(std::setlocale(LC_NUMERIC, "comma"), nullptr) << "the package locales is missing";
    EXPECT_EQ(std::strtod("1.5", nullptr), 1.0);
    std::locale::global(std::locale(std::locale::classic(), new Comma));
  }
  ~CommaLocale() {
    std::locale::global(former_);
    std::setlocale(LC_NUMERIC, "C");
    ::unsetenv("LOCPATH");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

 private:
  class Comma : public std::numpunct<char> {
   protected:
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };

  TemporaryFolder folder_;
  std::locale former_;
};

}  // namespace hullslam
