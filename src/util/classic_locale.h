// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <clocale>

namespace hullslam {

// While it exists, this thread has the locale "C", whatever locale the program has. It is for calls
// of libraries that read numbers by the locale.
class ClassicLocale {
 public:
  ClassicLocale() : former_(::uselocale(Classic())) {}
  ~ClassicLocale() { ::uselocale(former_); }
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;

 private:
  static locale_t Classic() {
    static const locale_t classic = ::newlocale(LC_ALL_MASK, "C", locale_t{});
    return classic;
  }

  locale_t former_;
};

}  // namespace hullslam
