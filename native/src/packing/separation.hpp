// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that overlap in a tile, moved until they do not.
#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "base/array.hpp"
#include "packing/bit_columns.hpp"
#include "packing/construction.hpp"

namespace lsgp {

// A number from 0 to less than `most`, the same with every library.
int uniform_below(std::mt19937& random, int most);

// The size of a tile, in texels, how many rounds may make nothing better, and after about how much work to give up.
struct SeparationLimits {
  double width, height;
  int patience;
  double most_work;
};

// Guided local search (Egeblad, Nielsen and Odgaard 2007; Gardeyn and Wauters 2025): bodies that overlap others move to
// where they overlap least, and the overlaps that stay weigh more and more. Bodies lie at whole texels.
class Separation {
 public:
  // poses: have to live longer. bodies: those that are placed. gap: between bodies, in texels.
  Separation(const Array<Array<Pose>>& poses, const Array<Index>& bodies, double gap);

  // Moves bodies into the tile without overlaps; false if they still overlap at one of the limits. placed: (all
  // bodies). work: is added to, as of Constructed.
  bool run(const SeparationLimits& limits, Array<Placed>& placed, std::mt19937& random, double& work);

 private:
  struct Place {
    int pose, column, row;
  };
  // The texels of a pose, and those nearer to it than the gap, `reach` texels further to the left and below.
  struct Texels {
    BitColumns own, widened;
  };

  // Columns and rows, the last ones included.
  struct Extent {
    int left, right, bottom, top;
    bool meets(const Extent& other) const {
      return left <= other.right && other.left <= right && bottom <= other.top && other.bottom <= top;
    }
  };

  const Texels& texels(Index body, int pose);
  Extent extent(Index body, const Place& place, int reach) const;
  void put(Index body, const Place& place);
  int overlap(Index a, const Place& at_a, Index b, const Place& at_b, double most);
  double cost(Index body, const Place& place, double most);
  void move(Index body, std::mt19937& random);
  double total_overlap();
  int last_column(Index body, int pose) const;
  int last_row(Index body, int pose) const;

  const Array<Array<Pose>>& poses_;
  const Array<Index> bodies_;
  const double gap_;
  const int reach_;
  Array<Array<std::optional<Texels>>> texels_;  // (bodies, poses) as far as they have been needed
  double width_ = 0, height_ = 0;
  Array<Place> place_;    // (bodies)
  Array<Extent> extent_;  // (bodies)
  Array<double> weight_;  // (bodies * bodies)
  double work_ = 0;
};

}  // namespace lsgp
