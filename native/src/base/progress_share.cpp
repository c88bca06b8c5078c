// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/progress_share.hpp"

#include <utility>

#include "lsgp/errors.hpp"

namespace lsgp {

Progress share_of(const Progress& progress, double begin, double end) {
  if (!progress) return {};
  return [progress, begin, end](double done) { return progress(begin + (end - begin) * done); };
}

void tell(const Progress& progress, double done) {
  if (progress && !progress(done)) throw Error(Code::cancelled, "Stopped as asked; nothing was changed.");
}

ProgressSteps::ProgressSteps(Progress progress) : progress_(std::move(progress)) {}

Progress ProgressSteps::next() {
  constexpr double share = 0.1;
  const double begin = done_;
  done_ += (1 - begin) * share;
  return share_of(progress_, begin, done_);
}

}  // namespace lsgp
