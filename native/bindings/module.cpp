// SPDX-License-Identifier: GPL-3.0-or-later
// The compiled module: the native verbs and what readers and writers of meshes need.
#include <pybind11/pybind11.h>

#include "binary_rows.hpp"
#include "ear_clipping.hpp"
#include "errors.hpp"
#include "mesh_text.hpp"
#include "polygons.hpp"
#include "verbs.hpp"

PYBIND11_MODULE(_lsgp, module) {
  module.doc() = "Native verbs of lsgp; call them through the functions of the package.";
  translate_errors();
  define_mesh_text(module);
  define_binary_rows(module);
  define_ear_clipping(module);
  define_polygons(module);
  define_maps(module);
  define_cuts(module);
  define_cones(module);
  define_presets(module);
  define_layouts(module);
  define_quads(module);
}
