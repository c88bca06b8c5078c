// SPDX-License-Identifier: GPL-3.0-or-later
// What every answer of the library promises, judged without it; a broken promise ends the process.
#pragma once

#include <vector>

#include "lsgp/lsgp.hpp"

void require(bool condition, const char* what);

// Findings have a sentence and name what exists.
void require_elements(const std::vector<lsgp::Finding>& findings, const lsgp::Surface& surface);

// Everything that is wrong with a map is named by a warning of it.
void require_honest(const lsgp::Surface& surface, const lsgp::Options& options, const lsgp::Result& result);

// The same bytes in all that is drawn or imposed, for two ways to the same result.
void require_same(const lsgp::Result& one, const lsgp::Result& other);

void require_cones(const lsgp::Surface& surface, const std::vector<lsgp::Index>& cones,
                   const std::vector<double>& angles);
