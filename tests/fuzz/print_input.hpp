// SPDX-License-Identifier: GPL-3.0-or-later
// An input as Python, for a test of what it found.
#pragma once

#include "lsgp/lsgp.hpp"

// Whether FUZZ_PRINT is set: inputs and errors are printed.
bool printing();

void print(const lsgp::Surface& surface);
void print(const lsgp::Cones& cones);
void print(const lsgp::Options& options);
void print(const lsgp::Pins& pins);
void print(const lsgp::PlacementOptions& options);
