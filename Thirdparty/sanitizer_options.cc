// SPDX-License-Identifier: GPL-3.0-or-later
// What the sanitizers should overlook in the libraries of others. Compiled into every program and
// test of a sanitizer build: from an archive the linker would not take it.

#ifdef __SANITIZE_THREAD__
// OpenCV tries GDAL among its decoders. GDAL takes its own two mutexes in one order when it sets
// itself up and in the other later, all in one thread and before a second one reads images.
extern "C" const char* __tsan_default_suppressions();  // NOLINT: the name is the sanitizer's
extern "C" const char* __tsan_default_suppressions() { return "deadlock:libgdal.so\n"; }  // NOLINT
#endif
