// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "packing/bit_columns.hpp"
#include "packing/bit_kernels.hpp"
#include "packing/bit_rows.hpp"
#include "packing/body.hpp"
#include "packing/construction.hpp"
#include "packing/footprint.hpp"
#include "packing/gaps.hpp"
#include "packing/outline.hpp"
#include "packing/separation.hpp"
#include "packing/sliding.hpp"

using namespace lsgp;

namespace {

constexpr Box anywhere{0, 1e9, 0, 1e9};

// A square ring of eight triangles.
Array<Complex> square_ring(double outer, double inner) {
  const Array<Complex> turn{1, Complex(0, 1), -1, Complex(0, -1)};
  Array<Complex> out;
  for (int i = 0; i < 4; ++i) {
    const Complex a = outer * Complex(1, 1) * turn[i], b = outer * Complex(1, 1) * turn[(i + 1) % 4];
    const Complex c = inner * Complex(1, 1) * turn[i], d = inner * Complex(1, 1) * turn[(i + 1) % 4];
    out.insert(out.end(), {a, b, c, b, d, c});
  }
  return out;
}

// A star with this many points.
Array<Complex> star(std::mt19937& random, int points, double size) {
  const auto number = [&] { return static_cast<double>(random() % 1000) / 1000; };
  Array<Complex> around, out;
  for (int i = 0; i < points; ++i) around.push_back(std::polar(size * (0.3 + 0.7 * number()), 2 * M_PI * i / points));
  for (int i = 0; i < points; ++i) out.insert(out.end(), {0, around[i], around[(i + 1) % points]});
  return out;
}

double distance(Complex point, Complex a, Complex b) {
  const double share = std::clamp(std::real((point - a) * std::conj(b - a)) / std::norm(b - a), 0.0, 1.0);
  return std::abs(point - a - share * (b - a));
}

// The least distance between segments of different outlines, or `reach` if that is less; 0 where segments cross.
double least_gap(const Array<Outline>& outlines, double reach) {
  const auto turns = [](Complex a, Complex b, Complex c) { return std::imag(std::conj(b - a) * (c - a)); };
  double least = reach;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    outlines[i].for_each_segment([&](Complex a, Complex b) {
      for (std::size_t j = 0; j < i; ++j) {
        outlines[j].for_each_segment([&](Complex c, Complex d) {
          if (turns(a, b, c) * turns(a, b, d) < 0 && turns(c, d, a) * turns(c, d, b) < 0) least = 0;
          least = std::min({least, distance(a, c, d), distance(b, c, d), distance(c, a, b), distance(d, a, b)});
        });
      }
    });
  }
  return least;
}

std::ptrdiff_t segment_count(const Outline& outline) {
  std::ptrdiff_t count = 0;
  outline.for_each_segment([&](Complex, Complex) { ++count; });
  return count;
}

}  // namespace

TEST_CASE("the outline of triangles has what one of them has alone") {
  const Outline around = Outline::around_triangles(square_ring(2, 1));
  CHECK(segment_count(around) == 8);
  Array<Complex> mirrored = square_ring(2, 1);
  for (std::size_t t = 0; t < mirrored.size(); t += 6) std::swap(mirrored[t], mirrored[t + 1]);
  CHECK(segment_count(Outline::around_triangles(mirrored)) == 8);
  CHECK(segment_count(Outline::around_triangles({1, 1, 1})) == 1);
  CHECK(segment_count(Outline::around_triangles({0, 1, 1})) == 2);
  CHECK(segment_count(Outline::around_triangles({0, 1, 2})) == 3);  // a triangle without area
}

TEST_CASE("a simplified outline is no further away than allowed") {
  Array<Complex> corners;
  constexpr int count = 200;
  const auto at = [](int i) { return std::polar(1.0, 2 * M_PI * i / count); };
  for (int i = 0; i < count; ++i) corners.insert(corners.end(), {0, at(i), at(i + 1 == count ? 0 : i + 1)});
  const Outline circle = Outline::around_triangles(corners);
  for (const double tolerance : {0.001, 0.01, 0.1}) {
    const Outline simple = circle.simplified(tolerance);
    CHECK(segment_count(simple) < segment_count(circle));
    for (const Complex point : circle.points()) {
      double least = 10;
      simple.for_each_segment([&](Complex a, Complex b) { least = std::min(least, distance(point, a, b)); });
      CHECK(least <= tolerance);
    }
  }
}

