// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of the library as exceptions of the package.
#pragma once

void translate_errors();
