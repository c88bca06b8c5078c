// SPDX-License-Identifier: GPL-3.0-or-later
// The native verbs by what they are about: checked views of arrays in, owning arrays out.
#pragma once

#include <pybind11/pybind11.h>

// Maps, kept solvers and previews, and measures of maps.
void define_maps(pybind11::module_& module);
// Cones, their angles, and what they have to add up to.
void define_cones(pybind11::module_& module);
// Cuts, what they cost, and where components may end.
void define_cuts(pybind11::module_& module);
// A map in one call.
void define_presets(pybind11::module_& module);
// Islands of finished maps: packed, in other shapes, or overlapping.
void define_layouts(pybind11::module_& module);
void define_quads(pybind11::module_& module);