TEST_CASE("the texels that are drawn are all those within reach") {
  std::mt19937 random(3);
  for (int k = 0; k < 20; ++k) {
    const Outline outline = Outline::around_triangles(star(random, 7, 12)).moved(1, {20.3, 20.7});
    for (const double reach : {0.0, 0.4, 3.2}) {
      BitRows raster(40, 40);
      draw(outline, reach, raster);
      for (int row = 0; row < 40; ++row) {
        for (int column = 0; column < 40; ++column) {
          // Points of the texel: where one is within reach, it has to be drawn; where all are far off, it must not be.
          double nearest = 100;
          int winding = 0;
          const Complex middle(column + 0.5, row + 0.5);
          outline.for_each_segment([&](Complex a, Complex b) {
            nearest = std::min(nearest, distance(middle, a, b));
            if ((a.imag() <= middle.imag()) != (b.imag() <= middle.imag())) {
              const double share = (middle.imag() - a.imag()) / (b.imag() - a.imag());
              if (a.real() + share * (b.real() - a.real()) < middle.real()) winding += a.imag() < b.imag() ? 1 : -1;
            }
          });
          if (winding != 0 || nearest < reach) CHECK(raster.is_set(row, column));
          if (winding == 0 && nearest > reach + std::sqrt(0.5)) CHECK(!raster.is_set(row, column));
        }
      }
    }
  }
}

TEST_CASE("texels that two rasters share at any place are those counted one by one") {
  std::mt19937 random(7);
  for (int k = 0; k < 200; ++k) {
    BitRows rows[]{{1 + uniform_below(random, 90), 1 + uniform_below(random, 200)},
                   {1 + uniform_below(random, 90), 1 + uniform_below(random, 200)}};
    for (BitRows& raster : rows) {
      for (int row = 0; row < raster.rows(); ++row) {
        const int begin = uniform_below(random, raster.columns());
        raster.set(row, begin, begin + uniform_below(random, raster.columns()) + 1);
      }
    }
    const int right = uniform_below(random, 500) - 250, up = uniform_below(random, 220) - 110;
    int expected = 0;
    for (int row = 0; row < rows[0].rows(); ++row) {
      for (int column = 0; column < rows[0].columns(); ++column) {
        const int x = column - right, y = row - up;
        const bool is_inside = x >= 0 && x < rows[1].columns() && y >= 0 && y < rows[1].rows();
        expected += is_inside && rows[0].is_set(row, column) && rows[1].is_set(y, x);
      }
    }
    const BitColumns a(rows[0]), b(rows[1]);
    std::ptrdiff_t words = 0;
    CHECK(shared_bits(a, b, {right, up}, 1 << 20, words) == expected);
    if (expected > 0) CHECK(shared_bits(a, b, {right, up}, expected - 1, words) > expected - 1);
  }
}

TEST_CASE("all kernels of this processor count the bits that words share") {
  std::mt19937_64 random(3);
  std::uint64_t a[most_words_at_once], low[most_words_at_once], high[most_words_at_once];
  for (int k = 0; k < 500; ++k) {
    const int shift = k % 64, count = k % (most_words_at_once + 1);
    int expected = 0;
    for (int i = 0; i < most_words_at_once; ++i) {
      a[i] = k < 100 ? ~std::uint64_t{0} : random();
      low[i] = k < 100 ? ~std::uint64_t{0} : random();
      high[i] = k < 100 ? ~std::uint64_t{0} : random();
      for (int bit = 0; bit < 64 && i < count; ++bit) {
        const int from = bit + shift;
        const std::uint64_t other = from < 64 ? low[i] >> from : high[i] >> (from - 64);
        expected += static_cast<int>(a[i] >> bit & other & 1);
      }
    }
    for (const SharedBitsOfWords kernel : kernels_of_shared_bits())
      CHECK(kernel(a, low, high, shift, count) == expected);
  }
}

TEST_CASE("the first free place is that which a look at every texel finds") {
  std::mt19937 random(5);
  TakenTexels taken(100, 150);
  BitRows same(100, 150);
  for (int k = 0; k < 12; ++k) {
    const Outline outline = Outline::around_triangles(star(random, 6, 15))
                                .moved(1, {static_cast<double>(random() % 150), static_cast<double>(random() % 100)});
    taken.take(outline, 1.5);
    draw(outline, 1.5, same);
  }
  for (int k = 0; k < 10; ++k) {
    const Outline shape = Outline::around_triangles(star(random, 5, 4 + k));
    const Box box = shape.box();
    const Footprint footprint(shape.moved(1, {-box.left, -box.bottom}));
    const int last_row = static_cast<int>(100 - (box.top - box.bottom)) - 1;
    const int last_column = static_cast<int>(150 - (box.right - box.left)) - 1;
    double looks = 0;
    for (int row = 0; row <= last_row; ++row) {
      int expected = -1;
      for (int column = 0; column <= last_column && expected < 0; ++column) {
        bool is_free = true;
        for (const Span& span : footprint.spans()) {
          for (int x = span.begin; x < span.end; ++x) is_free &= !same.is_set(row + span.row, column + x);
        }
        if (is_free) expected = column;
      }
      CHECK(taken.first_free(footprint, row, 0, last_column, looks) == expected);
    }
  }
}

