// SPDX-License-Identifier: GPL-3.0-or-later
#include "core.h"

int main() { return CoreWorks() ? 0 : 1; }
