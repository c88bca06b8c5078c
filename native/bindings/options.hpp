// SPDX-License-Identifier: GPL-3.0-or-later
// Options of verbs, from dictionaries and names.
#pragma once

#include <pybind11/pybind11.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "lsgp/lsgp.hpp"

namespace py = pybind11;

template <typename Choice>
Choice choose(const std::string& text, std::initializer_list<std::pair<const char*, Choice>> choices) {
  for (const auto& [name, choice] : choices) {
    if (text == name) return choice;
  }
  throw py::value_error("unknown choice '" + text + "'");
}

lsgp::SeamMode to_seam_mode(const std::string& name);

lsgp::BorderMode to_border_mode(const std::string& name);

lsgp::Lattice to_lattice(const std::string& name);

// A dictionary with the fields of lsgp.Options.
lsgp::Options to_options(const py::dict& values);

// The same, of maps whose rule for angles follows from their cones where the dictionary has none.
lsgp::MapOptions to_map_options(const py::dict& values);

// A dictionary with the fields of lsgp.api's placement options.
lsgp::PlacementOptions to_placement_options(const py::dict& values);