TEST_CASE("a point goes on until it is as near as it may be") {
  std::mt19937 random(7);
  const auto number = [&] { return static_cast<double>(random() % 2000) / 1000 - 1; };
  for (int k = 0; k < 1000; ++k) {
    const Complex a(number(), number()), b(number(), number()), point(3, number());
    const double gap = k % 3 == 0 ? 0.0 : 0.3;
    const double way = travel_to_segment(point, a, b, gap, 9);
    double nearest = 10;
    for (int step = 0; step <= 100; ++step) nearest = std::min(nearest, distance(point - way * step / 100.0, a, b));
    CHECK(nearest >= gap - 1e-12);
    if (way < 9) CHECK(distance(point - way, a, b) == doctest::Approx(gap).epsilon(1e-9));
  }
}

TEST_CASE("bodies are placed without meeting, at the gap or more, also in holes") {
  std::mt19937 random(11);
  Array<Outline> shapes{Outline::around_triangles(square_ring(30, 24))};
  for (int k = 0; k < 25; ++k) shapes.push_back(Outline::around_triangles(star(random, 8, 6 + k % 5)));
  Array<Array<Pose>> poses;
  Array<Index> order;
  for (const Outline& shape : shapes) {
    order.push_back(static_cast<Index>(poses.size()));
    poses.push_back(poses_of(shape, {1, Complex(0, 1), std::polar(1.0, 0.3)}, 1, anywhere));
  }
  for (const bool on_texels : {false, true}) {
    ConstructionOptions how;
    how.gap = 1.25;
    how.on_texels = on_texels;
    const Constructed found = construct(poses, {{70, 70, {}}, {90, 90, {}}}, order, {}, how);
    REQUIRE(found.missing == 0);
    Array<Outline> placed;
    bool any_in_hole = false;
    for (std::size_t b = 0; b < poses.size(); ++b) {
      const Placed& at = found.placed[b];
      placed.push_back(poses[b][at.pose].outline.moved(1, at.at + Complex(1000.0 * at.tile, 0)));
      const Box box = placed.back().box();
      CHECK(box.left >= 1000 * at.tile);
      CHECK(box.right <= 1000 * at.tile + 90);
      any_in_hole |= b > 0 && box.left > 6 && box.right < 54 && box.bottom > 6 && box.top < 54;
    }
    CHECK(least_gap(placed, 5) >= how.gap * (1 - 1e-12));
    CHECK(overlapping_pair({placed[1], placed[2]}).first == -1);
    CHECK(any_in_hole);
  }
}

TEST_CASE("bodies that all lie on each other come apart, at the gap or more, where there is room") {
  std::mt19937 random(13);
  Array<Array<Pose>> poses;
  Array<Index> bodies;
  for (int k = 0; k < 12; ++k) {
    bodies.push_back(k);
    poses.push_back(poses_of(Outline::around_triangles(star(random, 7, 10)), {1, Complex(0, 1)}, 1, anywhere));
  }
  constexpr double gap = 1.7, side = 80;
  Separation separation(poses, bodies, gap);
  Array<Placed> placed(poses.size(), Placed{0, 0, 0});
  double work = 0;
  REQUIRE(separation.run({side, side, 50, 1e10}, placed, random, work));
  CHECK(work > 0);
  Array<Outline> outlines;
  for (std::size_t b = 0; b < poses.size(); ++b) {
    outlines.push_back(poses[b][placed[b].pose].outline.moved(1, placed[b].at));
    const Box box = outlines.back().box();
    CHECK(std::min(box.left, box.bottom) >= 0);
    CHECK(std::max(box.right, box.top) <= side);
  }
  CHECK(least_gap(outlines, 5) >= gap * (1 - 1e-12));
  const Array<Placed> before = placed;
  CHECK(!separation.run({25, 25, 5, 1e10}, placed, random, work));
  for (std::size_t b = 0; b < poses.size(); ++b) CHECK(placed[b].at == before[b].at);
}

TEST_CASE("what overlaps is found, also inside") {
  const Outline small = Outline::around_triangles({0, 1, Complex(0, 1)});
  const Outline large = Outline::around_triangles({-5, Complex(5, -5), Complex(0, 9)});
  const Outline band = Outline::around_triangles(square_ring(20, 15));
  CHECK(overlapping_pair({small.moved(1, 30), band, small.moved(1, {30, 5}), large}).first == -1);
  CHECK(overlapping_pair({band, small, large}) == std::pair<Index, Index>(1, 2));
  CHECK(overlapping_pair({band, small.moved(1, 14.5)}) == std::pair<Index, Index>(0, 1));
}
