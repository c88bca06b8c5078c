// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <lsgp/lsgp.hpp>

int main() {
  lsgp::Surface tetrahedron;
  tetrahedron.positions.resize(4, 3);
  tetrahedron.positions << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  tetrahedron.triangles.resize(4, 3);
  tetrahedron.triangles << 0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2;
  lsgp::AutoUnwrapOptions options;
  options.preset = lsgp::Preset::bake;
  options.weights = lsgp::preset_weights(options.preset);
  options.weights->islands = 1;
  const lsgp::Unwrapped found = lsgp::auto_unwrap(tetrahedron, {}, options);
  std::printf("L2 stretch %.6f\n", found.result.distortion.l2_stretch);
  for (const lsgp::Choice& choice : found.choices) {
    std::printf("%c %s: %s\n", choice.is_best ? '*' : ' ', choice.name.c_str(), choice.reason.c_str());
  }
}
